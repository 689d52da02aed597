// Trace of a nominal run with all signals, and the power balance of its effects.
#pragma once

#include <string>
#include <vector>

#include "select/drive_profile.h"

namespace heatsoak::select {

/// One row: inputs hold from time_s until the next row, temperatures are those at time_s.
struct TraceRow {
  double time_s = 0.0;
  double winding_C = 0.0;
  double stator_C = 0.0;
  double ambient_C = 0.0;
  double current_A = 0.0;             ///< equivalent DC current, signed like the torque
  double speed_rad_per_s = 0.0;       ///< speed of the motor
  double torque_Nm = 0.0;             ///< torque at the motor's shaft
  double motor_V = 0.0;               ///< voltage at the terminals at this winding temperature
  double power_in_W = 0.0;            ///< electrical power into the terminals
  std::vector<double> own_C = {};     ///< temperatures of the nodes that effects add, in the order of own_nodes
  std::vector<double> sensor_C = {};  ///< readings of the sensors with a stated fault, in the order of shown_at
};

/// Mean heat flow from one effect into one node over the run.
struct BookedHeat {
  std::string effect;
  std::string node;
  double mean_W = 0.0;
};

struct Trace {
  std::vector<TraceRow> rows;
  std::vector<std::string> own_nodes;  ///< nodes that effects add
  std::vector<std::string> shown_at;   ///< nodes whose sensor has a stated fault
  std::vector<BookedHeat> balance;
  double stored_W = 0.0;  ///< mean rate of heat storage in all nodes
};

/// Runs the trace of one wheel. Rows are at every change of the inputs and at most `every_s` apart.
Trace run_trace(const robot::Robot& robot, const duty::Duty& duty, const duty::WheelDemand& wheel, const motor::Motor& motor,
                double every_s);

/// Returns the trace as CSV in the format of logs: one header row, names end in units. Columns of nodes from effects follow the ambient
/// temperature, then those of sensors with faults.
std::string to_csv(const Trace& trace);

}  // namespace heatsoak::select
