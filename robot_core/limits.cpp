// Stage 6: what voltage, current, battery, grip and the thermal guard leave of the wanted voltages.
//
// A limit works on currents: I = (V − K_e·n·ω)/R with the lowest R that the motor can have, so that the true current is not larger. One
// factor scales the currents of all wheels, and with them the force on the body, so that its direction is kept. At last each voltage has
// to keep the wheel's current within its limit for two speeds: that of its sensor and that which the other wheels and the gyro imply.
// Where no voltage does, the bridge is opened.
#include "robot_core/drive_stages.h"

namespace robot_core {
namespace {

// A sensed current this far above the limit is no noise and no settling.
constexpr float kOvercurrent_ratio = 1.3F;
constexpr float kOvercurrent_share = 0.15F;  // of the driver's limit
constexpr float kBoundDecay = 0.8F;          // of the bound's memory, per period: sampling and actuation are late by one or two

/// Largest current of one wheel, and which limit that is.
struct CurrentLimit {
  float most_A = 0.0F;
  Reason reason = Reason::none;

  void lower(float to_A, Reason why) {
    if (!(to_A >= most_A)) {  // what is no number counts as none
      most_A = to_A > 0.0F ? to_A : 0.0F;
      reason = why;
    }
  }
};

float back_emf_V(const Config& config, float wheel_rad_per_s) { return config.derived.geared_constant_V_s_per_rad * wheel_rad_per_s; }

/// Without the guard.
CurrentLimit find_limit(const Config& config, const WheelState& state, const Believed& believed, const BodyReference& body, int i) {
  CurrentLimit limit{config.current_limit_A, Reason::driver_current};
  if (config.traction_ratio > 0.0F && !body.is_wheelwise) {
    limit.lower(config.derived.grip_A[i], Reason::traction);
  }
  if (!believed.is_speed_sensed[i]) {
    limit.lower(config.limp_current_A, static_cast<Reason>(state.speed_fault));
  }
  return limit;
}

/// What the guard leaves. In shadow mode it is counted instead.
void apply_guard(const Config& config, State& state, const Believed& believed, const float* current_A, CurrentLimit* limit) {
  if (config.guard == nullptr) {
    return;
  }
  bool would_limit = false;
  for (int i = 0; i < config.wheel_count; ++i) {
    const WheelState& wheel = state.wheel[i];
    const bool brakes = current_A[i] * believed.wheel_speed_rad_per_s[i] < 0.0F;
    const float allowed_A = brakes ? wheel.allowed_braking_A : wheel.allowed_A;
    if (!config.shadow_mode) {
      limit[i].lower(allowed_A, Reason::guard);
    } else if (const float excess_A = smaller(absolute(current_A[i]), limit[i].most_A) - allowed_A; excess_A > 0.0F) {
      state.shadow_deficit_A_s += excess_A * believed.elapsed_s;
      would_limit = true;
    }
  }
  state.shadow_steps += would_limit ? 1U : 0U;
}

float voltage_limit_V(const Config& config, const Believed& believed) { return smaller(config.voltage_limit_V, believed.battery_V); }

/// Share of a wheel's current that its limits leave; the reason where it is below one.
float share_of_wheel(const Config& config, const Believed& believed, int i, float wanted_A, const CurrentLimit& limit, Reason& reason) {
  float share = 1.0F;
  if (absolute(wanted_A) > limit.most_A) {
    share = limit.most_A / absolute(wanted_A);
    reason = limit.reason;
  }
  const float most_V = voltage_limit_V(config, believed);
  const float back_V = back_emf_V(config, believed.wheel_speed_rad_per_s[i]);
  const float room_V = wanted_A > 0.0F ? most_V - back_V : most_V + back_V;
  const float driven_V = absolute(wanted_A) * config.lowest_resistance_ohm;
  if (driven_V * share > room_V) {
    share = room_V > 0.0F ? room_V / driven_V : 0.0F;
    reason = Reason::voltage;
  }
  return share;
}

/// Share of the power that the battery gives before it sags below its lowest voltage. The power of scaled currents is convex in the
/// scale, so scaling by this share is enough.
float share_of_battery(const Config& config, const State& state, const Believed& believed, const float* current_A) {
  if (!(config.battery_resistance_ohm > 0.0F)) {
    return 1.0F;
  }
  float power_W = 0.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    const float back_V = back_emf_V(config, believed.wheel_speed_rad_per_s[i]);
    power_W += (back_V + config.lowest_resistance_ohm * current_A[i]) * current_A[i];
  }
  const float source_V =
      smaller(config.battery_full_V, believed.battery_V + larger(0.0F, config.battery_resistance_ohm * state.battery_current_A));
  // A battery that is nearly empty still has to carry the robot home.
  constexpr float kLeastSag_share = 0.03F;
  const float sag_V = larger(source_V - config.battery_lowest_V, kLeastSag_share * config.battery_full_V);
  const float most_W = (source_V - sag_V) * sag_V * config.derived.most_battery_sag_A;
  return power_W > most_W ? most_W / power_W : 1.0F;
}

/// Holds a voltage within the current limit for the sensed and for the implied speed. False where no voltage does.
bool hold_window(const Config& config, const Believed& believed, int i, float most_A, float& voltage_V) {
  const float band_V = config.lowest_resistance_ohm * most_A;
  const float sensed_V = back_emf_V(config, believed.wheel_speed_rad_per_s[i]);
  const float implied_V = back_emf_V(config, believed.implied_speed_rad_per_s[i]);
  const float most_V = voltage_limit_V(config, believed);
  const float low_V = larger(larger(sensed_V, implied_V) - band_V, -most_V);
  const float high_V = smaller(smaller(sensed_V, implied_V) + band_V, most_V);
  if (!(low_V <= high_V) || !(most_A > 0.0F)) {
    return false;
  }
  voltage_V = clamped(voltage_V, low_V, high_V);
  return true;
}

/// Of a wheel whose speed nobody knows: into a standing motor no more than the limp current.
bool limp_blindly(const Config& config, const Believed& believed, int i, float& voltage_V) {
  const float most_V = smaller(config.lowest_resistance_ohm * config.limp_current_A, voltage_limit_V(config, believed));
  voltage_V = clamped(voltage_V, -most_V, most_V);
  return believed.is_current_sensed[i] && absolute(believed.motor_current_A[i]) <= config.limp_current_A;
}

bool is_overcurrent(const Config& config, const Believed& believed, WheelState& wheel, int i, float most_A) {
  wheel.current_bound_A = larger(most_A, kBoundDecay * wheel.current_bound_A);
  return believed.is_current_sensed[i] &&
         absolute(believed.motor_current_A[i]) > kOvercurrent_ratio * wheel.current_bound_A + kOvercurrent_share * config.current_limit_A;
}

/// One factor for all wheels that drive the body together.
float scale_currents(const Config& config, State& state, const Believed& believed, const BodyReference& body, const CurrentLimit* limit,
                     float* current_A, Reason* reason) {
  float share[kMostWheels] = {1.0F, 1.0F, 1.0F, 1.0F};
  float least = 1.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    if (believed.is_speed_known[i]) {
      share[i] = share_of_wheel(config, believed, i, current_A[i], limit[i], reason[i]);
      least = smaller(least, share[i]);
    }
  }
  for (int i = 0; i < config.wheel_count; ++i) {
    const float factor = body.is_wheelwise ? share[i] : least;
    reason[i] = reason[i] == Reason::none && factor < 1.0F ? Reason::other_wheel : reason[i];
    current_A[i] *= factor;
  }
  const float of_battery = share_of_battery(config, state, believed, current_A);
  if (of_battery < 1.0F) {
    for (int i = 0; i < config.wheel_count; ++i) {
      current_A[i] *= of_battery;
      reason[i] = Reason::battery_sag;
    }
  }
  return least * of_battery;
}

