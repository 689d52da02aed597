#include "drive_setup.h"

namespace heatsoak::target {
namespace {

using robot_core::Config;

constexpr int kStators = 2;
constexpr int kWindings = 3;
constexpr float kMostCurrent_A = 23.1481476F;
constexpr float kMostSpeed_rad_per_s = 419.207306F;

// Calculated by `heatsoak derate`; for this motor the table does not depend on the speed.
constexpr float kSpeed_rad_per_s[] = {0.0F};
constexpr float kStator_C[kStators] = {40.0F, 155.0F};
constexpr float kWinding_C[kWindings] = {40.0F, 155.0F, 158.0F};
constexpr float kHeatPerOhm_A2[kStators * kWindings] = {
    320.0233F, 13.33415F, -0.00017F, 306.689F, -0.00017F, -8.00075F,
};

constexpr float kPossibleCurrent_A[] = {kMostCurrent_A};
constexpr float kPossibleSpeed_rad_per_s[] = {kMostSpeed_rad_per_s};
constexpr float kPossibleAmbient_C[] = {40.0F};

constexpr float kSafetyFactor = 2.12109375F;

/// Thermal law of winding and stator with 2.12 times the heat.
void rates(const void*, const float* signal, const float* state_C, float* rate_K_per_s) {
  const float speed_rad_per_s = robot_core::absolute(signal[robot_core::guard_speed_rad_per_s]);
  const float current_A = signal[robot_core::guard_current_A];
  const float copper_W = current_A * current_A * (1.07F * (1.0F + 0.0039F * (state_C[0] - 25.0F)));
  const float to_stator_W = (state_C[0] - state_C[1]) * 0.263157904F;
  const float to_ambient_W = (state_C[1] - signal[robot_core::guard_ambient_C]) * 0.357142866F;
  rate_K_per_s[0] = (kSafetyFactor * copper_W - to_stator_W) * 0.316666663F;
  rate_K_per_s[1] = (kSafetyFactor * 0.0082F * speed_rad_per_s + to_stator_W - to_ambient_W) * 0.035F;
}

constexpr robot_core::GuardModel make_guard() {
  robot_core::GuardModel guard;
  guard.node_count = 2;
  guard.winding_limit_C = 155.0F;
  guard.hottest_ambient_C = 40.0F;
  guard.most_current_A = kMostCurrent_A;
  guard.cold_current_A = 17.3878F;
  guard.heat_ratio = kSafetyFactor;
  guard.resting_C[0] = guard.resting_C[1] = 40.01F;
  guard.table = {.speed_rad_per_s = {kSpeed_rad_per_s, 1},
                 .stator_C = {kStator_C, kStators},
                 .winding_C = {kWinding_C, kWindings},
                 .heat_per_ohm_A2 = kHeatPerOhm_A2,
                 .resistance_at_0C_ratio = 0.9025F,
                 .resistance_ratio_per_K = 0.0039F,
                 .most_current_A = kMostCurrent_A,
                 .straight_below_A = 0.992F,
                 .most_speed_rad_per_s = kMostSpeed_rad_per_s,
                 .no_current_speed_rad_per_s = 845.12195F,
                 .winding_per_stator_K = 1.0F};
  guard.plausible_range[robot_core::guard_current_A] = {true, -kMostCurrent_A, kMostCurrent_A, kPossibleCurrent_A, 1};
  guard.plausible_range[robot_core::guard_speed_rad_per_s] = {true, -1.05F * kMostSpeed_rad_per_s, 1.05F * kMostSpeed_rad_per_s,
                                                              kPossibleSpeed_rad_per_s, 1};
  guard.plausible_range[robot_core::guard_ambient_C] = {true, 0.0F, 40.0F, kPossibleAmbient_C, 1};
  guard.rates = rates;
  return guard;
}

constexpr robot_core::GuardModel kGuard = make_guard();

/// Calculates the columns of (AᵀA)⁻¹Aᵀ, where A has the rows t_x, t_y, R.
void set_inverse(Config& config) {
  float normal[3][3] = {};
  for (int i = 0; i < config.wheel_count; ++i) {
    const float row[3] = {config.wheel[i].rolling_x_share, config.wheel[i].rolling_y_share, config.contact_radius_m};
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        normal[a][b] += row[a] * row[b];
      }
    }
  }
  float inverse[3][3];
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      const int c = (a + 1) % 3, d = (a + 2) % 3, e = (b + 1) % 3, f = (b + 2) % 3;
      inverse[a][b] = normal[e][c] * normal[f][d] - normal[e][d] * normal[f][c];
    }
  }
  const float determinant = normal[0][0] * inverse[0][0] + normal[0][1] * inverse[1][0] + normal[0][2] * inverse[2][0];
  for (int i = 0; i < config.wheel_count; ++i) {
    robot_core::WheelConfig& wheel = config.wheel[i];
    const float row[3] = {wheel.rolling_x_share, wheel.rolling_y_share, config.contact_radius_m};
    const auto column = [&](int a) { return (inverse[a][0] * row[0] + inverse[a][1] * row[1] + inverse[a][2] * row[2]) / determinant; };
    wheel.inverse_x_factor = column(0);
    wheel.inverse_y_factor = column(1);
    wheel.inverse_yaw_per_m = column(2);
  }
}

