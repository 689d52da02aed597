// Findings about a log as data: what looks wrong, what the log lacks, and how it was read. src/present puts them into words. Channels are
// named by their keys; values are in the unit that the key states, as the log has them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace heatsoak::recording {

/// A current that no motor draws.
struct CurrentTooLarge {
  std::string channel;
  double top_A = 0.0;  ///< usual largest magnitude
};
/// power_in_W differs from bus_V × bus_A.
struct PowerDiffersFromBus {
  double ratio = 1.0;  ///< median of power_in_W / (bus_V × bus_A)
};
/// power_in_W and bus_V × bus_A have opposite signs.
struct PowerOppositeToBus {};
/// torque_Nm and current_A have opposite signs.
struct TorqueOppositeToCurrent {};
/// A speed that no motor reaches.
struct SpeedTooLarge {
  std::string channel;
  double top_rad_per_s = 0.0;  ///< usual largest magnitude
};
/// The shaft power is larger than the input power.
struct ShaftPowerExceedsInput {
  double ratio = 1.0;  ///< median of torque_Nm × speed_rad_per_s / power_in_W
};
/// An orientation spans far more than some turns, as if in degrees.
struct AngleSpansDegrees {
  std::string channel;
  double span_rad = 0.0;
};
/// The rows are so far apart that a wheel would speed up and stop between them.
struct WheelRowsFarApart {
  double period_s = 0.0;
};
/// A modulation exceeds the whole battery voltage.
struct ModulationAboveOne {
  std::string channel;
  double top_ratio = 0.0;  ///< usual largest magnitude
};
/// A voltage that no robot has.
struct VoltageTooLarge {
  std::string channel;
  double top_V = 0.0;  ///< usual largest magnitude
};
enum class TimeUnit { microseconds, milliseconds, minutes, hours };
/// The log lasts for days.
struct LastsForDays {
  double duration_s = 0.0;
  double period_s = 0.0;
  TimeUnit suspected = TimeUnit::milliseconds;
};
/// A temperature falls faster than any motor cools.
struct FallsTooFast {
  std::string channel;
  double period_s = 0.0;
  double fall_K = 0.0;
  double fall_s = 0.0;  ///< median time of a fall by `fall_K`
  TimeUnit suspected = TimeUnit::minutes;
};
/// The winding responds before its heat input changes, which is possible only with a wrong clock.
struct RespondsEarly {
  std::string temperature;
  std::string heat_input;
  double delay_s = 0.0;  ///< negative
  double delay_uncertainty_s = 0.0;
  bool is_one_row = false;  ///< the delay is about one row, as if a row's inputs described the interval before it
};
/// A temperature is constant while another one changes.
struct ConstantSensor {
  std::string channel;
  double value_C = 0.0;
  std::string moving;  ///< the other temperature
  double moves_K = 0.0;
};
/// A heat input is constant while the winding heats up and cools down again and again.
struct ConstantHeatInput {
  std::string channel;
  std::string unit;
  double value = 0.0;
  double by_K = 0.0;  ///< smallest counted change of the winding's temperature above the stator
  int count = 0;      ///< number of such changes
};
/// A heat input often has exactly its largest or smallest value.
struct StaysAtLimit {
  std::string channel;
  std::string unit;
  double value = 0.0;
  std::size_t samples_there = 0;  ///< samples of exactly this value
  std::size_t samples = 0;
};
/// The ambient temperature is mostly higher than a temperature of the motor.
struct AmbientAboveMotor {
  std::string channel;
  double above_K = 0.0;  ///< median
};
/// A temperature falls while the motor is heated and rises while it rests.
struct FallsWhileHeated {
  std::string channel;
  std::string heat_input;
};
/// The stator responds faster to the heat than the winding.
struct StatorRespondsFaster {
  std::string heat_input;
  double stator_K = 0.0;  ///< range of the temperature
  double winding_K = 0.0;
};
/// Without heat, the stator is hotter than the winding and falls by more.
struct StatorHotterAtRest {
  double above_K = 0.0;
};
/// At standstill, where there is only copper loss, the stator warms up faster than the winding.
struct StatorWarmsFirst {
  std::string heat_input;
  double stator_rise_K = 0.0;
  double winding_below_K = 0.0;
};
enum class TemperatureScale { tenths_of_degrees, kelvin, fahrenheit };
/// A temperature starts at a value that is plausible in another scale.
struct StartsInOtherScale {
  std::string channel;
  double start_C = 0.0;      ///< first value in the log
  double converted_C = 0.0;  ///< the same value read in the suspected scale
  TemperatureScale suspected = TemperatureScale::fahrenheit;
};
/// All temperatures of the motor start at one value far above the air. Read as degrees Fahrenheit, it is the temperature of the air.
struct MotorStartsInFahrenheit {
  std::string channel;  ///< the first of these temperatures
  double start_C = 0.0;
  double converted_C = 0.0;
  double ambient_C = 0.0;
};
/// Without heat, the motor approaches a value far above the air. Read as degrees Fahrenheit, it is the temperature of the air.
struct MotorCoolsInFahrenheit {
  std::string channel;  ///< the first temperature of the motor
  double rest_C = 0.0;
  double converted_C = 0.0;
  double ambient_C = 0.0;
};

