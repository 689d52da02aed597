// Stage 1: which samples are believed, and what stands in for the others.
#include "robot_core/drive_stages.h"

namespace robot_core {
namespace {

// A sample that is exactly the same for so long while other evidence says that it should have changed is stuck.
constexpr float kStuck_s = 0.05F;
// Sliding contacts make wheels disagree with each other for a while; beyond this share of the fastest speed it is no sliding.
constexpr float kDisagreement_share = 0.06F;
// Time constant of the comparison of wheels with each other's voltages.
constexpr float kSwap_s = 0.3F;
constexpr std::uint32_t kStepsPerComparison = 16;
constexpr float kFastestYaw_rad_per_s = 60.0F;
constexpr float kYawJump_rad_per_s = 10.0F;
constexpr float kYawDisagreement_rad_per_s = 2.0F;
constexpr float kHottestAir_C = 120.0F;
// A winding is never this many times its coldest resistance: 2 is copper at 280 degC.
constexpr float kHotResistance_ratio = 2.0F;

constexpr std::uint8_t code(Reason reason) { return static_cast<std::uint8_t>(reason); }

void validate_time(const Config& config, const Input& input, Believed& believed) {
  believed.elapsed_periods = 1;
  believed.elapsed_s = config.period_s;
  const float elapsed_s = input.elapsed_s;
  if (elapsed_s != elapsed_s) {
    return;  // not measured
  }
  if (!is_finite(elapsed_s) || elapsed_s <= 0.0F) {
    believed.robot_fault = Reason::period_invalid;
  } else if (elapsed_s > kLongestGap_periods * config.period_s) {
    believed.robot_fault = Reason::time_jump;
    believed.elapsed_s = elapsed_s;
  } else {
    believed.elapsed_periods = static_cast<int>(clamped(elapsed_s / config.period_s + 0.5F, 1.0F, kLongestGap_periods));
    believed.elapsed_s = static_cast<float>(believed.elapsed_periods) * config.period_s;
  }
}

/// Not finite if one of the components is not.
float sum(const Vector3& v) { return v.x + v.y + v.yaw; }

bool has_finite_values(const Config& config, const Command& command) {
  float all = 0.0F;
  switch (command.mode) {
    case Mode::coast:
    case Mode::brake:
      return true;
    case Mode::body_velocity:
      return is_finite(sum(command.velocity) + sum(command.acceleration) + sum(command.push));
    case Mode::pose_target:
      return is_finite(sum(command.pose));
    case Mode::wheel_speed:
      for (int i = 0; i < config.wheel_count; ++i) {
        all += command.wheel_speed_rad_per_s[i];
      }
      return is_finite(all);
    case Mode::wheel_torque:
      for (int i = 0; i < config.wheel_count; ++i) {
        all += command.wheel_torque_Nm[i];
      }
      return is_finite(all);
  }
  return false;
}

void validate_command(const Config& config, const Input& input, Believed& believed) {
  believed.mode = input.command.mode;
  if (!has_finite_values(config, input.command)) {
    believed.command_fault = Reason::command_invalid;
  } else if (!(input.command_age_s >= 0.0F && input.command_age_s <= config.command_timeout_s)) {
    believed.command_fault = Reason::command_stale;
  } else if (input.command.mode == Mode::pose_target && (config.plan_step == nullptr || !is_finite(sum(input.pose)))) {
    believed.command_fault = Reason::pose_invalid;
  }
  if (believed.command_fault != Reason::none && believed.mode != Mode::coast) {
    believed.mode = Mode::brake;
  }
}

void validate_battery(const Config& config, State& state, const Input& input, Believed& believed) {
  const float sample_V = input.battery_V;
  if (sample_V >= 0.5F * config.battery_lowest_V && sample_V <= 1.1F * config.battery_full_V) {
    believed.battery_V = believed.pwm_battery_V = state.battery_V = sample_V;
  } else {
    believed.battery_V = config.battery_lowest_V;
    believed.pwm_battery_V = config.battery_full_V;
    believed.robot_fault = believed.robot_fault == Reason::none ? Reason::battery_voltage_missing : believed.robot_fault;
  }
}

void validate_ambient(const Config& config, State& state, const Input& input, Believed& believed) {
  const float coldest_C = config.guard != nullptr ? config.guard->coldest_ambient_C : -40.0F;
  // A dead sensor shows just 0.
  const bool is_believed = input.ambient_C >= coldest_C + 0.05F && input.ambient_C <= kHottestAir_C;
  believed.ambient_C = is_believed ? input.ambient_C : kNoSample;
  if (is_believed) {
    state.has_ambient = 1;
  } else if (state.has_ambient != 0 && believed.robot_fault == Reason::none) {
    believed.robot_fault = Reason::ambient_missing;
  }
}

/// Normal equations of the body's velocity: Σ t·tᵀ·v = Σ t·(r·ω/slip − R·yaw rate) over the wheels that count.
struct PlaneFit {
  float xx = 0.0F;
  float xy = 0.0F;
  float yy = 0.0F;
  float x_m_per_s = 0.0F;
  float y_m_per_s = 0.0F;

