// Pose targets: predicts the pose and calls the planner once per period. A file of its own, so that firmware without a pose does not link
// the planner.
#include "robot_core/drive_core.h"

namespace robot_core {

void predict_pose(const Vector3& velocity, float age_s, Vector3& pose) {
  // With constant local velocity and yaw rate the robot follows an arc: the chord has the mean direction and sin(x)/x of the length.
  const float half_rad = 0.5F * velocity.yaw * age_s;
  const SineCosine mean = sine_cosine(pose.yaw + half_rad);
  const float chord_s = age_s * (1.0F - half_rad * half_rad * (1.0F / 6.0F));
  pose.x += chord_s * (velocity.x * mean.cosine_ratio - velocity.y * mean.sine_ratio);
  pose.y += chord_s * (velocity.x * mean.sine_ratio + velocity.y * mean.cosine_ratio);
  pose.yaw += 2.0F * half_rad;
}

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
