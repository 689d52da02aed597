// How well, and at what price, a script was driven.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "simulate/drive_script.h"

namespace heatsoak::simulate {

/// Limits of the core that a wheel can meet, in the order of DriveScore::limited_s.
inline constexpr std::array<robot_core::Reason, 5> kLimits{robot_core::Reason::voltage, robot_core::Reason::driver_current,
                                                           robot_core::Reason::battery_sag, robot_core::Reason::traction,
                                                           robot_core::Reason::guard};

struct DriveScore {
  double time_s = 0.0;
  double distance_m = 0.0;
  double slip_m = 0.0;            ///< ∫|slip|dt, mean of the wheels: creep under load and sliding
  double sliding_m = 0.0;         ///< the part of it beyond the creep, where more than 0.71 of the grip is used
  double sliding_s = 0.0;         ///< time in which any wheel does so
  double tracking_rms_m = 0.0;    ///< distance between plan and robot while the plan moves
  double tracking_most_m = 0.0;   ///< at any time
  double arrivals_count = 0.0;    ///< commands whose plan came to a stand
  double overshoot_mean_m = 0.0;  ///< over the arrivals: how far the robot goes on when the plan stands
  double overshoot_most_m = 0.0;
  double peak_current_A = 0.0;  ///< of any motor
  double current_rms_A = 0.0;   ///< of the motor with the most
  double short_s = 0.0;         ///< time in which a driver or the battery gave less than was commanded
  double lowest_battery_V = 0.0;
  double lifted_s = 0.0;         ///< time in which a wheel is off the ground
  double battery_empty_s = 0.0;  ///< time with nothing left in the battery: the robot stands
  double winding_peak_C = 0.0;
  double stator_peak_C = 0.0;
  int hottest_wheel = 0;  ///< from 0
  double duel_copper_share = 0.0;
  // What the drive core did about it.
  double guard_limited_s = 0.0;                    ///< time in which the guard limits a wheel or, in shadow mode, would have
  double guard_missing_A_s = 0.0;                  ///< in shadow mode: current over time that it would have taken away, all wheels
  double guard_winding_peak_C = 0.0;               ///< of the guard's observer, any wheel; 0 without guard
  double fault_s = 0.0;                            ///< time in which the core reports a fault of a wheel or of the robot
  std::array<double, kLimits.size()> limited_s{};  ///< time in which each of kLimits holds any wheel back
  double lost_packets_share = 0.0;
  EnergyAccount energy;
};

/// Why a match counts as not driven, whatever the motors' temperatures are.
enum class DriveProblem {
  battery_empty,  ///< before the end of the match
  tips,           ///< wheels are off the ground for more than 1 % of the time
  off_plan        ///< farther from its plan (rms) than the robot's own size
};
/// Returns "battery empty", "tips", "off its plan".
std::string_view to_string(DriveProblem problem);

/// Returns nothing if the match was driven.
std::optional<DriveProblem> drive_problem(const DriveScore& score);

/// Takes every moment of a run.
class DriveScorer {
 public:
  void take(const LoopMoment& moment);
  [[nodiscard]] DriveScore finish();

 private:
  void follow_command(const LoopMoment& moment);
  void follow_core(const LoopMoment& moment);
  void close_command();

  DriveScore score_;
  const SimulatedRobot* robot_ = nullptr;
  const CoreDrive* drive_ = nullptr;
  double error_squared_m2_s_ = 0.0;
  double planned_moving_s_ = 0.0;
  double duel_copper_J_ = 0.0;
  robot::PerWheel current_squared_A2_s_{};
  // The command that is being driven.
  const duty::ScheduledCommand* command_ = nullptr;
  double way_x_share_ = 0.0;  ///< direction of the plan's last motion
  double way_y_share_ = 0.0;
  double beyond_m_ = 0.0;
  bool came_from_afar_ = false;
  bool arrived_ = false;
};

}  // namespace heatsoak::simulate
