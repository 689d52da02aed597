// Thermal guards of the wheels. Each is stepped once per guard period, at different times, so that no control step runs all of them.
#include "robot_core/drive_stages.h"

// For size: each guard runs once in its own period.
#pragma GCC optimize("Os")

namespace robot_core {
namespace {

// A guard that started at its limit counts as known when it allows this share of the cold motor's current, or the driver's limit.
constexpr float kKnown_share = 0.8F;

int periods_per_guard_step(const Config& config) { return static_cast<int>(config.guard->period_s / config.period_s + 0.5F); }

/// Highest temperature of the other wheels' motors, without their windings.
float hottest_neighbour_C(const Config& config, const State& state, int of) {
  float hottest_C = config.guard->coldest_ambient_C;
  for (int i = 0; i < config.wheel_count; ++i) {
    for (int node = 1; node < config.guard->node_count && i != of; ++node) {
      hottest_C = larger(hottest_C, state.guard[i].state_C[node]);
    }
  }
  return hottest_C;
}

/// Ratio of the current with the lowest resistance to the current of a motor as hot as its observer. Voltage limits assume the lowest
/// resistance, but the guard limits heat, so its allowed current is multiplied by this ratio. A colder motor carries more current, but its
/// heat is the squared voltage over its resistance: it stays colder than the observer.
float cold_current_ratio(const Config& config, float winding_C) {
  constexpr float kReference_C = 25.0F;
  const float warm_K = larger(0.0F, winding_C - kReference_C);
  return larger(1.0F,
                config.resistance_ohm * (1.0F + config.resistance_rise_per_K * warm_K) * config.derived.per_lowest_resistance_A_per_V);
}

/// Reciprocal of the nominal motor's terminal resistance at its winding temperature. That temperature follows from the observer's, which
/// counts heat_ratio times the heat. Without an air temperature the coldest air is assumed, which gives the larger current.
float nominal_conductance_A_per_V(const Config& config, const GuardState& guard, float ambient_C) {
  constexpr float kReference_C = 25.0F;
  const GuardModel& model = *config.guard;
  const float air_C = ambient_C == ambient_C ? ambient_C : model.coldest_ambient_C;
  const float observed_K = guard.state_C[0] - air_C;
  // In steady state at one current both rises are proportional to the heat and to 1 + α·rise.
  const float feedback = config.resistance_rise_per_K * observed_K * (model.heat_ratio - 1.0F);
  const float warm_K = air_C + observed_K / (model.heat_ratio + feedback) - kReference_C;
  return config.derived.per_resistance_A_per_V / (1.0F + config.resistance_rise_per_K * warm_K);
}

/// Square of the current that the guard takes for one with the given square: an implausible current is replaced.
float plausible_square_A2(const GuardModel& model, float square_A2) {
  const PlausibleRange& range = model.plausible_range[guard_current_A];
  return range.is_used && square_A2 > range.most * range.most ? range.possible[0] * range.possible[0] : square_A2;
}

/// Current for an unknown speed: the limp current, but no more than the table allows at any of its speeds.
[[gnu::cold]] float limp_current_A(const Config& config, const GuardOutput& guard) {
  const GuardModel& model = *config.guard;
  float least_A = config.limp_current_A;
  for (int i = model.table.speed_rad_per_s.count; i-- > 0;) {
    const float speed_rad_per_s = model.table.speed_rad_per_s.points[i];
    const float allowed_A = allowed_current_A(model, speed_rad_per_s, guard.hottest_body_C, guard.winding_C + config.braking_reserve_K);
    least_A = smaller(least_A, allowed_A);
  }
  return least_A;
}

/// Steps the guard of one wheel. `periods`: number of periods in the sums of squares. `extra_s`: as in GuardPeriod.
void step_wheel_guard(const Config& config, State& state, const Validated& validated, int i, float periods, float extra_s) {
  WheelState& wheel = state.wheel[i];
  const GuardModel& model = *config.guard;
  const ValidatedWheel& sensed = validated.wheel[i];
  // Periods are rounded up for heat, but a guard must not cool for longer than the time that has passed.
  GuardPeriod time{extra_s, 1.0F, state.rounded_up};
  if (const std::uint32_t more = state.rounded_up - state.guard[i].rounded_up; more != 0) {
    time.cooling_share = larger(0.0F, 1.0F - static_cast<float>(more) / (kPeriodParts_ratio * periods));
  }
  // A current sensor that reads too low hides heat long before it contradicts the motor equation. The mean over this time is longer than
  // the delays of samples and voltages.
  constexpr float kHidden_s = 0.25F;
  const float square_per_ohm2 = wheel.conductance_A_per_V * wheel.conductance_A_per_V;
  const float counted_A2 = wheel.current_squared_A2 / periods;
  const float hidden_A2 = square_per_ohm2 * wheel.driven_squared_V2 / periods - plausible_square_A2(model, counted_A2);
  time.hidden_A2 = state.guard[i].hidden_A2;
  time.hidden_A2 += smaller(1.0F, periods * config.period_s / kHidden_s) * (hidden_A2 - time.hidden_A2);
  float square_A2 = counted_A2 + larger(0.0F, time.hidden_A2);
  // Without a spare sensor the limits keep the limp current for every speed that the wheel may have.
  if (!validated.is_checked && !sensed.is_current_sensed && wheel.driven_squared_V2 > 0.0F) {
    square_A2 = larger(square_A2, config.limp_current_A * config.limp_current_A);
  }
  const float rms_A = square_root(square_A2);
  const float speed_rad_per_s = sensed.speed_rad_per_s * config.gear_ratio;
  // Laws that depend on a signal without a sample use the value that heats most.
  float signal[kGuardSignals];
  for (float& each : signal) {
    each = kNoSample;
  }
  signal[guard_current_A] = sensed.current_A < 0.0F ? -rms_A : rms_A;
  // Without a speed the current is the limp current, which is safe at every speed.
  if (sensed.is_speed_known) {
    signal[guard_speed_rad_per_s] = speed_rad_per_s;
  }
  signal[guard_ambient_C] = validated.ambient_C;
  signal[guard_neighbour_C] = model.plausible_range[guard_neighbour_C].is_used ? hottest_neighbour_C(config, state, i) : 0.0F;
  signal[guard_acceleration_rad_per_s2] = absolute(speed_rad_per_s - state.guard[i].speed_rad_per_s) / model.period_s;
  const GuardOutput guard = step_guard(model, state.guard[i], signal, config.braking_reserve_K, time);
  wheel.conductance_A_per_V = nominal_conductance_A_per_V(config, state.guard[i], validated.ambient_C);
  const float cold_ratio = cold_current_ratio(config, guard.winding_C);
  if (sensed.is_speed_known) {
    wheel.allowed_A = cold_ratio * guard.allowed_A;
    wheel.allowed_braking_A = cold_ratio * guard.allowed_braking_A;
  } else {
    wheel.allowed_A = wheel.allowed_braking_A = limp_current_A(config, guard);
  }
  if (!guard.was_started) {
    wheel.guard_fault = static_cast<std::uint8_t>(Reason::guard_unknown);
  } else if (wheel.guard_fault == static_cast<std::uint8_t>(Reason::guard_unknown) &&
             guard.allowed_A >= smaller(config.current_limit_A, kKnown_share * model.cold_current_A)) {
    wheel.guard_fault = 0;
  }
}

/// Follows a stator sample that is hotter than the observer, by a bounded rise, so that a single wrong sample does not count. A colder one
/// is ignored.
void take_stator_sample(const GuardModel& model, State& state, const Input& input, int i) {
  WheelState& wheel = state.wheel[i];
  const float sample_C = input.stator_C[i];
  if (sample_C > -50.0F && sample_C < 400.0F) {
    wheel.has_stator = 1;
    if (GuardState& guard = state.guard[i]; sample_C > guard.state_C[1] && is_started(model, guard)) {
      constexpr float kMostRise_K_per_s = 20.0F;
      guard.state_C[1] = smaller(sample_C, guard.state_C[1] + kMostRise_K_per_s * model.period_s);
      seal(guard);
    }
    wheel.guard_fault = wheel.guard_fault == static_cast<std::uint8_t>(Reason::stator_missing) ? 0 : wheel.guard_fault;
  } else if (wheel.has_stator != 0 && wheel.guard_fault == 0) {
    wheel.guard_fault = static_cast<std::uint8_t>(Reason::stator_missing);
  }
}

/// A guard counts a gap in its next step, because its limit holds until then anyway. Without a valid time the gap is as long as the
/// watchdog lets it be, unless the bridge was open.
[[gnu::cold]] void note_gap(const Config& config, State& state, const Validated& validated) {
  const bool is_jump = validated.robot_fault == Reason::time_jump;
  for (int i = 0; i < config.wheel_count; ++i) {
    if (is_jump || state.wheel[i].is_open == 0) {
      add_gap(state.guard[i], is_jump ? validated.elapsed_s : kWatchdog_s);
    }
  }
}

/// Steps the guard of a wheel whose guard period has passed. A surplus of one period, from waiting, is kept for the next step, so that the
/// guards stay apart. More, after late steps, is counted at once.
void run_due_guard(const Config& config, State& state, const Input& input, const Validated& validated, int i, int waited, int periods) {
  WheelState& wheel = state.wheel[i];
  const int late = waited - periods;
  const auto steps = static_cast<float>(waited);
  take_stator_sample(*config.guard, state, input, i);
  step_wheel_guard(config, state, validated, i, steps, late > 1 ? static_cast<float>(late) * config.period_s : 0.0F);
  wheel.guard_clock = static_cast<std::uint16_t>(state.guard_clock - (late == 1 ? 1 : 0));
  const float kept_share = late == 1 ? 1.0F / steps : 0.0F;
  wheel.current_squared_A2 *= kept_share;
  wheel.driven_squared_V2 *= kept_share;
}

/// Counts the currents for the periods by which a step is late.
[[gnu::cold, gnu::noinline]] void count_late_periods(const Config& config, State& state, const Validated& validated) {
  const auto more = static_cast<float>(validated.guard_periods - 1);
  for (int i = 0; i < config.wheel_count; ++i) {
    WheelState& wheel = state.wheel[i];
    wheel.current_squared_A2 += more * validated.wheel[i].current_A * validated.wheel[i].current_A;
    if (wheel.is_open == 0) {
      const float driven_V = wheel.voltage_V - config.derived.geared_constant_V_s_per_rad * validated.wheel[i].speed_rad_per_s;
      wheel.driven_squared_V2 += more * driven_V * driven_V;
    }
  }
}

}  // namespace

void run_guards(const Config& config, State& state, const Input& input, const Validated& validated) {
  if (config.guard == nullptr) {
    return;
  }
  if (validated.guard_periods != 1) {
    count_late_periods(config, state, validated);
  }
  const int periods = periods_per_guard_step(config);
#pragma GCC unroll 4
  for (int i = 0; i < config.wheel_count; ++i) {
    const float current_A = validated.wheel[i].current_A;
    state.wheel[i].current_squared_A2 += current_A * current_A;
  }
  state.guard_clock = static_cast<std::uint16_t>(state.guard_clock + validated.guard_periods);
  if (validated.robot_fault == Reason::time_jump || validated.robot_fault == Reason::period_invalid) {
    note_gap(config, state, validated);
  }
  // A step runs one guard, a comparison of sensors or an estimate, because together they would take too long. Guards with a period too
  // short for that run at once.
  constexpr std::uint32_t kPeriodsPerEstimate = 32;
  const bool is_short = periods < config.wheel_count;
  bool has_run = false;
  for (int left = is_short ? config.wheel_count : 1; left > 0; --left) {
    const int i = state.next_guard;
    const int waited = static_cast<std::uint16_t>(state.guard_clock - state.wheel[i].guard_clock);
    if (waited < periods || (validated.were_sensors_compared && !is_short)) {
      break;
    }
    state.next_guard = static_cast<std::uint8_t>(i == 0 ? config.wheel_count - 1 : i - 1);
    run_due_guard(config, state, input, validated, i, waited, periods);
    has_run = true;
  }
  if (!has_run && state.steps % kPeriodsPerEstimate == 1) {
    const std::uint32_t turn = state.steps / kPeriodsPerEstimate % static_cast<std::uint32_t>(config.wheel_count);
    estimate_time_to_limit(*config.guard, state.guard[turn], config.braking_reserve_K);
  }
}

}  // namespace robot_core
