// Stage 1: decides which samples are accepted, and replaces the others.
#include "robot_core/drive_stages.h"

// Optimised for size, which is also faster here: less of the seldom needed code is inlined.
#pragma GCC optimize("Os")

namespace robot_core {
namespace {

constexpr float kFastestYaw_rad_per_s = 60.0F;
constexpr float kYawJump_rad_per_s = 10.0F;
constexpr float kHottestAir_C = 120.0F;
constexpr int kMostSameSteps = 60000;
// A sample of a wheel with fault 117 agrees with the rest up to this rim speed plus kSlipAndNoise_share.
constexpr float kAgrees_m_per_s = 0.08F;
constexpr float kDead_s = 1.0F;  // a rejected sample that is constant for this time is not the correct one

constexpr std::uint8_t code(Reason reason) { return static_cast<std::uint8_t>(reason); }

void validate_time(const Config& config, State& state, const Input& input, Validated& validated) {
  validated.elapsed_s = config.period_s;
  validated.guard_periods = 1;
  const float elapsed_s = input.elapsed_s;
  constexpr float kShortest_share = 0.5F;
  const float longest_s = kLongestGap_periods * config.period_s;
  // A tenth of a period is jitter of the timer.
  constexpr float kJitter_share = 0.1F;
  // Comparisons with NaN are false.
  if (elapsed_s >= (1.0F - kJitter_share) * config.period_s && elapsed_s <= config.period_s) {
    return;
  }
  if (elapsed_s >= kShortest_share * config.period_s && elapsed_s <= longest_s) {
    // Rounded up, so that no integration covers too short a time. The guards then cool for less.
    const float periods = elapsed_s / config.period_s;
    validated.guard_periods = static_cast<int>(clamped(periods + (1.0F - kJitter_share), 1.0F, kLongestGap_periods));
    const auto whole = static_cast<float>(validated.guard_periods);
    validated.elapsed_s = whole * config.period_s;
    if (periods < whole) {
      state.rounded_up += 1U + static_cast<std::uint32_t>(kPeriodParts_ratio * (whole - periods));
    }
    // A loop that is always slightly late would otherwise lose that share of its heat.
    if (periods > whole) {
      state.late_periods += periods - whole;
      if (state.late_periods >= 1.0F) {
        state.late_periods -= 1.0F;
        ++validated.guard_periods;
      }
    }
  } else if (elapsed_s > longest_s && is_finite(elapsed_s)) {
    validated.robot_fault = Reason::time_jump;
    validated.elapsed_s = elapsed_s;
  } else {
    validated.robot_fault = Reason::period_invalid;
  }
}

// No plausible command is larger, and products of such numbers stay finite.
constexpr float kMostCommand = 1e6F;

/// Sum of magnitudes; NaN if a component is NaN.
[[gnu::always_inline]] inline float sum(const Vector3& v) { return absolute(v.x) + absolute(v.y) + absolute(v.yaw); }

bool has_finite_values(const Config& config, const Command& command) {
  float all = 0.0F;
  switch (command.mode) {
    case Mode::coast:
    case Mode::brake:
      return true;
    case Mode::body_velocity:
      return sum(command.velocity) + sum(command.acceleration) + sum(command.push) <= kMostCommand;
    case Mode::pose_target:
      return sum(command.pose) <= kMostCommand;
    case Mode::wheel_speed:
      for (int i = 0; i < config.wheel_count; ++i) {
        all += absolute(command.wheel_speed_rad_per_s[i]);
      }
      return all <= kMostCommand;
    case Mode::wheel_torque:
      for (int i = 0; i < config.wheel_count; ++i) {
        all += absolute(command.wheel_torque_Nm[i]);
      }
      return all <= kMostCommand;
  }
  return false;
}

/// False if the age is not a number or negative.
bool is_fresh(const Config& config, float age_s) { return age_s >= 0.0F && age_s <= config.command_timeout_s; }

void validate_command(const Config& config, const Input& input, Validated& validated) {
  validated.mode = input.command.mode;
  if (!has_finite_values(config, input.command)) {
    validated.command_fault = Reason::command_invalid;
  } else if (!is_fresh(config, input.command_age_s)) {
    validated.command_fault = Reason::command_stale;
  } else if (input.command.mode == Mode::pose_target &&
             (config.plan_step == nullptr || !(sum(input.pose) <= kMostCommand) || !is_fresh(config, input.pose_age_s))) {
    validated.command_fault = Reason::pose_invalid;
  }
  if (validated.command_fault != Reason::none) {
    validated.mode = Mode::coast;
  }
}

/// Finds the battery voltage for the limits, where a low value is safe, and for the PWM ratio, where a high value is safe. A sample below
/// the voltage that the known load explains is no fault: a kicker may charge. The limits use it; the PWM ratio uses earlier samples.
void validate_battery(const Config& config, State& state, const Input& input, Validated& validated) {
  const float sample_V = input.battery_V;
  const float sag_V = config.battery_resistance_ohm * larger(0.0F, state.battery_current_A);
  constexpr float kSag_ratio = 1.5F;         // allows for an aged battery and its recovery after a load
  constexpr float kTolerance_share = 0.03F;  // share of the full battery: noise
  constexpr float kFall_share_per_s = 0.004F;
  constexpr float kRise_s = 0.05F;
  constexpr std::uint32_t kFirstSteps = 20;
  const float shown_V = state.battery_source_V;
  const float least_V = shown_V - kSag_ratio * sag_V;
  // A faulty timer must not discharge the battery estimate.
  const float since_s = smaller(validated.elapsed_s, kLongestGap_periods * config.period_s);
  state.battery_source_V = larger(0.0F, shown_V - kFall_share_per_s * config.battery_full_V * since_s);
  if (!(sample_V >= 0.5F * config.battery_lowest_V && sample_V <= 1.1F * config.battery_full_V)) {
    validated.battery_V = config.battery_lowest_V;
    validated.pwm_battery_V = 1.1F * config.battery_full_V;
    if (state.steps < kFirstSteps) {
      state.battery_source_V = config.battery_full_V;
    }
    validated.robot_fault = validated.robot_fault == Reason::none ? Reason::battery_voltage_missing : validated.robot_fault;
    return;
  }
  validated.battery_V = sample_V;
  if (sample_V >= least_V - kTolerance_share * config.battery_full_V) {
    if (state.steps < kFirstSteps) {
      // The first samples are no evidence yet of a battery that is not full.
      state.battery_source_V = larger(shown_V, smaller(sample_V, config.battery_full_V));
      validated.pwm_battery_V = config.battery_full_V;
    } else {
      const float source_V = smaller(sample_V + sag_V, config.battery_full_V);
      state.battery_source_V += smaller(1.0F, since_s / kRise_s) * larger(0.0F, source_V - state.battery_source_V);
      validated.pwm_battery_V = larger(sample_V, least_V);
    }
  } else {
    // Braking motors may charge the battery by up to the tolerance.
    validated.pwm_battery_V = smaller(shown_V, config.battery_full_V) + kTolerance_share * config.battery_full_V;
  }
}

/// Validates the air temperature. A sample below the last one is followed slowly, in case the sensor has come off. One above it is followed
/// faster than air warms up, so that a single wrong sample does not count.
void validate_ambient(const Config& config, State& state, const Input& input, Validated& validated) {
  constexpr float kCooling_K_per_s = 0.02F;
  constexpr float kMostRise_K = 0.01F;  // per step
  const float coldest_C = config.guard != nullptr ? config.guard->coldest_ambient_C : -40.0F;
  // A dead sensor shows exactly 0.
  const bool is_plausible = input.ambient_C >= coldest_C + 0.05F && input.ambient_C <= kHottestAir_C;
  validated.ambient_C = kNoSample;
  if (is_plausible) {
    if (input.ambient_C != state.ambient_C) {
      const float least_C = state.ambient_C - kCooling_K_per_s * config.period_s;
      const float most_C = state.ambient_C + kMostRise_K;
      const float sample_C = most_C < input.ambient_C ? most_C : input.ambient_C;
      state.ambient_C = least_C > sample_C ? least_C : sample_C;
    }
    validated.ambient_C = state.ambient_C;
  } else if (state.ambient_C == state.ambient_C && validated.robot_fault == Reason::none) {
    validated.robot_fault = Reason::ambient_missing;
  }
}

/// Least squares of the body's velocity over some wheels: Σ t·tᵀ·v = Σ t·(r·ω/slip − R·yaw rate).
struct PlaneFit {
  float xx = 0.0F;
  float xy = 0.0F;
  float yy = 0.0F;
  float x_m_per_s = 0.0F;  ///< sums; after solve() the velocity
  float y_m_per_s = 0.0F;
  float determinant = 0.0F;
  bool is_known = false;  ///< after solve(): true if the wheels determine both directions

