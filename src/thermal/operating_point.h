// Operating point of the machine: every quantity that a thermal law may depend on, and the table of these quantities.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace heatsoak::thermal {

/// Set of optional quantities: bit `row` stands for that row of kQuantities.
using QuantitySet = unsigned;
/// Largest number of log columns that the curves of one motor can use.
inline constexpr std::size_t kLogColumns = 3;

/// Means over one interval, chosen so that intervals can be merged without changing the heat: I²R uses the RMS current, a loss ∝ |ω| the
/// mean speed, one ∝ ω² the RMS speed. Products such as |I|·ω² use the product of the means. That is accurate if the interval is short
/// compared with load changes, like the rows of a log. A quantity that is not measured keeps its default.
template <class S>
struct OperatingPoint {
  using Scalar = S;

  S current_rms_A = S(0.0);  ///< equivalent DC current at the terminals: I² times the resistance of two phases in series is the heat
  S speed_mean_rad_per_s = S(0.0);  ///< mean of |ω|, motor shaft
  S speed_rms_rad_per_s = S(0.0);   ///< root mean square of ω, motor shaft
  S ambient_C = S(25.0);
  /// Voltage available for I·R after the back-EMF, scaled by the heating factor of the current. As the winding heats up and its resistance
  /// rises, it limits the current. Infinite: no voltage limit.
  S resistive_headroom_V = S(std::numeric_limits<double>::infinity());
  S series_resistance_ohm = S(0.0);    ///< driver and leads: they take part of that voltage, but do not heat the motor
  S shaft_power_W = S(0.0);            ///< mean of M·ω: positive drives, negative brakes
  S input_power_W = S(0.0);            ///< electrical power into the motor (or into its driver, if the log says so)
  S bus_V = S(0.0);                    ///< supply voltage of the driver
  S modulation_ratio = S(0.0);         ///< mean of |terminal voltage| / supply voltage, 0 to 1
  S vehicle_speed_m_per_s = S(0.0);    ///< mean of the speed's magnitude
  S neighbour_C = S(25.0);             ///< temperature of the neighbouring motor, valid if `known` has kNeighbour
  S unlogged_speed_share = S(0.0);     ///< 1 if the machine may turn at a speed that was not logged, else 0
  S age_h = S(0.0);                    ///< operating hours so far
  S velocity_rad_per_s = S(0.0);       ///< signed mean of ω, motor shaft; a log of |ω| does not provide the sign
  S acceleration_rad_per_s2 = S(0.0);  ///< mean of |dω/dt|, motor shaft
  // Columns of a log, in their own units: abscissas of tabulated curves over none of the signals above. Valid if `known` has their bits.
  S first_column = S(0.0);
  S second_column = S(0.0);
  S third_column = S(0.0);
  S copper_loss_W = S(0.0);  ///< copper loss of the network, which its drive stage sets before the laws are evaluated
  QuantitySet known = 0;     ///< optional quantities that are known, equal for all samples of Lanes; see set_quantity()

  [[nodiscard]] constexpr bool knows(QuantitySet quantities) const { return (known & quantities) == quantities; }
};

/// Signals of a log that a law may need besides the temperatures of its nodes and of the surroundings. A log without one of them holds no
/// evidence about the law. The inputs of the guard in the firmware are other ones: derate::observed::Signal. The copper loss is computed
/// from the current; velocity and acceleration need the speed.
enum class Signal { current, speed, shaft_power, input_power, modulation, bus_voltage, vehicle_speed, neighbour_temperature, age };

/// Rule for averaging a quantity over time. `rms` averages its square. `limit`: not averaged; a merged interval has the default, no limit.
enum class AveragingRule { mean, rms, limit };

/// Rule for computing the quantity from its log column.
enum class FromColumn {
  value,
  magnitude,
  computed  ///< from several columns: estimation/log_rows.cpp
};

