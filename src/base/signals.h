// Signals of a motor: name, unit, log column, averaging rule, worst case and meaning of each. The rows are in signal_table.h.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string_view>

namespace heatsoak::base {

/// Signals of a log that a law may need besides the temperatures of its nodes and of the surroundings. A log without one of them holds no
/// evidence about the law. The inputs of the guard in the firmware are other ones: derate::observed::Signal. The copper loss is computed
/// from the current; velocity and acceleration need the speed.
enum class Signal {
#define HEATSOAK_SIGNAL(name, ...) name,
#define HEATSOAK_QUANTITY(...)
#include "base/signal_table.h"
};

/// Rule for averaging a quantity over time. `rms` averages its square. `limit`: not averaged; a merged interval has the default, no limit.
enum class AveragingRule { mean, rms, limit };

/// Rule for computing the quantity from its log column.
enum class FromColumn {
  computed,  ///< from several columns: estimation/log_rows.cpp
  value,
  magnitude
};

/// Kind of a log column. It decides how rows are read and checked.
enum class QuantityKind {
  time,
  temperature,   ///< temperature of a part of the motor at the row's time
  surroundings,  ///< temperature that the motor does not determine: ambient, coolant, driver, neighbour
  heat_input,    ///< current, speed, torque, voltage, power: value of the interval that begins at the row's time
  signal         ///< any other signal
};

/// Assumption of the guard in the firmware about an input whose heating must not be underestimated.
enum class WorstCase {
  searched,         ///< the values of its range that heat winding and bodies most (derate/hot_cases.cpp)
  both_directions,  ///< every magnitude up to the largest, with either sign; current and speed only
  hottest_air       ///< the hottest declared air
};

/// Value of an input that the guard assumes for a motor without power, and for one that stands while its current is unknown.
enum class WithoutPower {
  unstated,       ///< not allowed: each row states one of the others
  zero,           ///< the motor is at rest
  hottest_air,    ///< the hottest declared air
  winding_limit,  ///< the winding limit, for the temperature of another motor
  any             ///< unknown: each node takes the largest rate over the possible values; implemented for the age only
};

/// Range of an input, in the unit of its row.
struct InputRange {
  double low = 0.0;
  double high = 0.0;
};

/// Values of an input among which its worst case is searched, ascending, in the unit of its row; no values: derate/hot_cases.cpp has them,
/// because they depend on motor or robot.
struct SearchedValues {
  double low = 0.0;
  double high = 0.0;
  int count = 0;
  bool is_by_ratio = false;  ///< 0, and `count` values in equal ratios; else in equal distances
};

/// Quantity as an input of the guard in the firmware.
struct FirmwareInput {
  std::string_view field;    ///< name in generated code and in robot_core/thermal_guard.h
  std::string_view meaning;  ///< description with sign convention
  WithoutPower without_power = WithoutPower::unstated;
  WorstCase worst = WorstCase::searched;
  SearchedValues searched = {};  ///< for WorstCase::searched
  /// Readings of a working sensor; empty: derate/plausible_range.cpp has them, because they depend on motor or robot.
  std::optional<InputRange> plausible = {};
  /// Words about an input that the drive core does not measure, after "{effect} depends on"; empty: it measures or computes the input.
  std::string_view unmeasured = {};
};

/// Words of the note about an effect whose signal no duty states: "{effect} {consequence}, because a duty does not state {quantity}".
struct UnstatedByDuty {
  std::string_view consequence = {};
  std::string_view quantity = {};  ///< empty: a duty states the signal, or its default needs no note
};

/// One row of the table of signals.
struct SignalRow {
  std::string_view name;              ///< in messages with spaces: "shaft power"
  std::optional<Signal> signal = {};  ///< signal that it needs in a log
  std::string_view meaning = {};      ///< description for `heatsoak describe`, with sign and kind of mean
  std::string_view unit = {};         ///< UDUNITS text
  std::optional<double> usual = {};   ///< value of a hot motor under load, in `unit`; none: the default
  AveragingRule averaging = AveragingRule::mean;
  std::string_view magnitude = {};  ///< name of the row that has its magnitude; empty: none
  bool is_motion = false;           ///< depends on the motion alone; for gaps, in which motion and torque are unknown independently
  bool is_optional = false;         ///< valid only if OperatingPoint::known has its bit, because no default is safe, as for a temperature
  bool is_range_compared = false;   ///< `diagnose` warns if hold-out runs leave its range in the training runs
  std::string_view column = {};     ///< log column; one row of each signal has it
  FromColumn from = FromColumn::computed;
  QuantityKind column_kind = QuantityKind::signal;
  std::string_view column_unit = {};     ///< UDUNITS text; empty: `unit`
  std::string_view column_meaning = {};  ///< description of the column
  std::string_view column_alias = {};    ///< earlier name of the column, which logs and mappings may still use
  std::string_view lacking = {};         ///< words of the message about a log without the signal
  UnstatedByDuty unstated = {};
  /// Place among the input signals of measured curves (effect `tabulated`), in the order in which a diagnosis tries them; empty: none.
  std::optional<int> curve_place = {};
  std::string_view curve_meaning = {};  ///< description as an input signal
  std::optional<FirmwareInput> firmware = {};
};

inline constexpr std::array kSignals{
#define HEATSOAK_SIGNAL(row_name, member, default_value, ...) SignalRow{.name = #row_name, .signal = Signal::row_name, __VA_ARGS__},
#define HEATSOAK_QUANTITY(row_name, member, default_value, ...) SignalRow{.name = #row_name, __VA_ARGS__},
#include "base/signal_table.h"
};

/// Returns the index of a row; kSignals.size() if there is none of that name.
constexpr std::size_t signal_row(std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(kSignals, name, &SignalRow::name) - kSignals.begin());
}

