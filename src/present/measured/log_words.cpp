#include "present/measured/log_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "base/quantity.h"
#include "recording/quantities.h"

namespace heatsoak::present {
namespace {

using base::significant;

/// Advice for a column in another unit, or without the unit if it is not known.
std::string if_unit(std::string_view unit = "") {
  return fmt::format(" If so, state unit = {} in a mapping (--map)", unit.empty() ? "\"…\"" : fmt::format("\"{}\"", unit));
}

std::string_view unit_of(recording::TimeUnit unit) {
  switch (unit) {
    case recording::TimeUnit::microseconds:
      return "us";
    case recording::TimeUnit::milliseconds:
      return "ms";
    case recording::TimeUnit::minutes:
      return "min";
    case recording::TimeUnit::hours:
      break;
  }
  return "h";
}

constexpr std::string_view kIfSign = " If so, state sign = \"-\" in a mapping (--map)";
constexpr std::string_view kIfSwapped = " If so, swap their columns in a mapping (--map)";

std::string say(const recording::CurrentTooLarge& of) {
  return fmt::format("{} reaches {} A: is it in milliamperes?{}", of.channel, significant(of.top_A, 3), if_unit("mA"));
}

std::string say(const recording::PowerDiffersFromBus& of) {
  return fmt::format("power_in_W is {} times bus_V × bus_A: is one of them in another unit?{}", significant(of.ratio, 3), if_unit());
}

std::string say(const recording::PowerOppositeToBus& /*of*/) {
  return fmt::format("power_in_W and bus_V × bus_A have opposite signs: is the sign of one of them wrong?{}", kIfSign);
}

std::string say(const recording::TorqueOppositeToCurrent& /*of*/) {
  return fmt::format("torque_Nm and current_A have opposite signs: is the sign of one of them wrong?{}", kIfSign);
}

std::string say(const recording::SpeedTooLarge& of) {
  constexpr double kRpm = 30.0 / std::numbers::pi;
  return fmt::format("{} reaches {} rad/s: is it in rpm ({} rad/s) or degrees per second ({} rad/s)?{}", of.channel,
                     significant(of.top_rad_per_s, 4), significant(of.top_rad_per_s / kRpm, 3),
                     significant(of.top_rad_per_s * std::numbers::pi / 180.0, 3), if_unit("rpm"));
}

std::string say(const recording::ShaftPowerExceedsInput& of) {
  return fmt::format(
      "torque_Nm × speed_rad_per_s is {} times power_in_W, more than the input: is the speed in rpm (÷ 9.55) or degrees per second (÷ "
      "57.3)?{}",
      significant(of.ratio, 3), if_unit("rpm"));
}

std::string say(const recording::AngleSpansDegrees& of) {
  return fmt::format("{} spans {} rad: is it in degrees?{}", of.channel, significant(of.span_rad, 3), if_unit("deg"));
}

std::string say(const recording::WheelRowsFarApart& of) {
  return fmt::format("the speeds of wheels are {} s apart: is the time in milliseconds?{}", significant(of.period_s, 3), if_unit("ms"));
}

std::string say(const recording::ModulationAboveOne& of) {
  return fmt::format(
      "{} reaches {}: is it in percent or in counts of a timer? 1 is the whole battery voltage. If so, scale it with an "
      "expression in a mapping (--map)",
      of.channel, significant(of.top_ratio, 3));
}

std::string say(const recording::VoltageTooLarge& of) {
  return fmt::format("{} reaches {} V: is it in millivolts?{}", of.channel, significant(of.top_V, 3), if_unit("mV"));
}

std::string say(const recording::LastsForDays& of) {
  return fmt::format("the log lasts {} days at {} s per row: is the time in {}?{}", significant(of.duration_s / 86400.0, 3),
                     significant(of.period_s, 3), words_of(of.suspected), if_unit(unit_of(of.suspected)));
}

std::string say(const recording::FallsTooFast& of) {
  return fmt::format("the rows are {} s apart and {} falls by {} K in {} s: is the time in {}?{}", significant(of.period_s, 3), of.channel,
                     significant(of.fall_K, 2), significant(of.fall_s, 2), words_of(of.suspected), if_unit(unit_of(of.suspected)));
}

std::string delay_text(double delay_s, double uncertainty_s) {
  return fmt::format("{} s ± {} s", significant(std::abs(delay_s), 2), significant(uncertainty_s, 2));
}

std::string say(const recording::RespondsEarly& of) {
  return fmt::format(
      "{} responds {} before {} changes, so one of their clocks is off; in a mapping give {} and all columns logged with it clock_offset = "
      "\"{} s\"{}",
      of.temperature, delay_text(of.delay_s, of.delay_uncertainty_s), of.heat_input, of.heat_input, significant(of.delay_s, 2),
      of.is_one_row ? ", or inputs = \"previous_interval\" if a row's inputs describe the interval before it" : "");
}

std::string say(const recording::ConstantSensor& of) {
  return fmt::format(
      "{} is constant, {} °C, while {} changes by {} K: is its sensor connected? If not, leave its column out of a mapping (--map)",
      of.channel, significant(of.value_C, 4), of.moving, significant(of.moves_K, 3));
}

std::string say(const recording::ConstantHeatInput& of) {
  return fmt::format(
      "{} is constant, {} {}, while winding_C rises and falls {} times by {} K or more above stator_C: is its sensor connected? If not, "
      "leave its column out of a mapping (--map)",
      of.channel, significant(of.value, 3), base::unit_for_display(of.unit), of.count, significant(of.by_K, 2));
}

std::string say(const recording::StaysAtLimit& of) {
  return fmt::format(
      "{} stays at exactly {} {} in {:.0f} % of its rows: is the sensor saturated? If so, state saturates_high or saturates_low in a "
      "mapping (--map)",
      of.channel, significant(of.value, 5), base::unit_for_display(of.unit),
      100.0 * static_cast<double>(of.samples_there) / static_cast<double>(of.samples));
}

std::string say(const recording::AmbientAboveMotor& of) {
  return fmt::format("ambient_C is hotter than {} most of the time (by {} K): are the channels swapped?{}", of.channel,
                     significant(of.above_K, 2), kIfSwapped);
}

std::string say(const recording::FallsWhileHeated& of) {
  return fmt::format(
      "{} falls while {} heats and rises while it rests: is the sign of the sensor wrong? If so, correct it with an "
      "expression in a mapping (--map)",
      of.channel, of.heat_input);
}

std::string say(const recording::StatorRespondsFaster& of) {
  return fmt::format("stator_C responds to {} faster than winding_C and varies more ({} K against {} K): are the two swapped?{}",
                     of.heat_input, significant(of.stator_K, 3), significant(of.winding_K, 3), kIfSwapped);
}

std::string say(const recording::StatorHotterAtRest& of) {
  return fmt::format("without heat, stator_C is hotter than winding_C (by {} K) and falls by more: are the two swapped?{}",
                     significant(of.above_K, 2), kIfSwapped);
}

std::string say(const recording::StatorWarmsFirst& of) {
  return fmt::format(
      "at standstill {} heats stator_C by {} K while winding_C is {} K cooler: are the two swapped, or is a sensor elsewhere?{}",
      of.heat_input, significant(of.stator_rise_K, 2), significant(of.winding_below_K, 2), kIfSwapped);
}

struct ScaleWords {
  std::string_view name;
  int digits;             ///< digits of the value as logged
  std::string_view unit;  ///< text for a mapping; empty for a scale that is no unit
};

ScaleWords scale_words(recording::TemperatureScale scale) {
  switch (scale) {
    case recording::TemperatureScale::tenths_of_degrees:
      return {"tenths of degrees", 4, ""};
    case recording::TemperatureScale::kelvin:
      return {"kelvin", 4, "K"};
    case recording::TemperatureScale::fahrenheit:
      break;
  }
  return {"degrees Fahrenheit", 3, "degF"};
}

std::string say(const recording::StartsInOtherScale& of) {
  const ScaleWords scale = scale_words(of.suspected);
  return fmt::format("{} starts at {} °C: is it in {} ({} °C)?{}", of.channel, significant(of.start_C, scale.digits), scale.name,
                     significant(of.converted_C, 3),
                     scale.unit.empty() ? " If so, divide it by 10 with an expression in a mapping (--map)" : if_unit(scale.unit));
}

std::string say(const recording::MotorStartsInFahrenheit& of) {
  return fmt::format("{} and the motor's other temperatures start at {} °C in air of {} °C: are they in degrees Fahrenheit ({} °C)?{}",
                     of.channel, significant(of.start_C, 3), significant(of.ambient_C, 3), significant(of.converted_C, 3), if_unit("degF"));
}

std::string say(const recording::MotorCoolsInFahrenheit& of) {
  return fmt::format(
      "{} reaches a steady state of {} °C without heat, in air of {} °C: are the motor's temperatures in degrees Fahrenheit ({} °C)?{}",
      of.channel, significant(of.rest_C, 3), significant(of.ambient_C, 3), significant(of.converted_C, 3), if_unit("degF"));
}

std::string say(const recording::IntervalsTooShort& /*of*/) { return "the intervals without a gap are too short"; }

std::string say(const recording::NoBestDelay& of) {
  return fmt::format("no delay within ± {} s gives a best fit", significant(of.within_s, 2));
}

std::string say(const recording::PartsDisagree& of) { return fmt::format("parts of the log disagree by {} s", significant(of.by_s, 2)); }

std::string say(const recording::TooFewRows& of) {
  return fmt::format("it has {} row{}; at least {} are needed", of.rows, of.rows == 1 ? "" : "s", of.needed);
}

std::string say(const recording::NoTemperature& /*of*/) { return "it has no temperature of the motor (winding_C, stator_C, …)"; }

std::string say(const recording::NoHeatInput& /*of*/) {
  return "it has no heat input (current_A, power_in_W, torque_Nm, speed_rad_per_s, …)";
}

std::string say(const recording::TemperatureIsConstant& of) {
  return fmt::format("{} is constant, {} °C", of.channel, significant(of.value_C, 4));
}

std::string say(const recording::TemperatureWithinNoise& of) {
  return fmt::format("no temperature changes by more than its noise: {} from {} °C to {} °C, noise {} K", of.channel,
                     significant(of.low_C, 4), significant(of.high_C, 4), significant(of.noise_K, 2));
}

std::string say(const recording::HeatInputIsZero& of) { return fmt::format("there is no heat input: {} is 0 throughout", of.channel); }

std::string say(const recording::NoWheelSpeed& /*of*/) { return "it has no speeds of wheels (wheel_speed_rad_per_s_1, …)"; }

std::string say(const recording::WheelsKeepSpeed& /*of*/) { return "no wheel changes its speed beyond the noise"; }

std::string say(const recording::NoWheelEffort& /*of*/) {
  return "it has no effort of wheels (wheel_modulation_ratio_1, wheel_voltage_V_1 or wheel_current_A_1, …)";
}

std::string say(const recording::ColumnWithoutUnit& of) {
  return fmt::format("column {} '{}' is not used: its name does not end in a unit{}", of.column, of.name,
                     recording::nearest_quantity(of.name));
}

std::string say(const recording::AdditionalSignal& of) {
  return fmt::format("{} is used as an additional signal{}", of.channel, recording::nearest_quantity(of.channel));
}

std::string say(const recording::NotRecorded& of) { return fmt::format("{} is not recorded: no column '{}'", of.channel, of.column); }

std::string say(const recording::ChannelWithoutNumbers& of) {
  return fmt::format("{} is left out: not one number in {} rows", of.channel, of.rows);
}

std::string say(const recording::BlanksFilled& of) {
  return fmt::format("{}: {} blank samples are filled as the mapping states", of.channel, of.samples);
}

template <class Finding>
std::string said(const Finding& finding) {
  return std::visit([](const auto& each) { return say(each); }, finding);
}

template <class Finding>
std::vector<std::string> all_said(const std::vector<Finding>& findings) {
  std::vector<std::string> words;
  std::ranges::transform(findings, std::back_inserter(words), said<Finding>);
  return words;
}

}  // namespace

std::string_view words_of(recording::TimeUnit unit) {
  switch (unit) {
    case recording::TimeUnit::microseconds:
      return "microseconds";
    case recording::TimeUnit::milliseconds:
      return "milliseconds";
    case recording::TimeUnit::minutes:
      return "minutes";
    case recording::TimeUnit::hours:
      break;
  }
  return "hours";
}

std::string words_of(const recording::Suspicion& suspicion) { return said(suspicion); }
std::string words_of(const recording::SuspicionOfLog& suspicion) {
  return fmt::format("{}: {}", suspicion.log, words_of(suspicion.suspicion));
}
std::string words_of(const recording::RespondsLate& finding) {
  return fmt::format(
      "{} follows {} {} late: its sensor lags, or a clock is off (clock_offset of a mapping); the values fitted to the winding (heat "
      "capacity, time constant, resistance to the stator) are biased by more than their intervals",
      finding.temperature, finding.heat_input, delay_text(finding.delay_s, finding.delay_uncertainty_s));
}
std::string words_of(const recording::NoDelayReason& reason) { return said(reason); }
std::string words_of(const recording::Lack& lack) { return said(lack); }
std::string words_of(const recording::ReadingNote& note) { return said(note); }

std::vector<std::string> words_of(const std::vector<recording::Suspicion>& suspicions) { return all_said(suspicions); }
std::vector<std::string> words_of(const std::vector<recording::Lack>& lacks) { return all_said(lacks); }
std::vector<std::string> words_of(const std::vector<recording::ReadingNote>& notes) { return all_said(notes); }

}  // namespace heatsoak::present
