#include "robot_core/drive_core.h"

#include "robot_core/drive_stages.h"

namespace robot_core {
namespace {

// Makes a state of zeros invalid.
constexpr std::uint64_t kSeed = 0x9E3779B97F4A7C15U;

}  // namespace

[[gnu::noinline]] std::uint64_t check_sum_of(const State& state) {
  static_assert(__builtin_offsetof(State, comparison) % sizeof(std::uint64_t) == 0);
  return check_sum_of_words<1, __builtin_offsetof(State, comparison) / sizeof(std::uint64_t)>(&state, kSeed);
}

namespace {

[[gnu::cold]] void reset(const Config& config, State& state, float body_C) {
  state = {};
  const GuardModel* const model = config.guard;
  for (int i = 0; i < config.wheel_count; ++i) {
    WheelState& wheel = state.wheel[i];
    wheel.conductance_A_per_V = config.derived.per_resistance_A_per_V;
    wheel.allowed_A = wheel.allowed_braking_A = std::numeric_limits<float>::max();
    if (model == nullptr) {
      continue;
    }
    start_guard(*model, state.guard[i], body_C);
    const float start_C = state.guard[i].state_C[0];
    const bool is_at_limit = !(start_C < model->winding_limit_C);
    wheel.guard_fault = is_at_limit ? static_cast<std::uint8_t>(Reason::guard_unknown) : 0;
    // Until the guard's first step, use the table at standstill.
    wheel.allowed_A = wheel.allowed_braking_A = allowed_current_A(*model, 0.0F, start_C, start_C + config.braking_reserve_K);
    // Spreads the guard steps of the wheels over the guard period.
    const int periods = static_cast<int>(model->period_s / config.period_s + 0.5F);
    wheel.guard_clock = static_cast<std::uint16_t>(-i * periods / config.wheel_count);
  }
  state.next_guard = static_cast<std::uint8_t>(config.wheel_count - 1);
  seal(state.comparison);
}

/// Starts with an accepted Config.
[[gnu::cold, gnu::noinline]] void begin(const Config& config, State& state, float body_C) {
  reset(config, state, body_C);
  state.is_valid = kStarted;
  state.check_sum = check_sum_of(state);
}

/// Opens all bridges. The temperatures are those with which the guards start; 0 without a start.
[[gnu::cold]] void open_all(const State& state, Reason reason, Output& out) {
  out = {};
  out.robot_reason = reason;
  out.is_warning = true;
  for (int i = 0; i < kMostWheels; ++i) {
    out.reason[i] = reason;
    out.winding_C[i] = state.guard[i].state_C[0];
  }
}

}  // namespace

[[gnu::cold]] bool start(const Config& config, State& state, const StartUp& start_up) {
  state = {};
  const bool is_valid = is_possible(config) && config.check_sum == config_check_sum(config);
  if (!is_valid) {
    state.check_sum = check_sum_of(state);
    return false;
  }
  begin(config, state, start_up.is_rested ? start_up.body_C : kNoSample);
  return true;
}

namespace {

/// Runs stages 2 to 4 and stores their result for the next period.
BodyReference find_references(const Config& config, State& state, const Input& input, const Validated& validated, WheelReferences& wheels,
                              WheelVoltages& voltage) {
  const BodyReference body = control_body_velocity(config, state, input, validated);
  if (body.is_open && !body.is_wheelwise) {
    for (int i = 0; i < config.wheel_count; ++i) {  // no motion is commanded
      wheels.wheel[i].speed_rad_per_s = 0.0F;
      voltage.wheel[i].feed_forward_V = 0.0F;
    }
  } else {
    find_wheel_speeds(config, input, body, wheels);
    feed_forward(config, input, validated, body, wheels, voltage);
  }
  HeldReference& held = state.held;
#pragma GCC unroll 4
  for (int i = 0; i < config.wheel_count; ++i) {
    held.speed_rad_per_s[i] = wheels.wheel[i].speed_rad_per_s;
    held.feed_forward_V[i] = voltage.wheel[i].feed_forward_V;
  }
  return body;
}

/// Reuses the result of stages 2 to 4 of the last period.
void hold_references(const Config& config, State& state, const Validated& validated, WheelReferences& wheels, WheelVoltages& voltage) {
  HeldReference& held = state.held;
  state.is_held_fresh = 0;
  held.since_s += validated.elapsed_s;
#pragma GCC unroll 4
  for (int i = 0; i < config.wheel_count; ++i) {
    wheels.wheel[i].speed_rad_per_s = held.speed_rad_per_s[i];
    voltage.wheel[i].feed_forward_V = held.feed_forward_V[i];
  }
}

/// Runs stages 5 to 7.
void control_wheels(const Config& config, State& state, const Validated& validated, const BodyReference& body,
                    const WheelReferences& wheels, WheelVoltages& voltage, Output& out) {
  control_wheel_speeds(config, state, validated, wheels, voltage);
  const LimitedVoltages limited = apply_limits(config, state, validated, body, voltage);
  make_output(config, state, validated, limited, out);
}

/// The reference of a body velocity changes slowly compared with the wheel loops, so it serves two periods. A change of mode or a fault of
/// the robot takes effect at once.
void step_valid(const Config& config, State& state, const Input& input, Output& out) {
  const Validated validated = validate_input(config, state, input);
  run_guards(config, state, input, validated);
  WheelReferences wheels;
  WheelVoltages voltage;
  const bool is_body_velocity =
      (validated.mode == Mode::body_velocity || validated.mode == Mode::brake) && validated.robot_fault == Reason::none;
  if (is_body_velocity && state.is_held_fresh != 0) {
    static constexpr BodyReference kBodyVelocity;
    hold_references(config, state, validated, wheels, voltage);
    control_wheels(config, state, validated, kBodyVelocity, wheels, voltage, out);
  } else {
    const BodyReference body = find_references(config, state, input, validated, wheels, voltage);
    state.is_held_fresh = is_body_velocity ? 1 : 0;
    control_wheels(config, state, validated, body, wheels, voltage, out);
  }
  ++state.steps;
  state.check_sum = check_sum_of(state);
}

/// Restarts a State with flipped bits; the known faults are kept. Memory that was never started stays invalid, because only start() has the
/// time to check the Config.
[[gnu::cold, gnu::noinline]] void restart(const Config& config, State& state) {
  const ComparisonState known = state.comparison;
  const std::uint32_t flips = state.is_valid ^ kStarted;
  if ((flips & (flips - 1)) != 0) {
    state = {};
    return;
  }
  begin(config, state, kNoSample);
  recall_faults(known, state);
  state.battery_source_V = config.battery_full_V;
  state.check_sum = check_sum_of(state);
}

}  // namespace

void step(const Config& config, State& state, const Input& input, Output& out) {
  const bool is_corrupted = state.check_sum != check_sum_of(state);
  if (is_corrupted) {
    restart(config, state);
  }
  if (is_corrupted) {
    // The restart takes as long as a step.
    open_all(state, Reason::state_corrupted, out);
  } else if (state.is_valid != kStarted) {
    open_all(state, Reason::config_invalid, out);
  } else {
    step_valid(config, state, input, out);
  }
}

Output step(const Config& config, State& state, const Input& input) {
  Output out;
  step(config, state, input, out);
  return out;
}

}  // namespace robot_core
