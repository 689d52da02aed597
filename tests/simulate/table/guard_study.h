// The hard match of the guard's study, and the drive of a robot through it.
#pragma once

#include <string>
#include <vector>

#include "base/unknown.h"
#include "drive_core_studies.h"
#include "simulate/guarded_core.h"
#include "simulate/match_run.h"

namespace heatsoak::simulate::studies {

/// An input of the hard match that differs from the files.
struct HardInput {
  std::string name;
  std::string usual;
  std::string hard;
  std::string remark;
};

struct HardMatch {
  robot::Robot robot;
  duty::MatchInputs inputs;
  double ambient_C = 0.0;
  std::vector<HardInput> changed;
};
/// Makes the hard match and lists every change. Inputs with a declared range are moved to their harder end. `share` scales all changes: 0
/// means files as they are, 1 the hard match.
HardMatch make_hard_match(const robot::Robot& robot, double share = 1.0);

/// Returns the motor's file after a bench test: its values with the tolerances that such a test leaves.
motor::Motor bench_tested(const motor::Motor& motor);
inline constexpr const char* kBenchTolerances =
    "both thermal resistances ±5 %, both time constants ±10 %, resistance and torque constant ±2 %, no-load current ±20 %";

/// One method of limiting the current.
struct Way {
  std::string name;
  const motor::Motor* motor = nullptr;  ///< the core knows the tolerances of this motor file
  const MotorGuard* guard = nullptr;    ///< null: no guard
  bool has_sensors = false;             ///< sensors of motor current and air temperature
  double cap_A = base::kUnknown;        ///< constant cap for every motor
};

/// Values of one second.
struct Second {
  double time_s = 0.0;
  double winding_C = 0.0;   ///< hottest winding of all wheels
  double observer_C = 0.0;  ///< hottest observer temperature of all wheels
  double allowed_A = 0.0;   ///< smallest allowed current of all wheels
  double distance_m = 0.0;  ///< distance since the start
  double off_plan_m = 0.0;  ///< largest distance between plan and robot
};

struct Hardship {
  DriveScore score;
  double off_plan_s = 0.0;  ///< time in which the robot is further from its plan than kOffPlan_m
  std::vector<Second> seconds;
};
inline constexpr double kOffPlan_m = 0.09;  ///< radius of a robot of the league

/// Drives the match; `motor` is the true motor.
Hardship drive_hard(const HardMatch& match, const Game& game, const Way& way, const motor::Motor& motor, std::uint64_t seed,
                    bool with_seconds);

/// Drives the match with a given configuration of the core; `has_sensors` has the meaning in Way.
Hardship drive_hard(const HardMatch& match, const Game& game, const robot_core::Config& core, bool has_sensors, const motor::Motor& motor,
                    std::uint64_t seed, bool with_seconds);

/// Draws motors of a file within its tolerances.
std::vector<motor::Motor> drawn_motors(const motor::Motor& motor, std::size_t count);

/// Draws 1000 motors within the tolerances, orders them by their rise per square of the torque in steady state, and returns the middle of
/// each of `count` equal groups. Few motors then represent the tolerances: the hottest of nine is at the 94th percentile.
std::vector<motor::Motor> representative_motors(const motor::Motor& motor, std::size_t count);

/// Finds the largest cap, to 0.05 A, that keeps the true winding within its limit in this match; it is known only in hindsight. The core
/// applies it through the voltage and the lowest resistance that the motor may have, so a warm motor gets less.
double largest_cap_A(const HardMatch& match, const Game& game, const motor::Motor& core_motor, const motor::Motor& motor,
                     std::uint64_t seed);

}  // namespace heatsoak::simulate::studies
