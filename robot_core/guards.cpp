// The thermal guards of the wheels, each stepped once per guard period, spread over it so that no control step carries all of them.
#include "robot_core/drive_stages.h"

namespace robot_core {
namespace {

// Over which the heating of a winding and the wanted current are smoothed for the time until the guard limits.
constexpr float kSmoothing_s = 3.0F;
constexpr float kLongestGap_s = 1.0F;
constexpr std::uint32_t kStepsPerEstimate = 500;

int periods_per_guard_step(const Config& config) { return static_cast<int>(config.guard->period_s / config.period_s + 0.5F); }

/// Temperature at which the table allows no more than `current_A`: between the axis points the table falls in a straight line.
float limiting_temperature_C(const GuardModel& model, const GuardRow& row, float current_A) {
  const GuardAxis& axis = model.winding_C;
  int low = 0;
  int high = axis.count - 1;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (allowed_current_A(model, row, axis.points[middle]) >= current_A) {
      low = middle;
    } else {
      high = middle;
    }
  }
  const float at_low_A = allowed_current_A(model, row, axis.points[low]);
  const float at_high_A = allowed_current_A(model, row, axis.points[high]);
  const float share = at_low_A > at_high_A ? clamped((at_low_A - current_A) / (at_low_A - at_high_A), 0.0F, 1.0F) : 0.0F;
  return axis.points[low] + share * (axis.points[high] - axis.points[low]);
}

/// If the load goes on: straight extrapolation of the smoothed heating, an estimate that is early while the winding approaches balance.
float time_to_limit_s(const Config& config, const WheelState& wheel, const GuardOutput& guard) {
  const float wanted_A = square_root(wheel.wanted_squared_A2);
  if (wanted_A > guard.allowed_A) {
    return 0.0F;
  }
  constexpr float kLeastHeating_K_per_s = 0.01F;
  if (!(wheel.rate_K_per_s > kLeastHeating_K_per_s)) {
    return kLongTime_s;
  }
  const float limiting_C = limiting_temperature_C(*config.guard, guard.row, wanted_A) - config.braking_reserve_K;
  return clamped((limiting_C - guard.winding_C) / wheel.rate_K_per_s, 0.0F, kLongTime_s);
}

float hottest_neighbour_C(const Config& config, const State& state, int of) {
  float hottest_C = 0.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    hottest_C = i == of ? hottest_C : larger(hottest_C, state.wheel[i].body_C);
  }
  return hottest_C;
}

void step_wheel_guard(const Config& config, State& state, const Believed& believed, int i, float periods) {
  WheelState& wheel = state.wheel[i];
  const GuardModel& model = *config.guard;
  const float mean_A = wheel.current_A / periods;
  const float rms_A = square_root(wheel.current_squared_A2 / periods);
  const float speed_rad_per_s = wheel.speed_sum_rad_per_s / periods * config.gear_ratio;
  float signal[kGuardSignals];
  signal[guard_current_A] = mean_A < 0.0F ? -rms_A : rms_A;
  // Of a wheel without a speed nothing is known, but then the current is the limp current, which every speed bears.
  signal[guard_speed_rad_per_s] = believed.wheel[i].is_speed_known ? speed_rad_per_s : kNoSample;
  signal[guard_ambient_C] = believed.ambient_C;
  signal[guard_vehicle_speed_m_per_s] = 0.0F;
  signal[guard_neighbour_C] = hottest_neighbour_C(config, state, i);
  signal[guard_age_h] = kNoSample;
  signal[guard_acceleration_rad_per_s2] = absolute(speed_rad_per_s - wheel.guard_speed_rad_per_s) / model.period_s;
  const GuardOutput guard = step_guard(model, state.guard[i], signal, config.braking_reserve_K);
  const bool is_limping = !believed.wheel[i].is_speed_known;
  wheel.allowed_A = is_limping ? config.limp_current_A : guard.allowed_A;
  wheel.allowed_braking_A = is_limping ? config.limp_current_A : guard.allowed_braking_A;
  wheel.body_C = guard.hottest_body_C;
  wheel.guard_speed_rad_per_s = speed_rad_per_s;
  if (!guard.was_started) {
    wheel.guard_fault = static_cast<std::uint8_t>(Reason::guard_unknown);
  } else if (guard.allowed_A >= model.most_current_A) {
    wheel.guard_fault = 0;
  }
  const float smoothing = model.period_s / kSmoothing_s;
  wheel.rate_K_per_s += smoothing * (guard.winding_rate_K_per_s - wheel.rate_K_per_s);
  wheel.wanted_squared_A2 += smoothing * (rms_A * rms_A - wheel.wanted_squared_A2);
  // An estimate over seconds need not be made anew in every guard period.
  if (state.steps % kStepsPerEstimate < static_cast<std::uint32_t>(periods)) {
    wheel.time_to_limit_s = time_to_limit_s(config, wheel, guard);
  }
}

