#include "test_robot.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "robot_core/drive_stages.h"
#include "robot_core/math.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::GuardModel;

constexpr double kGravity_m_per_s2 = 9.80665;
constexpr double kGeared_V_s_per_rad = 0.0328;
constexpr double kGear_ratio = 2.0;
constexpr double kColdest_C = 0.0;
constexpr double kHottestAir_C = 45.0;
constexpr double kFastest_rad_per_s = 420.0;
constexpr double kMostCurrent_A = 14.0;
constexpr int kSpeeds = 4;
constexpr int kStators = 8;
constexpr int kWindings = 12;

double resistance_at_ohm(const Truth& truth, double winding_C) {
  return truth.winding_ohm * (1.0 + kCopperRise_per_K * (winding_C - 25.0)) + truth.driver_ohm;
}

/// Axle angles in degrees. The first half of the wheels lies left of the x axis, the rest mirrors it.
double axle_deg(int wheel_count, int wheel) {
  constexpr std::array<double, 4> kFour{60.0, 135.0, -135.0, -60.0};
  constexpr std::array<double, 3> kThree{60.0, 180.0, -60.0};
  return wheel_count == 4 ? kFour.at(static_cast<std::size_t>(wheel)) : kThree.at(static_cast<std::size_t>(wheel));
}

/// Thermal network of the guard's observer, with kSafetyFactor on its heat.
void observer_rates(const void*, const float* signal, const float* state_C, float* rate_K_per_s) {
  const Truth truth;
  const auto current_A = static_cast<double>(signal[robot_core::guard_current_A]);
  const auto winding_C = static_cast<double>(state_C[0]);
  const auto stator_C = static_cast<double>(state_C[1]);
  const double copper_W = current_A * current_A * (resistance_at_ohm(truth, winding_C) - truth.driver_ohm);
  const double iron_W = truth.iron_W_s * std::abs(static_cast<double>(signal[robot_core::guard_speed_rad_per_s]));
  const double inward_W = (winding_C - stator_C) / truth.winding_to_stator_K_per_W;
  const double outward_W = (stator_C - static_cast<double>(signal[robot_core::guard_ambient_C])) / truth.stator_to_air_K_per_W;
  rate_K_per_s[0] = static_cast<float>((kSafetyFactor * copper_W - inward_W) / truth.winding_J_per_K);
  rate_K_per_s[1] = static_cast<float>((kSafetyFactor * iron_W + inward_W - outward_W) / truth.stator_J_per_K);
}

/// Axes, table, and candidate values of signals that are implausible.
struct GuardData {
  std::array<float, kSpeeds> speed_rad_per_s{0.0F, 300.0F, 600.0F, 900.0F};
  std::array<float, kStators> stator_C{25.0F, 50.0F, 75.0F, 100.0F, 115.0F, 130.0F, 145.0F, 155.0F};
  std::array<float, kWindings> winding_C{25.0F, 50.0F, 75.0F, 100.0F, 115.0F, 130.0F, 140.0F, 147.0F, 151.0F, 153.0F, 155.0F, 156.0F};
  std::array<float, kSpeeds * kStators * kWindings> square_A2{};
  std::array<float, 2> possible_current_A{static_cast<float>(-kMostCurrent_A), static_cast<float>(kMostCurrent_A)};
  std::array<float, 2> possible_speed_rad_per_s{0.0F, 900.0F};
  std::array<float, 1> possible_ambient_C{static_cast<float>(kHottestAir_C)};
  GuardModel model;

