#include "present/list.h"

#include "present/parameter_table.h"

namespace heatsoak::present {

Document list_document(std::span<const NamedThing> things) {
  Table table = labelled_table("");
  for (const NamedThing& each : things) {
    table.rows.push_back({{each.id}, {each.summary}});
  }
  return {.headline = {}, .paragraphs = {}, .tables = {std::move(table)}};
}

}  // namespace heatsoak::present
