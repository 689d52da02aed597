// The hard match of the guard's study, and how a robot is driven through it.
#pragma once

#include <string>
#include <vector>

#include "drive_core_studies.h"
#include "simulate/guarded_core.h"
#include "simulate/match_run.h"

namespace heatsoak::studies {

/// An input of the hard match that differs from the files.
struct HardInput {
  std::string name;
  std::string usual;
  std::string hard;
  std::string remark;
};

struct HardMatch {
  Robot robot;
  MatchInputs inputs;
  double ambient_C = 0.0;
  std::vector<HardInput> changed;
};
/// Every change is listed. Those within the ranges that the files declare take the harder end. `share`: of every change; 0: files as they
/// are, 1: the hard match.
HardMatch make_hard_match(const Robot& robot, double share = 1.0);

/// The motor's file after a bench test: its values with the tolerances that such a test leaves.
Motor bench_tested(const Motor& motor);
inline constexpr const char* kBenchTolerances =
    "both thermal resistances ±5 %, both time constants ±10 %, resistance and torque constant ±2 %, no-load current ±20 %";

/// How the current is limited.
struct Way {
  std::string name;
  const Motor* motor = nullptr;       ///< whose tolerances the core knows
  const MotorGuard* guard = nullptr;  ///< none: without
  bool has_sensors = false;           ///< of motor current and air temperature
  double cap_A = kAbsent;             ///< of every motor, always
};

/// Of one second.
struct Second {
  double time_s = 0.0;
  double winding_C = 0.0;   ///< hottest, any wheel
  double observer_C = 0.0;  ///< hottest of the guard's observer, any wheel
  double allowed_A = 0.0;   ///< least, any wheel
  double distance_m = 0.0;  ///< so far
  double off_plan_m = 0.0;  ///< largest distance between plan and robot
};

struct Hardship {
  DriveScore score;
  double off_plan_s = 0.0;  ///< time in which the robot is further from its plan than kOffPlan_m
  std::vector<Second> seconds;
};
inline constexpr double kOffPlan_m = 0.09;  ///< radius of a robot of the league

/// `motor` is the true one.
Hardship drive_hard(const HardMatch& match, const Game& game, const Way& way, const Motor& motor, std::uint64_t seed, bool with_seconds);

/// The same with a configuration of the core that is ready; `has_sensors` is Way's.
Hardship drive_hard(const HardMatch& match, const Game& game, const robot_core::Config& core, bool has_sensors, const Motor& motor,
                    std::uint64_t seed, bool with_seconds);

/// The motors of a file, drawn within its tolerances.
std::vector<Motor> drawn_motors(const Motor& motor, std::size_t count);

/// Largest cap with which the true winding stays within its limit in this match, to 0.05 A: known only afterwards. The core holds it by
/// the voltage and the lowest resistance that the motor may have, so that a warm motor gets less.
double largest_cap_A(const HardMatch& match, const Game& game, const Motor& core_motor, const Motor& motor, std::uint64_t seed);

}  // namespace heatsoak::studies
