// Stage 6: limits the wanted voltages by voltage, current, battery, grip and thermal guard.
//
// The limits act on currents: I = (V − K_e·n·ω)/R with the lowest R that the motor can have, so that the true current is not larger. One
// factor scales the currents of all wheels, which keeps the direction of the force on the body. Finally each voltage must keep the current
// limit for every speed that the wheel may have, by its own sensor and by the others (speed_range()), and by the sensed current. If one
// wheel has to be limited here, all wheels are scaled from the next period on (State::kept_share). If no voltage keeps the limit, the
// bridge opens.
#include "robot_core/drive_stages.h"

namespace robot_core {
namespace {

// A wheel whose speed is judged wrongly may be left without current. Then the others must still move the robot, although in another
// direction.
constexpr float kLeastKept_share = 0.25F;
constexpr float kKeptRise_ratio = 1.01F;  // per period

constexpr float kBoundDecay = 0.8F;  // decay of the bound per period: sampling and actuation are late by one or two periods

constexpr float kRounding = 1.0001F;
constexpr float kSlip_V = 1e-3F;  // a smaller change of a voltage is not reported

/// Wanted current of one wheel and its limit.
struct WheelDemand {
  float back_V;     ///< back-EMF at the sensed speed
  float current_A;  ///< current that the wanted voltage drives
  float most_A;     ///< largest magnitude that driver, grip and guard allow
  float share;      ///< wheel by wheel: fraction of the wanted current that the wheel's own limits allow
  Reason reason;    ///< reason for most_A; none: the smaller one of driver limit and grip
};

// Seldom needed code is in functions of its own, because the loops over the wheels are unrolled.

/// Limits a wheel without speed sensor to the limp current, and every wheel if a faulty sensor would contradict no other one.
[[gnu::cold, gnu::noinline]] void limit_to_limp(const Config& config, const WheelState& state, const Validated& validated,
                                                WheelDemand& demand) {
  if (config.limp_current_A < demand.most_A) {
    demand.most_A = config.limp_current_A;
    demand.reason = state.speed_fault != 0                    ? static_cast<Reason>(state.speed_fault)
                    : validated.common_reason != Reason::none ? validated.common_reason
                                                              : Reason::unchecked;
  }
}

/// Sets the current limit of a wheel without the guard.
void limit_demand(const Config& config, const WheelState& state, const Validated& validated, const BodyReference& body, int i,
                  WheelDemand& demand) {
  demand.most_A = config.wheel[i].body_limit_A;
  demand.reason = Reason::none;
  if (body.is_wheelwise) {
    demand.most_A = config.current_limit_A;
    demand.share = 1.0F;
    demand.reason = Reason::driver_current;
  }
  if (validated.is_redundancy_reduced && (!validated.wheel[i].is_speed_sensed || !validated.is_checked)) {
    limit_to_limp(config, state, validated, demand);
  }
}

[[gnu::cold, gnu::noinline]] Reason reason_of(const WheelConfig& wheel, const WheelDemand& demand) {
  const Reason own = wheel.is_grip_limit != 0 ? Reason::traction : Reason::driver_current;
  return demand.reason == Reason::none ? own : demand.reason;
}

/// Limits one wheel to the allowed current. Shadow mode only counts the excess and returns true if it would have limited.
bool apply_guard(const Config& config, State& state, float allowed_A, WheelDemand& demand) {
  if (allowed_A >= demand.most_A) {
    return false;
  }
  if (!config.shadow_mode) {
    demand.most_A = allowed_A;
    demand.reason = Reason::guard;
    return false;
  }
  const float excess_A = smaller(absolute(demand.current_A), demand.most_A) - allowed_A;
  // Counts the coming period, so that a gap of any length in the past adds no more.
  state.shadow_deficit_A_s += larger(0.0F, excess_A) * config.period_s;
  return excess_A > 0.0F;
}

/// Fraction of the power that the battery supplies before it sags below its lowest voltage. The power is a convex function of the scale of
/// the currents, so scaling them by this fraction is enough.
float share_of_battery(const Config& config, const State& state, const Validated& validated, float power_W) {
  const float source_V =
      smaller(config.battery_full_V, validated.battery_V + larger(0.0F, config.battery_resistance_ohm * state.battery_current_A));
  // A nearly empty battery must still supply the way home.
  constexpr float kLeastSag_share = 0.03F;
  const float sag_V = larger(source_V - config.battery_lowest_V, kLeastSag_share * config.battery_full_V);
  const float most_W = (source_V - sag_V) * sag_V * config.derived.most_battery_sag_A;
  return power_W > most_W && config.derived.most_battery_sag_A > 0.0F ? most_W / power_W : 1.0F;
}

/// Finds the fraction of a wheel's current that its limits allow, and the reason.
[[gnu::noinline]] void scale_wheel(const WheelConfig& wheel, float reachable_A, WheelDemand& demand, Reason& reason) {
  reason = reachable_A < demand.most_A ? Reason::voltage : reason_of(wheel, demand);
  const float most_A = smaller(demand.most_A, reachable_A);
  demand.share = most_A > 0.0F ? most_A / absolute(demand.current_A) : 0.0F;
}

/// Current in the wanted direction that the voltage can drive; negative if it cannot.
float reachable_current_A(const Config& config, const WheelDemand& demand, float most_V) {
  const float room_V = demand.current_A > 0.0F ? most_V - demand.back_V : most_V + demand.back_V;
  return room_V * config.derived.per_lowest_resistance_A_per_V;
}

[[gnu::cold, gnu::noinline]] bool move_into_window(const Config& config, const State& state, const Validated& validated,
                                                   const WheelDemand& demand, int i, float& voltage_V) {
  const float band_V = config.lowest_resistance_ohm * demand.most_A;
  // Without a spare sensor a single set of sensors determines each speed, and all samples do if a rejected one may be correct.
  const ValidatedWheel& sensed = validated.wheel[i];
  SpeedRange range = validated.is_checked || validated.are_samples_compared ? speed_range(config, state, validated, i)
                                                                            : SpeedRange{sensed.speed_rad_per_s, sensed.speed_rad_per_s};
  if (validated.are_samples_compared) {
    range.add(sensed.implied_rad_per_s);
  }
  if (validated.common_reason != Reason::none) {
    range.add(0.0F);
  }
  const float low_V = config.derived.geared_constant_V_s_per_rad * range.fastest_rad_per_s - band_V;
  const float high_V = config.derived.geared_constant_V_s_per_rad * range.slowest_rad_per_s + band_V;
  if (!(demand.most_A > 0.0F) || !(low_V <= high_V)) {
    return false;
  }
  voltage_V = clamped(voltage_V, low_V, high_V);
  return true;
}

/// Returns true if a voltage keeps the current limit for every speed that the wheel may have, because the spread of their estimates is
/// smaller than the room to the limit.
bool is_within(const Config& config, const Validated& validated, const WheelDemand& demand, float voltage_V) {
  return absolute(voltage_V - demand.back_V) + validated.spread_V < config.lowest_resistance_ohm * demand.most_A;
}

/// Keeps a voltage within the current limit for every speed that the wheel may have. Returns false if no voltage does, or for NaN.
bool hold_window(const Config& config, const State& state, const Validated& validated, const WheelDemand& demand, int i, float& voltage_V) {
  return is_within(config, validated, demand, voltage_V) || move_into_window(config, state, validated, demand, i, voltage_V);
}

/// Limits the voltage of a wheel with unknown speed: at standstill at most the limp current or the guard's limit. Its bridge closes only if
/// the voltage keeps the limit at standstill and for all samples; then the sensed current keeps it. False: open the bridge.
[[gnu::cold, gnu::noinline]] bool limp_blindly(const Config& config, const State& state, const Validated& validated,
                                               const WheelDemand& demand, int i, float most_V, float& voltage_V) {
  const float limp_V = smaller(config.lowest_resistance_ohm * demand.most_A, most_V);
  voltage_V = clamped(voltage_V, -limp_V, limp_V);
  return demand.most_A > 0.0F && validated.wheel[i].is_current_sensed &&
         (state.wheel[i].is_open == 0 || move_into_window(config, state, validated, demand, i, voltage_V));
}

/// Keeps the limit by the sensed current. The new current is the sensed one plus the change of voltage over resistance, at any speed. Noise
/// within the slack is ignored if the speed estimates agree, because they keep the limit already.
void hold_sensed_current(const Config& config, const Validated& validated, int i, const WheelState& wheel, float most_A, float& voltage_V) {
  if (wheel.is_open != 0) {
    return;
  }
  const float slack_V = validated.is_redundancy_reduced ? 0.0F : larger(0.0F, config.derived.sensed_slack_V - validated.spread_V);
  const float room_V = config.lowest_resistance_ohm * most_A + slack_V;
  const float back_V = wheel.voltage_V - config.lowest_resistance_ohm * validated.wheel[i].current_A;
  voltage_V = clamped(voltage_V, back_V - room_V, back_V + room_V);
}

/// Scales a wheel that exceeds its limit; returns the smaller one of `least` and the wheel's fraction.
float share_of_wheel(const Config& config, int i, float most_V, WheelDemand& demand, Reason& reason, float least) {
  const float size_A = absolute(demand.current_A);
  const float reachable_A = reachable_current_A(config, demand, most_V);
  if (size_A <= demand.most_A && size_A <= reachable_A) {
    return least;
  }
  scale_wheel(config.wheel[i], reachable_A, demand, reason);
  return smaller(least, demand.share);
}

/// Applies the guards of a robot with a hot motor. Returns the new smallest fraction. A wheel that brakes may always use the braking
/// reserve. All wheels may use it while the wanted currents take power out of the body. This must hold without the wheel that brakes most,
/// because its speed sensor may be faulty. Otherwise a wheel that is pulled along and drives for a moment would take the brakes from all
/// the others through the common factor.
[[gnu::noinline]] float apply_guards(const Config& config, State& state, const Validated& validated, const BodyReference& body,
                                     float most_V, WheelDemand* demand, LimitedVoltages& limited, float least) {
  float body_W = 0.0F;
  float most_braking_W = 0.0F;
  PerWheel driving_W;
  for (int i = 0; i < config.wheel_count; ++i) {
    driving_W[i] = demand[i].back_V * demand[i].current_A;
    // A wheel brakes only if all estimates of its speed agree on the direction.
    if (!(absolute(demand[i].back_V) > validated.spread_V) || validated.is_any_possible) {
      driving_W[i] = absolute(driving_W[i]);
    }
    body_W += driving_W[i];
    most_braking_W = smaller(most_braking_W, driving_W[i]);
  }
  const bool body_brakes = body_W < most_braking_W && !body.is_wheelwise;
  bool would_limit = false;
  for (int i = 0; i < config.wheel_count; ++i) {
    const bool brakes = body_brakes || driving_W[i] < 0.0F;
    const float allowed_A = brakes ? state.wheel[i].allowed_braking_A : state.wheel[i].allowed_A;
    const float earlier_A = demand[i].most_A;
    would_limit = apply_guard(config, state, allowed_A, demand[i]) || would_limit;
    if (validated.wheel[i].is_speed_known && demand[i].most_A < earlier_A) {
      least = share_of_wheel(config, i, most_V, demand[i], limited.wheel[i].reason, least);
    }
  }
  state.shadow_steps += would_limit ? 1U : 0U;
  return least;
}

/// Finds current and limit of every wheel, and one common factor that keeps the direction of the force.
float find_demands(const Config& config, State& state, const Validated& validated, const BodyReference& body, const WheelVoltages& voltage,
                   float most_V, WheelDemand* demand, LimitedVoltages& limited) {
  float least = 1.0F;
  float power_W = 0.0F;
  bool is_hot = false;
#pragma GCC unroll 4
  for (int i = 0; i < config.wheel_count; ++i) {
    const ValidatedWheel& sensed = validated.wheel[i];
    WheelDemand& each = demand[i];
    each.back_V = config.derived.geared_constant_V_s_per_rad * sensed.speed_rad_per_s;
    each.current_A = (voltage.wheel[i].wanted_V - each.back_V) * config.derived.per_lowest_resistance_A_per_V;
    limited.wheel[i].reason = validated.common_reason;
    limit_demand(config, state.wheel[i], validated, body, i, each);
    // The limit for braking is at least as high.
    if (!(state.wheel[i].allowed_A >= each.most_A)) [[unlikely]] {
      is_hot = true;
    }
    if (sensed.is_speed_known) {
      least = share_of_wheel(config, i, most_V, each, limited.wheel[i].reason, least);
    }
    power_W += (each.back_V + config.lowest_resistance_ohm * each.current_A) * each.current_A;
  }
  if (is_hot) {
    least = apply_guards(config, state, validated, body, most_V, demand, limited, least);
  }
  if (state.kept_share < 1.0F) {
    state.kept_share = smaller(1.0F, kKeptRise_ratio * state.kept_share);
    least *= body.is_wheelwise ? 1.0F : state.kept_share;
  }
  // Scaled by this factor, the power falls at least as much.
  const float of_battery = share_of_battery(config, state, validated, least * power_W);
  const float factor = least * of_battery;
  if (factor < 1.0F) {
    // Wheel by wheel, a limited wheel leaves the others as they are.
    const Reason shared = body.is_wheelwise ? Reason::none : Reason::other_wheel;
    for (int i = 0; i < config.wheel_count; ++i) {
      Reason& reason = limited.wheel[i].reason;
      demand[i].current_A *= body.is_wheelwise ? demand[i].share * of_battery : factor;
      reason = of_battery < 1.0F ? Reason::battery_sag : reason == Reason::none ? shared : reason;
    }
  }
  return factor;
}

/// Strongest fault of a wheel.
[[gnu::cold, gnu::noinline]] Reason fault_of(const WheelState& wheel) {
  const std::uint8_t later = wheel.current_fault != 0 ? wheel.current_fault : wheel.guard_fault;
  return static_cast<Reason>(wheel.speed_fault != 0 ? wheel.speed_fault : later);
}

/// Strongest reason of a wheel: faults before limits.
Reason strongest(const WheelState& wheel, Reason limit) {
  // Loads the three faults and is_open at once.
  constexpr std::uint32_t kFaults = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? 0x00FFFFFFU : 0xFFFFFF00U;
  std::uint32_t word = 0;
  __builtin_memcpy(&word, &wheel.speed_fault, sizeof(word));
  return (word & kFaults) == 0 ? limit : fault_of(wheel);
}

/// Limits a wheel whose voltage may exceed the current limit. Returns false if its bridge has to open. Else it lowers `kept` to the
/// remaining fraction of the wanted current.
[[gnu::cold, gnu::noinline]] bool hold_wheel(const Config& config, State& state, const Validated& validated, const WheelDemand& demand,
                                             int i, float most_V, LimitedWheel& end, float& kept) {
  WheelState& wheel = state.wheel[i];
  const ValidatedWheel& sensed = validated.wheel[i];
  const float asked_V = end.voltage_V;
  float voltage_V = asked_V;
  Reason cause = Reason::slip;
  bool is_held = sensed.is_speed_known ? hold_window(config, state, validated, demand, i, voltage_V)
                                       : limp_blindly(config, state, validated, demand, i, most_V, voltage_V);
  if (sensed.is_current_sensed) {
    const float by_speed_V = voltage_V;
    hold_sensed_current(config, validated, i, wheel, demand.most_A, voltage_V);
    if (voltage_V != by_speed_V) {
      cause = Reason::sensed_current;
      // The current sensor may be faulty too: if it and the speeds leave no common voltage, the bridge opens.
      const float held_V = voltage_V;
      is_held = is_held && !(sensed.is_speed_known &&
                             (!hold_window(config, state, validated, demand, i, voltage_V) || absolute(voltage_V - held_V) > kSlip_V));
    }
  }
  wheel.current_bound_A = larger(demand.most_A, kBoundDecay * wheel.current_bound_A);
  if (sensed.is_current_sensed && is_overcurrent(config, wheel, sensed.current_A)) {
    cause = Reason::sensed_current;
    is_held = false;
  }
  is_held = is_held && absolute(voltage_V) <= kRounding * most_V;  // false for NaN
  end.voltage_V = voltage_V;
  const bool is_changed = absolute(voltage_V - asked_V) > kSlip_V;
  if (!is_held || (is_changed && (cause == Reason::sensed_current || end.reason == Reason::none || end.reason == Reason::other_wheel))) {
    end.reason = demand.most_A > 0.0F ? cause : reason_of(config.wheel[i], demand);
  }
  if (is_held && is_changed && sensed.is_speed_known) {
    kept = smaller(kept, (voltage_V - demand.back_V) / (asked_V - demand.back_V));
  }
  return is_held;
}

/// Values for the common case of hold_wheel() that are the same for all wheels.
struct Common {
  float resistance_ohm;
  float per_resistance_A_per_V;
  float spread_V;
};

/// The common case of hold_wheel(): returns true if speeds and sensed current agree that the voltage keeps the limit. The sensed current
/// and the one that it predicts for the voltage must keep it. `driven_V`: voltage minus back-EMF.
bool is_plain(const Common& common, WheelState& wheel, const ValidatedWheel& sensed, float most_A, float voltage_V, float driven_V) {
  if (!sensed.is_speed_known || !(absolute(driven_V) + common.spread_V < common.resistance_ohm * most_A)) {
    return false;
  }
  if (!sensed.is_current_sensed) {
    wheel.current_bound_A = most_A;
    return true;
  }
  const float sensed_A = sensed.current_A;
  const float next_A = sensed_A + (voltage_V - wheel.voltage_V) * common.per_resistance_A_per_V;
  if (wheel.is_open == 0 && absolute(sensed_A) <= most_A && absolute(next_A) <= most_A) {
    wheel.current_bound_A = larger(most_A, kBoundDecay * wheel.current_bound_A);
    return true;
  }
  return false;
}

Reason reason_of_wheel(const WheelState& wheel, const ValidatedWheel& sensed, Reason limit) {
  return sensed.is_speed_known ? strongest(wheel, limit) : Reason::wheel_speed_unknown;
}

/// Opens all bridges. No wheel is held back then.
[[gnu::cold, gnu::noinline]] void open_bridges(const Config& config, State& state, const Validated& validated, const WheelDemand* demand,
                                               LimitedVoltages& limited) {
  state.is_limited = 0;
  state.battery_current_A = 0.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    WheelState& wheel = state.wheel[i];
    wheel.current_bound_A = larger(demand[i].most_A, kBoundDecay * wheel.current_bound_A);
    wheel.is_open = 1;
    wheel.integral_V = 0.0F;
    wheel.earlier_V = wheel.voltage_V;
    wheel.voltage_V = 0.0F;
    limited.wheel[i] = {0.0F, demand[i].most_A, reason_of_wheel(wheel, validated.wheel[i], Reason::none), true};
  }
}

}  // namespace

