// A closed-loop match as rows: what stands in the CSV and in the picture.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "simulate/drive_script.h"

namespace heatsoak::simulate {

/// Motion, plan, phase and temperatures are those at time_s; the rest are means from there to the next row: currents
/// rms with the sign of their mean.
struct MatchRow {
  double time_s = 0.0;
  duty::Phase phase = duty::Phase::halt;
  bool duel = false;
  robot::Pose plan;
  robot::Pose pose;
  robot::BodyVelocity velocity;  ///< global frame
  robot::PerWheel winding_C{};
  robot::PerWheel winding_peak_C{};  ///< the highest from time_s to the next row, for pictures: a duel heats for less than a row
  robot::PerWheel stator_C{};
  std::vector<robot::PerWheel> bodies_C;  ///< as MatchAdditions::bodies
  robot::PerWheel winding_sensor_C{};     ///< by a sensor with the faults that are stated for it
  robot::PerWheel stator_sensor_C{};
  robot::PerWheel current_A{};
  robot::PerWheel motor_V{};
  robot::PerWheel speed_rad_per_s{};  ///< of the motors
  robot::PerWheel torque_Nm{};        ///< at the motors' shafts
  robot::PerWheel slip_m_per_s{};     ///< rim minus ground
  robot::PerWheel normal_N{};
  robot::PerWheel copper_W{};
  double battery_V = 0.0;
  double battery_A = 0.0;
  double battery_charge_A_s = 0.0;
  double tracking_error_m = 0.0;
  // Of the drive core, from time_s to the next row.
  robot_core::Reason robot_reason = robot_core::Reason::none;   ///< strongest fault of the robot
  std::array<robot_core::Reason, robot::kMostWheels> reason{};  ///< strongest of each wheel: faults before limits
  robot::PerWheel allowed_A{};                                  ///< least
  robot::PerWheel guard_winding_C{};                            ///< highest of the guard's observer; 0 without guard
};

/// What the motor's file adds to a trace.
struct MatchAdditions {
  std::vector<motor::SensorFault> winding;  ///< stated for the sensor there
  std::vector<motor::SensorFault> stator;
  std::vector<std::string> bodies;  ///< with a temperature, beside winding and stator; in the order of the network
};
MatchAdditions additions_of(const motor::Motor& motor);

/// Gives `row` a row every `every_s`, of a run that begins at time 0 with everything at ambient temperature.
class MatchRows {
 public:
  MatchRows(double every_s, double ambient_C, const MatchAdditions& added, std::function<void(const MatchRow&)> row);

  void take(const LoopMoment& moment);
  /// The last row, which may be shorter than the others.
  void finish();

 private:
  void take_core(const LoopMoment& moment);
  void start(double time_s, const SimulatedRobot& robot, const robot::Pose& plan, duty::Phase phase, bool duel);

  double every_s_;
  std::array<motor::Reading, robot::kMostWheels> winding_;
  std::array<motor::Reading, robot::kMostWheels> stator_;
  std::function<void(const MatchRow&)> row_;
  MatchRow open_;
  robot::PerWheel current_squared_A2_{};  ///< sums over the periods of the open row, as are its means
  int periods_ = 0;
  bool begun_ = false;
};

/// Reasons are the numbers of robot_core::Reason. What sensors show has a column where they have faults, as have bodies that the motor's
/// file adds.
std::string csv_header(int wheel_count, const MatchAdditions& added);
/// One line, with its end.
void append_csv(std::string& text, const MatchRow& row, int wheel_count, double ambient_C, const MatchAdditions& added);

}  // namespace heatsoak::simulate