/// Assumption of the guard in the firmware about an input whose heating must not be underestimated.
enum class WorstCase {
  both_directions,  ///< every magnitude up to the largest, with either sign; current and speed only
  hottest_air,      ///< the hottest declared air
  searched          ///< the values of its range that heat winding and bodies most (derate/hot_cases.cpp)
};

/// Value of an input that the guard assumes for a motor without power.
enum class WithoutPower {
  zero,           ///< the motor is at rest
  hottest_air,    ///< the hottest declared air
  winding_limit,  ///< the winding limit, for the temperature of another motor
  any             ///< unknown: each node takes the largest rate over the possible values; implemented for the age only
};

/// Quantity as an input of the guard in the firmware. The constructor makes each row state the value without power.
struct FirmwareInput {
  std::string_view field;    ///< name in generated code
  std::string_view meaning;  ///< description with sign convention
  WithoutPower without_power;
  WorstCase worst;

  constexpr FirmwareInput(std::string_view field_of, std::string_view meaning_of, WithoutPower assumed,
                          WorstCase worst_of = WorstCase::searched)
      : field(field_of), meaning(meaning_of), without_power(assumed), worst(worst_of) {}
};

/// One row of the table of quantities; S as in OperatingPoint.
template <class S>
struct OperatingQuantity {
  S OperatingPoint<S>::*value;
  std::string_view name;             ///< in messages with spaces: "shaft power"
  std::string_view unit;             ///< UDUNITS text, also the unit of `column`
  std::optional<double> usual = {};  ///< value of a hot motor under load, in `unit`; none: the default
  AveragingRule averaging = AveragingRule::mean;
  bool is_motion = false;  ///< depends on the motion alone; for gaps, in which motion and torque are unknown independently
  std::optional<Signal> signal = {};
  std::string_view column = {};  ///< log column of the signal; one quantity of each signal has it
  FromColumn from = FromColumn::computed;
  std::string_view lacking = {};   ///< words of the message about a log without the signal
  bool is_input_signal = false;    ///< can be the input signal of a measured curve (effect `tabulated`)
  std::string_view meaning = {};   ///< description as an input signal
  bool is_range_compared = false;  ///< `diagnose` warns if hold-out runs leave its range in the training runs
  std::optional<FirmwareInput> firmware = {};
  bool is_optional = false;  ///< valid only if OperatingPoint::known has its bit, because no default is safe, as for a temperature
};

