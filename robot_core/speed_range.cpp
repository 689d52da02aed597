// Stage 1, third part: speeds that a wheel may have if some sensors are faulty. Called if a wheel is near its current limit.
#include "robot_core/drive_stages.h"

// Optimised for size, because few steps need it.
#pragma GCC optimize("Os")

namespace robot_core {
namespace {

/// Rim speeds of the accepted wheel sensors.
struct Rims {
  float rim_m_per_s[kMostWheels] = {};
  bool is_sensed[kMostWheels] = {};
};

/// Adds the speed that two other wheels and the gyro imply.
void add_pair(const Config& config, const Rims& rims, int i, int j, int k, float turning_m_per_s, SpeedRange& range) {
  const float determinant = cross(config.wheel[j], config.wheel[k]);
  if (!rims.is_sensed[j] || !rims.is_sensed[k] || absolute(determinant) < kLeastArea_ratio) {
    return;
  }
  const float of_j = cross(config.wheel[i], config.wheel[k]) * (rims.rim_m_per_s[j] - turning_m_per_s);
  const float of_k = cross(config.wheel[j], config.wheel[i]) * (rims.rim_m_per_s[k] - turning_m_per_s);
  range.add(((of_j + of_k) / determinant + turning_m_per_s) * config.wheel[i].speed_per_rim_per_m);
}

/// Adds the speed that three other wheels imply without the gyro (barycentric coordinates).
void add_triple(const Config& config, const Rims& rims, int i, SpeedRange& range) {
  const int j = (i + 1) % kMostWheels;
  const int k = (i + 2) % kMostWheels;
  const int l = (i + 3) % kMostWheels;
  const WheelConfig* const wheel = config.wheel;
  const float determinant = area(wheel[j], wheel[k], wheel[l]);
  if (!rims.is_sensed[j] || !rims.is_sensed[k] || !rims.is_sensed[l] || absolute(determinant) < kLeastArea_ratio) {
    return;
  }
  const float sum = area(wheel[i], wheel[k], wheel[l]) * rims.rim_m_per_s[j] + area(wheel[j], wheel[i], wheel[l]) * rims.rim_m_per_s[k] +
                    area(wheel[j], wheel[k], wheel[i]) * rims.rim_m_per_s[l];
  range.add(sum / determinant * wheel[i].speed_per_rim_per_m);
}

}  // namespace

[[gnu::cold]] SpeedRange speed_range(const Config& config, const State& state, const Validated& validated, int wheel) {
  SpeedRange range;
  Rims rims;
  const bool is_gyro_trusted = state.yaw_fault == 0;
  int sensed = is_gyro_trusted ? 1 : 0;
  for (int j = 0; j < config.wheel_count; ++j) {
    rims.is_sensed[j] = validated.wheel[j].is_speed_sensed;
    rims.rim_m_per_s[j] = rim_speed_m_per_s(config, j, validated.wheel[j].speed_rad_per_s);
    sensed += rims.is_sensed[j] ? 1 : 0;
  }
  // With one spare sensor two swapped ones may go unnoticed. Until a swap would have been found, every sample may belong to this wheel.
  // Without a spare sensor the current is limited to a safe value anyway.
  const bool is_any_possible = sensed == 4 && state.comparison.is_checked == 0;
  const float turning_m_per_s = config.contact_radius_m * validated.yaw_rate_rad_per_s;
  for (int j = 0; j < config.wheel_count; ++j) {
    if (rims.is_sensed[j] && j == wheel) {
      range.add(validated.wheel[j].speed_rad_per_s);
    }
    for (int k = j + 1; k < config.wheel_count && is_gyro_trusted && j != wheel; ++k) {
      if (k != wheel) {
        add_pair(config, rims, wheel, j, k, turning_m_per_s, range);
      }
    }
  }
  if (config.wheel_count == kMostWheels) {
    add_triple(config, rims, wheel, range);
  }
  for (int j = 0; j < config.wheel_count && is_any_possible && range.is_known(); ++j) {
    if (rims.is_sensed[j]) {
      range.add(validated.wheel[j].speed_rad_per_s);
    }
  }
  return range;
}

}  // namespace robot_core
