#include "present/signal_topics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "present/parameter_table.h"
#include "thermal/effect.h"
#include "thermal/operating_point.h"

namespace heatsoak::present {
namespace {

using base::SignalRow;

std::string averaging_words(base::AveragingRule rule) {
  switch (rule) {
    case base::AveragingRule::mean:
      return "mean of an interval";
    case base::AveragingRule::rms:
      return "root mean square of an interval";
    case base::AveragingRule::limit:
      return "not averaged: a merged interval has no limit";
  }
  return "";
}

std::string_view averaging_id(base::AveragingRule rule) {
  return rule == base::AveragingRule::mean ? "mean" : rule == base::AveragingRule::rms ? "rms" : "limit";
}

/// Formats a number of the signal with its unit.
std::string value_text(double value, std::string_view unit) {
  return std::isinf(value) ? "infinite" : fmt::format("{:g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string worst_case_words(const SignalRow& row) {
  if (!row.firmware) {
    return "";
  }
  const base::FirmwareInput& input = *row.firmware;
  switch (input.worst) {
    case base::WorstCase::hottest_air:
      return "the hottest declared air";
    case base::WorstCase::both_directions:
      return "every magnitude up to the largest of motor or robot, with either sign";
    case base::WorstCase::searched:
      break;
  }
  return fmt::format("the value that heats winding and bodies most, searched {}",
                     input.searched.count == 0 ? "within the range of motor or robot"
                                               : fmt::format("at 0 and from {} to {}", value_text(input.searched.low, row.unit),
                                                             value_text(input.searched.high, row.unit)));
}

std::string column_words(const SignalRow& row) {
  if (row.column.empty()) {
    return "";
  }
  const std::string alias = row.column_alias.empty() ? "" : fmt::format(" (also {})", row.column_alias);
  return fmt::format("{}{}: {}", row.column, alias, row.column_meaning);
}

std::vector<std::string> effects_that_need(const SignalRow& row) {
  std::vector<std::string> names;
  for (const thermal::EffectType& effect : thermal::all_effects()) {
    if (row.signal && std::ranges::find(effect.needs, *row.signal) != effect.needs.end()) {
      names.emplace_back(effect.name);
    }
  }
  return names;
}

/// Returns the value of the operating point if nothing states the signal.
double default_of(const SignalRow& row) {
  const auto& quantity = thermal::kQuantities<double>.at(base::signal_row(row.name));
  return thermal::OperatingPoint<double>{}.*quantity.value;
}

std::string default_words(const SignalRow& row) {
  return row.is_optional ? "none: a law ignores the signal if it is unknown" : value_text(default_of(row), row.unit);
}

Json signal_json(const SignalRow& row) {
  Json json{{"kind", "signal"},
            {"id", row.name},
            {"unit", row.unit},
            {"meaning", row.meaning},
            {"log_column", row.column.empty() ? Json() : Json(row.column)},
            {"averaging", averaging_id(row.averaging)},
            {"worst_case", row.firmware ? Json(worst_case_words(row)) : Json()},
            {"effects", effects_that_need(row)}};
  return json;
}

/// Returns whether `describe` has an effect of the same name, which it describes in place of the signal.
bool is_effect(const SignalRow& row) {
  return std::ranges::find(thermal::all_effects(), row.name, &thermal::EffectType::name) != thermal::all_effects().end();
}

}  // namespace

Document signal_description(const SignalRow& row) {
  Document document{.headline = {{fmt::format("{}: {}", row.name, row.meaning)}}};
  Table table = labelled_table("");
  add_labelled(table, "unit", row.unit.empty() ? "a number without unit" : row.unit);
  add_labelled(table, "log column", column_words(row));
  add_labelled(table, "averaging", averaging_words(row.averaging));
  add_labelled(table, "default", default_words(row));
  if (row.curve_place) {
    add_labelled(table, "measured curve", fmt::format("driver = \"{}\" of the effect tabulated: {}", row.name, row.curve_meaning));
  }
  if (row.firmware) {
    add_labelled(table, "firmware", fmt::format("{}: {}", row.firmware->field, row.firmware->meaning));
    add_labelled(table, "worst case", worst_case_words(row));
  }
  add_labelled(table, "needed by", fmt::format("{}", fmt::join(effects_that_need(row), ", ")));
  document.tables.push_back(std::move(table));
  document.add_note(Severity::scope, "`heatsoak describe signals` lists all signals.");
  return described(std::move(document), signal_json(row));
}

Document signals_description() {
  Document document{.headline = {{"signals: the numbers that a thermal law may depend on besides the temperatures of its nodes"}}};
  Table table{.columns = {{.name = "signal", .alignment = Alignment::left},
                          {.name = "unit", .alignment = Alignment::left},
                          {.name = "log column", .priority = 1, .alignment = Alignment::left},
                          {.name = "averaging", .priority = 2, .alignment = Alignment::left},
                          {.name = "worst case", .priority = 3, .alignment = Alignment::left},
                          {.name = "meaning", .alignment = Alignment::left, .is_prose = true}}};
  Json all = Json::array();
  for (const SignalRow& row : base::kSignals) {
    const std::string_view worst = !row.firmware                                             ? "–"
                                   : row.firmware->worst == base::WorstCase::hottest_air     ? "hottest air"
                                   : row.firmware->worst == base::WorstCase::both_directions ? "both directions"
                                                                                             : "searched";
    table.rows.push_back({{std::string(row.name)},
                          {row.unit.empty() ? "–" : std::string(row.unit)},
                          {row.column.empty() ? "–" : std::string(row.column)},
                          {std::string(averaging_id(row.averaging))},
                          {std::string(worst)},
                          {std::string(row.meaning)}});
    all.push_back(signal_json(row));
  }
  document.tables.push_back(std::move(table));
  document.add_note(Severity::note, "A signal without a log column is computed from the others, or set by the program.");
  document.add_note(Severity::background,
                    "worst case: value that the thermal guard in the firmware assumes where the signal is not measured; `heatsoak describe "
                    "NAME` states it.");
  return described(std::move(document), {{"kind", "signals"}, {"id", "signals"}, {"signals", all}});
}

TopicList signal_topics(const input::DataFolders& /*folders*/) {
  TopicList topics;
  for (const SignalRow& row : base::kSignals) {
    if (!is_effect(row)) {
      topics.push_back(
          {std::string(row.name), [&row] { return fmt::format("signal: {}", row.meaning); }, [&row] { return signal_description(row); }});
    }
  }
  return topics;
}

const SignalRow* signal_of_column(std::string_view column) {
  const auto found = std::ranges::find_if(
      base::kSignals, [column](const SignalRow& row) { return !column.empty() && (row.column == column || row.column_alias == column); });
  return found == base::kSignals.end() ? nullptr : &*found;
}

}  // namespace heatsoak::present
