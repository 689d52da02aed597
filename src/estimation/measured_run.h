// Segment of a recording, prepared for fits and filters: intervals with constant inputs, and sensor readings at their ends.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "estimation/findings.h"
#include "motor/sensor_effect.h"
#include "recording/recording.h"
#include "thermal/network.h"

namespace heatsoak::estimation {

struct Sensor {
  std::string signal;    ///< key in the recording, for example "winding_C"
  std::string node;      ///< node of the network
  double noise_K = 0.0;  ///< standard deviation of one merged sample, quantisation included: a model-free estimate, at least 0.01 K
  double step_K = 0.0;   ///< resolution; 0 if no quantisation is visible
  std::vector<motor::SensorFault> faults = {};  ///< stated faults of this sensor
};

/// Uncertainty of the inputs over one interval: they may have been `other` instead of at[interval], or equally far in the other direction.
/// Its causes are missing rows or blank cells while the inputs changed, and short pulses between equal ends.
struct UnknownInputs {
  Eigen::Index interval = 0;
  thermal::OperatingPoint<double> other;
};

/// Measured run with n samples. The inputs are at[k] between sample k and k + 1.
struct MeasuredRun {
  std::string name;  ///< name of the recording; with suffix #2, #3 … if it was split
  std::vector<double> time_s;
  std::vector<thermal::OperatingPoint<double>> at;  ///< n − 1
  std::vector<UnknownInputs> unknown_inputs;        ///< in ascending order of the interval; several for one interval are independent
  std::vector<Sensor> sensors;
  Eigen::MatrixXd measured_C;            ///< n × sensors; NaN: not measured
  std::vector<thermal::Signal> signals;  ///< quantities of the operating points that were measured
  bool is_current_measured = false;      ///< false also if it was computed from the torque
  /// Conditions of the recording, and "run" with the recording's name.
  std::map<std::string, std::string> conditions;
  std::map<std::string, Eigen::VectorXd> columns;  ///< result of columns_along()

  // Copies and the destructor are large, so they are compiled once.
  MeasuredRun();
  MeasuredRun(const MeasuredRun&);
  MeasuredRun(MeasuredRun&&) noexcept;
  MeasuredRun& operator=(const MeasuredRun&);
  MeasuredRun& operator=(MeasuredRun&&) noexcept;
  ~MeasuredRun();

  [[nodiscard]] Eigen::Index samples() const { return static_cast<Eigen::Index>(time_s.size()); }
  [[nodiscard]] bool has(thermal::Signal signal) const;
  /// True if the run has all these conditions.
  [[nodiscard]] bool has(const std::map<std::string, std::string>& of_conditions) const;
  /// Returns the index of the sensor at a node; empty if the node has none.
  [[nodiscard]] std::optional<Eigen::Index> sensor_at(std::string_view node) const;
};

/// Motor constants that give shaft torque and terminal voltage from current and speed. All zero: only the log's own columns are used.
struct ShaftTorque {
  double per_current_Nm_per_A = 0.0;
  double drag_Nm = 0.0;         ///< drag torque inside the turning motor
  double resistance_ohm = 0.0;  ///< terminal resistance
};

struct MeasuredRunOptions {
  /// Longest interval that rows are merged to; the merged inputs conserve heat. Rows are kept if their mean spacing is at least half of it.
  double longest_step_s = 2.0;
  /// Signals that the model needs: heat inputs, and the signals of its effects. A run ends where one of them is unknown for longer than
  /// both 10 s and three usual steps.
  std::vector<thermal::Signal> needed = {};
  /// The logged current is not read, because the heat comes from another input, which contains the copper loss.
  bool ignores_current = false;
  double least_current_A = 0.0;  ///< smallest current that can turn the motor: a log that never exceeds it is one at standstill
  ShaftTorque torque = {};       ///< used if the recording has no torque but current and speed
  std::vector<motor::SensorFault> faults = {};  ///< stated faults of the sensors
  std::vector<std::string> columns = {};        ///< keys of the log columns that are copied into the operating points, see set_columns()
  std::optional<double> ambient_C = {};  ///< used if the recording has neither coolant nor ambient temperature; empty: it must have one
};

struct MeasuredRuns {
  std::vector<MeasuredRun> runs;
  std::vector<RunNote> notes;
};

/// Returns the name of the recording that a run is a part of.
std::string recording_of(const MeasuredRun& run);

/// Returns the signals that a recording has or that follow from it, for example the shaft power from torque or current.
std::vector<thermal::Signal> signals_of(const recording::Recording& recording, const ShaftTorque& torque = {});
/// Returns the signals of a recording that is read with these options.
std::vector<thermal::Signal> signals_of(const recording::Recording& recording, const MeasuredRunOptions& options);
/// Returns whether signals_of() contains a signal.
bool has_signal(const recording::Recording& recording, thermal::Signal signal, const ShaftTorque& torque = {});

/// Returns the columns that a recording lacks for a comparison with the model: needed signals, the surroundings' temperature, any sensor.
std::vector<base::Diagnostic> lacking_columns(const recording::Recording& recording, const MeasuredRunOptions& options);

/// Splits a recording into runs whose inputs are known. The recording itself is split at every gap of more than three usual steps; these
/// runs replace that split. Its parts are joined again across gaps of at most 10 s in which no temperature changes by more than
/// Thresholds::jump_K. A merged interval ends at a row of the log. Its temperature is the mean over the rows within ± 0.1 · longest_step_s
/// of that row, or NaN if the cell of that row is blank. Sensors are winding_C and stator_C, without it housing_C. Throws Failure
/// (bad_input) if a needed signal, the surroundings' temperature or every sensor is missing; NoUsableInterval if no segment with all of
/// them is left.
MeasuredRuns measured_runs(const recording::Recording& recording, const MeasuredRunOptions& options);

/// Merges every `merged` intervals into one with the same heat. Readings are not averaged; log columns are dropped.
MeasuredRun thinned(const MeasuredRun& run, int merged);
/// Thins every run to intervals of about 15 s, but keeps at least 60 intervals per run if it has them. For fast searches from arbitrary
/// starting points.
std::vector<MeasuredRun> roughly(std::span<const MeasuredRun> runs);

}  // namespace heatsoak::estimation
