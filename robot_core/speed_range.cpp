// Stage 1, third part: speeds that a wheel may have if some sensors are faulty. Called if a wheel is near its current limit.
#include "robot_core/drive_stages.h"

namespace robot_core {
namespace {

/// Another wheel: rolling direction and rim speed without the rotation of the robot.
struct Other {
  float x_share;
  float y_share;
  float rim_m_per_s;  ///< NaN if the sensor is not accepted; SpeedRange::add() ignores the NaN that follow from it
};

Other other(const Config& config, const Validated& validated, int wheel) {
  const int i = wheel % kMostWheels;
  return {config.wheel[i].rolling_x_share, config.wheel[i].rolling_y_share, validated.rim_m_per_s[i]};
}

float cross(const WheelConfig& a, const Other& b) { return a.rolling_x_share * b.y_share - a.rolling_y_share * b.x_share; }
float cross(const Other& a, const Other& b) { return a.x_share * b.y_share - a.y_share * b.x_share; }

/// Adds the estimate sum/determinant, unless the sensors hardly determine it.
[[gnu::always_inline]] inline void add(SpeedRange& range, float sum_m_per_s, float determinant) {
  if (absolute(determinant) >= kLeastArea_ratio) {
    range.add(sum_m_per_s / determinant);
  }
}

}  // namespace

[[gnu::cold]] SpeedRange speed_range(const Config& config, const State& state, const Validated& validated, int wheel) {
  const WheelConfig& own = config.wheel[wheel];
  const float turning_m_per_s = config.contact_radius_m * validated.velocity.yaw;
  const Other a = other(config, validated, wheel + 1);
  const Other b = other(config, validated, wheel + 2);
  const Other c = other(config, validated, wheel + 3);
  SpeedRange range;
  range.add(validated.rim_m_per_s[wheel]);
  const float ab = cross(a, b);
  const float bc = cross(b, c);
  const float ca = cross(c, a);
  const float to_a = cross(own, a);
  const float to_b = cross(own, b);
  const float to_c = cross(own, c);
  if (state.yaw_fault == 0) {
    add(range, to_b * a.rim_m_per_s - to_a * b.rim_m_per_s, ab);
    add(range, to_c * b.rim_m_per_s - to_b * c.rim_m_per_s, bc);
    add(range, to_a * c.rim_m_per_s - to_c * a.rim_m_per_s, ca);
  }
  // Three others without the gyro: barycentric coordinates in the triangle between the tips of their rolling directions.
  add(range, (to_b + bc - to_c) * a.rim_m_per_s + (to_c + ca - to_a) * b.rim_m_per_s + (to_a + ab - to_b) * c.rim_m_per_s, ab + bc + ca);
  if (range.is_known() && validated.is_any_possible) {
    range.add(a.rim_m_per_s);
    range.add(b.rim_m_per_s);
    range.add(c.rim_m_per_s);
  }
  return {(range.slowest_rad_per_s + turning_m_per_s) * own.speed_per_rim_per_m,
          (range.fastest_rad_per_s + turning_m_per_s) * own.speed_per_rim_per_m};
}

}  // namespace robot_core
