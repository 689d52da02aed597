// Tracking, slip, energy and temperatures of a simulated script.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "simulate/drive_script.h"

namespace heatsoak::simulate {

/// Reasons for which the core can limit a wheel, in the order of DriveScore::limited_s.
inline constexpr std::array<robot_core::Reason, 5> kLimits{robot_core::Reason::voltage, robot_core::Reason::driver_current,
                                                           robot_core::Reason::battery_sag, robot_core::Reason::traction,
                                                           robot_core::Reason::guard};

struct DriveScore {
  double time_s = 0.0;
  double distance_m = 0.0;
  double slip_m = 0.0;            ///< ∫|slip|dt, mean of the wheels; includes creep under load
  double sliding_m = 0.0;         ///< part of slip_m above the creep speed, with more than 0.71 of the grip used
  double sliding_s = 0.0;         ///< time in which any wheel slips faster than the creep speed
  double tracking_rms_m = 0.0;    ///< RMS distance between plan and robot while the plan moves
  double tracking_most_m = 0.0;   ///< largest distance between plan and robot
  double arrivals_count = 0.0;    ///< number of commands whose plan moves and ends at rest
  double overshoot_mean_m = 0.0;  ///< mean of the arrivals: distance beyond the target after the plan has ended
  double overshoot_most_m = 0.0;
  double peak_current_A = 0.0;  ///< largest current of any motor
  double current_rms_A = 0.0;   ///< RMS current of the most loaded motor
  double short_s = 0.0;         ///< time in which a driver or the battery gave less than was commanded
  double lowest_battery_V = 0.0;
  double lifted_s = 0.0;         ///< time in which a wheel is off the ground
  double battery_empty_s = 0.0;  ///< time with an empty battery
  double winding_peak_C = 0.0;
  double stator_peak_C = 0.0;
  int hottest_wheel = 0;           ///< index of the hottest wheel, from 0
  double duel_copper_share = 0.0;  ///< share of the copper loss that occurs in duels
  // Actions of the drive core:
  double guard_limited_s = 0.0;                     ///< time in which the guard limits a wheel or, in shadow mode, would limit it
  double guard_missing_A_s = 0.0;                   ///< shadow mode: integral of the current that the guard would remove, all wheels
  std::optional<double> guard_winding_peak_C = {};  ///< peak of the guard's observer, all wheels; empty without guard
  double fault_s = 0.0;                             ///< time in which the core reports a fault of a wheel or of the robot
  std::array<double, kLimits.size()> limited_s{};   ///< time in which each of kLimits limits any wheel
  double lost_packets_share = 0.0;
  EnergyAccount energy;
};

/// Reason why a match counts as not driven, independent of the motor temperatures.
enum class DriveProblem {
  battery_empty,  ///< the battery is empty before the end of the match
  tips,           ///< wheels are off the ground for more than 1 % of the time
  off_plan        ///< the RMS tracking error exceeds the robot's size
};
/// Returns "battery empty", "tips", "off its plan".
std::string_view to_string(DriveProblem problem);

/// Returns the first problem of the match; nothing if it was driven.
std::optional<DriveProblem> drive_problem(const DriveScore& score);

/// Computes the score from all moments of a run.
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
  // Present command:
  const duty::ScheduledCommand* command_ = nullptr;
  double way_x_share_ = 0.0;  ///< unit vector of the plan's last motion
  double way_y_share_ = 0.0;
  double beyond_m_ = 0.0;
  bool came_from_afar_ = false;
  bool arrived_ = false;
};

}  // namespace heatsoak::simulate
