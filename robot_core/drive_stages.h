// The stages of step() in order and the signals between them. One file each: input_validation.cpp, body_velocity_control.cpp,
// wheel_speeds.cpp, feed_forward.cpp, wheel_speed_control.cpp, limits.cpp, output.cpp. block_diagram.h describes the same for readers.
#pragma once

#include "robot_core/drive_core.h"
#include "robot_core/math.h"

namespace robot_core {

// Members without initial values: every stage writes them before they are read, those per wheel for all wheels of the robot.

/// Stage 1: validated signals of one wheel.
struct ValidatedWheel {
  float speed_rad_per_s;    ///< sensed, else implied, else 0
  float implied_rad_per_s;  ///< implied by the other wheels and the gyro, else speed_rad_per_s
  float current_A;          ///< sensed, else estimated from voltage and speed
  bool is_speed_known;      ///< speed sensed or implied
  bool is_speed_sensed;
  bool is_current_sensed;
};

struct Validated {
  ValidatedWheel wheel[kMostWheels];
  Vector3 velocity;     ///< velocity of the body, local frame
  float battery_V;      ///< voltage for limits, unlikely to be above the true one
  float pwm_battery_V;  ///< voltage for the PWM ratio, unlikely to be below the true one
  float ambient_C;
  float elapsed_s;    ///< time since the last step, a whole number of periods
  int guard_periods;  ///< elapsed periods; one more whenever small delays add up to a period
  /// Sensed rim speed without the rotation of the robot; NaN if the sensor is not accepted, unless `are_samples_compared`.
  PerWheel rim_m_per_s;
  float spread_V;  ///< bound of the difference between estimates of one back-EMF from different sensors; infinite: unknown
  bool is_redundancy_reduced = false;  ///< true: three wheels, or a speed sensor or the gyro is not accepted
  bool is_checked = true;              ///< true: enough sensors are left for a wrong one to contradict the others
  /// True: with one spare sensor two swapped ones may go unnoticed, so until a swap is ruled out every sample may belong to each wheel.
  bool is_any_possible = false;
  bool are_all_sensed = true;
  Reason common_reason = Reason::none;  ///< wheel_speeds_dead: all wheels get the limp current, and the motors may stand
  bool were_sensors_compared = false;   ///< true: compare_sensors() used its turn in this step
  bool are_samples_compared = false;    ///< true: too few sensors are accepted, so implied speeds come from all samples
  Mode mode = Mode::coast;              ///< mode after faults of the command
  Reason command_fault = Reason::none;
  Reason robot_fault = Reason::none;
};

/// Result of stage 2: motion of the body.
struct BodyReference {
  Vector3 velocity;           ///< local frame
  Vector3 acceleration;       ///< seen from the field, resolved in the local frame
  Vector3 push;               ///< force and moment on an external object, local frame
  bool is_wheelwise = false;  ///< true in the modes wheel_speed and wheel_torque: no body motion is commanded
  bool is_open = false;       ///< true: open all bridges
};

/// Result of stage 3: reference of one wheel.
struct WheelReference {
  float speed_rad_per_s;
  float acceleration_rad_per_s2;
};
struct WheelReferences {
  WheelReference wheel[kMostWheels];
};

/// Result of stages 4 and 5: requested voltages of one wheel.
struct WheelVoltage {
  float feed_forward_V;
  float wanted_V;  ///< feed-forward plus the speed control's voltage
};
struct WheelVoltages {
  WheelVoltage wheel[kMostWheels];
};

/// Result of stage 6: voltage of one wheel after the limits.
struct LimitedWheel {
  float voltage_V;
  float allowed_A;
  Reason reason;
  bool is_open;
};
struct LimitedVoltages {
  LimitedWheel wheel[kMostWheels];
};

Validated validate_input(const Config& config, State& state, const Input& input);
BodyReference control_body_velocity(const Config& config, State& state, const Input& input, const Validated& validated);
void find_wheel_speeds(const Config& config, const Input& input, const BodyReference& body, WheelReferences& wheels);
void feed_forward(const Config& config, const Input& input, const Validated& validated, const BodyReference& body,
                  const WheelReferences& wheels, WheelVoltages& voltage);
void control_wheel_speeds(const Config& config, State& state, const Validated& validated, const WheelReferences& wheels,
                          WheelVoltages& voltage);
LimitedVoltages apply_limits(const Config& config, State& state, const Validated& validated, const BodyReference& body,
                             const WheelVoltages& voltage);
/// Stage 7. Writes all members of `out`.
void make_output(const Config& config, const State& state, const Validated& validated, const LimitedVoltages& limited, Output& out);

// Parts of stage 1, mostly in sensor_comparison.cpp.

inline float rim_speed_m_per_s(const Config& config, int i, float speed_rad_per_s) {
  return speed_rad_per_s * config.wheel[i].rim_per_speed_m;
}

/// True if a sensed current is so far above the limit that this is neither noise nor settling.
inline bool is_overcurrent(const Config& config, const WheelState& wheel, float sensed_A) {
  constexpr float kOvercurrent_ratio = 1.3F;
  return absolute(sensed_A) > kOvercurrent_ratio * wheel.current_bound_A + config.derived.current_margin_A;
}

/// Yaw rate that the validated wheel speeds imply.
float yaw_rate_of_wheels(const Config& config, const Validated& validated);

/// Range of the speeds that the smallest sufficient sets of sensors give for a wheel: its own sensor, two others with the gyro, or three
/// others. With four wheels and a gyro any two sensors may be wrong: while the wheels roll, one of these speeds is the true one.
struct SpeedRange {
  float slowest_rad_per_s = std::numeric_limits<float>::infinity();
  float fastest_rad_per_s = -std::numeric_limits<float>::infinity();

