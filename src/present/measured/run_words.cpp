#include "present/measured/run_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/quantity.h"
#include "estimation/log_rows.h"
#include "present/measured/severity_of_kind.h"

namespace heatsoak::present {
namespace {

std::string say(const estimation::GapsSplitRows& of) {
  return fmt::format("gaps split its {} rows into {} runs ([runs] longest_gap of a mapping sets what counts as a gap)", of.rows, of.runs);
}

std::string_view lacking_value(const estimation::RowsLack& of) {
  switch (of.what) {
    case estimation::RowsLack::What::surroundings:
      return "ambient temperature within a minute";
    case estimation::RowsLack::What::temperature:
      return "temperature of winding or stator";
    case estimation::RowsLack::What::signal:
      break;
  }
  return estimation::column_of(of.signal.value());
}

std::string say(const estimation::RowsLack& of) { return fmt::format("{} of {} rows have no {}", of.lacking, of.rows, lacking_value(of)); }

std::string say(const estimation::TooFewIntervals& of) {
  return fmt::format("its {} s make fewer than {} intervals of {} s", base::significant(of.duration_s, 2), of.needed,
                     base::significant(of.interval_s, 2));
}

std::string say(const estimation::UsablePartsTooShort& /*of*/) { return "intervals are too short"; }

std::string say(const estimation::SensorNeverChanges& of) {
  return fmt::format("{}: {} is not used as a sensor, because its value never changes", of.recording, of.channel);
}

std::string say(const estimation::RowsUnused& of) {
  return fmt::format("{}: {} of {} rows are not used: {}", of.recording, of.unused, of.rows, words_of(of.reasons));
}

std::string say(const estimation::SplitIntoRuns& of) {
  return fmt::format("{} is split into {} runs: heat or ambient temperature is unknown between them", of.recording, of.runs);
}

std::string say(const estimation::ColumnsLacking& of) {
  return fmt::format("temperatures of {} may be too high, because it does not have {}: the hottest value of the curve is used",
                     of.recording, fmt::join(of.columns, ", "));
}

std::string say(const estimation::ColumnBlank& of) {
  return fmt::format("temperatures of {} may be wrong, because {} is blank for {} s, too long to interpolate: {}", of.recording, of.column,
                     base::significant(of.blank_s, 3), of.is_held ? "the nearest known value is used" : "the value is treated as unknown");
}

}  // namespace

std::string part_of(const std::string& signal) { return signal.substr(0, signal.rfind('_')); }

std::string words_of(const estimation::RunNote& note) {
  return std::visit([](const auto& each) { return say(each); }, note);
}

Severity severity_of(const estimation::RunNote& note) {
  using namespace estimation;
  return severity_in<Kinds<ColumnsLacking, ColumnBlank>, Kinds<SensorNeverChanges, RowsUnused, SplitIntoRuns>, Kinds<>>(note);
}

std::string words_of(const std::vector<estimation::LossOfRows>& reasons) {
  std::vector<std::string> all;
  for (const estimation::LossOfRows& reason : reasons) {
    all.push_back(std::visit([](const auto& each) { return say(each); }, reason));
  }
  return fmt::format("{}", fmt::join(all, ", "));
}

}  // namespace heatsoak::present
