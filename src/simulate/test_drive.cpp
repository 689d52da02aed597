#include "simulate/test_drive.h"

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"
#include "robot_core/trajectory.h"

namespace heatsoak::simulate {
namespace {

/// Plan that accelerates to a constant velocity.
class StraightPlan final : public duty::Follower {
 public:
  explicit StraightPlan(const StraightDrive& drive) : x_share_(std::cos(drive.direction_rad)), y_share_(std::sin(drive.direction_rad)) {
    const auto limits =
        robot_core::AxisLimits<double>::symmetric(drive.speed_m_per_s * 1.001, drive.acceleration_m_per_s2, drive.jerk_m_per_s3);
    if (robot_core::plan_velocity<double>({}, {0.0, drive.speed_m_per_s, 0.0}, limits, way_) != robot_core::PlanResult::ok) {
      throw base::bad_input({}, "test drive", "has no trajectory; expected positive speed, acceleration and jerk");
    }
  }

  void take(const duty::MotionCommand& command) override { static_cast<void>(command); }
  void advance(double step_s) override { time_s_ += step_s; }
  [[nodiscard]] robot::Pose pose() const override {
    const double way_m = way_.at(time_s_).position;
    return {way_m * x_share_, way_m * y_share_, 0.0};
  }
  [[nodiscard]] robot::BodyVelocity velocity_global() const override {
    const double speed_m_per_s = way_.at(time_s_).velocity;
    return {speed_m_per_s * x_share_, speed_m_per_s * y_share_, 0.0};
  }
  [[nodiscard]] robot::BodyAcceleration acceleration_global() const override {
    const double acceleration_m_per_s2 = way_.at(time_s_).acceleration;
    return {acceleration_m_per_s2 * x_share_, acceleration_m_per_s2 * y_share_, 0.0};
  }
  [[nodiscard]] bool at_rest() const override { return false; }

 private:
  double x_share_;
  double y_share_;
  robot_core::Trajectory<double> way_;
  double time_s_ = 0.0;
};

DriveMoment moment_of(const LoopMoment& moment) {
  DriveMoment made;
  made.time_s = moment.time_s;
  made.plan = moment.plan->pose();
  made.pose = moment.robot->state().pose;
  made.planned = moment.plan->velocity_global();
  made.velocity = moment.robot->velocity_global();
  made.wheel_speed_rad_per_s = moment.robot->state().wheel_speed_rad_per_s;
  made.current_A = moment.out->current_A;
  made.terminal_V = moment.out->terminal_V;
  made.slip_m_per_s = moment.out->slip_m_per_s;
  std::copy_n(moment.drive->output().reason, robot::kMostWheels, made.reason.begin());
  return made;
}

void judge(DrivenLine& driven, double direction_rad) {
  const double x_share = std::cos(direction_rad);
  const double y_share = std::sin(direction_rad);
  const std::size_t steady = driven.moments.size() - driven.moments.size() / 4;
  double square_m2_per_s2 = 0.0;
  double along_m_per_s = 0.0;
  double across_m_per_s = 0.0;
  double planned_m_per_s = 0.0;
  for (std::size_t i = 0; i < driven.moments.size(); ++i) {
    const DriveMoment& each = driven.moments[i];
    const double x_m_per_s = each.velocity.x_m_per_s - each.planned.x_m_per_s;
    const double y_m_per_s = each.velocity.y_m_per_s - each.planned.y_m_per_s;
    square_m2_per_s2 += x_m_per_s * x_m_per_s + y_m_per_s * y_m_per_s;
    if (i >= steady) {
      along_m_per_s += each.velocity.x_m_per_s * x_share + each.velocity.y_m_per_s * y_share;
      across_m_per_s += each.velocity.y_m_per_s * x_share - each.velocity.x_m_per_s * y_share;
      planned_m_per_s += each.planned.x_m_per_s * x_share + each.planned.y_m_per_s * y_share;
    }
  }
  const auto steady_count = static_cast<double>(driven.moments.size() - steady);
  driven.speed_error_rms_m_per_s = std::sqrt(square_m2_per_s2 / static_cast<double>(driven.moments.size()));
  driven.steady_speed_error_m_per_s = (along_m_per_s - planned_m_per_s) / steady_count;
  driven.direction_error_rad = std::atan2(across_m_per_s, along_m_per_s);
  const DriveMoment& last = driven.moments.back();
  driven.distance_error_m = std::hypot(last.pose.x_m - last.plan.x_m, last.pose.y_m - last.plan.y_m);
  driven.yaw_error_rad = last.pose.yaw_rad - last.plan.yaw_rad;
}

}  // namespace

DrivenLine drive_straight(const robot::Robot& robot, const motor::Motor& motor, const robot_core::Config& core, const DriveOptions& options,
                          const StraightDrive& drive, double ambient_C) {
  SimulatedRobot simulated(robot, motor, ambient_C);
  CoreDrive core_drive(core, simulated, options);
  StraightPlan plan(drive);
  DrivenLine driven;
  driven.moments.reserve(static_cast<std::size_t>(std::llround(drive.duration_s / SimulatedRobot::kPeriod_s)));
  const std::array<duty::ScheduledCommand, 1> script{{{0.0, duty::Phase::running, {}}}};
  drive_script(simulated, core_drive, plan, script, drive.duration_s,
               [&](const LoopMoment& moment) { driven.moments.push_back(moment_of(moment)); });
  if (driven.moments.size() < 4) {
    throw base::bad_input({}, "test drive", "is shorter than four periods of the simulation");
  }
  judge(driven, drive.direction_rad);
  return driven;
}

DriveOptions without_position_feedback(DriveOptions options) {
  options.radio.position_gain_per_s = options.radio.heading_gain_per_s = 0.0;
  return options;
}

robot_core::Config with_friction_factor(robot_core::Config config, double factor) {
  const auto single = static_cast<float>(factor);
  for (robot_core::WheelConfig& wheel : config.wheel) {
    wheel.sine_V *= single;
    wheel.sign_V *= single;
  }
  config.rotation_friction_V *= single;
  robot_core::complete(config);
  return config;
}

robot::Robot with_dirty_wheel(const robot::Robot& robot, std::size_t wheel, double factor) {
  robot::Robot dirty = robot;
  if (dirty.friction.heading.wheels.empty() && !dirty.friction.heading.constant_Nm) {
    throw base::bad_input({robot.file.string()}, "friction.heading", "is missing: without it no wheel has a friction of its own");
  }
  if (dirty.friction.heading.wheels.empty()) {
    const robot::Kinematics kinematics = robot::make_kinematics(robot);
    for (std::size_t i = 0; i < robot.wheels.axis_rad.size(); ++i) {
      dirty.friction.heading.wheels.push_back({robot.friction.heading.constant_Nm.value(), robot.friction.heading.sine_Nm.value_or(0.0),
                                               robot::rolling_phase_rad(kinematics.wheels.at(i))});
    }
    dirty.friction.heading.constant_Nm.reset();
    dirty.friction.heading.sine_Nm.reset();
  }
  dirty.friction.heading.wheels.at(wheel).constant_Nm *= factor;
  return dirty;
}

}  // namespace heatsoak::simulate