  void add(const WheelConfig& wheel, float rim_m_per_s) {
    const float t_x = wheel.rolling_x_share;
    const float t_y = wheel.rolling_y_share;
    xx += t_x * t_x;
    xy += t_x * t_y;
    yy += t_y * t_y;
    x_m_per_s += t_x * rim_m_per_s;
    y_m_per_s += t_y * rim_m_per_s;
  }
  void solve() {
    determinant = xx * yy - xy * xy;
    is_known = determinant > kLeastDeterminant;
    if (is_known) {
      const float inverse = 1.0F / determinant;
      const float x = (x_m_per_s * yy - y_m_per_s * xy) * inverse;
      y_m_per_s = (y_m_per_s * xx - x_m_per_s * xy) * inverse;
      x_m_per_s = x;
    }
  }
  float rim_of(const WheelConfig& wheel) const { return wheel.rolling_x_share * x_m_per_s + wheel.rolling_y_share * y_m_per_s; }
  /// Sets `rim_m_per_s` of a wheel of the fit to the speed that the others imply: its residual grows by 1/(1 − leverage), as in
  /// find_from_all(). They may not determine it: then it stays.
  void leave_out(const WheelConfig& wheel, float& rim_m_per_s) const {
    const float t_x = wheel.rolling_x_share;
    const float t_y = wheel.rolling_y_share;
    const float of_others = determinant - (yy * t_x * t_x - 2.0F * xy * t_x * t_y + xx * t_y * t_y);
    if (of_others > kLeastDeterminant) {
      rim_m_per_s -= (rim_m_per_s - rim_of(wheel)) * determinant / of_others;
    }
  }

