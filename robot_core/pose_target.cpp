// Pose targets: calls the planner once per period. A file of its own, so that firmware without a pose does not link the planner.
#include "robot_core/drive_core.h"

namespace robot_core {

bool plan_to_pose(const Config& config, const Vector3& pose, const Vector3& target, Vector3& velocity, Vector3& acceleration) {
  constexpr float kPi = 3.14159265F;
  constexpr float kTurn = 2.0F * kPi;
  // Take the shorter direction of rotation.
  const float apart_rad = target.yaw - pose.yaw;
  const float turns = apart_rad / kTurn + (apart_rad < 0.0F ? -0.5F : 0.5F);
  if (!(absolute(turns) < 1e6F)) {
    return false;
  }
  const float nearest_yaw_rad = target.yaw - kTurn * static_cast<float>(static_cast<int>(turns));
  const AxisState<float> from[3] = {
      {pose.x, velocity.x, acceleration.x}, {pose.y, velocity.y, acceleration.y}, {pose.yaw, velocity.yaw, acceleration.yaw}};
  const AxisState<float> to[3] = {{target.x, 0.0F, 0.0F}, {target.y, 0.0F, 0.0F}, {nearest_yaw_rad, 0.0F, 0.0F}};
  const PlaneLimits<float> plane{config.speed_limit_m_per_s, config.acceleration_limit_m_per_s2, config.jerk_limit_m_per_s3};
  // Yaw and plane motion reach their acceleration limits in the same time.
  const float yaw_jerk = config.yaw_acceleration_limit_rad_per_s2 * config.jerk_limit_m_per_s3 / config.acceleration_limit_m_per_s2;
  const auto yaw = AxisLimits<float>::symmetric(config.yaw_rate_limit_rad_per_s, config.yaw_acceleration_limit_rad_per_s2, yaw_jerk);
  Trajectory<float> plan[3];
  if (plan_plane(from, to, plane, yaw, plan) != PlanResult::ok) {
    return false;
  }
  const AxisState<float> x = plan[0].at(config.period_s);
  const AxisState<float> y = plan[1].at(config.period_s);
  const AxisState<float> turn = plan[2].at(config.period_s);
  velocity = {x.velocity, y.velocity, turn.velocity};
  acceleration = {x.acceleration, y.acceleration, turn.acceleration};
  return true;
}

}  // namespace robot_core
