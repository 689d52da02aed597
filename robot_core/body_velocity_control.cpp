// Stage 2: converts the command into the motion that the body should have now.
#include "robot_core/drive_stages.h"

// For size: it runs in every second step, and its part for pose targets seldom.
#pragma GCC optimize("Os")

namespace robot_core {
namespace {

constexpr float kStanding_m_per_s = 0.03F;
// A command that jumps is approached with this multiple of the acceleration limit: more than a planned motion needs.
constexpr float kApproach_ratio = 2.0F;
constexpr float kMostYawIntegral_rad = 0.5F;
// Speed at which the reference follows a robot that its limits hold back, and lead of the reference over the robot.
constexpr float kHoldBack_s = 0.1F;
constexpr float kLead_share = 0.2F;
constexpr float kRecovery_s = 0.3F;
constexpr float kRelease_s = 0.2F;
// Smoothing time of the force that accelerates the body.
constexpr float kForce_s = 0.01F;

Vector3 turned(const Vector3& v, const SineCosine& turn) {
  return {v.x * turn.cosine_ratio - v.y * turn.sine_ratio, v.x * turn.sine_ratio + v.y * turn.cosine_ratio, v.yaw};
}

float length(const Vector3& v) { return square_root(v.x * v.x + v.y * v.y); }

Vector3 scaled(const Vector3& v, float plane, float yaw) { return {v.x * plane, v.y * plane, v.yaw * yaw}; }

/// Limits the length of the plane part and the magnitude of the yaw part, keeping their directions. Returns true if it changed `v`.
[[gnu::always_inline]] inline bool limit(Vector3& v, float most_plane, float most_yaw) {
  const float square = v.x * v.x + v.y * v.y;
  const bool is_long = square > most_plane * most_plane;
  if (is_long) {
    const float share = most_plane / square_root(square);
    v.x *= share;
    v.y *= share;
  }
  const bool is_fast = absolute(v.yaw) > most_yaw;
  if (is_fast) {
    v.yaw = v.yaw > 0.0F ? most_yaw : -most_yaw;
  }
  return is_long || is_fast;
}

/// Reference of the command for the present time: extrapolated by its acceleration and turned into the robot's present heading.
BodyReference follow_command(const Config& config, State& state, const Input& input, const Validated& validated) {
  if (validated.mode == Mode::body_velocity) {
    const Command& command = input.command;
    const float age_s = input.command_age_s;
    const Vector3 continued{command.velocity.x + command.acceleration.x * age_s, command.velocity.y + command.acceleration.y * age_s,
                            command.velocity.yaw + command.acceleration.yaw * age_s};
    const SineCosine turn = sine_cosine(-validated.velocity.yaw * age_s);
    BodyReference body{turned(continued, turn), turned(command.acceleration, turn), {}};
    body.push = turned(command.push, turn);
    return body;
  }
  if (validated.mode == Mode::pose_target) {
    Vector3 pose = input.pose;
    config.predict_pose(validated.velocity, input.pose_age_s, pose);
    if (config.plan_step(config, pose, input.command.pose, state.plan_velocity, state.plan_acceleration)) {
      const SineCosine turn = sine_cosine(-pose.yaw);
      return {turned(state.plan_velocity, turn), turned(state.plan_acceleration, turn), {}};
    }
    state.plan_velocity = state.plan_acceleration = {};
  }
  return {};
}

/// If limits hold the robot back, the velocity reference stays a little ahead of the robot in the commanded direction. The errors of the
/// wheels then keep the ratios of that direction.
void hold_back(State& state, const Vector3& wanted, const Validated& validated, float since_s) {
  if (state.is_limited == 0 && state.speed_share >= 1.0F) {
    return;
  }
  const float square = wanted.x * wanted.x + wanted.y * wanted.y + 1e-6F;
  const float reached = (wanted.x * validated.velocity.x + wanted.y * validated.velocity.y) / square;
  const float target = clamped(reached + kLead_share, 0.0F, 1.0F);
  if (target < state.speed_share && state.is_limited != 0) {
    state.speed_share += (target - state.speed_share) * smaller(1.0F, since_s / kHoldBack_s);
  } else {
    state.speed_share = smaller(1.0F, state.speed_share + since_s / kRecovery_s);
  }
}

/// Turns the last reference into the robot's present heading and moves it towards the wanted one.
void approach(const Config& config, const State& state, const Validated& validated, float since_s, BodyReference& body) {
  // Within a period the robot turns by at most a tenth of a radian; after a gap the reference has been set anew.
  const float angle_rad = clamped(-validated.velocity.yaw * since_s, -0.3F, 0.3F);
  const Vector3 last = turned(state.velocity_reference, {angle_rad, 1.0F - 0.5F * angle_rad * angle_rad});
  Vector3 change{body.velocity.x - last.x, body.velocity.y - last.y, body.velocity.yaw - last.yaw};
  const float most_m_per_s = kApproach_ratio * config.acceleration_limit_m_per_s2 * since_s;
  const float most_rad_per_s = kApproach_ratio * config.yaw_acceleration_limit_rad_per_s2 * since_s;
  if (limit(change, most_m_per_s, most_rad_per_s)) {
    body.velocity = {last.x + change.x, last.y + change.y, last.yaw + change.yaw};
    const float rate_per_s = 1.0F / (kApproach_ratio * since_s);
    body.acceleration = scaled(change, rate_per_s, rate_per_s);
  }
}

void close_loop(const Config& config, State& state, const Validated& validated, float since_s, BodyReference& body) {
  const float yaw_error_rad_per_s = body.velocity.yaw - validated.velocity.yaw;
  state.yaw_integral_rad = clamped(state.yaw_integral_rad + yaw_error_rad_per_s * since_s, -kMostYawIntegral_rad, kMostYawIntegral_rad);
  // A standing robot must not turn because of the integral that its motion needed.
  if (body.velocity.yaw == 0.0F && length(body.velocity) < kStanding_m_per_s) {
    state.yaw_integral_rad -= state.yaw_integral_rad * smaller(1.0F, since_s / kRelease_s);
  }
  body.acceleration.x += config.body_gain_per_s * (body.velocity.x - validated.velocity.x);
  body.acceleration.y += config.body_gain_per_s * (body.velocity.y - validated.velocity.y);
  body.acceleration.yaw += config.yaw_gain_per_s * yaw_error_rad_per_s + config.yaw_integral_per_s2 * state.yaw_integral_rad;
  limit(body.acceleration, kApproach_ratio * config.acceleration_limit_m_per_s2,
        kApproach_ratio * config.yaw_acceleration_limit_rad_per_s2);
  // Every packet corrects the velocity by a small step, which would act as a force impulse.
  const float share = smaller(1.0F, since_s / kForce_s);
  Vector3& smoothed = state.acceleration_reference;
  smoothed.x += share * (body.acceleration.x - smoothed.x);
  smoothed.y += share * (body.acceleration.y - smoothed.y);
  smoothed.yaw += share * (body.acceleration.yaw - smoothed.yaw);
  body.acceleration = smoothed;
  // The wheels follow their speeds; only the gyro sees their slip in yaw.
  body.velocity.yaw += config.derived.yaw_correction_per_s * state.yaw_integral_rad;
}

}  // namespace

BodyReference control_body_velocity(const Config& config, State& state, const Input& input, const Validated& validated) {
  // After a gap or a start of State the references start anew and are valid for one period.
  const bool is_anew = validated.robot_fault == Reason::time_jump || state.steps == 0;
  const float since_s = is_anew ? config.period_s : state.held.since_s + validated.elapsed_s;
  state.held.since_s = 0.0F;
  const bool is_wheelwise = validated.mode == Mode::wheel_speed || validated.mode == Mode::wheel_torque;
  // While the bridges are open the reference follows the robot. Otherwise the robot would have to catch up with it afterwards.
  const bool is_open = validated.mode == Mode::coast || validated.robot_fault == Reason::period_invalid;
  if (is_anew || is_open || is_wheelwise) {
    state.velocity_reference = validated.velocity;
    state.acceleration_reference = {};
    state.yaw_integral_rad = 0.0F;
  }
  if (is_open || is_wheelwise) {
    state.speed_share = 1.0F;
    return {{}, {}, {}, is_wheelwise, is_open};
  }
  if (validated.mode != Mode::pose_target) {
    state.plan_velocity = state.plan_acceleration = {};
  }
  BodyReference body = follow_command(config, state, input, validated);
  limit(body.velocity, config.speed_limit_m_per_s, config.yaw_rate_limit_rad_per_s);
  hold_back(state, body.velocity, validated, since_s);
  if (state.speed_share < 1.0F) {
    body.velocity = scaled(body.velocity, state.speed_share, state.speed_share);
  }
  approach(config, state, validated, since_s, body);
  state.velocity_reference = body.velocity;
  close_loop(config, state, validated, since_s, body);
  body.is_wheelwise = body.is_open = false;
  return body;
}

}  // namespace robot_core
