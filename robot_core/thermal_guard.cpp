#include "robot_core/thermal_guard.h"

namespace robot_core {
namespace {

// Makes a state of zeros invalid.
constexpr std::uint64_t kStarted = 0x4845415453544152U;
constexpr float kMostTemperature_C = 1000.0F;
// Smoothing time of heating and load for the time until the guard limits.
constexpr float kSmoothing_s = 3.0F;
constexpr float kLongestGap_s = 1.0F;

/// Returns false for NaN.
bool is_between(float low, float x, float high) { return x >= low && x <= high; }

bool is_temperature(const GuardModel& model, float x_C) { return is_between(model.coldest_ambient_C - 1.0F, x_C, kMostTemperature_C); }

// One copy of the unrolled sum.
[[gnu::noinline]] std::uint64_t check_sum_of(const GuardState& state) {
  constexpr unsigned kWords = __builtin_offsetof(GuardState, gap_bits) / sizeof(std::uint64_t);
  static_assert(__builtin_offsetof(GuardState, gap_bits) % sizeof(std::uint64_t) == 0);
  return check_sum_of_words<1, kWords>(&state, kStarted);
}

/// Signals that were implausible, one bit each.
struct Replaced {
  unsigned all = 0;
  unsigned open = 0;  ///< those with several candidates; a single candidate is the signal's value already
};

/// Copies the signals and replaces implausible ones by a candidate value.
Replaced replace_implausible(const GuardModel& model, const float* given, float* signal) {
  Replaced replaced;
  for (int i = 0; i < kGuardSignals; ++i) {
    const PlausibleRange& plausible_range = model.plausible_range[i];
    signal[i] = given[i];
    if (!plausible_range.is_used) {
      continue;
    }
    // The sensor of a neighbour that is much colder than the air is faulty.
    const float least = i == guard_neighbour_C ? signal[guard_ambient_C] - 5.0F : plausible_range.least;
    if (!is_between(least, signal[i], plausible_range.most)) {
      signal[i] = plausible_range.possible[0];
      replaced.all |= 1U << static_cast<unsigned>(i);
      replaced.open |= plausible_range.possible_count > 1 ? 1U << static_cast<unsigned>(i) : 0U;
    }
  }
  return replaced;
}

/// Raises the rate of each node to its worst case over the candidates; the signal keeps the value that heats the winding most.
[[gnu::cold]] void take_hottest(const GuardModel& model, float* signal, int which, const float* state_C, float* most_K_per_s) {
  const PlausibleRange& plausible_range = model.plausible_range[which];
  float hottest = plausible_range.possible[0];
  float hottest_K_per_s = -1e30F;
  for (int i = 0; i < plausible_range.possible_count; ++i) {
    float rate_K_per_s[kMostGuardNodes];
    signal[which] = plausible_range.possible[i];
    model.rates(model.context, signal, state_C, rate_K_per_s);
    for (int node = 0; node < model.node_count; ++node) {
      most_K_per_s[node] = larger(most_K_per_s[node], rate_K_per_s[node]);
    }
    if (rate_K_per_s[0] > hottest_K_per_s) {
      hottest_K_per_s = rate_K_per_s[0];
      hottest = plausible_range.possible[i];
    }
  }
  signal[which] = hottest;
}

/// Uses two passes if several signals have candidates, because a signal's hottest value may depend on another signal.
[[gnu::cold, gnu::noinline]] void find_hottest_rates(const GuardModel& model, unsigned unknown, float* signal, const float* state_C,
                                                     float* rate_K_per_s) {
  const int passes = (unknown & (unknown - 1)) != 0 ? 2 : 1;
  for (int pass = 0; pass < passes; ++pass) {
    for (int i = 0; i < kGuardSignals; ++i) {
      if ((unknown & (1U << static_cast<unsigned>(i))) != 0) {
        take_hottest(model, signal, i, state_C, rate_K_per_s);
      }
    }
  }
}

}  // namespace

[[gnu::cold]] void start_guard(const GuardModel& model, GuardState& state, float body_C) {
  const float start_C = is_temperature(model, body_C) ? body_C : model.winding_limit_C;
  state = {};
  for (int node = 0; node < model.node_count; ++node) {
    state.state_C[node] = start_C;
  }
  state.time_to_limit_s = kLongTime_s;
  seal(state);
}

void seal(GuardState& state) { state.check_sum = check_sum_of(state); }

float gap_s(const GuardState& state) {
  return state.gap_complement == ~state.gap_bits ? __builtin_bit_cast(float, state.gap_bits) : std::numeric_limits<float>::infinity();
}

void set_gap(GuardState& state, float gap_s) {
  state.gap_bits = __builtin_bit_cast(std::uint32_t, gap_s);
  state.gap_complement = ~state.gap_bits;
}

[[gnu::cold]] void add_gap(GuardState& state, float added_s) {
  set_gap(state, added_s <= kLongestGap_s ? gap_s(state) + added_s : std::numeric_limits<float>::infinity());
}

bool is_started(const GuardModel& model, const GuardState& state) {
  bool started = state.check_sum == check_sum_of(state) && state.gap_complement == ~state.gap_bits;
  for (int node = 0; node < model.node_count; ++node) {
    started = started && is_temperature(model, state.state_C[node]) && is_between(-1.0F, state.carry_K[node], 1.0F);
  }
  return started;
}

namespace {

// One copy of the function for all callers.
[[gnu::noinline]] heatsoak_row row_at(const heatsoak_current_table& table, float speed_rad_per_s, float stator_C) {
  return heatsoak_find_row(&table, speed_rad_per_s, stator_C);
}

[[gnu::noinline]] float square_at_A2(const heatsoak_current_table& table, const heatsoak_row& row, float winding_C) {
  return heatsoak_allowed_A2(&table, &row, winding_C);
}

/// Temperature at which the table allows only `current_A`. The heats of the table and of that current are linear between the axis points.
[[gnu::cold]] float limiting_temperature_C(const heatsoak_current_table& table, heatsoak_row row, float current_A) {
  const heatsoak_axis& axis = table.winding_C;
  const float square_A2 = current_A * larger(current_A, table.straight_below_A);
  const float hotter_K = row.hotter_K;
  row.hotter_K = 0.0F;
  float limiting_C = axis.points[0];
  float spare_A2 = 0.0F;
  for (int i = 0; i < axis.count; ++i) {
    const float here_C = axis.points[i];
    const float here_A2 = (square_at_A2(table, row, here_C) - square_A2) * heatsoak_resistance_ratio(&table, here_C);
    if (here_A2 < 0.0F) {
      limiting_C += spare_A2 / (spare_A2 - here_A2) * (here_C - limiting_C);
      break;
    }
    limiting_C = here_C;
    spare_A2 = here_A2;
  }
  return limiting_C - hotter_K;
}

float hottest_body_C(const GuardModel& model, const GuardState& state) {
  float hottest_C = state.state_C[1];
  for (int node = 2; node < model.node_count; ++node) {
    hottest_C = larger(hottest_C, state.state_C[node]);
  }
  return hottest_C;
}

}  // namespace

[[gnu::cold]] void estimate_time_to_limit(const GuardModel& model, GuardState& state, float braking_reserve_K) {
  const heatsoak_row row = row_at(model.table, absolute(state.speed_rad_per_s), hottest_body_C(model, state));
  const float limiting_C = limiting_temperature_C(model.table, row, square_root(state.load_squared_A2)) - braking_reserve_K;
  const float room_K = limiting_C - state.state_C[0];
  constexpr float kLeastHeating_K_per_s = 0.01F;
  float time_s = room_K < 0.0F ? 0.0F : kLongTime_s;
  if (room_K >= 0.0F && state.heating_K_per_s > kLeastHeating_K_per_s) {
    time_s = smaller(room_K / state.heating_K_per_s, kLongTime_s);
  }
  // A valid check sum stays valid and a wrong one wrong.
  const bool was_valid = state.check_sum == check_sum_of(state);
  state.time_to_limit_s = time_s;
  if (was_valid) {
    seal(state);
  }
}

[[gnu::cold]] float allowed_current_A(const GuardModel& model, float speed_rad_per_s, float stator_C, float winding_C) {
  const heatsoak_row row = row_at(model.table, speed_rad_per_s, stator_C);
  return heatsoak_current_A(&model.table, &row, square_at_A2(model.table, row, winding_C));
}

[[gnu::cold, gnu::noinline]] void rates_of_any_age(const GuardModel& model, float* signal, const float* state_C, float* rate_K_per_s) {
  model.rates(model.context, signal, state_C, rate_K_per_s);
  const PlausibleRange& age = model.plausible_range[guard_age_h];
  for (int i = 0; age.is_used && i < age.possible_count; ++i) {
    float of_age_K_per_s[kMostGuardNodes];
    signal[guard_age_h] = age.possible[i];
    model.rates(model.context, signal, state_C, of_age_K_per_s);
    for (int node = 0; node < model.node_count; ++node) {
      rate_K_per_s[node] = larger(rate_K_per_s[node], of_age_K_per_s[node]);
    }
  }
}

namespace {

/// The current during a gap is unknown: assume the largest one at standstill for the whole gap, up to the temperature limit.
[[gnu::cold, gnu::noinline]] void heat_for_gap(const GuardModel& model, GuardState& state, float gap_s) {
  float signal[kGuardSignals] = {};
  signal[guard_current_A] = model.most_current_A;
  signal[guard_ambient_C] = model.hottest_ambient_C;
  signal[guard_neighbour_C] = model.winding_limit_C;
  float rate_K_per_s[kMostGuardNodes];
  rates_of_any_age(model, signal, state.state_C, rate_K_per_s);
  for (int node = 0; node < model.node_count; ++node) {
    const float heated_C = state.state_C[node] + gap_s * larger(0.0F, rate_K_per_s[node]);
    state.state_C[node] = larger(state.state_C[node], smaller(heated_C, model.winding_limit_C));
  }
  set_gap(state, 0.0F);
}

}  // namespace

GuardOutput step_guard(const GuardModel& model, GuardState& state, const float* signal, float braking_reserve_K, const GuardPeriod& time) {
  GuardOutput out;
  out.allowed_A = out.allowed_braking_A = 0.0F;
  const float unknown_s = gap_s(state);
  out.was_started = is_started(model, state) && is_finite(unknown_s);
  if (!out.was_started) {
    start_guard(model, state, model.winding_limit_C);
  } else {
    state.hidden_A2 = time.hidden_A2;
    if (unknown_s != 0.0F) {
      heat_for_gap(model, state, unknown_s);
    }
  }
  float validated[kGuardSignals];
  const Replaced replaced = replace_implausible(model, signal, validated);
  float rate_K_per_s[kMostGuardNodes];
  model.rates(model.context, validated, state.state_C, rate_K_per_s);
  if (replaced.open != 0) {
    find_hottest_rates(model, replaced.open, validated, state.state_C, rate_K_per_s);
  }
  for (int node = 0; node < model.node_count; ++node) {
    const float counted_s = rate_K_per_s[node] > 0.0F ? model.period_s + time.extra_s : time.cooling_share * model.period_s;
    const float change_K = counted_s * rate_K_per_s[node] - state.carry_K[node];
    const float next_C = state.state_C[node] + change_K;
    state.carry_K[node] = (next_C - state.state_C[node]) - change_K;
    state.state_C[node] = smaller(next_C > model.coldest_ambient_C ? next_C : model.coldest_ambient_C, kMostTemperature_C);
  }
  out.winding_C = state.state_C[0];
  out.hottest_body_C = hottest_body_C(model, state);
  out.is_unknown_input = replaced.all != 0;
  const float smoothing = model.period_s / kSmoothing_s;
  state.heating_K_per_s += smoothing * (rate_K_per_s[0] - state.heating_K_per_s);
  // Under a pulsed load the pulses reach the limit first, so the load follows them at once and falls slowly.
  const float square_A2 = validated[guard_current_A] * validated[guard_current_A];
  state.load_squared_A2 = larger(square_A2, state.load_squared_A2 + smoothing * (square_A2 - state.load_squared_A2));
  state.speed_rad_per_s = validated[guard_speed_rad_per_s];
  ++state.steps;
  state.rounded_up = time.rounded_up;
  if ((replaced.all & (1U << static_cast<unsigned>(guard_speed_rad_per_s))) == 0) {
    const heatsoak_row row = row_at(model.table, absolute(validated[guard_speed_rad_per_s]), out.hottest_body_C);
    const float braking_A2 = square_at_A2(model.table, row, out.winding_C);
    const float driving_A2 = smaller(braking_A2, square_at_A2(model.table, row, out.winding_C + braking_reserve_K));
    out.allowed_braking_A = heatsoak_current_A(&model.table, &row, braking_A2);
    out.allowed_A = heatsoak_current_A(&model.table, &row, driving_A2);
  }
  seal(state);
  return out;
}

}  // namespace robot_core