void set_wheels(Config& config) {
  // Rolling directions: axle angles of -30, 30, 135 and -135 degrees plus 90 degrees. The phases of the friction are the team's.
  constexpr float kRolling[4][2] = {
      {0.5F, 0.866025388F}, {-0.5F, 0.866025388F}, {-0.707106769F, -0.707106769F}, {0.707106769F, -0.707106769F}};
  constexpr float kPhase[4][2] = {{0.552F, 0.834F}, {-0.449F, 0.893F}, {0.506F, 0.862F}, {-0.381F, 0.925F}};
  for (int i = 0; i < config.wheel_count; ++i) {
    robot_core::WheelConfig& wheel = config.wheel[i];
    wheel.rolling_x_share = kRolling[i][0];
    wheel.rolling_y_share = kRolling[i][1];
    wheel.damping_V_s_per_rad = 0.0375F;
    wheel.sine_V = 0.2F;
    wheel.sign_V = 0.9F;
    wheel.phase_cosine_ratio = kPhase[i][0];
    wheel.phase_sine_ratio = kPhase[i][1];
  }
  set_inverse(config);
}

void set_control(Config& config) {
  config.rotation_friction_V = 0.3F;
  config.friction_smoothing_m_per_s = 0.05F;
  config.has_friction = true;
  config.body_gain_per_s = 4.0F;
  config.yaw_gain_per_s = 8.0F;
  config.yaw_integral_per_s2 = 20.0F;
  config.wheel_gain_V_s_per_rad = 0.05F;
  config.wheel_integral_V_per_rad = 0.5F;
  config.speed_limit_m_per_s = 2.0F;
  config.yaw_rate_limit_rad_per_s = 6.0F;
  config.acceleration_limit_m_per_s2 = 2.0F;
  config.yaw_acceleration_limit_rad_per_s2 = 30.0F;
  config.jerk_limit_m_per_s3 = 6.0F;
  config.traction_ratio = 0.7F;
  config.braking_reserve_K = 2.0F;
  config.limp_current_A = 1.0F;
}

}  // namespace

Config drive_setup() {
  Config config;
  config.wheel_radius_m = 0.028F;
  config.contact_radius_m = 0.0804F;
  config.mass_kg = 2.632F;
  config.yaw_inertia_kg_m2 = 0.011F;
  config.wheel_inertia_kg_m2 = 22.9e-6F;
  config.torque_constant_Nm_per_A = 0.0328F;
  config.resistance_ohm = 1.08F;
  config.lowest_resistance_ohm = 0.9F;
  config.fastest_wheel_rad_per_s = 420.0F;
  config.largest_acceleration_rad_per_s2 = 33000.0F;
  config.battery_full_V = 25.2F;
  config.battery_lowest_V = 18.0F;
  config.battery_resistance_ohm = 0.04F;
  config.voltage_limit_V = 12.5F;
  config.current_limit_A = 12.0F;
  set_wheels(config);
  set_control(config);
  config.guard = &kGuard;
  config.plan_step = robot_core::plan_to_pose;
  config.predict_pose = robot_core::predict_pose;
  robot_core::complete(config);
  return config;
}

}  // namespace heatsoak::target