/// Strongest reason of a wheel: faults before limits.
Reason strongest(const WheelState& wheel, Reason limit) {
  const std::uint8_t faults[] = {wheel.speed_fault, wheel.current_fault, wheel.guard_fault};
  for (const std::uint8_t fault : faults) {
    if (fault != 0) {
      return static_cast<Reason>(fault);
    }
  }
  return limit;
}

/// The integrator follows the voltage that the wheel really gets.
void feed_back(const Config& config, const Believed& believed, WheelState& wheel, float wanted_V) {
  const float excess_V = wheel.is_open != 0 ? 0.0F : wheel.voltage_V - wanted_V;
  wheel.integral_V += excess_V * smaller(1.0F, believed.elapsed_s / config.tracking_time_s);
}

}  // namespace

LimitedVoltage apply_limits(const Config& config, State& state, const Believed& believed, const BodyReference& body,
                            const WheelVoltage& voltage) {
  LimitedVoltage limited;
  CurrentLimit limit[kMostWheels];
  PerWheel current_A = {};
  for (int i = 0; i < config.wheel_count; ++i) {
    limit[i] = find_limit(config, state.wheel[i], believed, body, i);
    current_A[i] =
        (voltage.wanted_V[i] - back_emf_V(config, believed.wheel_speed_rad_per_s[i])) * config.derived.per_lowest_resistance_A_per_V;
  }
  apply_guard(config, state, believed, current_A, limit);
  const bool is_all_open = body.is_open || believed.robot_fault == Reason::period_invalid;
  const float share = scale_currents(config, state, believed, body, limit, current_A, limited.reason);
  state.is_limited = !is_all_open && share < 1.0F ? 1 : 0;
  float power_W = 0.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    WheelState& wheel = state.wheel[i];
    float& voltage_V = limited.voltage_V[i];
    voltage_V = back_emf_V(config, believed.wheel_speed_rad_per_s[i]) + config.lowest_resistance_ohm * current_A[i];
    const bool is_held = believed.is_speed_known[i] ? hold_window(config, believed, i, limit[i].most_A, voltage_V)
                                                    : limp_blindly(config, believed, i, voltage_V);
    const bool is_over = is_overcurrent(config, believed, wheel, i, limit[i].most_A);
    limited.is_open[i] = is_all_open || !is_held || is_over || !is_finite(voltage_V);
    limited.allowed_A[i] = limit[i].most_A;
    if (limited.is_open[i]) {
      voltage_V = 0.0F;
      current_A[i] = 0.0F;
      limited.reason[i] = is_all_open ? Reason::none : limit[i].reason;
      wheel.integral_V = 0.0F;
    }
    limited.reason[i] = strongest(wheel, limited.reason[i]);
    power_W += voltage_V * current_A[i];
    wheel.is_open = limited.is_open[i] ? 1 : 0;
    wheel.voltage_V = voltage_V;
    feed_back(config, believed, wheel, voltage.wanted_V[i]);
  }
  state.battery_current_A = power_W / believed.pwm_battery_V;
  return limited;
}

}  // namespace robot_core
