// Stage 3: wheel speeds of a body motion: r·ω = slip factor·(t·v + R·yaw rate).
#include "robot_core/drive_stages.h"

namespace robot_core {

namespace {

/// The command sets the speeds of the single wheels, or only their torques.
[[gnu::noinline]] void take_wheel_command(const Config& config, const Input& input, WheelReferences& wheels) {
  for (int i = 0; i < config.wheel_count; ++i) {
    wheels.wheel[i].speed_rad_per_s =
        input.command.mode == Mode::wheel_speed
            ? clamped(input.command.wheel_speed_rad_per_s[i], -config.fastest_wheel_rad_per_s, config.fastest_wheel_rad_per_s)
            : 0.0F;
    wheels.wheel[i].acceleration_rad_per_s2 = 0.0F;
  }
}

}  // namespace

void find_wheel_speeds(const Config& config, const Input& input, const BodyReference& body, WheelReferences& wheels) {
  if (body.is_wheelwise) {
    take_wheel_command(config, input, wheels);
    return;
  }
  // Local values: the compiler cannot know that a reference written in the loop does not change them.
  const int count = config.wheel_count;
  const float x_m_per_s = body.velocity.x;
  const float y_m_per_s = body.velocity.y;
  const float turning_m_per_s = config.contact_radius_m * body.velocity.yaw;
  // Acceleration in the frame of the turning robot: dv/dt = a − yaw rate × v.
  const float rate_x = body.acceleration.x + body.velocity.yaw * body.velocity.y;
  const float rate_y = body.acceleration.y - body.velocity.yaw * body.velocity.x;
  const float rate_yaw = config.contact_radius_m * body.acceleration.yaw;
  for (int i = 0; i < count; ++i) {
    const WheelConfig& wheel = config.wheel[i];
    const float per_rim = wheel.speed_per_rim_per_m;
    const float t_x = wheel.rolling_x_share;
    const float t_y = wheel.rolling_y_share;
    wheels.wheel[i] = {per_rim * (t_x * x_m_per_s + t_y * y_m_per_s + turning_m_per_s), per_rim * (t_x * rate_x + t_y * rate_y + rate_yaw)};
  }
}

}  // namespace robot_core
