#include "present/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "present/check_words.h"
#include "present/evaluation.h"
#include "present/motor_notes.h"
#include "present/robot_notes.h"

namespace heatsoak::present {
namespace {

std::vector<Text> conclusion(std::span<const check::Outcome> outcomes, bool is_update) {
  const bool all_pass = std::ranges::all_of(outcomes, &check::Outcome::passed);
  std::vector<Text> text{{conclusion_words(outcomes), all_pass ? Tone::good : Tone::bad}};
  if (is_update) {
    const auto changed = std::ranges::count_if(outcomes, [](const check::Outcome& each) { return !each.before.empty(); });
    text.push_back({fmt::format("{} limit{} rewritten", changed, changed == 1 ? "" : "s")});
  }
  return text;
}

Table table_of(const check::Check& check) {
  const std::string subject = subject_words(check);
  return {.title = subject.empty() ? check.name : fmt::format("{} ({})", check.name, subject),
          .columns = {{"", "", 0, Alignment::left},
                      {"threshold", "", 0, Alignment::left},
                      {"value", "", 0},
                      {"limit", "", 0},
                      {"margin", "", 1},
                      {"", "", 0, Alignment::left, 0, true}},
          .rows = {}};
}

Text status_cell(check::Status status) {
  switch (status) {
    case check::Status::kept:
      return {"ok", Tone::good};
    case check::Status::broken:
      return {"FAIL", Tone::bad};
    case check::Status::not_evaluated:
      return {"ERROR", Tone::bad};
  }
  return {};
}

/// Adds the notes on robots and motors, for each file once.
void add_file_notes(Document& document, std::span<const check::Outcome> outcomes) {
  std::set<std::filesystem::path> noted;
  for (const check::Outcome& each : outcomes) {
    const check::Check& of = *each.check;
    if (of.robot && noted.insert(of.robot->file).second) {
      add_robot_notes(document, *of.robot);
    }
    if (of.motor && noted.insert(of.motor->file).second) {
      add_lines(document.notes, value_warnings({&*of.motor, 1}), Severity::warning);
    }
  }
}

}  // namespace

Document check_document(std::span<const check::Outcome> outcomes, bool is_update, const std::vector<std::string>& files) {
  Document document{.headline = conclusion(outcomes, is_update), .paragraphs = {}};
  const check::Check* before = nullptr;
  for (const check::Outcome& each : outcomes) {
    if (each.check != before) {
      document.tables.push_back(table_of(*each.check));
      before = each.check;
    }
    std::string why = each.passed() ? explanation_words(each) : located_explanation(each);
    if (!each.before.empty()) {
      why += fmt::format("{}limit {} → {}", why.empty() ? "" : "; ", each.before, each.limit.text);
    }
    document.tables.back().rows.push_back({status_cell(each.status()),
                                           {std::string(each.limit.type->name)},
                                           {value_words(each)},
                                           {limit_words(each)},
                                           {margin_words(each)},
                                           {std::move(why)}});
  }
  add_file_notes(document, outcomes);
  const auto loosened = std::ranges::count(outcomes, true, &check::Outcome::failed_before);
  if (loosened > 0) {
    document.add_note(Severity::warning, fmt::format("{} of the rewritten limits did not hold before. Read the difference before you "
                                                     "commit the file: a limit that follows every value detects no change.",
                                                     loosened));
  }
  document.data = check_json(outcomes, files);
  add_notes(document.data, document.notes);
  return document;
}

}  // namespace heatsoak::present