  GuardData() {
    float* at = square_A2.data();
    for (const float speed : speed_rad_per_s) {
      for (const float stator : stator_C) {
        for (const float winding : winding_C) {
          const auto allowed_A =
              static_cast<float>(formula_current_A(static_cast<double>(speed), static_cast<double>(stator), static_cast<double>(winding)));
          *at++ = allowed_A * allowed_A;
        }
      }
    }
    model.node_count = 2;
    model.winding_limit_C = static_cast<float>(kWindingLimit_C);
    model.coldest_ambient_C = static_cast<float>(kColdest_C);
    model.hottest_ambient_C = static_cast<float>(kHottestAir_C);
    model.most_current_A = static_cast<float>(kMostCurrent_A);
    model.heat_ratio = static_cast<float>(kSafetyFactor);
    // No law makes heat without current: the nodes rest at the temperature of the air.
    std::fill_n(model.resting_C, model.node_count, static_cast<float>(kHottestAir_C) + 0.01F);
    model.cold_current_A = static_cast<float>(formula_current_A(0.0, 25.0, 25.0));
    model.table = {.speed_rad_per_s = {speed_rad_per_s.data(), kSpeeds},
                   .stator_C = {stator_C.data(), kStators},
                   .winding_C = {winding_C.data(), kWindings},
                   .heat_per_ohm_A2 = square_A2.data(),
                   .resistance_at_0C_ratio = 1.0F,
                   .resistance_ratio_per_K = 0.0F,
                   .most_current_A = static_cast<float>(kMostCurrent_A),
                   .straight_below_A = 0.1F,
                   .most_speed_rad_per_s = 900.0F,
                   .no_current_speed_rad_per_s = 901.0F,
                   .winding_per_stator_K = 1.0F};
    model.plausible_range[robot_core::guard_current_A] = {true, -30.0F, 30.0F, possible_current_A.data(), 2};
    model.plausible_range[robot_core::guard_speed_rad_per_s] = {true, -900.0F, 900.0F, possible_speed_rad_per_s.data(), 2};
    model.plausible_range[robot_core::guard_ambient_C] = {true, static_cast<float>(kColdest_C), static_cast<float>(kHottestAir_C),
                                                          possible_ambient_C.data(), 1};
    model.rates = observer_rates;
  }
};

/// Calculates the columns of (AᵀA)⁻¹Aᵀ by Cramer's rule, where A has the rows t_x, t_y, R.
void set_inverse(Config& config) {
  double n[3][3] = {};
  const auto row_of = [&](int i) {
    return std::array<double, 3>{static_cast<double>(config.wheel[i].rolling_x_share), static_cast<double>(config.wheel[i].rolling_y_share),
                                 static_cast<double>(config.contact_radius_m)};
  };
  for (int i = 0; i < config.wheel_count; ++i) {
    const auto row = row_of(i);
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        n[a][b] += row[a] * row[b];
      }
    }
  }
  const auto cofactor = [&](int a, int b) {
    const int c = (a + 1) % 3, d = (a + 2) % 3, e = (b + 1) % 3, f = (b + 2) % 3;
    return n[c][e] * n[d][f] - n[c][f] * n[d][e];
  };
  const double determinant = n[0][0] * cofactor(0, 0) + n[0][1] * cofactor(0, 1) + n[0][2] * cofactor(0, 2);
  for (int i = 0; i < config.wheel_count; ++i) {
    const auto row = row_of(i);
    const auto column = [&](int a) {
      return static_cast<float>((cofactor(a, 0) * row[0] + cofactor(a, 1) * row[1] + cofactor(a, 2) * row[2]) / determinant);
    };
    config.wheel[i].inverse_x_factor = column(0);
    config.wheel[i].inverse_y_factor = column(1);
    config.wheel[i].inverse_yaw_per_m = column(2);
  }
}

void set_control(Config& config) {
  config.body_gain_per_s = 4.0F;
  config.yaw_gain_per_s = 8.0F;
  config.yaw_integral_per_s2 = 20.0F;
  config.wheel_gain_V_s_per_rad = 0.05F;
  config.wheel_integral_V_per_rad = 0.5F;
  config.speed_limit_m_per_s = 3.0F;
  config.yaw_rate_limit_rad_per_s = 8.0F;
  config.acceleration_limit_m_per_s2 = 3.5F;
  config.yaw_acceleration_limit_rad_per_s2 = 40.0F;
  config.jerk_limit_m_per_s3 = 20.0F;
  config.traction_ratio = 0.75F;
  config.command_timeout_s = 0.2F;
  config.braking_reserve_K = 2.0F;
  config.limp_current_A = 1.5F;
}

double sign_of(double x, double width) { return x / std::sqrt(x * x + width * width); }

}  // namespace

std::uint64_t Random::bits() {
  state_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31U);
}

float Random::between(float low, float high) { return low + (high - low) * static_cast<float>(bits() >> 40U) * 0x1p-24F; }

float Random::any_float() { return std::bit_cast<float>(static_cast<std::uint32_t>(bits() >> 32U)); }

