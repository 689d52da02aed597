#include "derate/sensed/sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/quantity.h"
#include "motor/default_spread.h"

namespace heatsoak::derate {
namespace {

/// Returns the larger relative distance of the two ends of a tolerance from the value; 0 without a tolerance.
double half_width_ratio(const motor::Motor& motor, std::string_view key, double value) {
  const std::optional<base::Spread> spread = motor::spread_or_default(motor, key);
  if (!spread) {
    return 0.0;
  }
  return std::max(spread->high - value, value - spread->low) / value;
}

}  // namespace

std::span<const SensorParameter> sensor_parameters() {
  using enum SensorKind;
  static constexpr std::array<SensorParameter, 5> kAll{{
      {{"thermistor_accuracy", "K", base::Range::between(0.05, 50.0),
        "largest error of the thermistor, mounting included; 2 K unless given"},
       thermistor,
       &SensorOptions::accuracy_K},
      {{"thermistor_lag", "s", base::Range::between(0.0, 600.0), "time constant of the thermistor; 0 s unless given"},
       thermistor,
       &SensorOptions::lag_s},
      {{"resistance_accuracy", "K", base::Range::between(0.5, 50.0),
        "accuracy that current and speed must permit before a reading is used; 10 K unless given"},
       winding_resistance,
       &SensorOptions::accuracy_K},
      {{"voltage_error", "V", base::Range::between(0.0, 10.0), "offset of the terminal voltage; 20 mV unless given"},
       winding_resistance,
       &SensorOptions::voltage_error_V},
      {{"current_error", "A", base::Range::between(0.0, 10.0), "offset of the current; 10 mA unless given"},
       winding_resistance,
       &SensorOptions::current_error_A},
  }};
  return kAll;
}

SensorOptions default_sensor(SensorKind kind) {
  return kind == SensorKind::thermistor ? SensorOptions{} : SensorOptions{.kind = kind, .node = motor::states::winding, .accuracy_K = 10.0};
}

std::string sensor_flags(const SensorOptions& sensor) {
  std::string text = sensor.kind == SensorKind::winding_resistance
                         ? "--winding-resistance"
                         : fmt::format("--thermistor {}", sensor.node == motor::states::winding ? "winding" : "stator");
  for (const SensorParameter& each : sensor_parameters()) {
    if (each.kind == sensor.kind) {
      std::string flag(each.spec.key);
      std::ranges::replace(flag, '_', '-');
      text += fmt::format(" --{} {}{}", flag, base::significant(sensor.*each.value, 6), each.spec.unit);
    }
  }
  return text;
}

bool ResistanceReading::is_usable(double current_A, double speed_rad_per_s) const {
  return std::abs(current_A) >= least_current_A + current_per_speed_A_s_per_rad * std::abs(speed_rad_per_s);
}

ResistanceReading resistance_reading(const motor::Motor& motor, const SensorOptions& options, double period_s) {
  const motor::MotorValues& values = motor.nominal;
  const double resistance_ohm = values.terminal_resistance_ohm;
  const double alpha_per_K = values.temperature_coefficient_per_K;
  constexpr double kReference_C = 25.0;
  const double hot_ratio = 1.0 + alpha_per_K * (values.winding_limit_C - kReference_C);
  // NdFeB magnets lose up to 0.12 %/K, and the rotor may be up to 80 K warmer than during calibration.
  constexpr double kWeakening = 0.1;
  const double torque_constant_error_Nm_per_A =
      (half_width_ratio(motor, "torque_constant", values.torque_constant_Nm_per_A) + kWeakening) * values.torque_constant_Nm_per_A;
  // At less than nominal resistance the voltage drop is smaller, so the same voltage error has a larger effect.
  const double least_ohm = resistance_ohm * (1.0 - std::min(0.5, half_width_ratio(motor, "terminal_resistance", resistance_ohm)));
  const double inductance_H = values.terminal_inductance_H.value_or(0.0);
  const double most_change_A = inductance_H > 0.0 ? options.voltage_error_V * period_s / inductance_H : std::numeric_limits<double>::max();
  const double K_per_share = 2.0 * hot_ratio / (alpha_per_K * options.accuracy_K);
  return {.resistance_25C_ohm = resistance_ohm,
          .temperature_coefficient_per_K = alpha_per_K,
          .torque_constant_Nm_per_A = values.torque_constant_Nm_per_A,
          .least_current_A = K_per_share * (options.voltage_error_V / least_ohm + options.current_error_A),
          .current_per_speed_A_s_per_rad = K_per_share * torque_constant_error_Nm_per_A / least_ohm,
          .most_current_change_A = most_change_A};
}

}  // namespace heatsoak::derate
