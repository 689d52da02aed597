// Stage 1, third part: speeds that a wheel may have if some sensors are faulty. Called if a wheel is near its current limit.
#include "robot_core/drive_stages.h"

namespace robot_core {
[[gnu::cold]] SpeedRange speed_range(const Config& config, const State& state, const Validated& validated, int wheel) {
  const WheelConfig& own = config.wheel[wheel];
  const float turning_m_per_s = config.contact_radius_m * validated.velocity.yaw;
  // NaN if the sensor is not accepted; SpeedRange::add() ignores the NaN that follow from it.
  const float a_m_per_s = validated.rim_m_per_s[(wheel + 1) % kMostWheels];
  const float b_m_per_s = validated.rim_m_per_s[(wheel + 2) % kMostWheels];
  const float c_m_per_s = validated.rim_m_per_s[(wheel + 3) % kMostWheels];
  const std::uint32_t sets = state.yaw_fault == 0 ? own.sets : own.sets & kSetOfThree;
  SpeedRange range;
  range.add(validated.rim_m_per_s[wheel]);
  if ((sets & 1U) != 0) {
    range.add((own.to_b_ratio * a_m_per_s - own.to_a_ratio * b_m_per_s) / own.ab_ratio);
  }
  if ((sets & 2U) != 0) {
    range.add((own.to_c_ratio * b_m_per_s - own.to_b_ratio * c_m_per_s) / own.bc_ratio);
  }
  if ((sets & 4U) != 0) {
    range.add((own.to_a_ratio * c_m_per_s - own.to_c_ratio * a_m_per_s) / own.ca_ratio);
  }
  // Without the gyro: barycentric coordinates in the triangle between the tips of the rolling directions.
  if ((sets & kSetOfThree) != 0) {
    range.add((own.own_bc_ratio * a_m_per_s + own.own_ca_ratio * b_m_per_s + own.own_ab_ratio * c_m_per_s) / own.abc_ratio);
  }
  if (range.is_known() && validated.is_any_possible) {
    range.add(a_m_per_s);
    range.add(b_m_per_s);
    range.add(c_m_per_s);
  }
  return {(range.slowest_rad_per_s + turning_m_per_s) * own.speed_per_rim_per_m,
          (range.fastest_rad_per_s + turning_m_per_s) * own.speed_per_rim_per_m};
}

}  // namespace robot_core