// clang-format off
/// Every number of OperatingPoint once; the order of the input signals is also that in which a diagnosis tries them.
template <class S, class P = OperatingPoint<S>>
inline constexpr std::array kQuantities{
    OperatingQuantity<S>{&P::speed_mean_rad_per_s, "speed", "rad/s", 300.0, AveragingRule::mean, true, Signal::speed, "speed_rad_per_s", FromColumn::computed, "speed", true, "mean of |ω|", true,
                         FirmwareInput{"speed_rad_per_s", "speed of the motor's shaft, signed", WithoutPower::zero, WorstCase::both_directions}},
    OperatingQuantity<S>{&P::velocity_rad_per_s, "velocity", "rad/s", 300.0, AveragingRule::mean, true, Signal::speed, "", FromColumn::computed, "", true, "speed ω with its sign"},
    OperatingQuantity<S>{&P::current_rms_A, "current", "A", 5.0, AveragingRule::rms, false, Signal::current, "current_A", FromColumn::computed, "current", true, "rms current", true,
                         FirmwareInput{"current_A", "equivalent DC current (torque per torque constant), rms over the period, with the sign of the speed when the motor drives", WithoutPower::zero, WorstCase::both_directions}},
    OperatingQuantity<S>{&P::modulation_ratio, "modulation", "", 0.5, AveragingRule::mean, false, Signal::modulation, "modulation_ratio", FromColumn::computed, "modulation", true, "ratio |V_motor|/V_bus"},
    OperatingQuantity<S>{&P::shaft_power_W, "shaft_power", "W", 50.0, AveragingRule::mean, false, Signal::shaft_power, "torque_Nm", FromColumn::computed, "torque and speed", true, "mechanical power; above 0 while the motor drives"},
    OperatingQuantity<S>{&P::input_power_W, "input_power", "W", 80.0, AveragingRule::mean, false, Signal::input_power, "power_in_W", FromColumn::value, "input power", true, "electrical input power", true},
    OperatingQuantity<S>{&P::acceleration_rad_per_s2, "acceleration", "rad/s2", 100.0, AveragingRule::mean, true, Signal::speed, "", FromColumn::computed, "", true, "mean of |dω/dt|", false,
                         FirmwareInput{"acceleration_rad_per_s2", "magnitude of dω/dt of the motor's shaft, mean over the period", WithoutPower::zero}},
    OperatingQuantity<S>{&P::bus_V, "bus_voltage", "V", 24.0, AveragingRule::mean, false, Signal::bus_voltage, "bus_V", FromColumn::value, "supply voltage", true, "voltage of the supply"},
    OperatingQuantity<S>{&P::vehicle_speed_m_per_s, "vehicle_speed", "m/s", 2.0, AveragingRule::mean, true, Signal::vehicle_speed, "vehicle_speed_m_per_s", FromColumn::magnitude, "vehicle speed", true, "magnitude of the vehicle's speed", true,
                         FirmwareInput{"vehicle_speed_m_per_s", "speed of the robot through the air, not of its wheels; 0 if it is not known", WithoutPower::zero}},
    OperatingQuantity<S>{&P::age_h, "age", "h", 100.0, AveragingRule::mean, false, Signal::age, "age_h", FromColumn::value, "hours of running", true, "operating hours", false,
                         FirmwareInput{"age_h", "operating hours of the motor", WithoutPower::any}},
    OperatingQuantity<S>{&P::neighbour_C, "neighbour_temperature", "degC", 90.0, AveragingRule::mean, false, Signal::neighbour_temperature, "neighbour_C", FromColumn::value, "temperature of the neighbour", false, "", false,
                         FirmwareInput{"neighbour_C", "temperature of the motor next to this one; the winding's limit if it is not known", WithoutPower::winding_limit}, true},
    OperatingQuantity<S>{&P::ambient_C, "ambient", "degC", 20.0, AveragingRule::mean, false, {}, "ambient_C", FromColumn::computed, "", false, "", false,
                         FirmwareInput{"ambient_C", "air around the motor; the hottest declared air if it is not measured", WithoutPower::hottest_air, WorstCase::hottest_air}},
    OperatingQuantity<S>{&P::speed_rms_rad_per_s, "speed_rms", "rad/s", 300.0, AveragingRule::rms, true, Signal::speed},
    OperatingQuantity<S>{&P::resistive_headroom_V, "resistive_headroom", "V", std::numeric_limits<double>::infinity(), AveragingRule::limit},
    OperatingQuantity<S>{&P::series_resistance_ohm, "series_resistance", "ohm"},
    OperatingQuantity<S>{&P::unlogged_speed_share, "unlogged_speed_share", ""},
    OperatingQuantity<S>{.value = &P::first_column, .name = "first_column", .unit = "", .is_optional = true},
    OperatingQuantity<S>{.value = &P::second_column, .name = "second_column", .unit = "", .is_optional = true},
    OperatingQuantity<S>{.value = &P::third_column, .name = "third_column", .unit = "", .is_optional = true},
    OperatingQuantity<S>{&P::copper_loss_W, "copper_loss", "W", 10.0},
};
// clang-format on

inline constexpr std::size_t kQuantityCount = kQuantities<double>.size();
static_assert(sizeof(OperatingPoint<double>) == (kQuantityCount + 1) * sizeof(double), "every number of OperatingPoint needs one row");

/// Returns the number of rows that give a signal its log column.
constexpr std::size_t log_columns_of(std::size_t signal) {
  std::size_t count = 0;
  for (const OperatingQuantity<double>& each : kQuantities<double>) {
    count += each.signal == static_cast<Signal>(signal) && !each.column.empty() ? 1 : 0;
  }
  return count;
}

