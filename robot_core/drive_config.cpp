// Checks a Config and calculates the values that follow from others.
#include "robot_core/crc_32.h"
#include "robot_core/drive_stages.h"

namespace robot_core {
namespace {

constexpr float kGravity_m_per_s2 = 9.80665F;

bool is_positive(float x) { return x > 0.0F; }
bool is_not_negative(float x) { return x >= 0.0F; }

/// Returns true if a condition holds for these members. Their offsets are constants, which take less room than code that reads them.
template <auto holds, typename Object, unsigned count>
bool all(const Object& object, float Object::*const (&members)[count]) {
  bool all_hold = true;
  for (const auto member : members) {
    all_hold = all_hold && holds(object.*member);
  }
  return all_hold;
}

/// Returns true if all numbers are finite. All members between these two are floats, but for flags, which are finite as floats, too.
bool are_finite(const Config& config) {
  const auto* const bytes = reinterpret_cast<const unsigned char*>(&config);
  bool are_all = true;
  for (unsigned at = __builtin_offsetof(Config, period_s); at < __builtin_offsetof(Config, has_friction); at += sizeof(float)) {
    float number = 0.0F;
    __builtin_memcpy(&number, bytes + at, sizeof(number));
    are_all = are_all && is_finite(number);
  }
  return are_all;
}

// A guard waits for up to two of its periods, which are counted in 16 bits.
constexpr float kMostGuardPeriods = 3e4F;

/// Returns true if a guard period is a whole number of control periods and the guard has a table and resting temperatures.
[[gnu::cold]] bool is_possible(const GuardModel& guard, float period_s) {
  for (int node = 0; node < guard.node_count && node < kMostGuardNodes; ++node) {
    if (!(guard.resting_C[node] >= guard.hottest_ambient_C)) {
      return false;
    }
  }
  const float periods = guard.period_s / period_s;
  const float whole = static_cast<float>(static_cast<int>(clamped(periods, 0.0F, kMostGuardPeriods) + 0.5F));
  return guard.node_count >= 2 && guard.node_count <= kMostGuardNodes && is_positive(guard.period_s) && whole >= 1.0F &&
         absolute(periods - whole) < 1e-3F * whole && guard.rates != nullptr && guard.table.heat_per_ohm_A2 != nullptr &&
         guard.table.speed_rad_per_s.count >= 1 && guard.table.stator_C.count >= 1 && guard.table.winding_C.count >= 2 &&
         guard.table.resistance_ratio_per_K >= 0.0F && heatsoak_resistance_ratio(&guard.table, guard.table.winding_C.points[0]) > 0.0F &&
         guard.heat_ratio >= 1.0F && is_finite(guard.winding_limit_C) && is_finite(guard.coldest_ambient_C) &&
         guard.hottest_ambient_C < guard.winding_limit_C;
}

}  // namespace

[[gnu::cold]] bool is_possible(const Config& config) {
  if (config.wheel_count != 3 && config.wheel_count != 4) {
    return false;
  }
  static constexpr float Config::*kPositive[] = {&Config::period_s,
                                                 &Config::wheel_radius_m,
                                                 &Config::contact_radius_m,
                                                 &Config::mass_kg,
                                                 &Config::yaw_inertia_kg_m2,
                                                 &Config::wheel_inertia_kg_m2,
                                                 &Config::torque_constant_Nm_per_A,
                                                 &Config::resistance_ohm,
                                                 &Config::lowest_resistance_ohm,
                                                 &Config::gear_ratio,
                                                 &Config::gear_efficiency,
                                                 &Config::fastest_wheel_rad_per_s,
                                                 &Config::largest_acceleration_rad_per_s2,
                                                 &Config::battery_full_V,
                                                 &Config::battery_lowest_V,
                                                 &Config::voltage_limit_V,
                                                 &Config::current_limit_A,
                                                 &Config::tracking_time_s,
                                                 &Config::speed_limit_m_per_s,
                                                 &Config::yaw_rate_limit_rad_per_s,
                                                 &Config::acceleration_limit_m_per_s2,
                                                 &Config::yaw_acceleration_limit_rad_per_s2,
                                                 &Config::command_timeout_s};
  static constexpr float Config::*kNotNegative[] = {
      &Config::resistance_rise_per_K,    &Config::battery_resistance_ohm, &Config::rotation_friction_V, &Config::friction_smoothing_m_per_s,
      &Config::body_gain_per_s,          &Config::yaw_gain_per_s,         &Config::yaw_integral_per_s2, &Config::wheel_gain_V_s_per_rad,
      &Config::wheel_integral_V_per_rad, &Config::jerk_limit_m_per_s3,    &Config::traction_ratio,      &Config::braking_reserve_K,
      &Config::limp_current_A,           &Config::warning_time_s};
  bool possible =
      all<is_positive>(config, kPositive) && all<is_not_negative>(config, kNotNegative) && config.battery_lowest_V <= config.battery_full_V;
  const DerivedConfig& derived = config.derived;
  possible = possible && is_positive(derived.geared_constant_V_s_per_rad) && are_finite(config);
  for (int i = 0; i < config.wheel_count; ++i) {
    const WheelConfig& wheel = config.wheel[i];
    possible = possible && is_positive(wheel.slip_factor) && is_positive(wheel.damping_V_s_per_rad) &&
               is_not_negative(wheel.level_load_share) && is_not_negative(wheel.sign_V);
  }
  possible = possible && (config.plan_step == nullptr || config.predict_pose != nullptr);
  return possible && (config.guard == nullptr || is_possible(*config.guard, config.period_s));
}

namespace {

/// Rim speeds of one body motion satisfy Σ c·r = 0: for any three wheels with the gyro, and for all four without it. An estimate of r_i
/// from the others is therefore off by |Σ c·residual|/|c_i|. That is at most the largest |c|/|c_i| times the sum of the absolute residuals.
/// Coefficients below `least` determine no speed.
float most_ratio(const float (&coefficient)[kMostWheels], float least) {
  float largest = 0.0F;
  float smallest = std::numeric_limits<float>::max();
  for (const float each : coefficient) {
    largest = larger(largest, absolute(each));
    smallest = absolute(each) < least ? smallest : smaller(smallest, absolute(each));
  }
  return largest / smallest;
}

/// Largest ratio of |c|/|c_i| over all sets of wheels.
[[gnu::cold]] float most_ratio(const Config& config) {
  const WheelConfig* const wheel = config.wheel;
  float most = 0.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    for (int j = i + 1; j < config.wheel_count; ++j) {
      for (int k = j + 1; k < config.wheel_count; ++k) {
        const float pairs[kMostWheels] = {cross(wheel[j], wheel[k]), cross(wheel[k], wheel[i]), cross(wheel[i], wheel[j])};
        most = larger(most, most_ratio(pairs, kLeastArea_ratio));
      }
    }
  }
  if (config.wheel_count == kMostWheels) {
    const float all[kMostWheels] = {area(wheel[1], wheel[2], wheel[3]), area(wheel[0], wheel[2], wheel[3]),
                                    area(wheel[0], wheel[1], wheel[3]), area(wheel[0], wheel[1], wheel[2])};
    most = larger(most, most_ratio(all, kLeastArea_ratio));
  }
  return most;
}

/// Calculates from which sets of other wheels the speed of a wheel follows.
[[gnu::cold]] void find_sets(Config& config, int i) {
  WheelConfig& own = config.wheel[i];
  const WheelConfig& a = config.wheel[(i + 1) % kMostWheels];
  const WheelConfig& b = config.wheel[(i + 2) % kMostWheels];
  const WheelConfig& c = config.wheel[(i + 3) % kMostWheels];
  own.ab_ratio = cross(a, b);
  own.bc_ratio = cross(b, c);
  own.ca_ratio = cross(c, a);
  own.to_a_ratio = cross(own, a);
  own.to_b_ratio = cross(own, b);
  own.to_c_ratio = cross(own, c);
  own.own_bc_ratio = own.to_b_ratio + own.bc_ratio - own.to_c_ratio;
  own.own_ca_ratio = own.to_c_ratio + own.ca_ratio - own.to_a_ratio;
  own.own_ab_ratio = own.to_a_ratio + own.ab_ratio - own.to_b_ratio;
  own.abc_ratio = own.ab_ratio + own.bc_ratio + own.ca_ratio;
  own.sets = 0;
  const float determinants[] = {own.ab_ratio, own.bc_ratio, own.ca_ratio, own.abc_ratio};
  for (unsigned set = 0; set < 4; ++set) {
    own.sets |= absolute(determinants[set]) >= kLeastArea_ratio ? 1U << set : 0U;
  }
}

}  // namespace

