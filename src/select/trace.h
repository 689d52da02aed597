// One nominal run with every signal, and the power balance of its effects.
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
  double torque_Nm = 0.0;             ///< at the motor's shaft
  double motor_V = 0.0;               ///< at the terminals, at this winding temperature
  double power_in_W = 0.0;            ///< into the terminals
  std::vector<double> own_C = {};     ///< temperatures of the nodes that effects add, in the order of own_nodes
  std::vector<double> sensor_C = {};  ///< by the sensors for which the motor's file states a fault, as shown_at names their nodes
};

/// Heat that one effect brought into one node, as the mean over the run.
struct BookedHeat {
  std::string effect;
  std::string node;
  double mean_W = 0.0;
};

struct Trace {
  std::vector<TraceRow> rows;
  std::vector<std::string> own_nodes;
  std::vector<std::string> shown_at;
  std::vector<BookedHeat> balance;
  double stored_W = 0.0;  ///< mean rate at which the nodes took heat up
};

/// Rows stand at every change of the inputs and at most `every_s` apart.
Trace run_trace(const robot::Robot& robot, const duty::Duty& duty, const duty::WheelDemand& wheel, const motor::Motor& motor,
                double every_s);

/// The canonical log format: one header row, names end in units. Nodes of effects stand behind the ambient, then what sensors with
/// faults show.
std::string to_csv(const Trace& trace);

}  // namespace heatsoak::select