/// A stator that is hotter than the observer says is believed, a colder one is not.
void take_stator_sample(const GuardModel& model, State& state, const Input& input, int i) {
  WheelState& wheel = state.wheel[i];
  const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(i));
  const float sample_C = input.stator_C[i];
  if (sample_C > -50.0F && sample_C < 400.0F) {
    state.has_stator = static_cast<std::uint8_t>(state.has_stator | bit);
    if (GuardState& guard = state.guard[i]; sample_C > guard.state_C[1] && is_started(model, guard)) {
      guard.state_C[1] = sample_C;
      seal(guard);
    }
    wheel.guard_fault = wheel.guard_fault == static_cast<std::uint8_t>(Reason::stator_missing) ? 0 : wheel.guard_fault;
  } else if ((state.has_stator & bit) != 0 && wheel.guard_fault == 0) {
    wheel.guard_fault = static_cast<std::uint8_t>(Reason::stator_missing);
  }
}

/// Nobody knows what flowed in a gap: the largest current heats a standing winding for all of it, up to the limit.
void heat_for_gap(const Config& config, WheelState& wheel, GuardState& guard, float gap_s) {
  const GuardModel& model = *config.guard;
  if (!(gap_s <= kLongestGap_s) || !is_started(model, guard)) {
    start_guard(model, guard, model.winding_limit_C);
    wheel.guard_fault = static_cast<std::uint8_t>(Reason::guard_unknown);
    return;
  }
  float signal[kGuardSignals] = {};
  signal[guard_current_A] = model.most_current_A;
  signal[guard_ambient_C] = model.hottest_ambient_C;
  signal[guard_neighbour_C] = model.winding_limit_C;
  float rate_K_per_s[kMostGuardNodes];
  model.rates(model.context, signal, guard.state_C, rate_K_per_s);
  for (int node = 0; node < model.node_count; ++node) {
    const float heated_C = guard.state_C[node] + gap_s * larger(0.0F, rate_K_per_s[node]);
    guard.state_C[node] = larger(guard.state_C[node], smaller(heated_C, model.winding_limit_C));
  }
  seal(guard);
}

}  // namespace

void run_guards(const Config& config, State& state, const Input& input, const Believed& believed) {
  if (config.guard == nullptr) {
    return;
  }
  const int periods = periods_per_guard_step(config);
  const auto weight = static_cast<float>(believed.elapsed_periods);
  for (int i = 0; i < config.wheel_count; ++i) {
    WheelState& wheel = state.wheel[i];
    if (believed.robot_fault == Reason::time_jump) {
      heat_for_gap(config, wheel, state.guard[i], believed.elapsed_s);
    }
    const float current_A = believed.wheel[i].current_A;
    wheel.current_squared_A2 += weight * current_A * current_A;
    wheel.current_A += weight * current_A;
    wheel.speed_sum_rad_per_s += weight * believed.wheel[i].speed_rad_per_s;
    wheel.guard_steps += believed.elapsed_periods;
    if (wheel.guard_steps >= periods) {
      take_stator_sample(*config.guard, state, input, i);
      // Sums over a period or two more than the guard's count for its own length: their surplus is kept for the next step.
      const auto summed = static_cast<float>(wheel.guard_steps);
      step_wheel_guard(config, state, believed, i, summed);
      wheel.guard_steps -= periods;
      const float left_share = static_cast<float>(wheel.guard_steps) / summed;
      wheel.current_squared_A2 *= left_share;
      wheel.current_A *= left_share;
      wheel.speed_sum_rad_per_s *= left_share;
    }
  }
}

}  // namespace robot_core
