#include "duty/match/generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string_view>
#include <utility>

#include "robot_core/trajectory.h"

namespace heatsoak::duty {
namespace {

/// Grid of load points: 2 % of the nominal torque of a 50 W motor, and 0.1 m/s at the rim. Finer steps do not change a verdict.
constexpr DemandGatherer::Grid kGrid{.torque_step_Nm = 0.002, .speed_step_rad_per_s = 3.0};

using robot_core::AxisLimits;
using robot_core::AxisState;
using robot_core::PlaneLimits;
using robot_core::PlanResult;
using robot_core::Trajectory;

std::string_view in_words(PlanResult result) {
  switch (result) {
    case PlanResult::ok:
      return "no error";
    case PlanResult::not_finite:
      return "a state, target or limit is not finite";
    case PlanResult::limit_without_room:
      return "a limit allows no motion";
    case PlanResult::target_velocity_beyond_limit:
      return "the target moves faster than the limits allow";
    case PlanResult::target_acceleration_beyond_limit:
      return "the target accelerates harder than the limits allow";
    case PlanResult::target_without_approach:
      return "the target cannot be approached within the limits";
    case PlanResult::out_of_range:
      return "limits and distances are too many orders of magnitude apart";
    case PlanResult::not_that_many_axes:
      return "no axis, or more axes than the planner supports";
  }
  return "the planner gives no reason";
}

double least(double a, double b) { return std::isfinite(b) ? std::min(a, b) : a; }

/// Follows the planner's trajectory exactly.
class IdealTracking final : public Follower {
 public:
  IdealTracking(const robot::Robot& robot, double aggressiveness, Planner planner) : planner_(planner) {
    const robot::RobotLimits& limits = robot.limits;
    const double acceleration_m_per_s2 = limits.acceleration_m_per_s2.value_or(0.0);
    plane_ = {limits.speed_m_per_s.value_or(0.0) * aggressiveness,
              std::min(acceleration_m_per_s2, limits.braking_m_per_s2.value_or(acceleration_m_per_s2)) * aggressiveness,
              limits.jerk_m_per_s3.value_or(0.0) * aggressiveness};
    // No team publishes a yaw jerk. The assumed one reaches full angular acceleration in 0.1 s.
    yaw_ = AxisLimits<double>::symmetric(limits.yaw_rate_rad_per_s.value_or(0.0) * aggressiveness,
                                         limits.yaw_acceleration_rad_per_s2.value_or(0.0) * aggressiveness,
                                         10.0 * limits.yaw_acceleration_rad_per_s2.value_or(0.0) * aggressiveness);
    for (const double limit : {plane_.speed_max, plane_.acceleration_max, plane_.jerk_max, yaw_.velocity_max, yaw_.jerk_max}) {
      if (!(limit > 0.0)) {
        throw base::bad_input({robot.file.string()}, "limits",
                              "a match needs speed, acceleration, braking, jerk, yaw_rate and yaw_acceleration");
      }
    }
  }

  void take(const MotionCommand& command) override {
    const AxisState<double> target[3] = {{command.x_m, 0.0, 0.0}, {command.y_m, 0.0, 0.0}, {command.yaw_rad, 0.0, 0.0}};
    PlaneLimits<double> plane = plane_;
    plane.speed_max = least(plane.speed_max, std::max(0.05, command.speed_limit_m_per_s));
    constexpr AxisState<double> stand[3]{};
    const PlanResult result = command.stand ? robot_core::plan_plane_velocity(state_, stand, plane_, yaw_, trajectories_)
                              : planner_ == Planner::jerk_limited
                                  ? robot_core::plan_plane(state_, target, plane, yaw_, trajectories_)
                                  : robot_core::plan_plane_bang_bang(state_, target, plane, yaw_, trajectories_);
    if (result != PlanResult::ok) {
      throw base::Failure(base::ExitCode::numerics_failed,
                          fmt::format("no trajectory to ({:.3f}, {:.3f}) m: {}; look at [limits] of the robot", command.x_m, command.y_m,
                                      in_words(result)));
    }
    time_s_ = 0.0;
  }

  void advance(double step_s) override {
    time_s_ += step_s;
    for (int axis = 0; axis < 3; ++axis) {
      state_[axis] = trajectories_[axis].at(time_s_);
    }
  }

  [[nodiscard]] robot::Pose pose() const override { return {state_[0].position, state_[1].position, state_[2].position}; }
  [[nodiscard]] robot::BodyVelocity velocity_global() const override {
    return {state_[0].velocity, state_[1].velocity, state_[2].velocity};
  }
  [[nodiscard]] robot::BodyAcceleration acceleration_global() const override {
    return {state_[0].acceleration, state_[1].acceleration, state_[2].acceleration};
  }
  [[nodiscard]] bool at_rest() const override {
    return std::ranges::all_of(trajectories_, [&](const Trajectory<double>& each) { return time_s_ >= each.duration_s; });
  }