const robot_core::Vector3& ChangingVelocity::next(Random& random) {
  if (--periods_left_ <= 0) {
    velocity_ = {random.between(-2.0F, 2.0F), random.between(-2.0F, 2.0F), random.between(-5.0F, 5.0F)};
    periods_left_ = 200 + random.below(600);
  }
  return velocity_;
}

int mirror_of(int wheel_count, int wheel) { return wheel_count - 1 - wheel; }

double formula_current_A(double speed_rad_per_s, double stator_C, double winding_C) {
  constexpr double kHorizon_s = 2.0;
  const Truth truth;
  const double hot_ohm = resistance_at_ohm(truth, kWindingLimit_C) - truth.driver_ohm;
  const double stored_W = truth.winding_J_per_K * (kWindingLimit_C - winding_C) / kHorizon_s;
  const double passed_W = std::max(0.0, winding_C - stator_C) / truth.winding_to_stator_K_per_W;
  const double heat_W = (stored_W + passed_W) / kSafetyFactor - truth.iron_W_s * std::abs(speed_rad_per_s);
  return winding_C > kWindingLimit_C ? 0.0 : std::min(kMostCurrent_A, std::sqrt(std::max(0.0, heat_W) / hot_ohm));
}

SteadyState steady_state(const Truth& truth, double copper_W, double iron_W) {
  const double stator_C = truth.air_C + truth.stator_to_air_K_per_W * (copper_W + iron_W);
  return {stator_C + truth.winding_to_stator_K_per_W * copper_W, stator_C};
}

Config make_config(int wheel_count, bool has_guard) {
  static const GuardData guard;
  const Truth truth;
  Config config;
  config.wheel_count = wheel_count;
  config.wheel_radius_m = 0.028F;
  config.contact_radius_m = 0.08F;
  config.mass_kg = 2.6F;
  config.yaw_inertia_kg_m2 = 0.011F;
  config.wheel_inertia_kg_m2 = 23e-6F;
  config.torque_constant_Nm_per_A = static_cast<float>(kGeared_V_s_per_rad / kGear_ratio);
  config.resistance_ohm = static_cast<float>(resistance_at_ohm(truth, 25.0));
  config.resistance_rise_per_K = static_cast<float>(kCopperRise_per_K * truth.winding_ohm / resistance_at_ohm(truth, 25.0));
  config.lowest_resistance_ohm =
      static_cast<float>(kLowestResistance_ratio * (resistance_at_ohm(truth, kColdest_C) - truth.driver_ohm) + truth.driver_ohm);
  config.gear_ratio = static_cast<float>(kGear_ratio);
  config.gear_efficiency = 0.9F;
  config.fastest_wheel_rad_per_s = static_cast<float>(kFastest_rad_per_s);
  config.largest_acceleration_rad_per_s2 = 19000.0F;
  config.battery_full_V = 25.2F;
  config.battery_lowest_V = 18.0F;
  config.battery_resistance_ohm = 0.04F;
  config.voltage_limit_V = 12.5F;
  config.current_limit_A = 12.0F;
  set_control(config);
  for (int i = 0; i < wheel_count; ++i) {
    const double axle_rad = axle_deg(wheel_count, i) * std::numbers::pi / 180.0;
    config.wheel[i].rolling_x_share = static_cast<float>(-std::sin(axle_rad));
    config.wheel[i].rolling_y_share = static_cast<float>(std::cos(axle_rad));
    config.wheel[i].level_load_share = 1.0F / static_cast<float>(wheel_count);
    config.wheel[i].damping_V_s_per_rad = static_cast<float>(kGeared_V_s_per_rad + truth.viscous_Nm_s / kGeared_V_s_per_rad);
  }
  set_inverse(config);
  config.guard = has_guard ? &guard.model : nullptr;
  config.plan_step = robot_core::plan_to_pose;
  config.predict_pose = robot_core::predict_pose;
  robot_core::complete(config);
  return config;
}

double Plant::rolling_speed_rad_per_s(int i) const {
  const robot_core::WheelConfig& wheel = config_.wheel[i];
  return (static_cast<double>(wheel.rolling_x_share) * velocity_[0] + static_cast<double>(wheel.rolling_y_share) * velocity_[1] +
          static_cast<double>(config_.contact_radius_m) * velocity_[2]) /
         static_cast<double>(config_.wheel_radius_m);
}

