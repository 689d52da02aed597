// Stage 3: wheel speeds of a body motion: r·ω = slip factor·(t·v + R·yaw rate).
#include "robot_core/drive_stages.h"

namespace robot_core {

void find_wheel_speeds(const Config& config, const Input& input, const BodyReference& body, WheelReferences& wheels) {
  // Acceleration in the frame of the turning robot: dv/dt = a − yaw rate × v.
  const float rate_x = body.acceleration.x + body.velocity.yaw * body.velocity.y;
  const float rate_y = body.acceleration.y - body.velocity.yaw * body.velocity.x;
  for (int i = 0; i < config.wheel_count; ++i) {
    const WheelConfig& wheel = config.wheel[i];
    const float per_rim = config.wheel[i].speed_per_rim_per_m;
    if (body.is_wheelwise) {
      wheels.wheel[i].speed_rad_per_s =
          input.command.mode == Mode::wheel_speed
              ? clamped(input.command.wheel_speed_rad_per_s[i], -config.fastest_wheel_rad_per_s, config.fastest_wheel_rad_per_s)
              : 0.0F;
      wheels.wheel[i].acceleration_rad_per_s2 = 0.0F;
      continue;
    }
    wheels.wheel[i].speed_rad_per_s = per_rim * (wheel.rolling_x_share * body.velocity.x + wheel.rolling_y_share * body.velocity.y +
                                                 config.contact_radius_m * body.velocity.yaw);
    wheels.wheel[i].acceleration_rad_per_s2 =
        per_rim * (wheel.rolling_x_share * rate_x + wheel.rolling_y_share * rate_y + config.contact_radius_m * body.acceleration.yaw);
  }
}

}  // namespace robot_core