 private:
  Planner planner_;
  PlaneLimits<double> plane_;
  AxisLimits<double> yaw_;
  AxisState<double> state_[3]{};
  Trajectory<double> trajectories_[3];
  double time_s_ = 0.0;
};

enum class Keep { every_wheel, hardest_wheel };

/// Returns the robot. Throws Failure (bad_input) that lists all values which a match needs and the robot lacks.
const robot::Robot& complete(const robot::Robot& robot) {
  constexpr std::array<std::string_view, 5> kTables{"body", "wheels", "friction", "traction", "limits"};
  robot::require_parameters(robot, kTables);
  return robot;
}

class Match {
 public:
  Match(const MatchInputs& inputs, const MatchValues& values, const robot::Robot& robot, std::uint64_t seed, Planner planner, double bin_s,
        const MatchObserver& observer, double step_s, Keep keep)
      : step_s_(step_s),
        bin_s_(bin_s),
        keep_(keep),
        random_(seed, 0),
        game_(generate_game(inputs.division, inputs.overtime, values, random_)),
        behaviour_(inputs, values, random_),
        body_(robot::make_body(complete(robot), without_rotor())),
        motion_(ideal_tracking(robot, values.aggressiveness, planner)),
        observer_(observer),
        steps_(steps_of_thread()) {
    steps_.clear();
    for (int wheel = 0; keep_ == Keep::every_wheel && wheel < body_.kinematics.wheel_count; ++wheel) {
      gatherers_.push_back(gatherer(wheel));
    }
  }

  MatchLoad play() {
    for (const MatchPhase& span : game_) {
      load_.play_s += rule_of(span.phase).clock_runs ? span.duration_s : 0.0;
      double into_s = 0.0;
      while (span.duration_s - into_s > 0.5 * step_s_) {
        const robot::Pose now = motion_->pose();
        const MotionCommand command = behaviour_.next(span.phase, into_s, span.duration_s - into_s, {now.x_m, now.y_m, now.yaw_rad});
        into_s += follow(span.phase, command, span.duration_s - into_s);
      }
    }
    double slip_s = 0.0;
    for (const PhaseLoad& phase : load_.phases) {
      slip_s += phase.slip_s;
    }
    if (keep_ == Keep::hardest_wheel) {
      gather_hardest();
    }
    for (DemandGatherer& each : gatherers_) {
      load_.wheels.push_back(each.finish());
      load_.wheels.back().slip_share = slip_s / load_.duration_s;
    }
    return std::move(load_);
  }

 private:
  static motor::MotorValues without_rotor() {
    motor::MotorValues motor;
    motor.rotor_inertia_kg_m2 = 0.0;
    return motor;
  }

  [[nodiscard]] DemandGatherer gatherer(int wheel) const { return {fmt::format("wheel {}", wheel + 1), bin_s_, kGrid}; }

  void gather_hardest() {
    robot::PerWheel work_Nm2_s{};
    for (const PhaseLoad& phase : load_.phases) {
      std::ranges::transform(work_Nm2_s, phase.torque_squared_Nm2_s, work_Nm2_s.begin(), std::plus());
    }
    const auto hardest = static_cast<std::size_t>(std::ranges::max_element(work_Nm2_s) - work_Nm2_s.begin());
    DemandGatherer& one = gatherers_.emplace_back(gatherer(static_cast<int>(hardest)));
    for (const Step& each : steps_) {
      one.add(each.duration_s, each.torque_Nm[hardest], each.speed_rad_per_s[hardest]);
    }
  }

  /// Executes a command in steps, or in one step while nothing moves. A duel starts when the robot stands and lasts at most the rest
  /// `left_s` of the phase. Returns the duration.
  double follow(Phase phase, const MotionCommand& command, double left_s) {
    motion_->take(command);
    load_.script.push_back({load_.duration_s, phase, command});
    double done_s = 0.0;
    double length_s = std::max(command.duration_s, step_s_);
    if (command.duel) {
      length_s = std::max(left_s, step_s_);
      while (!motion_->at_rest() && length_s - done_s > 0.5 * step_s_) {
        motion_->advance(step_s_);
        moment(phase, command, step_s_, false);
        done_s += step_s_;
      }
      length_s = std::min(length_s, done_s + command.duration_s);
    }
    while (length_s - done_s > 0.5 * step_s_) {
      const bool still = motion_->at_rest();
      const double step_s = still ? length_s - done_s : step_s_;
      motion_->advance(step_s);
      moment(phase, command, step_s, command.duel && still);
      done_s += step_s;
    }
    return done_s;
  }

