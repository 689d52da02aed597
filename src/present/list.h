// Document and JSON of `list`.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

struct NamedThing {
  std::string id;
  std::string summary;
};

/// Returns a table without a head and without a headline, so that the quiet form shows only the names.
Document list_document(std::span<const NamedThing> things);
Json list_json(std::string_view kind, std::span<const NamedThing> things);

}  // namespace heatsoak::present
