#include "robot_core/guard_memory.h"

#include "robot_core/drive_stages.h"

// Optimised for size; runs at power-off and at the start.
#pragma GCC optimize("Os")

namespace robot_core {
namespace {

constexpr float kStep_share = 0.2F;
constexpr float kVeryLong_s = 1e9F;
constexpr float kUnknown_s = -1.0F;

/// Signals during power-off: no current, speed or airflow. Unknown temperatures take their highest safe value, rates that of any age.
void signals_without_power(const GuardModel& model, float* signal) {
  for (int i = 0; i < kGuardSignals; ++i) {
    signal[i] = 0.0F;
  }
  signal[guard_ambient_C] = model.hottest_ambient_C;
  signal[guard_neighbour_C] = model.winding_limit_C;
}

/// Returns a fifth of the shortest time constant. No rate exceeds the largest row sum of the derivatives (Gershgorin).
float cooling_step_s(const GuardModel& model, float* signal, const float* state_C) {
  float moved_C[kMostGuardNodes];
  float rate_K_per_s[kMostGuardNodes];
  float moved_K_per_s[kMostGuardNodes];
  float sum_per_s[kMostGuardNodes] = {};
  rates_of_any_age(model, signal, state_C, rate_K_per_s);
  for (int node = 0; node < model.node_count; ++node) {
    moved_C[node] = state_C[node];
  }
  for (int from = 0; from < model.node_count; ++from) {
    moved_C[from] += 1.0F;
    rates_of_any_age(model, signal, moved_C, moved_K_per_s);
    moved_C[from] -= 1.0F;
    for (int node = 0; node < model.node_count; ++node) {
      sum_per_s[node] += absolute(moved_K_per_s[node] - rate_K_per_s[node]);
    }
  }
  float fastest_per_s = 0.0F;
  for (int node = 0; node < model.node_count; ++node) {
    fastest_per_s = larger(fastest_per_s, sum_per_s[node]);
  }
  return fastest_per_s > 0.0F ? kStep_share / fastest_per_s : model.period_s;
}

/// One step of the classical method of Runge and Kutta. Raises `peak_C` to the highest temperature of each node during the step; between
/// its ends a node that first warms and then cools follows a parabola.
void cool_for(const GuardModel& model, float* signal, float step_s, float* state_C, float* carry_K, float* peak_C) {
  float rate_K_per_s[4][kMostGuardNodes];
  float ahead_C[kMostGuardNodes];
  rates_of_any_age(model, signal, state_C, rate_K_per_s[0]);
  for (int stage = 1; stage < 4; ++stage) {
    const float ahead_s = stage == 3 ? step_s : 0.5F * step_s;
    for (int node = 0; node < model.node_count; ++node) {
      ahead_C[node] = state_C[node] + ahead_s * rate_K_per_s[stage - 1][node];
    }
    rates_of_any_age(model, signal, ahead_C, rate_K_per_s[stage]);
  }
  for (int node = 0; node < model.node_count; ++node) {
    const float first = rate_K_per_s[0][node];
    const float last = rate_K_per_s[3][node];
    const float mean = (first + 2.0F * (rate_K_per_s[1][node] + rate_K_per_s[2][node]) + last) * (1.0F / 6.0F);
    const float change_K = step_s * mean - carry_K[node];
    const float next_C = state_C[node] + change_K;
    carry_K[node] = (next_C - state_C[node]) - change_K;
    state_C[node] = next_C;
    peak_C[node] = larger(peak_C[node], first > 0.0F && last < 0.0F ? next_C + 0.5F * step_s * last * last / (first - last) : next_C);
  }
}

/// Cools the nodes for a time; for an unknown one (negative) each node takes the highest temperature that it can have had. After
/// kMostCoolingSteps steps each node is at most as far above its resting temperature as the node that is farthest above.
void cool_guard(const GuardModel& model, float elapsed_s, float* state_C) {
  const bool is_known = elapsed_s >= 0.0F;
  float signal[kGuardSignals];
  signals_without_power(model, signal);
  float longest_s = 0.0F;
  float carry_K[kMostGuardNodes] = {};
  float peak_C[kMostGuardNodes];
  for (int node = 0; node < model.node_count; ++node) {
    peak_C[node] = state_C[node];
  }
  float left_s = is_known ? elapsed_s : kVeryLong_s;
  for (int step = 0; step < kMostCoolingSteps && left_s > 0.0F; ++step) {
    // The time constants may change while the motor cools.
    longest_s = step % 4 == 0 ? cooling_step_s(model, signal, state_C) : longest_s;
    const float step_s = smaller(left_s, longest_s);
    cool_for(model, signal, step_s, state_C, carry_K, peak_C);
    left_s -= step_s;
  }
  float above_K = 0.0F;
  for (int node = 0; node < model.node_count; ++node) {
    above_K = larger(above_K, state_C[node] - model.resting_C[node]);
  }
  for (int node = 0; node < model.node_count; ++node) {
    const float later_C = left_s > 0.0F ? model.resting_C[node] + above_K : state_C[node];
    state_C[node] = is_known ? later_C : larger(later_C, peak_C[node]);
  }
}

}  // namespace

Restored restore_guard(const GuardModel& model, GuardState& state, const GuardState& saved, float elapsed_s, float board_C) {
  if (!is_started(model, saved)) {
    start_guard(model, state, model.winding_limit_C);
    return Restored::nothing;
  }
  // A clock that divides by zero gives an infinite time.
  const float known_s = elapsed_s < kVeryLong_s ? elapsed_s : kUnknown_s;
  const bool has_board = board_C >= model.coldest_ambient_C - 1.0F && board_C <= 1000.0F;
  const float least_C = has_board ? board_C : model.hottest_ambient_C;
  float state_C[kMostGuardNodes] = {};
  for (int node = 0; node < model.node_count; ++node) {
    state_C[node] = saved.state_C[node];
  }
  cool_guard(model, known_s, state_C);
  start_guard(model, state, model.winding_limit_C);
  for (int node = 0; node < model.node_count; ++node) {
    state.state_C[node] = larger(state_C[node], least_C);
  }
  set_gap(state, gap_s(saved));
  state.hidden_A2 = saved.hidden_A2;
  seal(state);
  return known_s >= 0.0F ? Restored::cooled : Restored::time_unknown;
}

namespace {

/// Periods of current that the guard of a wheel had not counted yet when the copy was made. A guard waits at most for two guard periods.
int waiting_periods(const State& saved, int i) { return static_cast<std::uint16_t>(saved.guard_clock - saved.wheel[i].guard_clock); }
float longest_wait_s(const Config& config) { return 2.0F * config.guard->period_s + 0.5F * config.period_s; }

/// Copy of a guard, or an empty one if the copy cannot be trusted: other layout, or firmware that restarted before any guard had its turn.
GuardState copy_of(const Config& config, const State& saved, int i) {
  const bool has_waited_long = static_cast<float>(waiting_periods(saved, i)) * config.period_s > longest_wait_s(config);
  const bool is_trusted = saved.is_valid == kStarted && !(has_waited_long && saved.check_sum == check_sum_of(saved));
  return is_trusted ? saved.guard[i] : GuardState{};
}

/// Continues the guard's unfinished period. Since the copy was made, the last voltage may have acted until the watchdog opened the bridge.
void continue_period(const Config& config, const State& saved, float elapsed_s, State& state, int i) {
  const float since_s = elapsed_s >= 0.0F ? smaller(kWatchdog_s, elapsed_s + config.period_s) : kWatchdog_s;
  if (saved.check_sum != check_sum_of(saved)) {
    add_gap(state.guard[i], since_s + longest_wait_s(config));
    return;
  }
  WheelState& wheel = state.wheel[i];
  const WheelState& before = saved.wheel[i];
  wheel.current_squared_A2 = before.current_squared_A2;
  wheel.driven_squared_V2 = before.driven_squared_V2;
  wheel.guard_clock = static_cast<std::uint16_t>(state.guard_clock - waiting_periods(saved, i));
  state.next_guard = saved.next_guard;
  if (before.is_open == 0) {
    add_gap(state.guard[i], since_s);
  }
}

}  // namespace

bool restore(const Config& config, State& state, const State& saved, float elapsed_s, float board_C) {
  const bool was_valid = state.check_sum == check_sum_of(state);
  if (saved.is_valid == kStarted && recall_sensors(saved.comparison, state)) {
    note_faults(state);
  }
  bool are_all = config.guard != nullptr;
  for (int i = 0; i < config.wheel_count && config.guard != nullptr; ++i) {
    WheelState& wheel = state.wheel[i];
    GuardState& guard = state.guard[i];
    if (restore_guard(*config.guard, guard, copy_of(config, saved, i), elapsed_s, board_C) == Restored::nothing) {
      are_all = false;
      wheel.guard_fault = static_cast<std::uint8_t>(Reason::guard_unknown);
    } else {
      continue_period(config, saved, elapsed_s, state, i);
      wheel.guard_fault = 0;
    }
    float body_C = guard.state_C[1];
    for (int node = 2; node < config.guard->node_count; ++node) {
      body_C = larger(body_C, guard.state_C[node]);
    }
    wheel.allowed_A = wheel.allowed_braking_A = allowed_current_A(*config.guard, 0.0F, body_C, guard.state_C[0] + config.braking_reserve_K);
  }
  if (was_valid) {  // else the next step reports the damage
    state.check_sum = check_sum_of(state);
  }
  return are_all;
}

}  // namespace robot_core
