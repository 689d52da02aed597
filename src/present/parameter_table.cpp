#include "present/parameter_table.h"

#include <fmt/format.h>

#include <cmath>

#include "base/quantity.h"

namespace heatsoak::present {
namespace {

/// Formats a deviation in percent: "+9"; below 1 % with one significant digit.
std::string percent_off(double bound, double value) {
  const double percent = 100.0 * (bound - value) / std::abs(value);
  return fmt::format("{}{}", percent < 0.0 ? "" : "+",
                     std::abs(percent) < 1.0 ? base::significant(percent, 1) : fmt::format("{:.0f}", percent));
}

std::string range_text(std::string_view unit, const base::ParameterValue& parameter) {
  if (!parameter.spread) {
    return "";
  }
  const double low = parameter.spread->low;
  const double high = parameter.spread->high;
  if (unit == "rad") {
    return fmt::format("{}…{} °", base::significant(base::convert(low, "rad", "deg"), 3),
                       base::significant(base::convert(high, "rad", "deg"), 3));
  }
  if (unit != "degC" && parameter.value != 0.0) {
    return fmt::format("{}…{} %", percent_off(low, parameter.value), percent_off(high, parameter.value));
  }
  return fmt::format("{}…{} {}", base::significant(low, 3), base::significant(high, 3), base::unit_for_display(unit));
}

}  // namespace

Table parameter_table(std::string title) {
  return {.title = std::move(title),
          .columns = {{"parameter", "", 0, Alignment::left},
                      {"value", "", 0},
                      {"origin", "", 1, Alignment::left},
                      {"range", "", 2, Alignment::left},
                      {"source", "", 3, Alignment::left},
                      {"", "", 0, Alignment::left, 0, true}},
          .rows = {}};
}

void add_parameter(Table& table, std::string_view key, std::string_view unit, const base::ParameterValue& parameter,
                   std::string_view meaning) {
  std::string remarks(meaning);
  const auto add = [&remarks](std::string_view words) {
    remarks += fmt::format("{}{}", remarks.empty() || words.empty() ? "" : "; ", words);
  };
  add(parameter.derivation);
  for (const base::Confirmation& each : parameter.confirmed_by) {
    add(fmt::format("{} states {}", each.source, each.printed));
  }
  table.rows.push_back({{std::string(key)},
                        {parameter.printed.empty() ? with_unit(parameter.value, unit) : parameter.printed},
                        {std::string(base::to_string(parameter.origin))},
                        {range_text(unit, parameter)},
                        {parameter.source},
                        {std::move(remarks)}});
}

void add_value(Table& table, std::string_view key, const std::string& value) {
  table.rows.push_back({{std::string(key)}, {value}, {}, {}, {}, {}});
}

Table labelled_table(std::string title) {
  return {.title = std::move(title), .columns = {{"", "", 0, Alignment::left}, {"", "", 0, Alignment::left, 0, true}}, .rows = {}};
}

void add_labelled(Table& table, std::string_view label, std::string_view words) {
  if (!words.empty()) {
    table.rows.push_back({{std::string(label)}, {std::string(words)}});
  }
}

std::string with_unit(double value, std::string_view unit) {
  return unit.empty() ? base::significant(value, 4) : fmt::format("{} {}", base::significant(value, 4), base::unit_for_display(unit));
}

}  // namespace heatsoak::present