double Plant::resistance_ohm(int i) const { return resistance_at_ohm(truth_, winding_C_[i]); }

double Plant::coldest_current_A(const robot_core::Output& output, int i) const {
  const double voltage_V = static_cast<double>(output.pwm_ratio[i]) * battery_V_;
  return output.is_open[i] ? 0.0 : (voltage_V - kGeared_V_s_per_rad * speed_[i]) / static_cast<double>(config_.lowest_resistance_ohm);
}

double Plant::true_current_A(const robot_core::Output& output, int i) const {
  return coldest_current_A(output, i) * static_cast<double>(config_.lowest_resistance_ohm) / resistance_ohm(i);
}

double Plant::contact_change_rad_per_s() const {
  const double grip_N = truth_.grip_ratio * static_cast<double>(config_.mass_kg) * kGravity_m_per_s2 / config_.wheel_count;
  return grip_N * static_cast<double>(config_.wheel_radius_m) / static_cast<double>(config_.wheel_inertia_kg_m2) *
         static_cast<double>(config_.period_s);
}

/// Implicit in the wheel's speed: J·(ω' − ω)/h = K·I(ω') − friction − r·F(ω'). F is proportional to the slip up to the grip.
void Plant::turn_wheels(const robot_core::Output& output, double period_s, double* force_N) {
  const double radius_m = static_cast<double>(config_.wheel_radius_m);
  const double inertia_kg_m2 = static_cast<double>(config_.wheel_inertia_kg_m2);
  const double grip_N = truth_.grip_ratio * static_cast<double>(config_.mass_kg) * kGravity_m_per_s2 / config_.wheel_count;
  const double stiffness_N_s_per_m = grip_N / truth_.creep_m_per_s;
  for (int i = 0; i < config_.wheel_count; ++i) {
    const double rolling_m_per_s = rolling_speed_rad_per_s(i) * radius_m;
    const double voltage_V = static_cast<double>(output.pwm_ratio[i]) * battery_V_;
    const double now_A = output.is_open[i] ? 0.0 : (voltage_V - kGeared_V_s_per_rad * speed_[i]) / resistance_ohm(i);
    const double efficiency = static_cast<double>(config_.gear_efficiency);
    const double torque_constant = kGeared_V_s_per_rad * (now_A * speed_[i] >= 0.0 ? efficiency : 1.0 / efficiency);
    const double per_ohm = output.is_open[i] ? 0.0 : 1.0 / resistance_ohm(i);
    const double damping = torque_constant * kGeared_V_s_per_rad * per_ohm + truth_.viscous_Nm_s;
    const double torque_Nm = torque_constant * voltage_V * per_ohm - truth_.bearing_Nm * sign_of(speed_[i], 1.0);
    const double per_h = inertia_kg_m2 / period_s;
    const auto next = [&](double contact_N, double contact_N_s_per_m) {
      return (per_h * speed_[i] + torque_Nm - radius_m * contact_N) / (per_h + damping + radius_m * radius_m * contact_N_s_per_m);
    };
    double next_rad_per_s = next(-stiffness_N_s_per_m * rolling_m_per_s, stiffness_N_s_per_m);
    force_N[i] = stiffness_N_s_per_m * (radius_m * next_rad_per_s - rolling_m_per_s);
    if (std::abs(force_N[i]) > grip_N) {
      force_N[i] = std::copysign(grip_N, force_N[i]);
      next_rad_per_s = next(force_N[i], 0.0);
    }
    current_A_[i] += output.is_open[i] ? 0.0 : (voltage_V - kGeared_V_s_per_rad * next_rad_per_s) * per_ohm;
    speed_[i] = next_rad_per_s;
  }
}

