// A stretch of a recording as fits and filters take it: intervals with held inputs, and sensors at their ends.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "identify/measurement/recording.h"
#include "motor/sensor_effect.h"
#include "thermal/network.h"

namespace heatsoak {

struct Sensor {
  std::string signal;                    ///< key of the recording, "winding_C"
  std::string node;                      ///< of the network
  double noise_K = 0.0;                  ///< standard deviation of one sample, model-free, the share of the quantisation included
  double step_K = 0.0;                   ///< resolution; 0 where none is seen
  std::vector<SensorFault> faults = {};  ///< that are stated for it
};

/// Rows that nobody logged, while the inputs changed: over `interval` they may as well have been `other`, or as far on the other side.
struct UnknownInputs {
  Eigen::Index interval = 0;
  OperatingPoint<double> other;
};

/// n samples; between sample k and k+1 the inputs are at[k].
struct MeasuredRun {
  std::string name;  ///< of the recording, with #2, #3 … where it was split
  std::vector<double> time_s;
  std::vector<OperatingPoint<double>> at;     ///< n − 1
  std::vector<UnknownInputs> unknown_inputs;  ///< by interval, ascending; several of one interval are independent
  std::vector<Sensor> sensors;
  Eigen::MatrixXd measured_C;   ///< n × sensors; NaN: not known
  std::vector<Signal> signals;  ///< what of the operating points was measured
  /// What is said of the run: the recording's conditions, and "run" -> the recording's name.
  std::map<std::string, std::string> conditions;
  std::map<std::string, Eigen::VectorXd> columns;  ///< of the log that are no operating point: columns_along

  [[nodiscard]] Eigen::Index samples() const { return static_cast<Eigen::Index>(time_s.size()); }
  [[nodiscard]] bool has(Signal signal) const;
  /// Whether all of the conditions are said of the run.
  [[nodiscard]] bool has(const std::map<std::string, std::string>& of_conditions) const;
  /// -1 where no sensor sits at the node.
  [[nodiscard]] Eigen::Index sensor_at(std::string_view node) const;
};

/// What the constants of a motor tell of rows whose current and speed are known: the torque at the shaft and the voltage at the terminals.
/// Nothing where the log's own columns are all that counts.
struct ShaftTorque {
  double per_current_Nm_per_A = 0.0;
  double drag_Nm = 0.0;         ///< that the motor loses inside while it turns
  double resistance_ohm = 0.0;  ///< of the terminals
};

struct MeasuredRunOptions {
  /// Rows closer than this are merged; inputs become means that conserve heat. Rows further apart than half of it stay.
  double longest_step_s = 2.0;
  /// Heat inputs that the model reacts to; where one of them is not known for longer than ten seconds and three usual steps the run is
  /// split.
  std::vector<Signal> needed;
  double least_current_A = 0.0;          ///< less turns no motor: a log that never has more is one of a motor that stands
  ShaftTorque torque = {};               ///< where the recording has none but current and speed
  std::vector<SensorFault> faults = {};  ///< of the sensors, as they are stated
  std::string column = {};               ///< key of the one that goes into the operating points
  double ambient_C = kNotStated_C;       ///< where the recording has neither coolant nor ambient; NaN: it must have one
  static constexpr double kNotStated_C = std::numeric_limits<double>::quiet_NaN();
};

struct MeasuredRuns {
  std::vector<MeasuredRun> runs;
  std::vector<std::string> notes;  ///< what was left out or taken for granted, in sentences
};

/// Signals that a recording has, the shaft's power among them where it has a torque or its current tells one.
std::vector<Signal> signals_of(const Recording& recording, const ShaftTorque& torque = {});

/// Throws Failure: bad_input where a needed signal or the surroundings' temperature is no column, cannot_answer where
/// no stretch is left with all of them. Temperatures become means over the tenth of a step around the sample's time, where there are such
/// rows.
MeasuredRuns measured_runs(const Recording& recording, const MeasuredRunOptions& options);

/// Every `merged` intervals become one, with the same heat; for a rough look.
MeasuredRun thinned(const MeasuredRun& run, int merged);
/// Every run by intervals of some 15 s, of which a run has 60 at least where it had as many: for a search that begins anywhere.
std::vector<MeasuredRun> roughly(std::span<const MeasuredRun> runs);

}  // namespace heatsoak