/// Number of enumerators of Signal: one more than the last enumerator in the table. An enumerator without a row is not counted.
inline constexpr std::size_t kSignalCount = [] {
  std::size_t count = 0;
  for (const OperatingQuantity<double>& each : kQuantities<double>) {
    count = each.signal && static_cast<std::size_t>(*each.signal) >= count ? static_cast<std::size_t>(*each.signal) + 1 : count;
  }
  return count;
}();
static_assert(
    [] {
      for (std::size_t signal = 0; signal < kSignalCount; ++signal) {
        if (log_columns_of(signal) != 1) {
          return false;
        }
      }
      return true;
    }(),
    "each signal has one log column");

/// Returns the number of quantities that are inputs of the firmware.
constexpr std::size_t firmware_input_count() {
  std::size_t count = 0;
  for (const OperatingQuantity<double>& each : kQuantities<double>) {
    count += each.firmware ? 1 : 0;
  }
  return count;
}

static_assert(std::ranges::none_of(kQuantities<double>,
                                   [](const OperatingQuantity<double>& each) {
                                     return each.firmware && each.firmware->without_power == WithoutPower::any && each.name != "age";
                                   }),
              "only the age is searched over all values: derate/power_off.h, rates_of_any_age() of the drive core");

/// Returns the index of a quantity in the table; kQuantityCount if there is none of that name.
constexpr std::size_t quantity_row(std::string_view name) {
  std::size_t row = 0;
  while (row < kQuantityCount && kQuantities<double>[row].name != name) {
    ++row;
  }
  return row;
}

/// Returns the bit of a quantity in OperatingPoint::known; 0 if it is not optional.
constexpr QuantitySet known_bit(std::size_t row) { return kQuantities<double>[row].is_optional ? QuantitySet{1} << row : 0; }
static_assert(kQuantityCount <= std::numeric_limits<QuantitySet>::digits, "one bit for each row");

inline constexpr QuantitySet kNeighbour = known_bit(quantity_row("neighbour_temperature"));

/// Row of a column of the log; `place` is below kLogColumns.
constexpr std::size_t column_row(std::size_t place) {
  constexpr std::size_t kFirst = quantity_row("first_column");
  return kFirst + place;
}
constexpr QuantitySet column_bit(std::size_t place) { return known_bit(column_row(place)); }
static_assert(quantity_row("third_column") == column_row(kLogColumns - 1) && column_bit(0) != 0 && kNeighbour != 0);

/// Sets a quantity of the table and, if it is optional, its bit in `known`. Code that fills an operating point sets each optional quantity
/// with this function: a law ignores a value without its bit.
template <class S, class V>
constexpr void set_quantity(OperatingPoint<S>& at, std::size_t row, const V& value) {
  at.*kQuantities<S>[row].value = value;
  at.known |= known_bit(row);
}

/// Returns the row with the log column of a signal.
constexpr const OperatingQuantity<double>& quantity_of(Signal signal) {
  for (const OperatingQuantity<double>& each : kQuantities<double>) {
    if (each.signal == signal && !each.column.empty()) {
      return each;
    }
  }
  return kQuantities<double>.front();
}

/// Calls f for each quantity, with that quantity of all given points as arguments.
template <class F, class... Point>
constexpr void for_each_quantity(F&& f, Point&... at) {
  const auto one = [&]<std::size_t i>() { f(at.*(kQuantities<typename Point::Scalar>[i].value)...); };
  [&]<std::size_t... i>(std::index_sequence<i...>) { (one.template operator()<i>(), ...); }
  (std::make_index_sequence<kQuantityCount>());
}

/// Calls assign(target, source) for each quantity of the two points, and copies which optional quantities are known.
template <class F, class To, class From>
constexpr void convert_point(F&& assign, To& to, const From& from) {
  for_each_quantity(std::forward<F>(assign), to, from);
  to.known = from.known;
}

}  // namespace heatsoak::thermal
