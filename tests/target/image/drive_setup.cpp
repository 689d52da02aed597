#include "drive_setup.h"

namespace heatsoak::target {
namespace {

using robot_core::Config;

constexpr int kSpeeds = 7;
constexpr int kStators = 8;
constexpr int kWindings = 10;
constexpr int kCandidates = 33;
constexpr float kMostCurrent_A = 23.1481476F;
constexpr float kMostSpeed_rad_per_s = 419.207306F;

template <int count>
struct Numbers {
  float values[count];
};

/// From -most to most.
constexpr Numbers<kCandidates> spread(float most) {
  Numbers<kCandidates> numbers{};
  for (int i = 0; i < kCandidates; ++i) {
    numbers.values[i] = most * static_cast<float>(i - kCandidates / 2) / static_cast<float>(kCandidates / 2);
  }
  return numbers;
}

constexpr float kSpeed_rad_per_s[kSpeeds] = {0.0F, 69.8678894F, 139.735779F, 209.603653F, 279.471558F, 349.339417F, kMostSpeed_rad_per_s};
constexpr float kStator_C[kStators] = {40.0F, 56.4285698F, 72.8571396F, 89.2857132F, 105.714287F, 122.14286F, 138.571426F, 155.0F};
constexpr float kWinding_C[kWindings] = {40.0F, 91.0F, 123.0F, 139.0F, 147.0F, 151.0F, 153.0F, 154.0F, 155.0F, 156.0F};

// By `heatsoak derate`; of this motor it does not depend on the speed.
constexpr float kAtEverySpeed_A[kStators * kWindings] = {
    17.3877773F, 12.09727F,   8.44920063F, 6.22634506F, 4.84678459F, 4.01161289F, 3.52868319F, 3.26271391F, 2.97458076F, 0.0F,
    17.3359432F, 12.0344868F, 8.36716747F, 6.11949825F, 4.7117691F,  3.8491354F,  3.34377623F, 3.06235409F, 2.75391102F, 0.0F,
    17.2840214F, 11.9713497F, 8.28442669F, 6.01079702F, 4.57269144F, 3.67950487F, 3.14809656F, 2.84786558F, 2.51399136F, 0.0F,
    17.2318344F, 11.9079475F, 8.20080376F, 5.90015316F, 4.42937565F, 3.50166249F, 2.93934774F, 2.61598158F, 2.24855208F, 0.0F,
    17.1795597F, 11.8441048F, 8.11638641F, 5.78730154F, 4.28120279F, 3.31419468F, 2.71461606F, 2.36131525F, 1.94726157F, 0.0F,
    17.1271076F, 11.7799969F, 8.03099728F, 5.67224264F, 4.12764359F, 3.11560082F, 2.46957493F, 2.07574272F, 1.58998692F, 0.0F,
    17.0744781F, 11.7155352F, 7.94472504F, 5.55479956F, 3.96825647F, 2.90340829F, 2.1973362F,  1.74398768F, 1.12427604F, 0.0F,
    17.0216732F, 11.6507206F, 7.85756969F, 5.43479538F, 3.80215812F, 2.67443824F, 1.88615584F, 1.33196509F, 0.0F,        0.0F,
};

constexpr Numbers<kSpeeds * kStators * kWindings> whole_table() {
  Numbers<kSpeeds * kStators * kWindings> table{};
  for (int i = 0; i < kSpeeds * kStators * kWindings; ++i) {
    table.values[i] = kAtEverySpeed_A[i % (kStators * kWindings)];
  }
  return table;
}

constexpr Numbers<kSpeeds* kStators* kWindings> kTable_A = whole_table();
constexpr Numbers<kCandidates> kPossibleCurrent_A = spread(kMostCurrent_A);
constexpr Numbers<kCandidates> kPossibleSpeed_rad_per_s = spread(kMostSpeed_rad_per_s);
constexpr float kPossibleAmbient_C[] = {40.0F};

/// Winding and stator with the heat counted 2.12 times.
void rates(const void*, const float* signal, const float* state_C, float* rate_K_per_s) {
  constexpr float kSafetyFactor = 2.12109375F;
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
  guard.speed_rad_per_s = {kSpeed_rad_per_s, kSpeeds};
  guard.stator_C = {kStator_C, kStators};
  guard.winding_C = {kWinding_C, kWindings};
  guard.current_A = kTable_A.values;
  guard.belief[robot_core::guard_current_A] = {true, -kMostCurrent_A, kMostCurrent_A, kPossibleCurrent_A.values, kCandidates};
  guard.belief[robot_core::guard_speed_rad_per_s] = {true, -1.05F * kMostSpeed_rad_per_s, 1.05F * kMostSpeed_rad_per_s,
                                                     kPossibleSpeed_rad_per_s.values, kCandidates};
  guard.belief[robot_core::guard_ambient_C] = {true, 0.0F, 40.0F, kPossibleAmbient_C, 1};
  guard.rates = rates;
  return guard;
}

constexpr robot_core::GuardModel kGuard = make_guard();

/// Columns of (AᵀA)⁻¹Aᵀ, where A has the rows t_x, t_y, R.
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
  // Along the axle's angle plus 90 degrees, of axles at -30, 30, 135 and -135 degrees; the friction's phases are the team's.
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
  robot_core::complete(config);
  return config;
}

}  // namespace heatsoak::target