  void moment(Phase phase, const MotionCommand& command, double step_s, bool pushes) {
    const robot::Pose pose = motion_->pose();
    const robot::BodyVelocity velocity = motion_->velocity_global();
    if (pose.yaw_rad != axis_yaw_rad_) {
      axis_yaw_rad_ = pose.yaw_rad;
      axis_ = robot::field_axis(axis_yaw_rad_);
    }
    robot::BodyMotion motion = robot::local_motion(body_, axis_, velocity, motion_->acceleration_global());
    if (pushes) {
      const double direction_rad = command.push_direction_rad - pose.yaw_rad;
      const double force_N = command.push_share * robot::largest_push_N(body_, direction_rad, motion.external_height_m);
      motion.external = {-force_N * std::cos(direction_rad), -force_N * std::sin(direction_rad), 0.0};
    }
    // At constant velocity the wheel demands do not change, so they are reused.
    if (!(motion == motion_of_wheels_)) {
      motion_of_wheels_ = motion;
      wheels_ = robot::inverse_dynamics(body_, motion);
    }
    const robot::WheelDemands& wheels = wheels_;
    PhaseLoad& phase_load = load_.phases.at(static_cast<std::size_t>(phase));
    phase_load.time_s += step_s;
    phase_load.duel_s += pushes ? step_s : 0.0;
    phase_load.slip_s += wheels.transmitted_share < 1.0 ? step_s : 0.0;
    if (keep_ == Keep::hardest_wheel) {
      steps_.push_back({step_s, wheels.torque_Nm, wheels.speed_rad_per_s});
    }
    for (std::size_t i = 0; i < gatherers_.size(); ++i) {
      gatherers_[i].add(step_s, wheels.torque_Nm[i], wheels.speed_rad_per_s[i]);
    }
    for (int i = 0; i < body_.kinematics.wheel_count; ++i) {
      const double squared_Nm2_s = wheels.torque_Nm[i] * wheels.torque_Nm[i] * step_s;
      phase_load.torque_squared_Nm2_s[i] += squared_Nm2_s;
      phase_load.duel_torque_squared_Nm2_s += pushes ? squared_Nm2_s : 0.0;
    }
    load_.duration_s += step_s;
    load_.distance_m += std::sqrt(velocity.x_m_per_s * velocity.x_m_per_s + velocity.y_m_per_s * velocity.y_m_per_s) * step_s;
    if (observer_) {
      observer_({load_.duration_s, step_s, phase, pushes, pose, velocity, &wheels});
    }
  }

  /// Loads are kept until the most loaded wheel is known, because merging them into bins and points takes a third of a game's computing
  /// time.
  struct Step {
    double duration_s = 0.0;
    robot::PerWheel torque_Nm{};
    robot::PerWheel speed_rad_per_s{};
  };

  /// The memory is reused, because allocating it for every game would take as long as the robot's dynamics.
  static std::vector<Step>& steps_of_thread() {
    thread_local std::vector<Step> steps;
    return steps;
  }

  double step_s_;
  double bin_s_;
  Keep keep_;
  base::Random random_;
  std::vector<MatchPhase> game_;
  Behaviour behaviour_;
  robot::BodyConfig body_;
  std::unique_ptr<Follower> motion_;
  const MatchObserver& observer_;
  std::vector<DemandGatherer> gatherers_;
  std::vector<Step>& steps_;
  MatchLoad load_;
  robot::BodyMotion motion_of_wheels_;
  robot::WheelDemands wheels_ = robot::inverse_dynamics(body_, motion_of_wheels_);
  double axis_yaw_rad_ = 0.0;
  robot::FieldAxis axis_ = robot::field_axis(0.0);
};

}  // namespace

std::unique_ptr<Follower> ideal_tracking(const robot::Robot& robot, double aggressiveness, Planner planner) {
  return std::make_unique<IdealTracking>(robot, aggressiveness, planner);
}

MatchLoad play_match(const MatchInputs& inputs, const MatchValues& values, const robot::Robot& robot, std::uint64_t seed, Planner planner,
                     double bin_s, const MatchObserver& observer, double step_s) {
  return Match(inputs, values, robot, seed, planner, bin_s, observer, step_s, Keep::every_wheel).play();
}

WheelDemand hardest_wheel_of_match(const MatchInputs& inputs, const MatchValues& values, const robot::Robot& robot, std::uint64_t seed,
                                   Planner planner, double bin_s, double step_s) {
  const MatchObserver nobody;
  return std::move(Match(inputs, values, robot, seed, planner, bin_s, nobody, step_s, Keep::hardest_wheel).play().wheels.front());
}

std::string_view to_string(Planner planner) { return planner == Planner::bang_bang ? "bang_bang" : "jerk_limited"; }

}  // namespace heatsoak::duty
