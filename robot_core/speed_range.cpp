// Stage 1, third part: speeds that a wheel may have if some sensors are faulty.
#include "robot_core/drive_stages.h"

namespace robot_core {
SpeedRange speed_range(const Config& config, const State& state, const Validated& validated, int wheel) {
  const auto index = static_cast<unsigned>(wheel);
  const WheelConfig& own = config.wheel[index];
  const PerWheel& rim_m_per_s = validated.rim_m_per_s;
  const float turning_m_per_s = config.contact_radius_m * validated.velocity.yaw;
  const float a_m_per_s = rim_m_per_s[(index + 1) % kMostWheels];
  const float b_m_per_s = rim_m_per_s[(index + 2) % kMostWheels];
  const float c_m_per_s = rim_m_per_s[(index + 3) % kMostWheels];
  // Leaves out the sets with a sensor that is not accepted, whose rim speed is NaN.
  std::uint32_t sets = state.yaw_fault == 0 ? own.sets : own.sets & kSetOfThree;
  sets &= a_m_per_s == a_m_per_s ? ~0U : kSetOfBC;
  sets &= b_m_per_s == b_m_per_s ? ~0U : kSetOfCA;
  sets &= c_m_per_s == c_m_per_s ? ~0U : kSetOfAB;
  SpeedRange range;
  range.add(rim_m_per_s[index]);
  if ((sets & kSetOfAB) != 0) {
    range.add((own.to_b_ratio * a_m_per_s - own.to_a_ratio * b_m_per_s) / own.ab_ratio);
  }
  if ((sets & kSetOfBC) != 0) {
    range.add((own.to_c_ratio * b_m_per_s - own.to_b_ratio * c_m_per_s) / own.bc_ratio);
  }
  if ((sets & kSetOfCA) != 0) {
    range.add((own.to_a_ratio * c_m_per_s - own.to_c_ratio * a_m_per_s) / own.ca_ratio);
  }
  // Without the gyro: barycentric coordinates in the triangle between the tips of the rolling directions.
  if ((sets & kSetOfThree) != 0) {
    range.add((own.own_bc_ratio * a_m_per_s + own.own_ca_ratio * b_m_per_s + own.own_ab_ratio * c_m_per_s) / own.abc_ratio);
  }
  if (validated.is_any_possible && range.is_known()) {
    range.add(a_m_per_s);
    range.add(b_m_per_s);
    range.add(c_m_per_s);
  }
  return {(range.slowest_rad_per_s + turning_m_per_s) * own.speed_per_rim_per_m,
          (range.fastest_rad_per_s + turning_m_per_s) * own.speed_per_rim_per_m};
}

[[gnu::cold]] void check_redundancy(const Config& config, const State& state, Validated& validated) {
  int sensed = state.yaw_fault == 0 ? 1 : 0;
  for (int i = 0; i < config.wheel_count; ++i) {
    sensed += validated.wheel[i].is_speed_sensed ? 1 : 0;
  }
  validated.is_redundancy_reduced = true;
  if (config.wheel_count < kMostWheels) {
    validated.rim_m_per_s[kMostWheels - 1] = kNoSample;
  }
  validated.is_checked = sensed > 3;
  validated.is_any_possible = sensed == kMostWheels && state.comparison.is_checked == 0;
}

[[gnu::cold]] void widen_spread(const Config& config, Validated& validated) {
  SpeedRange rim;
  for (int i = 0; i < config.wheel_count; ++i) {
    rim.add(rim_speed_m_per_s(config, i, validated.wheel[i].speed_rad_per_s));
  }
  validated.spread_V = larger(validated.spread_V, config.derived.rim_spread_V_s_per_m * (rim.fastest_rad_per_s - rim.slowest_rad_per_s));
}

}  // namespace robot_core