  void add(float speed_rad_per_s) {
    slowest_rad_per_s = smaller(slowest_rad_per_s, speed_rad_per_s);
    fastest_rad_per_s = larger(fastest_rad_per_s, speed_rad_per_s);
  }
  bool is_known() const { return slowest_rad_per_s <= fastest_rad_per_s; }
};
/// Calculates the range of one wheel (speed_range.cpp). The range is empty if no accepted set of sensors determines the speed.
SpeedRange speed_range(const Config& config, const State& state, const Validated& validated, int wheel);
/// Three wheels, or a rejected sensor: at most one more may be wrong.
void check_redundancy(const Config& config, const State& state, Validated& validated);
/// Every sample may belong to each wheel: the spread is at least the difference between the fastest and the slowest rim.
void widen_spread(const Config& config, Validated& validated);

/// A set determines no speed if two rolling directions have a smaller sine (8 degrees apart), or three span a smaller doubled area.
inline constexpr float kLeastArea_ratio = 0.14F;
/// Bits of WheelConfig::sets: sets of the next three wheels a, b and c that determine the speed of a wheel, pairs together with the gyro.
inline constexpr std::uint32_t kSetOfAB = 1U;
inline constexpr std::uint32_t kSetOfBC = 2U;
inline constexpr std::uint32_t kSetOfCA = 4U;
inline constexpr std::uint32_t kSetOfThree = 8U;
/// Twice the signed area of the triangle between the tips of three rolling direction vectors.
inline float area(const WheelConfig& a, const WheelConfig& b, const WheelConfig& c) {
  return (b.rolling_x_share - a.rolling_x_share) * (c.rolling_y_share - a.rolling_y_share) -
         (b.rolling_y_share - a.rolling_y_share) * (c.rolling_x_share - a.rolling_x_share);
}
/// Sine of the angle from the rolling direction of `a` to the rolling direction of `b`.
inline float cross(const WheelConfig& a, const WheelConfig& b) {
  return a.rolling_x_share * b.rolling_y_share - a.rolling_y_share * b.rolling_x_share;
}

/// A relative error of a wheel speed up to this share is within slip and noise.
inline constexpr float kSlipAndNoise_share = 0.125F;

/// Parts of a period in which State::rounded_up counts.
inline constexpr float kPeriodParts_ratio = 1024.0F;

inline constexpr std::uint32_t kStepsPerComparison = 16;

/// Compares sensors with each other: finds stuck and swapped ones, and accepts those again that have recovered.
void compare_sensors(const Config& config, State& state, const Input& input, Validated& validated);

/// Value of State::is_valid after start(). It contains the places of the members that restore() reads from a copy, so that a copy from
/// firmware with another layout is refused. Change kMeaning if one of them gets another meaning in the same place.
constexpr std::uint32_t started_mark() {
  constexpr std::uint32_t kMeaning = 0x4452564EU;
  constexpr std::uint32_t kPlaces[] = {sizeof(State),
                                       __builtin_offsetof(State, wheel),
                                       sizeof(WheelState),
                                       __builtin_offsetof(WheelState, current_squared_A2),
                                       __builtin_offsetof(WheelState, driven_squared_V2),
                                       __builtin_offsetof(WheelState, guard_clock),
                                       __builtin_offsetof(WheelState, is_open),
                                       __builtin_offsetof(State, guard_clock),
                                       __builtin_offsetof(State, next_guard),
                                       __builtin_offsetof(State, comparison),
                                       __builtin_offsetof(ComparisonState, fitted),
                                       __builtin_offsetof(ComparisonState, ambient_C),
                                       __builtin_offsetof(State, guard),
                                       sizeof(GuardState),
                                       __builtin_offsetof(GuardState, state_C),
                                       __builtin_offsetof(GuardState, carry_K),
                                       __builtin_offsetof(GuardState, hidden_A2),
                                       __builtin_offsetof(GuardState, gap_bits)};
  std::uint32_t mark = kMeaning;
  for (const std::uint32_t place : kPlaces) {
    mark = (mark ^ place) * 0x01000193U;  // FNV-1a
  }
  return mark;
}
inline constexpr std::uint32_t kStarted = started_mark();

/// Check sum of the State from the member after the sum up to the comparisons.
std::uint64_t check_sum_of(const State& state);

/// Copies the faults of wheel speeds and yaw rate into ComparisonState, where a flipped bit in the rest of State does not reach them.
void note_faults(State& state);

/// Restores the known sensor faults from a copy. They survive a flipped bit in the rest of State, so that faulty sensors stay rejected.
void recall_faults(const ComparisonState& known, State& state);
/// Marks the sensors as fitted that had samples before a restart, so that their absence is a fault, and continues from the last air
/// temperature. Returns false if the copy fails its check sum.
bool recall_sensors(const ComparisonState& known, State& state);

/// Updates the check sum of the comparisons.
void seal(ComparisonState& comparison);

/// Steps the thermal guards that are due: each wheel's guard once per guard period, spread over that period.
void run_guards(const Config& config, State& state, const Input& input, const Validated& validated);

}  // namespace robot_core
