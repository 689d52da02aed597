#include "simulate/planner_study.h"

#include <algorithm>
#include <array>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "firmware/core_config.h"
#include "robot/assumed_friction.h"
#include "robot/inverse_dynamics.h"
#include "simulate/drive_score.h"
#include "simulate/match_run.h"

namespace heatsoak::simulate {
namespace {

constexpr std::array<double, 3> kDistances_m{0.5, 1.0, 2.0};
constexpr int kDirections = 8;
constexpr double kAmbient_C = 25.0;
/// Simulated time after the end of the plan, for settling.
constexpr double kAfterwards_s = 1.0;
constexpr std::size_t kDrives = kDistances_m.size() * kDirections;

double planned_s(const robot::Robot& robot, duty::Planner planner, const duty::MotionCommand& command) {
  const std::unique_ptr<duty::Follower> plan = duty::ideal_tracking(robot, 1.0, planner);
  plan->take(command);
  double time_s = 0.0;
  for (; !plan->at_rest(); time_s += SimulatedRobot::kPeriod_s) {
    plan->advance(SimulatedRobot::kPeriod_s);
  }
  return time_s;
}

StudyResult drive_once(const robot::Robot& robot, const motor::Motor& motor, const robot_core::Config& core, const DriveOptions& options,
                       duty::Planner planner, const duty::MotionCommand& command) {
  SimulatedRobot simulated(robot, motor, kAmbient_C);
  CoreDrive drive(core, simulated, options);
  const std::unique_ptr<duty::Follower> plan = duty::ideal_tracking(robot, 1.0, planner);
  StudyResult result;
  result.planned_s = planned_s(robot, planner, command);
  const std::array<duty::ScheduledCommand, 1> script{{{0.0, duty::Phase::running, command}}};
  DriveScorer scorer;
  drive_script(simulated, drive, *plan, script, result.planned_s + kAfterwards_s, [&](const LoopMoment& moment) {
    scorer.take(moment);
    const robot::Pose& pose = simulated.state().pose;
    if (std::hypot(pose.x_m - command.x_m, pose.y_m - command.y_m) > kSettled_m) {
      result.settled_s = moment.time_s;
    }
  });
  const DriveScore score = scorer.finish();
  result.slip_share = score.slip_m / score.distance_m;
  result.sliding_share = score.sliding_m / score.distance_m;
  result.tracking_rms_m = score.tracking_rms_m;
  result.overshoot_mean_m = score.overshoot_mean_m;
  result.peak_current_A = score.peak_current_A;
  result.copper_J = score.energy.copper_J;
  return result;
}

StudyResult one_case(const robot::Robot& robot, const motor::Motor& motor, const StudyCase& limits, const DriveOptions& options) {
  const bool bang_bang = std::isinf(limits.jerk_m_per_s3);
  robot::Robot limited = robot;
  limited.wheels.slip_factor.clear();  // simulated wheels slip by the law of [traction]
  limited.limits.acceleration_m_per_s2 = limits.acceleration_m_per_s2;
  limited.limits.braking_m_per_s2 = limits.acceleration_m_per_s2;
  limited.limits.jerk_m_per_s3 = bang_bang ? robot.limits.jerk_m_per_s3 : limits.jerk_m_per_s3;
  const robot_core::Config core = firmware::make_core_config(limited, motor.nominal, {});
  StudyResult sum;
  for (const double distance_m : kDistances_m) {
    for (int direction = 0; direction < kDirections; ++direction) {
      const double heading_rad = 2.0 * std::numbers::pi * direction / kDirections;
      duty::MotionCommand command;
      command.x_m = distance_m * std::cos(heading_rad);
      command.y_m = distance_m * std::sin(heading_rad);
      const StudyResult each =
          drive_once(limited, motor, core, options, bang_bang ? duty::Planner::bang_bang : duty::Planner::jerk_limited, command);
      for (double StudyResult::*const mean :
           {&StudyResult::planned_s, &StudyResult::settled_s, &StudyResult::slip_share, &StudyResult::sliding_share,
            &StudyResult::tracking_rms_m, &StudyResult::overshoot_mean_m, &StudyResult::copper_J}) {
        sum.*mean += each.*mean / static_cast<double>(kDrives);
      }
      sum.peak_current_A = std::max(sum.peak_current_A, each.peak_current_A);
    }
  }
  sum.limits = limits;
  return sum;
}

}  // namespace

std::vector<StudyResult> study_planners(const robot::Robot& robot, const motor::Motor& motor, std::span<const StudyCase> cases,
                                        const DriveOptions& drive, int threads, const base::Progress& progress) {
  std::vector<StudyResult> results(cases.size());
  base::in_parallel(cases.size(), threads, 0, cases.size(), progress,
                    [&](std::size_t i) { results[i] = one_case(robot, motor, cases[i], drive); });
  return results;
}

double grip_m_per_s2(const robot::Robot& robot) {
  motor::MotorValues no_rotor;
  no_rotor.rotor_inertia_kg_m2 = 0.0;
  const robot::BodyConfig body = robot::make_body(robot, no_rotor);
  const auto use_beyond_ratio = [&](double acceleration_m_per_s2) {
    constexpr int kHeadings = 72;
    double use_ratio = 0.0;
    for (int heading = 0; heading < kHeadings; ++heading) {
      const double heading_rad = 2.0 * std::numbers::pi * heading / kHeadings;
      robot::BodyMotion motion;
      motion.acceleration = {acceleration_m_per_s2 * std::cos(heading_rad), acceleration_m_per_s2 * std::sin(heading_rad), 0.0};
      use_ratio = std::max(use_ratio, std::ranges::max(robot::inverse_dynamics(body, motion).traction_use_ratio));
    }
    return use_ratio - 1.0;
  };
  const auto [low, high] =
      boost::math::tools::bisect(use_beyond_ratio, 0.0, robot.traction.coefficient_ratio.value() * robot::kGravity_m_per_s2 * 2.0,
                                 boost::math::tools::eps_tolerance<double>(20));
  return 0.5 * (low + high);
}

std::vector<StudyCase> jerk_sweep(const robot::Robot& robot) {
  constexpr int kJerks = 12;
  constexpr double kLeast_m_per_s3 = 3.0;
  constexpr double kMost_m_per_s3 = 60.0;
  constexpr double kAlike = 0.05;
  const double sliding_m_per_s2 = grip_m_per_s2(robot);
  constexpr std::array<std::string_view, 1> kTables{"limits"};
  robot::require_parameters(robot, kTables);
  const double own_m_per_s2 = std::min(robot.limits.acceleration_m_per_s2.value(), robot.limits.braking_m_per_s2.value());
  std::vector<StudyCase> cases;
  for (const double acceleration_m_per_s2 : {own_m_per_s2, sliding_m_per_s2, 1.5 * sliding_m_per_s2}) {
    // A robot that already uses all of its grip has one acceleration less.
    if (!cases.empty() && std::abs(acceleration_m_per_s2 / own_m_per_s2 - 1.0) < kAlike) {
      continue;
    }
    for (int i = 0; i < kJerks; ++i) {
      cases.push_back({acceleration_m_per_s2, kLeast_m_per_s3 * std::pow(kMost_m_per_s3 / kLeast_m_per_s3, i / (kJerks - 1.0))});
    }
    cases.push_back({acceleration_m_per_s2, std::numeric_limits<double>::infinity()});
  }
  return cases;
}

JerkSweep sweep_jerk(const robot::Robot& robot, const motor::Motor& motor, bool is_sensing_ideal, std::uint64_t seed,
                     const base::Progress& progress) {
  require_rotor_inertia(motor);
  JerkSweep sweep{robot::with_assumed_friction(robot), motor, {}};
  const DriveOptions drive = is_sensing_ideal ? ideal_drive() : real_drive(sweep.robot, seed);
  sweep.results = study_planners(sweep.robot, motor, jerk_sweep(sweep.robot), drive, 0, progress);
  return sweep;
}

}  // namespace heatsoak::simulate