/// Returns the row with the log column of a signal: the one of its name.
constexpr const SignalRow& row_of(Signal signal) {
  return *std::ranges::find_if(kSignals, [signal](const SignalRow& each) { return each.signal == signal && !each.column.empty(); });
}

/// Number of enumerators of Signal.
// clang-format off
inline constexpr std::size_t kSignalCount = 0
#define HEATSOAK_SIGNAL(...) + 1
#define HEATSOAK_QUANTITY(...)
#include "base/signal_table.h"
;
// clang-format on
static_assert(std::ranges::none_of(kSignals, &std::string_view::empty, &SignalRow::meaning), "each row has a description");
static_assert(std::ranges::count_if(kSignals, [](const SignalRow& each) { return each.signal && !each.column.empty(); }) == kSignalCount,
              "each signal has one log column");

/// Number of input signals of measured curves.
inline constexpr std::size_t kCurveSignalCount = std::ranges::count_if(kSignals, [](const SignalRow& each) { return !!each.curve_place; });

/// Indices of the rows that can be the input signal of a measured curve, by SignalRow::curve_place.
inline constexpr std::array<std::size_t, kCurveSignalCount> kCurveSignals = [] {
  std::array<std::size_t, kCurveSignalCount> rows{};
  rows.fill(kSignals.size());
  for (std::size_t row = 0; row < kSignals.size(); ++row) {
    if (kSignals[row].curve_place) {
      rows.at(static_cast<std::size_t>(*kSignals[row].curve_place)) = row;
    }
  }
  return rows;
}();
static_assert(std::ranges::find(kCurveSignals, kSignals.size()) == kCurveSignals.end(), "curve_place counts from 0 without a gap");

static_assert(std::ranges::none_of(kSignals,
                                   [](const SignalRow& each) {
                                     return each.firmware && (each.firmware->without_power == WithoutPower::unstated ||
                                                              (each.firmware->without_power == WithoutPower::any && each.name != "age"));
                                   }),
              "each input of the firmware has a value without power; only the age is searched over all values: derate/power_off.h, "
              "rates_of_any_age() of the drive core");

}  // namespace heatsoak::base
