// A temperature sensor of the guard: the user's declaration and the resulting parameters of the generated code.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/parameter.h"
#include "derate/current_table.h"
#include "derate/guarantee.h"
#include "derate/observer.h"
#include "motor/datasheet_network.h"

namespace heatsoak::derate {

enum class SensorKind {
  thermistor,         ///< at winding or stator
  winding_resistance  ///< copper resistance (voltage − K_t·ω)/current, which depends on the winding temperature
};

/// Declaration of the sensor by the user.
struct SensorOptions {
  SensorKind kind = SensorKind::thermistor;
  int node = motor::states::stator;  ///< node whose temperature is measured
  double accuracy_K = 2.0;           ///< largest error, > 0
  double lag_s = 0.0;                ///< time constant between node and reading; 0: none
  double voltage_error_V = 0.02;     ///< winding_resistance: largest offset of the terminal voltage
  double current_error_A = 0.01;     ///< winding_resistance: largest offset of the current
};

/// Parameter of a sensor declaration, as commands and check files name it.
struct SensorParameter {
  base::ParameterSpec spec;
  SensorKind kind = SensorKind::thermistor;
  double SensorOptions::*value = nullptr;
};
std::span<const SensorParameter> sensor_parameters();

/// Returns the declaration with the default values of this kind.
SensorOptions default_sensor(SensorKind kind);

/// Returns the options of `derate` that declare the sensor: "--thermistor stator --thermistor-accuracy 2K --thermistor-lag 3s".
std::string sensor_flags(const SensorOptions& sensor);

/// Conditions under which the winding's resistance gives a valid reading. Resistance is measured relative to the first reading after a
/// rest, so that gain errors and the tolerance of R25 cancel. With R = R25·(1 + α·(T − 25 °C)) a voltage error δU causes the error
/// δT = (1 + α·(T − 25 °C))/α·δU/(|I|·R), where δU = voltage error + current error·R + error of K_t·|ω|. The calibration and the reading
/// may each use half of the accuracy.
struct ResistanceReading {
  double resistance_25C_ohm = 0.0;
  double temperature_coefficient_per_K = 0.0;
  double torque_constant_Nm_per_A = 0.0;
  double least_current_A = 0.0;                ///< required current at rest
  double current_per_speed_A_s_per_rad = 0.0;  ///< additional required current per speed
  double most_current_change_A = 0.0;          ///< per period, so that the inductive voltage stays below the voltage error

  [[nodiscard]] bool is_usable(double current_A, double speed_rad_per_s) const;
};

/// Computes the conditions for a motor. Treats the driver's series resistance as known; its tolerance is part of the voltage error.
ResistanceReading resistance_reading(const motor::Motor& motor, const SensorOptions& options, double period_s);

/// Bounds of the cross-check. A reading outside of them is not used.
struct ReadingCheck {
  double most_C = 300.0;           ///< a reading above this, or below the coldest air, is invalid
  double most_rate_K_per_s = 0.0;  ///< fastest change of the node
  double most_jump_K = 0.0;        ///< allowed jump between two readings in addition to that rate
  /// The node's rise above the air is at least this share of the nominal motor's rise, minus `cold_margin_K`. If the air is not measured,
  /// the coldest air is assumed for this check and the hottest air for the nominal motor.
  double cold_share = 0.0;
  double cold_margin_K = 0.0;
  double frozen_band_K = 0.0;    ///< a sensor is stuck if its readings stay within this band …
  double frozen_K = 0.0;         ///< … while the nominal motor's node changes by more than this
  double contradiction_s = 2.0;  ///< duration of a contradiction after which the sensor is disabled permanently
  double hold_s = 1.0;           ///< time after the last reading during which the lower safety factor applies
};

/// Continuous allowed current of the nominal motor at one speed.
struct LastingCurrent {
  double speed_rad_per_s = 0.0;
  double without_A = 0.0;  ///< without the sensor
  double with_A = 0.0;     ///< with the sensor
};

/// Parameters that the generated code needs in addition to the guard without a sensor, and the results of their check.
struct SensorPlan {
  SensorOptions options;
  std::optional<ResistanceReading> resistance = {};
  /// Observer with the lower safety factor. A sensor at the stator responds too late to a pulse from cold. The heat capacity of the winding
  /// is therefore divided by winding_speed_ratio, so that a pulse heats it at least as fast as without a sensor.
  Observer observer;
  double winding_speed_ratio = 1.0;
  CurrentTable table;           ///< table of that observer
  std::vector<double> gain;     ///< per state: correction per period and kelvin of innovation
  double lag_gain_ratio = 0.0;  ///< gain of the sensor's own temperature if it has a lag
  double most_gain_A = 0.0;     ///< limit of the current above that of the guard without a sensor; bounds the effect of a faulty sensor
  ReadingCheck check = {};
  std::vector<LastingCurrent> lasting = {};
  Guarantee guarantee = {};             ///< check on fresh drawn motors, each with a drawn sensor error
  int dropped = 0;                      ///< drawn motors of that check whose correct sensor is rejected by the cross-check
  int sensor_fault_over = 0;            ///< drawn motors that exceed a limit with the worst undetected sensor fault
  double sensor_fault_nominal_C = 0.0;  ///< hottest winding of the nominal motor with that fault, from the hottest air temperature
  double sensor_fault_warm_C =
      0.0;  ///< hottest winding with that fault, from any start up to the winding limit with all nodes equally warm
};

}  // namespace heatsoak::derate