 private:
  static constexpr float kLeastDeterminant = 0.02F;  // two wheels whose rolling directions are 8 degrees apart
};

/// All sensors are accepted: least squares with a constant matrix.
void find_from_all(const Config& config, Validated& validated) {
  const DerivedConfig& derived = config.derived;
  const float turning_m_per_s = config.contact_radius_m * validated.velocity.yaw;
  PerWheel& rim_m_per_s = validated.rim_m_per_s;
  float x_m_per_s = 0.0F;
  float y_m_per_s = 0.0F;
#pragma GCC unroll 4
  for (int i = 0; i < config.wheel_count; ++i) {
    rim_m_per_s[i] = rim_speed_m_per_s(config, i, validated.wheel[i].speed_rad_per_s) - turning_m_per_s;
    x_m_per_s += config.wheel[i].rolling_x_share * rim_m_per_s[i];
    y_m_per_s += config.wheel[i].rolling_y_share * rim_m_per_s[i];
  }
  validated.velocity.x = derived.plane_xx_factor * x_m_per_s + derived.plane_xy_factor * y_m_per_s;
  validated.velocity.y = derived.plane_xy_factor * x_m_per_s + derived.plane_yy_factor * y_m_per_s;
  float disagreement_m_per_s = 0.0F;
#pragma GCC unroll 4
  for (int i = 0; i < config.wheel_count; ++i) {
    const float residual_m_per_s =
        rim_m_per_s[i] - config.wheel[i].rolling_x_share * validated.velocity.x - config.wheel[i].rolling_y_share * validated.velocity.y;
    ValidatedWheel& found = validated.wheel[i];
    found.is_speed_known = true;
    // Leaving one wheel out multiplies its residual by 1/(1 − leverage) (Belsley, Kuh and Welsch, Regression Diagnostics, 1980, eq. 2.8).
    found.implied_rad_per_s = found.speed_rad_per_s - residual_m_per_s * config.wheel[i].others_rad_per_m;
    disagreement_m_per_s += absolute(residual_m_per_s);
  }
  validated.spread_V = derived.spread_V_s_per_m * disagreement_m_per_s;
}

/// Fits the velocity of the body to the accepted samples, or to all, and finds the speed that the others imply for each of them. Writes
/// their rim speeds without the rotation, NaN for the other samples.
[[gnu::noinline]] void imply_from(const Config& config, const State& state, Validated& validated, bool are_all, PlaneFit& found) {
  const float turning_m_per_s = config.contact_radius_m * validated.velocity.yaw;
  const int count = config.wheel_count;
  PerWheel& rim_m_per_s = validated.rim_m_per_s;
  PlaneFit fit;
  for (int i = 0; i < count; ++i) {
    float own_m_per_s = kNoSample;
    if (are_all || validated.wheel[i].is_speed_sensed) {
      own_m_per_s = rim_speed_m_per_s(config, i, state.wheel[i].raw_speed_rad_per_s) - turning_m_per_s;
      fit.add(config.wheel[i], own_m_per_s);
    }
    rim_m_per_s[i] = own_m_per_s;
  }
  fit.solve();
  found = fit;
  for (int i = 0; i < count; ++i) {
    float implied_m_per_s = rim_m_per_s[i];
    if (implied_m_per_s == implied_m_per_s) {  // not NaN
      if (fit.is_known) {
        fit.leave_out(config.wheel[i], implied_m_per_s);
      }
      validated.wheel[i].implied_rad_per_s = (implied_m_per_s + turning_m_per_s) * config.wheel[i].speed_per_rim_per_m;
    }
  }
}

/// Returns true if a rejected sample may be the correct one. This is possible only without a spare sensor, in two cases: fault 111 to 113
/// of a wheel without current sensor whose sample does not stay constant; or fault 117 of two wheels that still contradict the rest. Two
/// wrong sensors can outvote the others; if only one is wrong, the other wheel soon agrees with the rest again.
bool is_rejection_doubtful(const Config& config, const State& state, const Validated& validated) {
  bool is_doubtful = false;
  int wrong = 0;
  if (!validated.is_checked) {
    for (int i = 0; i < config.wheel_count; ++i) {
      const WheelState& wheel = state.wheel[i];
      if (wheel.speed_fault == code(Reason::wheel_speed_wrong)) {
        const float implied_rad_per_s = validated.wheel[i].speed_rad_per_s;
        const float agrees_rad_per_s =
            kAgrees_m_per_s * config.wheel[i].speed_per_rim_per_m + kSlipAndNoise_share * absolute(implied_rad_per_s);
        wrong += absolute(wheel.raw_speed_rad_per_s - implied_rad_per_s) > agrees_rad_per_s ? 1 : 0;
      }
      is_doubtful |= wheel.speed_fault >= code(Reason::wheel_speed_jump) && wheel.speed_fault <= code(Reason::wheel_speed_swapped) &&
                     wheel.has_current == 0 && static_cast<float>(wheel.same_steps) * config.period_s < kDead_s;
    }
  }
  return is_doubtful || wrong > 1;
}

/// Calculates speeds and body velocity from the remaining sensors if some are missing.
[[gnu::cold]] void find_from_some(const Config& config, const State& state, Validated& validated) {
  const float turning_m_per_s = config.contact_radius_m * validated.velocity.yaw;
  PlaneFit fit;
  imply_from(config, state, validated, false, fit);
  const bool is_known = fit.is_known;
  if (!is_known) {
    fit.x_m_per_s = state.velocity_reference.x;
    fit.y_m_per_s = state.velocity_reference.y;
  }
  validated.velocity.x = fit.x_m_per_s;
  validated.velocity.y = fit.y_m_per_s;
  float disagreement_m_per_s = 0.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    const WheelConfig& wheel = config.wheel[i];
    ValidatedWheel& found = validated.wheel[i];
    if (found.is_speed_sensed) {
      disagreement_m_per_s += absolute(validated.rim_m_per_s[i] - fit.rim_of(wheel));
      found.is_speed_known = true;
      continue;
    }
    found.speed_rad_per_s = (fit.rim_of(wheel) + turning_m_per_s) * wheel.speed_per_rim_per_m;
    found.is_speed_known = is_known;
    if (state.yaw_fault != 0) {
      // Without the gyro three wheels still determine the fourth, but two do not determine a third.
      const SpeedRange range = speed_range(config, state, validated, i);
      found.is_speed_known = is_known && range.is_known();
      found.speed_rad_per_s = range.slowest_rad_per_s;
    }
    found.speed_rad_per_s = found.is_speed_known ? found.speed_rad_per_s : 0.0F;
    found.implied_rad_per_s = found.speed_rad_per_s;
  }
  validated.spread_V = config.derived.spread_V_s_per_m * disagreement_m_per_s;
  // If too few sensors are left, every sample is compared with all others, even with rejected ones. Sensors that were lost together and
  // agree with each other again are so accepted again.
  validated.are_samples_compared = !is_known || is_rejection_doubtful(config, state, validated);
  if (validated.are_samples_compared) {
    PlaneFit all;
    imply_from(config, state, validated, true, all);
  }
}

void validate_yaw_rate(const Config& config, State& state, const Input& input, Validated& validated) {
  const float sample = input.yaw_rate_rad_per_s;
  const bool is_possible = absolute(sample) <= kFastestYaw_rad_per_s;  // false for NaN
  const bool is_jump = absolute(sample - state.raw_yaw_rate_rad_per_s) > kYawJump_rad_per_s && state.steps != 0;
  if (!is_possible || is_jump) {
    state.yaw_fault = code(Reason::yaw_rate_missing);
    state.was_yaw_implausible = 1;
    note_faults(state);
  }
  state.is_yaw_same = sample == state.raw_yaw_rate_rad_per_s ? 1 : 0;
  state.raw_yaw_rate_rad_per_s = is_possible ? sample : 0.0F;
  validated.velocity.yaw = state.raw_yaw_rate_rad_per_s;
  if (state.yaw_fault != 0) {
    const float from_wheels = yaw_rate_of_wheels(config, validated);
    validated.velocity.yaw =
        validated.are_all_sensed ? clamped(from_wheels, -kFastestYaw_rad_per_s, kFastestYaw_rad_per_s) : state.velocity_reference.yaw;
    validated.robot_fault = validated.robot_fault == Reason::none ? static_cast<Reason>(state.yaw_fault) : validated.robot_fault;
  }
}

[[gnu::always_inline]] inline void count_same(WheelState& wheel, float change_rad_per_s) {
  const int same = change_rad_per_s == 0.0F ? wheel.same_steps + 1 : 0;
  wheel.same_steps = static_cast<std::uint16_t>(same < kMostSameSteps ? same : kMostSameSteps);
}

/// Handles a sample that is implausible (NaN, out of range, a jump) or from a sensor with a fault.
[[gnu::cold, gnu::noinline]] void take_doubtful_sample(const Config& config, WheelState& wheel, float sample, float jump_rad_per_s,
                                                       ValidatedWheel& validated) {
  const float change_rad_per_s = sample - wheel.raw_speed_rad_per_s;
  count_same(wheel, change_rad_per_s);
  const bool is_possible = absolute(sample) <= config.fastest_wheel_rad_per_s;  // false for NaN
  wheel.raw_speed_rad_per_s = is_possible ? sample : 0.0F;
  const bool is_jump = !(absolute(change_rad_per_s) <= jump_rad_per_s);
  if (!is_possible || is_jump) {
    wheel.was_implausible = 1;
    // Without a jump a sample too large is no disturbance, but a wrong scale.
    const Reason fault = !is_jump ? Reason::wheel_speed_wrong : is_possible ? Reason::wheel_speed_jump : Reason::wheel_speed_missing;
    wheel.speed_fault = wheel.speed_fault == 0 ? code(fault) : wheel.speed_fault;
  }
  validated.is_speed_sensed = wheel.speed_fault == 0;
  validated.speed_rad_per_s = validated.is_speed_sensed ? sample : 0.0F;
}

void take_samples(const Config& config, State& state, const Input& input, Validated& validated) {
  const float most_rad_per_s = config.fastest_wheel_rad_per_s;
  float jump_rad_per_s = config.derived.jump_rad_per_s;
  if (state.steps == 0) {
    jump_rad_per_s = 2.0F * most_rad_per_s;  // there is no earlier sample to compare with
  } else if (validated.robot_fault != Reason::time_jump) {
    // A gap explains no jump: it may be the timer's fault, and a robot that rolls needs a tenth of a second for such a change.
    jump_rad_per_s += config.largest_acceleration_rad_per_s2 * (validated.elapsed_s - config.period_s);
  }
  validated.are_all_sensed = true;
  bool are_faults_new = false;
#pragma GCC unroll 4
  for (int i = 0; i < config.wheel_count; ++i) {
    WheelState& wheel = state.wheel[i];
    const float sample = input.wheel_speed_rad_per_s[i];
    const float change_rad_per_s = sample - wheel.raw_speed_rad_per_s;
    const bool is_plain = absolute(sample) <= most_rad_per_s && absolute(change_rad_per_s) <= jump_rad_per_s;
    if (!is_plain || wheel.speed_fault != 0) {
      take_doubtful_sample(config, wheel, sample, jump_rad_per_s, validated.wheel[i]);
      are_faults_new = are_faults_new || wheel.speed_fault != state.comparison.speed_fault[i];
      validated.are_all_sensed = validated.are_all_sensed && validated.wheel[i].is_speed_sensed;
      continue;
    }
    count_same(wheel, change_rad_per_s);
    wheel.raw_speed_rad_per_s = sample;
    validated.wheel[i].is_speed_sensed = true;
    validated.wheel[i].speed_rad_per_s = sample;
  }
  if (are_faults_new) {
    note_faults(state);
  }
}

/// Current that the last voltage drives through the nominal motor, for a wheel without a current sensor. With another resistance the heat
/// differs as much as with a sensed current, in the opposite sense, so the safety factor on heat covers it. A wrong wheel speed would hide
/// heat, so the speed that the other wheels imply counts if it gives more.
float estimated_current_A(const Config& config, const WheelState& wheel, const ValidatedWheel& validated) {
  if (wheel.is_open != 0) {
    return 0.0F;
  }
  const float own_V = wheel.voltage_V - config.derived.geared_constant_V_s_per_rad * validated.speed_rad_per_s;
  const float implied_V = wheel.voltage_V - config.derived.geared_constant_V_s_per_rad * validated.implied_rad_per_s;
  return (absolute(implied_V) > absolute(own_V) ? implied_V : own_V) * wheel.conductance_A_per_V;
}

/// Handles a missing sample, or one of a sensor that contradicts voltage and speed.
[[gnu::noinline]] void estimate_current(const Config& config, WheelState& wheel, float sample_A, bool is_sample,
                                        ValidatedWheel& validated) {
  const float estimate_A = estimated_current_A(config, wheel, validated);
  validated.is_current_sensed = false;
  validated.current_A = estimate_A;
  wheel.current_fault = code(wheel.has_current != 0 ? Reason::current_missing : Reason::none);
  if (is_sample) {
    wheel.current_fault = code(Reason::current_implausible);
    wheel.has_current = 1;
    // A distrusted sensor can still open the bridge.
    validated.is_current_sensed = is_overcurrent(config, wheel, sample_A);
    validated.current_A = absolute(sample_A) > absolute(estimate_A) ? sample_A : estimate_A;
  }
}

void validate_currents(const Config& config, State& state, const Input& input, Validated& validated) {
  const float most_A = config.derived.most_sensed_A;
#pragma GCC unroll 4
  for (int i = 0; i < config.wheel_count; ++i) {
    WheelState& wheel = state.wheel[i];
    const float sample_A = input.motor_current_A[i];
    const bool is_sample = absolute(sample_A) <= most_A;  // false for NaN
    if (!is_sample || wheel.is_current_distrusted != 0) {
      estimate_current(config, wheel, sample_A, is_sample, validated.wheel[i]);
      continue;
    }
    wheel.has_current = 1;
    wheel.current_fault = 0;
    validated.wheel[i].is_current_sensed = true;
    validated.wheel[i].current_A = sample_A;
  }
}

}  // namespace

