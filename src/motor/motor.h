// A motor as its file declares it: figures with unit, origin, source and spread.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/figure.h"
#include "base/parameter.h"
#include "base/random.h"
#include "input/reader.h"
#include "motor/fit_table.h"
#include "motor/sensor_effect.h"
#include "thermal/effect.h"

namespace heatsoak {

inline constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

/// The figures as numbers, in this program's conventions: resistance and inductance between two terminals,
/// torque constant per DC ampere of block commutation. NaN where the file gives none.
struct MotorValues {
  double nominal_voltage_V = kAbsent;
  double no_load_speed_rad_per_s = kAbsent;
  double no_load_current_A = kAbsent;
  double nominal_speed_rad_per_s = kAbsent;
  double nominal_torque_Nm = kAbsent;
  double nominal_current_A = kAbsent;
  double stall_torque_Nm = kAbsent;
  double stall_current_A = kAbsent;
  double max_efficiency = kAbsent;
  double terminal_resistance_ohm = kAbsent;
  double terminal_inductance_H = kAbsent;
  double torque_constant_Nm_per_A = kAbsent;
  double speed_constant_rad_per_s_per_V = kAbsent;
  double speed_torque_gradient_rad_per_s_per_Nm = kAbsent;
  double mechanical_time_constant_s = kAbsent;
  double rotor_inertia_kg_m2 = kAbsent;
  double pole_pairs = kAbsent;
  double mass_kg = kAbsent;
  double diameter_m = kAbsent;
  double length_m = kAbsent;
  double assigned_power_W = kAbsent;
  double peak_current_A = kAbsent;
  double peak_torque_Nm = kAbsent;
  double max_speed_rad_per_s = kAbsent;
  double ambient_min_C = kAbsent;
  double ambient_max_C = kAbsent;
  double winding_limit_C = kAbsent;
  double stator_limit_C = kAbsent;
  double temperature_coefficient_per_K = kAbsent;
  double thermal_resistance_winding_stator_K_per_W = kAbsent;
  double thermal_resistance_stator_ambient_K_per_W = kAbsent;
  double thermal_time_constant_winding_s = kAbsent;
  double thermal_time_constant_stator_s = kAbsent;
};

/// The one declaration of a motor figure: what the file calls it, and where its number goes.
struct MotorFigureSpec {
  ParameterSpec spec;
  double MotorValues::*value = nullptr;
  Need need = Need::optional;
  bool is_thermal = false;  ///< the temperature calculation rests on it
};
std::span<const MotorFigureSpec> motor_figure_specs();
/// Agreed, not built, such as a limit or the nominal voltage: no part has another one, so it needs no tolerance.
bool is_agreed(std::string_view key);

/// An effect that the file adds to the datasheet network.
struct MotorEffect {
  std::string name;
  const EffectType* type = nullptr;
  std::vector<std::string> nodes;
  std::vector<Figure> parameters;  ///< in the type's declared order
  /// Where it acts: "cooling" -> "fan" as logs name their conditions. Empty: everywhere. An effect with a condition was seen in
  /// some runs only: what predictions do with it stands in conditions.h.
  std::map<std::string, std::string> condition = {};
  std::string column = {};  ///< of logs, that a curve is drawn over; empty where it is over another signal

  /// Of the parameters, in the type's declared order.
  [[nodiscard]] std::vector<double> values() const;
};

/// A fault that the file states for a sensor at the motor: it moves what is shown, not the temperature.
struct MotorSensor {
  std::string name;
  const SensorEffectType* type = nullptr;
  Figure size;
};

struct Motor {
  std::string id;  ///< the file's stem
  std::filesystem::path file;
  std::string manufacturer;
  std::string name;
  std::string part_number;
  std::string type;                            ///< "brushless", "brushed"
  std::string rotor;                           ///< "external" around the stator, "internal"; empty where the file does not say
  std::map<std::string, std::string> assumed;  ///< conditions that were stated to hold (conditions.h); no part of the file
  std::vector<std::string> notes;
  std::map<std::string, std::string, std::less<>> sources;
  bool stall_includes_saturation = false;
  std::map<std::string_view, Figure> figures;  ///< by key, in this program's conventions
  std::vector<MotorEffect> effects;
  std::vector<MotorSensor> sensors;
  std::optional<MotorFit> fit;  ///< where a calibration wrote the file
  MotorValues nominal;
};

/// Throws Failure (bad_input) with every problem of the file.
Motor read_motor(const std::filesystem::path& path);

/// By key, "thermal_resistance_winding_stator" or "effects.fan.conductance"; null where the motor has none.
Figure* find_figure(Motor& motor, std::string_view key);
/// Sets `nominal` by the figures, after some of them were changed.
void refresh_values(Motor& motor);

/// What the file states for the sensor of a signal, "winding_C".
std::vector<SensorFault> faults_of(const Motor& motor, std::string_view signal);

/// One draw of every declared tolerance and range of what makes temperatures; figures of a fit hang together as the fit says, and all heat
/// of a motor with a forecast band has a factor of that band.
struct MotorSample {
  MotorValues values;
  std::vector<std::vector<double>> effect_parameters;  ///< per effect, in declared order
};
MotorSample nominal_sample(const Motor& motor);
MotorSample draw_sample(const Motor& motor, Random& random);

/// What a verdict on this motor's temperature rests on. Of a file that a calibration wrote: `measured` where it has all of the four thermal
/// resistances and time constants from data and nothing is estimated, else `mixed`. Otherwise: `datasheet` where every thermal figure is
/// measured or from the manufacturer's sheet, `estimated` where one of the four thermal resistances and time constants, the winding limit
/// or a figure of an added effect is an estimate, `mixed` otherwise.
std::string_view data_quality(const Motor& motor);

}  // namespace heatsoak
