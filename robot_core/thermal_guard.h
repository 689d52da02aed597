// The thermal guard of one motor: an observer of its temperatures and the current that it may still carry.
//
// The motor's thermal law and the table come from `heatsoak derate`; this file is how they are run, the same text on the host and on
// the controller. Method: explicit Euler steps of one guard period with compensated summation (Kahan 1965), because in single precision
// a step of a slow stator is smaller than the last digit of its temperature.
#pragma once

#include <cstdint>

#include "robot_core/current_table.h"
#include "robot_core/math.h"

namespace robot_core {

/// Signals that a thermal law may depend on, in the order of the generated code.
enum GuardSignal : int {
  guard_current_A,              ///< equivalent DC current, RMS over the guard period, > 0 drives
  guard_speed_rad_per_s,        ///< motor shaft, signed
  guard_ambient_C,              ///< air around the motor
  guard_vehicle_speed_m_per_s,  ///< robot through the air
  guard_neighbour_C,            ///< hottest motor next to this one
  guard_age_h,                  ///< operating hours of the motor
  guard_acceleration_rad_per_s2,
  kGuardSignals
};

inline constexpr int kMostGuardNodes = 6;

/// Range in which a signal is believed, and candidate values for when it is not.
struct PlausibleRange {
  bool is_used = false;  ///< false: no law of this motor depends on it
  float least = 0.0F;
  float most = 0.0F;
  const float* possible = nullptr;  ///< `possible_count` candidates; the one that heats most is used
  int possible_count = 0;
};

/// One motor's guard as data. Generated on the target; on the host it points into the result of `derate`.
struct GuardModel {
  int node_count = 0;  ///< winding first, then stator
  float period_s = 0.01F;
  float winding_limit_C = 0.0F;
  float coldest_ambient_C = 0.0F;
  float hottest_ambient_C = 0.0F;
  float most_current_A = 0.0F;  ///< current limit of the motor driver
  float cold_current_A = 0.0F;  ///< allowed to a cold motor that stands
  float heat_ratio = 1.0F;      ///< safety factor on heat, at least 1: the observer heats this many times as much as the nominal motor
  heatsoak_current_table table{};
  PlausibleRange plausible_range[kGuardSignals];
  /// dT/dt of every node in K/s. `context` is handed through.
  void (*rates)(const void* context, const float* signal, const float* state_C, float* rate_K_per_s) = nullptr;
  const void* context = nullptr;
};

struct alignas(8) GuardState {
  std::uint64_t check_sum = 0;
  float state_C[kMostGuardNodes] = {};
  float carry_K[kMostGuardNodes] = {};
  float speed_rad_per_s = 0.0F;  ///< of the last step, motor shaft
  float heating_K_per_s = 0.0F;  ///< of the winding, smoothed
  float load_squared_A2 = 0.0F;  ///< square of the current, smoothed
  float time_to_limit_s = 0.0F;  ///< estimate: until less is allowed than flows now, if the load goes on; kLongTime_s: never
  std::uint32_t steps = 0;
  std::uint32_t unused = 0;
};

inline constexpr float kLongTime_s = 3600.0F;

/// Written by step_guard(), all of it.
struct GuardOutput {
  float allowed_A;          ///< magnitude, until the next call
  float allowed_braking_A;  ///< magnitude where the current brakes; at least allowed_A
  float winding_C;          ///< of the observer: above the nominal motor's by the safety factor on heat
  float hottest_body_C;     ///< highest of the nodes other than the winding
  bool is_unknown_input;    ///< a signal was not believed and its hottest case was taken
  bool was_started;         ///< false: the state was none, and the guard began as hot as its limit
};

/// All nodes at `body_C`. Anything that cannot be a temperature counts as the winding's limit.
void start_guard(const GuardModel& model, GuardState& state, float body_C);

/// True if the state has been started, has its check sum and holds temperatures.
bool is_started(const GuardModel& model, const GuardState& state);

/// After a change of the temperatures from outside.
void seal(GuardState& state);

/// One guard period. `signal` has kGuardSignals values; the current is what flowed since the last call.
/// `braking_reserve_K` is kept free below the limit for braking: driving current is read from the table at a winding that much hotter.
GuardOutput step_guard(const GuardModel& model, GuardState& state, const float* signal, float braking_reserve_K);

/// The table at one place. 0 where an argument is not a number, above the speeds or above the temperatures.
float allowed_current_A(const GuardModel& model, float speed_rad_per_s, float stator_C, float winding_C);

}  // namespace robot_core