Validated validate_input(const Config& config, State& state, const Input& input) {
  Validated validated;
  validate_time(config, state, input, validated);
  validate_command(config, input, validated);
  validate_battery(config, state, input, validated);
  validate_ambient(config, state, input, validated);
  take_samples(config, state, input, validated);
  validate_yaw_rate(config, state, input, validated);
  if (validated.are_all_sensed) {
    find_from_all(config, validated);
  }
  if (!validated.are_all_sensed || state.yaw_fault != 0 || config.wheel_count < kMostWheels) {
    check_redundancy(config, state, validated);
    if (!validated.are_all_sensed) {
      find_from_some(config, state, validated);
    }
    if (validated.are_samples_compared) {
      validated.spread_V = std::numeric_limits<float>::infinity();
    } else if (validated.is_any_possible) {
      widen_spread(config, validated);
    }
  }
  compare_sensors(config, state, input, validated);
  if (state.comparison.standing_s > kStanding_s) {
    validated.common_reason = Reason::wheel_speeds_dead;
    validated.is_redundancy_reduced = true;
    validated.is_checked = false;
    validated.spread_V = std::numeric_limits<float>::infinity();
  }
  if (state.comparison.runaway_s >= kRunaway_s) {
    validated.mode = Mode::coast;
    validated.robot_fault = validated.robot_fault == Reason::none ? Reason::runaway : validated.robot_fault;
  }
  validate_currents(config, state, input, validated);
  return validated;
}

}  // namespace robot_core
