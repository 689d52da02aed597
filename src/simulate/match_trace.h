// Rows of a closed-loop match for CSV and chart.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "simulate/drive_script.h"

namespace heatsoak::simulate {

/// One row. Motion, plan, phase and temperatures are values at time_s. The others are means until the next row; currents are RMS values
/// with the sign of their mean.
struct MatchRow {
  double time_s = 0.0;
  duty::Phase phase = duty::Phase::halt;
  bool duel = false;
  robot::Pose plan;
  robot::Pose pose;
  robot::BodyVelocity velocity;  ///< global frame
  robot::PerWheel winding_C{};
  robot::PerWheel winding_peak_C{};  ///< peak until the next row, for charts: a duel may be shorter than a row
  robot::PerWheel stator_C{};
  std::vector<robot::PerWheel> bodies_C;  ///< in the order of MatchAdditions::bodies
  robot::PerWheel winding_sensor_C{};     ///< reading of a sensor with the stated faults
  robot::PerWheel stator_sensor_C{};
  robot::PerWheel current_A{};
  robot::PerWheel motor_V{};
  robot::PerWheel speed_rad_per_s{};  ///< motor speeds
  robot::PerWheel torque_Nm{};        ///< torques at the motor shafts
  robot::PerWheel slip_m_per_s{};     ///< speed of the rim minus speed of the ground contact
  robot::PerWheel normal_N{};
  robot::PerWheel copper_W{};
  double battery_V = 0.0;
  double battery_A = 0.0;
  double battery_charge_A_s = 0.0;
  double tracking_error_m = 0.0;
  // Values of the drive core until the next row:
  robot_core::Reason robot_reason = robot_core::Reason::none;   ///< strongest fault of the robot
  std::array<robot_core::Reason, robot::kMostWheels> reason{};  ///< strongest reason of each wheel; faults are stronger than limits
  robot::PerWheel allowed_A{};                                  ///< smallest allowed current
  std::optional<robot::PerWheel> guard_winding_C;               ///< highest temperatures of the guard's observer, if there is a guard
};

/// Additional columns of a trace that the motor file requires.
struct MatchAdditions {
  std::vector<motor::SensorFault> winding;  ///< stated faults of the winding sensor
  std::vector<motor::SensorFault> stator;   ///< stated faults of the stator sensor
  std::vector<std::string> bodies;          ///< nodes besides winding and stator, in the order of the network
};
MatchAdditions additions_of(const motor::Motor& motor);

/// Calls `row` every `every_s` of a run that starts at time 0 with all temperatures at ambient.
class MatchRows {
 public:
  MatchRows(double every_s, double ambient_C, const MatchAdditions& added, std::function<void(const MatchRow&)> row);

  void take(const LoopMoment& moment);
  /// Writes the last row, which may be shorter than the others.
  void finish();

 private:
  void take_core(const LoopMoment& moment);
  void start(double time_s, const SimulatedRobot& robot, const robot::Pose& plan, duty::Phase phase, bool duel);

  double every_s_;
  std::array<motor::Reading, robot::kMostWheels> winding_;
  std::array<motor::Reading, robot::kMostWheels> stator_;
  std::function<void(const MatchRow&)> row_;
  MatchRow open_;
  robot::PerWheel current_squared_A2_{};  ///< sums over the periods of the open row; open_ holds sums, too
  int periods_ = 0;                       ///< in the open row
  bool begun_ = false;
};

/// Returns the header row with line break. Reasons are numbers of robot_core::Reason. Without a guard its column is empty. Sensors with
/// stated faults and additional bodies of the motor file have columns.
std::string csv_header(int wheel_count, const MatchAdditions& added);
/// Appends one row with line break.
void append_csv(std::string& text, const MatchRow& row, int wheel_count, double ambient_C, const MatchAdditions& added);

}  // namespace heatsoak::simulate