  void add(const WheelConfig& wheel, float rim_m_per_s, float sign) {
    const float t_x = sign * wheel.rolling_x_share;
    const float t_y = sign * wheel.rolling_y_share;
    xx += t_x * wheel.rolling_x_share;
    xy += t_x * wheel.rolling_y_share;
    yy += t_y * wheel.rolling_y_share;
    x_m_per_s += t_x * rim_m_per_s;
    y_m_per_s += t_y * rim_m_per_s;
  }
  /// False where the wheels leave a direction open.
  bool solve(float& x, float& y) const {
    constexpr float kLeastDeterminant = 0.02F;  // two wheels whose rolling directions are 8 degrees apart
    const float determinant = xx * yy - xy * xy;
    if (!(determinant > kLeastDeterminant)) {
      return false;
    }
    const float inverse = 1.0F / determinant;
    x = (x_m_per_s * yy - y_m_per_s * xy) * inverse;
    y = (y_m_per_s * xx - x_m_per_s * xy) * inverse;
    return true;
  }
};

float rim_speed_m_per_s(const Config& config, int i, float speed_rad_per_s) { return speed_rad_per_s * config.wheel[i].rim_per_speed_m; }

/// All sensors are believed: least squares with a matrix that never changes. Leaving one wheel out multiplies its residual by
/// 1/(1 − leverage) (Belsley, Kuh and Welsch, Regression Diagnostics, 1980, equation 2.8).
void find_from_all(const Config& config, Believed& believed) {
  const DerivedConfig& derived = config.derived;
  const float turning_m_per_s = config.contact_radius_m * believed.yaw_rate_rad_per_s;
  PerWheel rim_m_per_s = {};
  float x_m_per_s = 0.0F;
  float y_m_per_s = 0.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    rim_m_per_s[i] = rim_speed_m_per_s(config, i, believed.wheel[i].speed_rad_per_s) - turning_m_per_s;
    x_m_per_s += config.wheel[i].rolling_x_share * rim_m_per_s[i];
    y_m_per_s += config.wheel[i].rolling_y_share * rim_m_per_s[i];
  }
  believed.velocity = {derived.plane_xx * x_m_per_s + derived.plane_xy * y_m_per_s,
                       derived.plane_xy * x_m_per_s + derived.plane_yy * y_m_per_s, believed.yaw_rate_rad_per_s};
  for (int i = 0; i < config.wheel_count; ++i) {
    const float residual_m_per_s =
        rim_m_per_s[i] - config.wheel[i].rolling_x_share * believed.velocity.x - config.wheel[i].rolling_y_share * believed.velocity.y;
    believed.wheel[i].implied_rad_per_s =
        believed.wheel[i].speed_rad_per_s - residual_m_per_s * config.wheel[i].others_factor * config.wheel[i].speed_per_rim_per_m;
    believed.wheel[i].is_speed_known = true;
  }
}

/// Some sensors are missing: from those that are left.
void find_from_some(const Config& config, const State& state, Believed& believed) {
  const float turning_m_per_s = config.contact_radius_m * believed.yaw_rate_rad_per_s;
  PlaneFit all;
  PerWheel rim_m_per_s = {};
  for (int i = 0; i < config.wheel_count; ++i) {
    if (believed.wheel[i].is_speed_sensed) {
      rim_m_per_s[i] = rim_speed_m_per_s(config, i, believed.wheel[i].speed_rad_per_s) - turning_m_per_s;
      all.add(config.wheel[i], rim_m_per_s[i], 1.0F);
    }
  }
  believed.velocity = state.velocity_reference;
  believed.velocity.yaw = believed.yaw_rate_rad_per_s;
  const bool is_known = all.solve(believed.velocity.x, believed.velocity.y);
  for (int i = 0; i < config.wheel_count; ++i) {
    const WheelConfig& wheel = config.wheel[i];
    Vector3 others = believed.velocity;
    bool is_implied = is_known;
    if (believed.wheel[i].is_speed_sensed) {
      PlaneFit rest = all;
      rest.add(wheel, rim_m_per_s[i], -1.0F);
      is_implied = rest.solve(others.x, others.y);
    }
    const float implied_m_per_s = wheel.rolling_x_share * others.x + wheel.rolling_y_share * others.y + turning_m_per_s;
    believed.wheel[i].implied_rad_per_s =
        is_implied ? implied_m_per_s * config.wheel[i].speed_per_rim_per_m : believed.wheel[i].speed_rad_per_s;
    believed.wheel[i].is_speed_known = believed.wheel[i].is_speed_sensed || is_implied;
    if (!believed.wheel[i].is_speed_sensed) {
      believed.wheel[i].speed_rad_per_s = is_implied ? believed.wheel[i].implied_rad_per_s : 0.0F;
    }
  }
}

/// Yaw rate that the wheels imply; only where all of them are sensed.
bool find_yaw_rate_of_wheels(const Config& config, const Believed& believed, float& yaw_rate_rad_per_s) {
  yaw_rate_rad_per_s = 0.0F;
  bool are_all_sensed = true;
  for (int i = 0; i < config.wheel_count; ++i) {
    yaw_rate_rad_per_s += config.wheel[i].inverse_yaw_per_m * rim_speed_m_per_s(config, i, believed.wheel[i].speed_rad_per_s);
    are_all_sensed = are_all_sensed && believed.wheel[i].is_speed_sensed;
  }
  return are_all_sensed;
}

/// Stuck samples, and a gyro that is believed again: once in a while, for these tests are about tens of milliseconds.
void compare_yaw_rate(const Config& config, State& state, float sample, bool is_possible, bool is_same, const Believed& believed) {
  float from_wheels = 0.0F;
  const bool is_known = find_yaw_rate_of_wheels(config, believed, from_wheels);
  const bool disagrees = is_known && absolute(sample - from_wheels) > kYawDisagreement_rad_per_s;
  const float since_s = believed.elapsed_s * static_cast<float>(kStepsPerComparison);
  state.yaw_disagreement_s = is_same && disagrees ? state.yaw_disagreement_s + since_s : 0.0F;
  state.yaw_agreement_s = is_possible && !disagrees ? state.yaw_agreement_s + since_s : 0.0F;
  if (state.yaw_disagreement_s > kStuck_s && state.yaw_fault == 0) {
    state.yaw_fault = code(Reason::yaw_rate_stuck);
  } else if (state.yaw_agreement_s >= kSteadyAgain_s) {
    state.yaw_fault = 0;
  }
}

void validate_yaw_rate(const Config& config, State& state, const Input& input, Believed& believed) {
  const float sample = input.yaw_rate_rad_per_s;
  const bool is_possible = absolute(sample) <= kFastestYaw_rad_per_s;  // false for what is no number
  const float change_rad_per_s = sample - state.raw_yaw_rate_rad_per_s;
  if (!is_possible || absolute(change_rad_per_s) > kYawJump_rad_per_s) {
    state.yaw_fault = code(Reason::yaw_rate_missing);
    state.yaw_agreement_s = 0.0F;
  }
  if (state.steps % kStepsPerComparison == 1) {
    compare_yaw_rate(config, state, sample, is_possible, change_rad_per_s == 0.0F, believed);
  }
  state.raw_yaw_rate_rad_per_s = is_possible ? sample : 0.0F;
  state.yaw_rate_rad_per_s = sample;
  if (state.yaw_fault != 0) {
    float from_wheels = 0.0F;
    const bool is_known = find_yaw_rate_of_wheels(config, believed, from_wheels);
    state.yaw_rate_rad_per_s =
        is_known ? clamped(from_wheels, -kFastestYaw_rad_per_s, kFastestYaw_rad_per_s) : state.velocity_reference.yaw;
    believed.robot_fault = believed.robot_fault == Reason::none ? static_cast<Reason>(state.yaw_fault) : believed.robot_fault;
  }
  believed.yaw_rate_rad_per_s = state.yaw_rate_rad_per_s;
}

/// Samples that speak against themselves: no number, out of range, a jump.
void take_samples(const Config& config, State& state, const Input& input, Believed& believed) {
  const float most_rad_per_s = config.fastest_wheel_rad_per_s;
  const float jump_rad_per_s =
      config.derived.jump_rad_per_s + config.largest_acceleration_rad_per_s2 * (believed.elapsed_s - config.period_s);
  believed.are_all_sensed = true;
  for (int i = 0; i < config.wheel_count; ++i) {
    WheelState& wheel = state.wheel[i];
    const float sample = input.wheel_speed_rad_per_s[i];
    const float change_rad_per_s = sample - wheel.raw_speed_rad_per_s;
    wheel.same_steps = change_rad_per_s == 0.0F ? wheel.same_steps + 1 : 0;
    const bool is_possible = absolute(sample) <= most_rad_per_s;  // false for what is no number
    wheel.raw_speed_rad_per_s = is_possible ? sample : 0.0F;
    if (!is_possible || absolute(change_rad_per_s) > jump_rad_per_s) {
      wheel.agreement_s = 0.0F;
      const Reason fault = is_possible ? Reason::wheel_speed_jump : Reason::wheel_speed_missing;
      wheel.speed_fault = wheel.speed_fault == 0 ? code(fault) : wheel.speed_fault;
    }
    believed.wheel[i].is_speed_sensed = wheel.speed_fault == 0;
    believed.wheel[i].speed_rad_per_s = believed.wheel[i].is_speed_sensed ? sample : 0.0F;
    believed.are_all_sensed = believed.are_all_sensed && believed.wheel[i].is_speed_sensed;
  }
}

/// Largest and smallest current that voltage and speed explain, whatever the winding's temperature.
struct CurrentRange {
  float low_A = 0.0F;
  float high_A = 0.0F;
};
CurrentRange explained_current(const Config& config, const WheelState& wheel, float speed_rad_per_s) {
  if (wheel.is_open != 0) {
    return {};
  }
  const float cold_A =
      (wheel.voltage_V - config.derived.geared_constant_V_s_per_rad * speed_rad_per_s) * config.derived.per_lowest_resistance_A_per_V;
  constexpr float kHot_share = 1.0F / kHotResistance_ratio;
  const float hot_A = cold_A * kHot_share;
  return {smaller(cold_A, hot_A), larger(cold_A, hot_A)};
}

/// Stuck samples, and sensors that are believed again. One wheel per step: these tests are about tens of milliseconds.
void compare_with_others(const Config& config, State& state, const Input& input, const Believed& believed, int i) {
  const float most_apart_rad_per_s = kDisagreement_share * config.fastest_wheel_rad_per_s;
  const auto stuck_steps = static_cast<std::uint32_t>(kStuck_s / config.period_s);
  const float margin_A = config.derived.current_margin_A;
  const float since_s = believed.elapsed_s * static_cast<float>(config.wheel_count);
  WheelState& wheel = state.wheel[i];
  const float sample = wheel.raw_speed_rad_per_s;
  const bool agrees = absolute(sample - believed.wheel[i].implied_rad_per_s) <= most_apart_rad_per_s;
  const float sensed_A = input.motor_current_A[i];
  const CurrentRange explained = explained_current(config, wheel, sample);
  const bool is_current = absolute(sensed_A) <= config.derived.most_sensed_A;
  const bool current_agrees = sensed_A >= explained.low_A - margin_A && sensed_A <= explained.high_A + margin_A;
  const bool current_contradicts = is_current && !current_agrees;
  // Up to kSteadyAgain_s beyond the threshold are kept, so that the sensor has to agree for that long before it is believed again.
  wheel.current_error_s = !current_contradicts ? larger(0.0F, wheel.current_error_s - since_s)
                                               : smaller(wheel.current_error_s + since_s, kStuck_s + kSteadyAgain_s);
  if (wheel.speed_fault == 0) {
    wheel.disagreement_s = !agrees || current_contradicts ? wheel.disagreement_s + since_s : 0.0F;
    if (wheel.same_steps > stuck_steps && wheel.disagreement_s > kStuck_s) {
      wheel.speed_fault = code(Reason::wheel_speed_stuck);
      wheel.agreement_s = 0.0F;
    }
  } else if (wheel.speed_fault != code(Reason::wheel_speed_swapped)) {
    wheel.agreement_s = agrees && !current_contradicts && believed.wheel[i].is_speed_known ? wheel.agreement_s + since_s : 0.0F;
    if (wheel.agreement_s >= kSteadyAgain_s && wheel.same_steps < stuck_steps) {
      wheel.speed_fault = 0;
      wheel.disagreement_s = 0.0F;
    }
  }
}

/// Swapped sensors: each wheel's sample follows the other's voltage. Leaky integrals of the distance to the speed that the own and the
/// other's voltage explain.
void compare_pairs(const Config& config, State& state, float elapsed_s) {
  const float forget = smaller(1.0F, elapsed_s / kSwap_s);
  for (int i = 0; i < config.wheel_count; ++i) {
    WheelState& wheel = state.wheel[i];
    const float explained = wheel.is_open != 0 ? 0.0F : wheel.voltage_V * config.wheel[i].per_damping_rad_per_V_s;
    wheel.modelled_rad_per_s += forget * (explained - wheel.modelled_rad_per_s);
    state.own_error_rad[i] += elapsed_s * absolute(wheel.raw_speed_rad_per_s - wheel.modelled_rad_per_s) - forget * state.own_error_rad[i];
  }
  const float least_rad = kSwap_s * kDisagreement_share * config.fastest_wheel_rad_per_s;
  int pair = 0;
  for (int i = 0; i < config.wheel_count; ++i) {
    for (int j = i + 1; j < config.wheel_count; ++j, ++pair) {
      WheelState& a = state.wheel[i];
      WheelState& b = state.wheel[j];
      state.swap_error_rad[pair] +=
          elapsed_s * (absolute(a.raw_speed_rad_per_s - b.modelled_rad_per_s) + absolute(b.raw_speed_rad_per_s - a.modelled_rad_per_s)) -
          forget * state.swap_error_rad[pair];
      constexpr float kMuchBetter_ratio = 0.3F;
      if (smaller(state.own_error_rad[i], state.own_error_rad[j]) > least_rad &&
          state.swap_error_rad[pair] < kMuchBetter_ratio * (state.own_error_rad[i] + state.own_error_rad[j])) {
        a.speed_fault = b.speed_fault = code(Reason::wheel_speed_swapped);
      }
    }
  }
}

void validate_currents(const Config& config, State& state, const Input& input, Believed& believed) {
  for (int i = 0; i < config.wheel_count; ++i) {
    WheelState& wheel = state.wheel[i];
    const float sample_A = input.motor_current_A[i];
    const bool is_sample = absolute(sample_A) <= config.derived.most_sensed_A;  // false for what is no number
    wheel.current_fault = 0;
    believed.wheel[i].is_current_sensed = is_sample && wheel.current_error_s < kStuck_s;
    believed.wheel[i].current_A = sample_A;
    if (is_sample) {
      wheel.has_current = 1;
    } else if (wheel.has_current != 0) {
      wheel.current_fault = code(Reason::current_missing);
    }
    if (!believed.wheel[i].is_current_sensed) {
      const CurrentRange explained = explained_current(config, wheel, believed.wheel[i].speed_rad_per_s);
      const float largest_A = -explained.low_A > explained.high_A ? explained.low_A : explained.high_A;
      const bool is_larger = is_sample && absolute(sample_A) > absolute(largest_A);
      believed.wheel[i].current_A = is_larger ? sample_A : largest_A;
      wheel.current_fault = is_sample ? code(Reason::current_implausible) : wheel.current_fault;
    }
  }
}

}  // namespace

Believed validate_input(const Config& config, State& state, const Input& input) {
  Believed believed;
  validate_time(config, input, believed);
  validate_command(config, input, believed);
  validate_battery(config, state, input, believed);
  validate_ambient(config, state, input, believed);
  take_samples(config, state, input, believed);
  validate_yaw_rate(config, state, input, believed);
  if (believed.are_all_sensed) {
    find_from_all(config, believed);
  } else {
    find_from_some(config, state, believed);
  }
  compare_with_others(config, state, input, believed, static_cast<int>(state.steps % static_cast<std::uint32_t>(config.wheel_count)));
  if (state.steps % kStepsPerComparison == 0) {
    compare_pairs(config, state, believed.elapsed_s * kStepsPerComparison);
  }
  validate_currents(config, state, input, believed);
  return believed;
}

}  // namespace robot_core