[[gnu::cold]] void complete(Config& config) {
  DerivedConfig& derived = config.derived;
  derived = {};
  derived.geared_constant_V_s_per_rad = config.torque_constant_Nm_per_A * config.gear_ratio;
  derived.per_lowest_resistance_A_per_V = 1.0F / config.lowest_resistance_ohm;
  derived.per_resistance_A_per_V = 1.0F / config.resistance_ohm;
  derived.volt_per_Nm = config.resistance_ohm / (derived.geared_constant_V_s_per_rad * config.gear_efficiency);
  derived.yaw_correction_per_s = config.yaw_gain_per_s > 0.0F ? config.yaw_integral_per_s2 / config.yaw_gain_per_s : 0.0F;
  derived.per_tracking_time_per_s = 1.0F / config.tracking_time_s;
  derived.most_battery_sag_A = config.battery_resistance_ohm > 0.0F ? 1.0F / config.battery_resistance_ohm : 0.0F;
  float xx = 0.0F;
  float xy = 0.0F;
  float yy = 0.0F;
  for (int i = 0; i < config.wheel_count && i < kMostWheels; ++i) {
    const WheelConfig& wheel = config.wheel[i];
    xx += wheel.rolling_x_share * wheel.rolling_x_share;
    xy += wheel.rolling_x_share * wheel.rolling_y_share;
    yy += wheel.rolling_y_share * wheel.rolling_y_share;
  }
  constexpr float kJump_share = 0.03F;     // share of the fastest speed: encoder steps and noise
  constexpr float kCurrent_share = 0.15F;  // noise, delay and settling of the current
  derived.jump_rad_per_s = config.largest_acceleration_rad_per_s2 * config.period_s + kJump_share * config.fastest_wheel_rad_per_s;
  derived.most_sensed_A = 2.5F * config.battery_full_V / config.lowest_resistance_ohm;  // when braking, the back-EMF adds to the battery
  const float per_determinant = 1.0F / (xx * yy - xy * xy);
  derived.plane_xx_factor = yy * per_determinant;
  derived.plane_xy_factor = -xy * per_determinant;
  derived.plane_yy_factor = xx * per_determinant;
  for (int i = 0; i < config.wheel_count && i < kMostWheels; ++i) {
    WheelConfig& wheel = config.wheel[i];
    const float t_x = wheel.rolling_x_share;
    const float t_y = wheel.rolling_y_share;
    wheel.rim_per_speed_m = config.wheel_radius_m / wheel.slip_factor;
    wheel.speed_per_rim_per_m = wheel.slip_factor / config.wheel_radius_m;
    find_sets(config, i);
    const float leverage =
        derived.plane_xx_factor * t_x * t_x + 2.0F * derived.plane_xy_factor * t_x * t_y + derived.plane_yy_factor * t_y * t_y;
    constexpr float kMostLeverage = 0.98F;  // above this the other wheels hardly determine this wheel's direction
    wheel.others_rad_per_m = leverage < kMostLeverage ? wheel.speed_per_rim_per_m / (1.0F - leverage) : 0.0F;
    const float force_N = config.traction_ratio * wheel.level_load_share * config.mass_kg * kGravity_m_per_s2;
    const float nominal_A = force_N * config.wheel_radius_m / (derived.geared_constant_V_s_per_rad * config.gear_efficiency) +
                            absolute(wheel.sign_V) / config.resistance_ohm;
    // The grip limit uses the nominal resistance, because it protects no component.
    const float grip_A = nominal_A * config.resistance_ohm / config.lowest_resistance_ohm;
    wheel.is_grip_limit = config.traction_ratio > 0.0F && grip_A < config.current_limit_A ? 1 : 0;
    wheel.body_limit_A = wheel.is_grip_limit != 0 ? grip_A : config.current_limit_A;
    // The margin follows the grip limit if the robot has no driver limit.
    derived.current_margin_A = larger(derived.current_margin_A, kCurrent_share * wheel.body_limit_A);
    derived.rim_spread_V_s_per_m = larger(derived.rim_spread_V_s_per_m, wheel.speed_per_rim_per_m * derived.geared_constant_V_s_per_rad);
  }
  derived.spread_V_s_per_m = most_ratio(config) * derived.rim_spread_V_s_per_m;
  // Noise of a current sensor as a share of the driver's limit.
  constexpr float kSensedSlack_share = 0.05F;
  derived.sensed_slack_V = kSensedSlack_share * config.current_limit_A * config.lowest_resistance_ohm;
  config.check_sum = config_check_sum(config);
}

[[gnu::cold]] std::uint32_t config_check_sum(const Config& config) {
  constexpr unsigned kFirst = __builtin_offsetof(Config, check_sum) + sizeof(Config::check_sum);
  constexpr unsigned kEnd = __builtin_offsetof(Config, unused) + sizeof(Config::unused);
  static_assert(kEnd % sizeof(std::uint32_t) == 0, "no padding up to the end of the flags");
  return heatsoak_crc_32(reinterpret_cast<const unsigned char*>(&config) + kFirst, kEnd - kFirst);
}

}  // namespace robot_core
