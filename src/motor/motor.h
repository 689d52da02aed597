// A motor as its file declares it: values with unit, origin, source and spread.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/parameter.h"
#include "base/parameter_value.h"
#include "base/random.h"
#include "input/reader.h"
#include "motor/fit_table.h"
#include "motor/sensor_effect.h"
#include "thermal/effect.h"

namespace heatsoak::motor {

/// Values as numbers in this program's conventions: resistance and inductance between two terminals, torque constant per DC ampere of block
/// commutation. A file may lack the optional ones.
struct MotorValues {
  // Required values. Every motor that read_motor(path) returns has them.
  double nominal_voltage_V = 0.0;
  double no_load_current_A = 0.0;
  double terminal_resistance_ohm = 0.0;
  double torque_constant_Nm_per_A = 0.0;
  double winding_limit_C = 0.0;
  double temperature_coefficient_per_K = 0.0;
  double thermal_resistance_winding_stator_K_per_W = 0.0;
  double thermal_resistance_stator_ambient_K_per_W = 0.0;
  double thermal_time_constant_winding_s = 0.0;
  double thermal_time_constant_stator_s = 0.0;

  std::optional<double> no_load_speed_rad_per_s = {};
  std::optional<double> nominal_speed_rad_per_s = {};
  std::optional<double> nominal_torque_Nm = {};
  std::optional<double> nominal_current_A = {};
  std::optional<double> stall_torque_Nm = {};
  std::optional<double> stall_current_A = {};
  std::optional<double> max_efficiency = {};
  std::optional<double> terminal_inductance_H = {};
  std::optional<double> speed_constant_rad_per_s_per_V = {};
  std::optional<double> speed_torque_gradient_rad_per_s_per_Nm = {};
  std::optional<double> mechanical_time_constant_s = {};
  std::optional<double> rotor_inertia_kg_m2 = {};
  std::optional<double> pole_pairs = {};
  std::optional<double> mass_kg = {};
  std::optional<double> diameter_m = {};
  std::optional<double> length_m = {};
  std::optional<double> assigned_power_W = {};
  std::optional<double> peak_current_A = {};
  std::optional<double> peak_torque_Nm = {};
  std::optional<double> max_speed_rad_per_s = {};
  std::optional<double> ambient_min_C = {};
  std::optional<double> ambient_max_C = {};
  std::optional<double> stator_limit_C = {};
};

/// Returns the internal drag torque of the turning motor, K_t·I_0, in N m.
double drag_torque_Nm(const MotorValues& motor);

/// Declaration of one motor parameter: its key, unit and range in the file, and the member that stores it.
struct MotorParameterSpec {
  base::ParameterSpec spec;
  std::variant<double MotorValues::*, std::optional<double> MotorValues::*> value;
  input::Need need = input::Need::optional;
  bool is_thermal = false;  ///< temperatures depend on it
};
std::span<const MotorParameterSpec> motor_parameter_specs();
/// Returns whether the value is set by agreement, such as a limit or the nominal voltage. It is the same for all parts and needs no
/// tolerance.
bool is_agreed(std::string_view key);

/// An effect that the file adds to the data sheet network.
struct MotorEffect {
  std::string name;
  const thermal::EffectType* type = nullptr;
  std::vector<std::string> nodes;
  std::vector<base::ParameterValue> parameters;  ///< in the type's declared order
  /// Condition under which it acts: "cooling" -> "fan", as logs name their conditions. Empty: always. An effect with a condition was
  /// observed in some runs only; conditions.h describes how predictions treat it.
  std::map<std::string, std::string> condition = {};
  std::string column = {};  ///< log column that is the abscissa of its curve; empty if the abscissa is another signal

  /// Returns the values of the parameters in the type's declared order.
  [[nodiscard]] std::vector<double> values() const;
  /// Returns the index of its column among those of the motor, see kColumnChoices (thermal/effect.h); 0 without a column.
  [[nodiscard]] std::size_t column_place() const;
};

/// A sensor error that the file states. It changes the reading, not the temperature.
struct MotorSensor {
  std::string name;
  const SensorEffectType* type = nullptr;
  base::ParameterValue size;
};

struct Motor {
  std::string id;  ///< stem of the file name
  std::filesystem::path file;
  std::string manufacturer;
  std::string name;
  std::string part_number;
  std::string type;                            ///< "brushless", "brushed"
  std::string rotor;                           ///< "external" (around the stator) or "internal"; empty if the file does not say
  std::map<std::string, std::string> assumed;  ///< conditions set by under() (conditions.h); not in the file
  std::vector<std::string> notes;
  std::map<std::string, std::string, std::less<>> sources;
  bool stall_includes_saturation = false;
  std::map<std::string_view, base::ParameterValue> parameters;  ///< by key, in this program's conventions
  std::vector<MotorEffect> effects;
  std::vector<MotorSensor> sensors;
  std::optional<MotorFit> fit;  ///< present if a calibration wrote the file
  MotorValues nominal;

  // Copies and the destructor are large, so they are compiled once.
  Motor();
  Motor(const Motor&);
  Motor(Motor&&) noexcept;
  Motor& operator=(const Motor&);
  Motor& operator=(Motor&&) noexcept;
  ~Motor();
};

/// Reads a motor file. Throws Failure (bad_input) with every problem of the file.
Motor read_motor(const std::filesystem::path& path);

/// Finds a value by key, "thermal_resistance_winding_stator" or "effects.fan.conductance"; null if the motor has none.
base::ParameterValue* find_parameter(Motor& motor, std::string_view key);
/// Updates `nominal` after values in `parameters` were changed.
void refresh_values(Motor& motor);

/// Returns the faults that the file states for the sensor of a signal such as "winding_C".
std::vector<SensorFault> faults_of(const Motor& motor, std::string_view signal);

/// One sample of all uncertain values that temperatures depend on. Fitted values have the correlation of the fit. If the fit has a forecast
/// band, both thermal resistances are multiplied by its drawn heat factor. The time constants stay, so temperatures change as with a factor
/// on all heat, and voltages do not change.
struct MotorSample {
  MotorValues values;
  std::vector<std::vector<double>> effect_parameters;  ///< per effect, in declared order
};
/// Returns the nominal values of the file.
MotorSample nominal_sample(const Motor& motor);
/// Returns a random sample of all values with a spread.
MotorSample draw_sample(const Motor& motor, base::Random& random);
/// Returns the motor with the heat factor of its forecast band at the 95th percentile, all other values nominal; nullopt without a band.
std::optional<Motor> at_upper_band(const Motor& motor);

/// Returns the quality of the data that determine temperatures. If a calibration wrote the file: `measured` if all four thermal resistances
/// and time constants are measured and no thermal value is an estimate, else `mixed`. Otherwise `datasheet` if every thermal value is
/// measured or from the data sheet. `estimated` if one of the four, the winding limit or a parameter of an effect is an estimate. Else
/// `mixed`.
std::string_view data_quality(const Motor& motor);

}  // namespace heatsoak::motor