/// Probable wrong unit, wrong sign or swapped channels.
using Suspicion =
    std::variant<CurrentTooLarge, PowerDiffersFromBus, PowerOppositeToBus, TorqueOppositeToCurrent, SpeedTooLarge, ShaftPowerExceedsInput,
                 AngleSpansDegrees, WheelRowsFarApart, ModulationAboveOne, VoltageTooLarge, LastsForDays, FallsTooFast, RespondsEarly,
                 ConstantSensor, ConstantHeatInput, StaysAtLimit, AmbientAboveMotor, FallsWhileHeated, StatorRespondsFaster,
                 StatorHotterAtRest, StatorWarmsFirst, StartsInOtherScale, MotorStartsInFahrenheit, MotorCoolsInFahrenheit>;

/// Returns whether both are of one kind and about the same channels. Their numbers may differ: a log and a part of it give other numbers.
bool have_one_subject(const Suspicion& a, const Suspicion& b);

/// Suspicion about one of several logs.
struct SuspicionOfLog {
  std::string log;  ///< name of the recording
  Suspicion suspicion;
};

/// The winding certainly responds late, as with a sensor lag.
struct RespondsLate {
  std::string temperature;
  std::string heat_input;
  double delay_s = 0.0;
  double delay_uncertainty_s = 0.0;
};

/// No interval without a gap is long enough to determine a delay.
struct IntervalsTooShort {};
/// The best delay is at the end of the searched range.
struct NoBestDelay {
  double within_s = 0.0;  ///< half width of the range
};
/// Parts of the log give different delays.
struct PartsDisagree {
  double by_s = 0.0;  ///< standard error
};
/// Reason why the delay of a temperature is not determined.
using NoDelayReason = std::variant<IntervalsTooShort, NoBestDelay, PartsDisagree>;

struct TooFewRows {
  std::size_t rows = 0;
  std::size_t needed = 0;
};
/// The log has no temperature of the motor.
struct NoTemperature {};
/// The log has no channel that heats the motor.
struct NoHeatInput {};
/// No temperature changes; `channel` is the first one.
struct TemperatureIsConstant {
  std::string channel;
  double value_C = 0.0;
};
/// No temperature changes by more than its noise; `channel` is the first one.
struct TemperatureWithinNoise {
  std::string channel;
  double low_C = 0.0;
  double high_C = 0.0;
  double noise_K = 0.0;
};
/// All heat inputs are 0; `channel` is the first one.
struct HeatInputIsZero {
  std::string channel;
};
/// The log has no speeds of wheels.
struct NoWheelSpeed {};
/// No wheel changes its speed beyond the noise.
struct WheelsKeepSpeed {};
/// The log has neither modulation, voltage nor current of wheels.
struct NoWheelEffort {};
/// Data that a log lacks for a purpose.
using Lack = std::variant<TooFewRows, NoTemperature, NoHeatInput, TemperatureIsConstant, TemperatureWithinNoise, HeatInputIsZero,
                          NoWheelSpeed, WheelsKeepSpeed, NoWheelEffort>;

/// A column is not used, because its name does not end in a unit.
struct ColumnWithoutUnit {
  std::size_t column = 0;  ///< from 1
  std::string name;
};
/// A channel is not in the table of quantities, but its name is similar to one that is.
struct AdditionalSignal {
  std::string channel;
};
/// The log lacks a column that its mapping declares optional.
struct NotRecorded {
  std::string channel;
  std::string column;
};
/// A channel without any number is left out.
struct ChannelWithoutNumbers {
  std::string channel;
  std::size_t rows = 0;
};
/// Blank samples are filled, as the mapping states.
struct BlanksFilled {
  std::string channel;
  std::size_t samples = 0;
};
/// Remark of the reader of a log, besides the samples that it left out.
using ReadingNote = std::variant<ColumnWithoutUnit, AdditionalSignal, NotRecorded, ChannelWithoutNumbers, BlanksFilled>;

}  // namespace heatsoak::recording