void Plant::move(const robot_core::Output& output) {
  constexpr int kParts = 2;
  const double period_s = static_cast<double>(config_.period_s) / kParts;
  std::ranges::fill(current_A_, 0.0);
  for (int part = 0; part < kParts; ++part) {
    double force_N[kMostWheels] = {};
    const double before_A[kMostWheels] = {current_A_[0], current_A_[1], current_A_[2], current_A_[3]};
    turn_wheels(output, period_s, force_N);
    double x_N = push_[0], y_N = push_[1], moment_Nm = push_[2], battery_A = 0.0;
    for (int i = 0; i < config_.wheel_count; ++i) {
      x_N += static_cast<double>(config_.wheel[i].rolling_x_share) * force_N[i];
      y_N += static_cast<double>(config_.wheel[i].rolling_y_share) * force_N[i];
      moment_Nm += static_cast<double>(config_.contact_radius_m) * force_N[i];
      battery_A += static_cast<double>(output.pwm_ratio[i]) * (current_A_[i] - before_A[i]);
    }
    const double speed_m_per_s = std::hypot(velocity_[0], velocity_[1]);
    const double drag = truth_.drag_N / std::hypot(speed_m_per_s, 0.02);
    const double mass_kg = static_cast<double>(config_.mass_kg);
    const double rate_x = (x_N - drag * velocity_[0]) / mass_kg + velocity_[2] * velocity_[1];
    const double rate_y = (y_N - drag * velocity_[1]) / mass_kg - velocity_[2] * velocity_[0];
    velocity_[0] += period_s * rate_x;
    velocity_[1] += period_s * rate_y;
    velocity_[2] += period_s * moment_Nm / static_cast<double>(config_.yaw_inertia_kg_m2);
    pose_[0] += period_s * (std::cos(pose_[2]) * velocity_[0] - std::sin(pose_[2]) * velocity_[1]);
    pose_[1] += period_s * (std::sin(pose_[2]) * velocity_[0] + std::cos(pose_[2]) * velocity_[1]);
    pose_[2] += period_s * velocity_[2];
    battery_V_ = truth_.battery_V - static_cast<double>(config_.battery_resistance_ohm) * battery_A;
  }
  for (double& current : current_A_) {
    current /= kParts;
  }
  heat(static_cast<double>(config_.period_s));
}

void Plant::heat(double period_s) {
  for (int i = 0; i < config_.wheel_count; ++i) {
    const double copper_W = current_A_[i] * current_A_[i] * (resistance_ohm(i) - truth_.driver_ohm);
    const double iron_W = truth_.iron_W_s * std::abs(speed_[i]) * kGear_ratio;
    const double inward_W = (winding_C_[i] - stator_C_[i]) / truth_.winding_to_stator_K_per_W;
    const double outward_W = (stator_C_[i] - truth_.air_C) / truth_.stator_to_air_K_per_W;
    winding_C_[i] += period_s * (copper_W - inward_W) / truth_.winding_J_per_K;
    stator_C_[i] += period_s * (iron_W + inward_W - outward_W) / truth_.stator_J_per_K;
  }
}

robot_core::Input Plant::sense(Random& random, float noise_rad_per_s, bool are_currents_fitted) const {
  robot_core::Input input;
  for (int i = 0; i < config_.wheel_count; ++i) {
    input.wheel_speed_rad_per_s[i] = static_cast<float>(speed_[i]) + random.between(-noise_rad_per_s, noise_rad_per_s);
    if (are_currents_fitted) {
      input.motor_current_A[i] = static_cast<float>(current_A_[i]) + random.between(-0.05F, 0.05F);
    }
    input.stator_C[i] = static_cast<float>(stator_C_[i]);
  }
  input.battery_V = static_cast<float>(battery_V_);
  input.yaw_rate_rad_per_s = static_cast<float>(velocity_[2]) + random.between(-0.02F, 0.02F);
  input.ambient_C = static_cast<float>(truth_.air_C);
  input.pose = {static_cast<float>(pose_[0]), static_cast<float>(pose_[1]), static_cast<float>(pose_[2])};
  input.elapsed_s = config_.period_s;
  return input;
}

void Plant::warm_up(double body_C) {
  std::ranges::fill(winding_C_, body_C);
  std::ranges::fill(stator_C_, body_C);
}

void Plant::set_velocity(double x_m_per_s, double y_m_per_s, double yaw_rad_per_s) {
  velocity_[0] = x_m_per_s;
  velocity_[1] = y_m_per_s;
  velocity_[2] = yaw_rad_per_s;
  for (int i = 0; i < config_.wheel_count; ++i) {
    speed_[i] = rolling_speed_rad_per_s(i);
  }
}

void seal(robot_core::State& state) { state.check_sum = robot_core::check_sum_of(state); }

}  // namespace heatsoak::test_robot
