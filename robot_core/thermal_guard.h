// The thermal guard of one motor: an observer of its temperatures and the current that it may still carry.
//
// `heatsoak derate` calculates the motor's thermal law and table. This file runs them, with the same source on host and controller. Method:
// explicit Euler steps of one guard period with compensated summation (Kahan 1965). It is needed because in single precision a step of a
// slow stator is smaller than the last digit of its temperature.
#pragma once

#include <cstdint>

#include "robot_core/current_table.h"
#include "robot_core/math.h"

namespace robot_core {

// clang-format off
/// Input signals of a thermal law, in the order of the generated code, whose fields have these names.
#define ROBOT_CORE_GUARD_SIGNALS(SIGNAL)                                                                             \
  SIGNAL(current_A)               /* equivalent DC current, RMS over the guard period; positive: drives */           \
  SIGNAL(speed_rad_per_s)         /* speed of the motor's shaft, signed */                                           \
  SIGNAL(ambient_C)               /* air around the motor */                                                         \
  SIGNAL(vehicle_speed_m_per_s)   /* speed of the robot through the air */                                           \
  SIGNAL(neighbour_C)             /* temperature of the neighbouring motor, of several the hottest */                \
  SIGNAL(age_h)                   /* operating hours of the motor */                                                 \
  SIGNAL(acceleration_rad_per_s2) /* magnitude of dω/dt of the motor's shaft, mean over the guard period */

/// guard_current_A, guard_speed_rad_per_s, …
enum GuardSignal : int {
#define ROBOT_CORE_GUARD_INDEX(field) guard_##field,
  ROBOT_CORE_GUARD_SIGNALS(ROBOT_CORE_GUARD_INDEX)
#undef ROBOT_CORE_GUARD_INDEX
  kGuardSignals
};
// clang-format on

inline constexpr int kMostGuardNodes = 6;

/// Plausible range of a signal, and candidate values that replace an implausible one.
struct PlausibleRange {
  bool is_used = false;  ///< true if a law of this motor depends on the signal
  float least = 0.0F;
  float most = 0.0F;
  const float* possible = nullptr;  ///< `possible_count` candidates; the guard uses the one that heats most
  int possible_count = 0;
};

/// Guard of one motor as data. On the target it is generated; on the host it points into the result of `derate`.
struct GuardModel {
  int node_count = 0;  ///< winding first, then stator and other bodies
  float period_s = 0.01F;
  float winding_limit_C = 0.0F;
  float coldest_ambient_C = 0.0F;
  float hottest_ambient_C = 0.0F;
  float most_current_A = 0.0F;  ///< current limit of the motor driver
  float cold_current_A = 0.0F;  ///< allowed current of a cold motor at standstill
  float heat_ratio = 1.0F;      ///< safety factor on heat, at least 1: the observer counts this many times the heat of the nominal motor
  /// Steady state of the nodes without current in the hottest surroundings, rounded up. Nodes that are all at most c >= 0 K above it never
  /// get further above it.
  float resting_C[kMostGuardNodes] = {};
  heatsoak_current_table table{};
  PlausibleRange plausible_range[kGuardSignals];
  /// Calculates dT/dt of every node in K/s. `context` is passed on unchanged.
  void (*rates)(const void* context, const float* signal, const float* state_C, float* rate_K_per_s) = nullptr;
  const void* context = nullptr;
};

struct alignas(8) GuardState {
  std::uint64_t check_sum = 0;
  float state_C[kMostGuardNodes] = {};
  float carry_K[kMostGuardNodes] = {};
  float speed_rad_per_s = 0.0F;  ///< motor shaft speed in the last step
  float heating_K_per_s = 0.0F;  ///< heating rate of the winding, smoothed
  float load_squared_A2 = 0.0F;  ///< squared current; rises at once, falls with a time constant of 3 s
  float time_to_limit_s = 0.0F;  ///< estimated time until the allowed current falls below that load; kLongTime_s: never
  std::uint32_t steps = 0;
  std::uint32_t rounded_up = 0;  ///< State::rounded_up in the last step
  float hidden_A2 = 0.0F;        ///< leaky mean square of the current by voltage and speed minus that of the counted current
  std::uint32_t unused = 0;
  // The check sum ends here. A gap changes between the guard's steps, and its complement costs less time than a new check sum.
  std::uint32_t gap_bits = 0;  ///< time with unknown current that the temperatures do not include yet, a float in s
  std::uint32_t gap_complement = ~0U;
};

inline constexpr float kLongTime_s = 3600.0F;

/// Result of step_guard(), which writes all members.
struct GuardOutput {
  float allowed_A;          ///< magnitude of the allowed current until the next call
  float allowed_braking_A;  ///< magnitude of the allowed braking current; at least allowed_A
  float winding_C;          ///< observer temperature, above the nominal motor's by the safety factor on heat
  float hottest_body_C;     ///< highest temperature of all nodes but the winding
  bool is_unknown_input;    ///< true if a signal was implausible and its hottest case was used
  bool was_started;         ///< false: the state was invalid, and the guard started at its temperature limit
};

/// Starts the guard with all nodes at `body_C`. An implausible temperature counts as the winding's limit.
void start_guard(const GuardModel& model, GuardState& state, float body_C);

/// Returns true if the state was started, has a valid check sum and no flipped bit in its gap, and holds plausible temperatures.
bool is_started(const GuardModel& model, const GuardState& state);

/// Calculates the largest rate of each node over the possible ages of the motor, which the drive core does not know. Changes the age in
/// `signal`.
void rates_of_any_age(const GuardModel& model, float* signal, const float* state_C, float* rate_K_per_s);

/// Updates the check sum after a change of the temperatures from outside.
void seal(GuardState& state);

/// Time with unknown current that the temperatures do not include yet; infinite if a bit of it has flipped.
float gap_s(const GuardState& state);
void set_gap(GuardState& state, float gap_s);

/// Adds to gap_s(), which the next step of the guard counts: with the largest current at standstill in the hottest air. After a
/// gap of more than 1 s it starts at its temperature limit.
void add_gap(GuardState& state, float added_s);

/// Time since the last step of a guard, and values that the guard keeps for its caller.
struct GuardPeriod {
  float extra_s = 0.0F;          ///< time beyond the guard period; counts for heating but not for cooling
  float cooling_share = 1.0F;    ///< share of the guard period that counts for cooling
  std::uint32_t rounded_up = 0;  ///< value for GuardState::rounded_up
  float hidden_A2 = 0.0F;        ///< value for GuardState::hidden_A2
};

/// Runs one guard period. `signal` has kGuardSignals values; its current flowed since the last call. `braking_reserve_K` is kept free below
/// the limit for braking: the driving current is read from the table for a winding that much hotter.
GuardOutput step_guard(const GuardModel& model, GuardState& state, const float* signal, float braking_reserve_K,
                       const GuardPeriod& time = {});

/// Updates GuardState::time_to_limit_s: extrapolates the smoothed heating linearly. Too short near the steady state and for pulses.
void estimate_time_to_limit(const GuardModel& model, GuardState& state, float braking_reserve_K);

/// Allowed current of the table at one point; 0 for NaN and above the highest speed or temperature.
float allowed_current_A(const GuardModel& model, float speed_rad_per_s, float stator_C, float winding_C);

}  // namespace robot_core