LimitedVoltages apply_limits(const Config& config, State& state, const Validated& validated, const BodyReference& body,
                             const WheelVoltages& voltage) {
  LimitedVoltages limited;
  WheelDemand demand[kMostWheels];
  const float most_V = smaller(config.voltage_limit_V, validated.battery_V);
  const float share = find_demands(config, state, validated, body, voltage, most_V, demand, limited);
  if (body.is_open) {
    open_bridges(config, state, validated, demand, limited);
    return limited;
  }
  state.is_limited = share < 1.0F ? 1 : 0;
  // Back-calculation: the integrators follow the voltages after the limits.
  const float feedback_share = smaller(1.0F, validated.elapsed_s * config.derived.per_tracking_time_per_s);
  const Common common{config.lowest_resistance_ohm, config.derived.per_lowest_resistance_A_per_V, validated.spread_V};
  const int count = config.wheel_count;
  float power_W = 0.0F;
  float kept = 1.0F;
  for (int i = 0; i < count; ++i) {
    WheelState& wheel = state.wheel[i];
    LimitedWheel& end = limited.wheel[i];
    const float back_V = demand[i].back_V;
    const float current_A = demand[i].current_A;
    const float most_A = demand[i].most_A;
    float voltage_V = back_V + common.resistance_ohm * current_A;
    float driven_V = voltage_V - back_V;
    bool is_open = false;
    if (!is_plain(common, wheel, validated.wheel[i], most_A, voltage_V, driven_V)) {
      end.voltage_V = voltage_V;
      is_open = !hold_wheel(config, state, validated, demand[i], i, most_V, end, kept);
      voltage_V = end.voltage_V;
      driven_V = voltage_V - back_V;
    }
    if (is_open) {
      voltage_V = 0.0F;
      wheel.integral_V = 0.0F;
    } else {
      power_W += voltage_V * current_A;
      wheel.driven_squared_V2 += driven_V * driven_V;
      wheel.integral_V += (voltage_V - voltage.wheel[i].wanted_V) * feedback_share;
    }
    wheel.is_open = is_open ? 1 : 0;
    wheel.earlier_V = wheel.voltage_V;
    wheel.voltage_V = voltage_V;
    end.voltage_V = voltage_V;
    end.allowed_A = most_A;
    end.is_open = is_open;
    end.reason = reason_of_wheel(wheel, validated.wheel[i], end.reason);
  }
  state.battery_current_A = power_W / validated.pwm_battery_V;
  if (kept < 1.0F) {
    state.kept_share = larger(kLeastKept_share, state.kept_share * kept);
  }
  return limited;
}

}  // namespace robot_core
