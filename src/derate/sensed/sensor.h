// A temperature sensor in the guard: what is declared of it, and what follows from that for the generated code.
#pragma once

#include <optional>
#include <vector>

#include "derate/current_table.h"
#include "derate/observer.h"
#include "motor/datasheet_network.h"

namespace heatsoak {

enum class SensorKind {
  thermistor,         ///< at winding or stator
  winding_resistance  ///< (voltage − K_t·ω)/current of the copper, whose resistance follows its temperature
};

/// As the user declares it.
struct SensorOptions {
  SensorKind kind = SensorKind::thermistor;
  int node = states::stator;      ///< whose temperature is read
  double accuracy_K = 2.0;        ///< largest error, > 0
  double lag_s = 0.0;             ///< time constant between node and reading; 0: none
  double voltage_error_V = 0.02;  ///< winding_resistance: offset of the terminal voltage
  double current_error_A = 0.01;  ///< winding_resistance: offset of the current
};

/// When the winding's resistance is worth a reading. Resistance is read relative to the first reading after a rest, so that gain errors and
/// the tolerance of R25 cancel. With R = R25·(1 + α·(T − 25 °C)) an error of the voltage δU makes
/// δT = (1 + α·(T − 25 °C))/α·δU/(|I|·R), δU = voltage error + current error·R + error of K_t·|ω|. Half of the accuracy is for the
/// calibration, half for the reading.
struct ResistanceReading {
  double resistance_25C_ohm = 0.0;
  double temperature_coefficient_per_K = 0.0;
  double torque_constant_Nm_per_A = 0.0;
  double least_current_A = 0.0;                ///< at rest
  double current_per_speed_A_s_per_rad = 0.0;  ///< that is needed beyond it
  double most_current_change_A = 0.0;          ///< from one period to the next: the inductance's voltage stays below the voltage error

  [[nodiscard]] bool is_usable(double current_A, double speed_rad_per_s) const;
};

/// A driver's resistance in series with the winding is taken as known; its tolerance is part of the voltage error.
ResistanceReading resistance_reading(const Motor& motor, const SensorOptions& options, double period_s);

/// What the cross-check of a reading allows. A reading outside of it is not used.
struct ReadingCheck {
  double most_C = 300.0;           ///< a reading above is none, like one below the coldest air
  double most_rate_K_per_s = 0.0;  ///< of the node
  double most_jump_K = 0.0;        ///< between two readings, beyond that rate
  /// The rise of the node above the air is at least this share of the nominal motor's, less `cold_margin_K`. Where the
  /// air is not measured it counts as the coldest here, and as the hottest in the nominal motor.
  double cold_share = 0.0;
  double cold_margin_K = 0.0;
  double frozen_band_K = 0.0;    ///< a reading that stays within it …
  double frozen_K = 0.0;         ///< … while the nominal motor's node changes by more than this is stuck
  double contradiction_s = 2.0;  ///< for which a contradiction lasts before the sensor is dropped for good
  double hold_s = 1.0;           ///< after the last reading for which the lower safety factor counts
};

/// Held for good by the nominal motor, all that is allowed.
struct LastingCurrent {
  double speed_rad_per_s = 0.0;
  double without_A = 0.0;  ///< a sensor
  double with_A = 0.0;
};

/// Everything that the generated code needs beyond the guard without a sensor.
struct SensorPlan {
  SensorOptions options;
  std::optional<ResistanceReading> resistance = {};
  /// Counts heat by the lower safety factor. Its winding stores winding_speed_ratio times less heat, so that a pulse from cold heats it at
  /// least as fast as without a sensor: no sensor at the stator sees a pulse in time.
  Observer observer;
  double winding_speed_ratio = 1.0;
  CurrentTable table;           ///< of that observer
  std::vector<double> gain;     ///< of the states per period and kelvin of innovation
  double lag_gain_ratio = 0.0;  ///< of the sensor's own temperature, where it lags
  double most_gain_A = 0.0;     ///< above what the guard without a sensor allows: the most that a lying sensor can add
  ReadingCheck check = {};
  std::vector<LastingCurrent> lasting = {};
  int samples = 0;  ///< drawn motors, each with a drawn sensor error
  int over = 0;     ///< of them that exceeded a limit
  double winding_p95_C = 0.0;
  double winding_most_C = 0.0;
  int dropped = 0;               ///< of them whose honest sensor is dropped by the cross-check
  int lying_over = 0;            ///< of as many that exceed a limit where the sensor lies as much as it can without being noticed
  double lying_nominal_C = 0.0;  ///< hottest winding of the nominal motor then
};

}  // namespace heatsoak
