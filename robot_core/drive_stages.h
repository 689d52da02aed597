// The stages of step(), in order, and the signals between them. One file each: input_validation.cpp, body_velocity_control.cpp,
// wheel_speeds.cpp, feed_forward.cpp, wheel_speed_control.cpp, limits.cpp, output.cpp. block_diagram.h declares the same for people.
#pragma once

#include "robot_core/drive_core.h"
#include "robot_core/math.h"

namespace robot_core {

// Values per wheel are written by every stage for the wheels that the robot has, so they have no values before.

/// Stage 1: what is believed of one wheel.
struct ValidatedWheel {
  float speed_rad_per_s;    ///< sensed, else implied, else 0
  float implied_rad_per_s;  ///< by the other wheels and the gyro; the sensed speed where they say nothing. Of stage 1 alone
  float current_A;          ///< sensed, else estimated from voltage and speed
  bool is_speed_known;      ///< sensed or implied
  bool is_speed_sensed;
  bool is_current_sensed;
};

struct Validated {
  ValidatedWheel wheel[kMostWheels];
  float yaw_rate_rad_per_s = 0.0F;
  Vector3 velocity;            ///< of the body, local frame
  float battery_V = 0.0F;      ///< for limits: never more than the true one is likely to be
  float pwm_battery_V = 0.0F;  ///< for the PWM ratio: never less
  float ambient_C = 0.0F;
  float elapsed_s = 0.0F;  ///< since the last step: a whole number of periods
  int guard_periods = 1;   ///< the same as periods, and one more as often as small delays add up to one
  float spread_V = 0.0F;  ///< bound of the difference between estimates of one back-EMF from different sensors; infinite: use speed_range()
  bool is_redundancy_reduced = false;  ///< three wheels, or a speed sensor or the gyro is not believed
  bool is_checked = true;              ///< enough sensors are left that a wrong one contradicts the others
  bool are_all_sensed = true;
  bool are_samples_compared = false;  ///< too few are believed: implied speeds are those of all samples
  Mode mode = Mode::coast;            ///< after faults of the command
  Reason command_fault = Reason::none;
  Reason robot_fault = Reason::none;
};

/// Stage 2.
struct BodyReference {
  Vector3 velocity;           ///< local frame
  Vector3 acceleration;       ///< as seen from the field, resolved in the local frame
  Vector3 push;               ///< on something outside
  bool is_wheelwise = false;  ///< wheel_speed or wheel_torque: no body motion is asked for
  bool is_open = false;       ///< coast
};

/// Stage 3.
struct WheelReference {
  float speed_rad_per_s;
  float acceleration_rad_per_s2;
};
struct WheelReferences {
  WheelReference wheel[kMostWheels];
};

/// Stages 4 and 5: voltages that are asked for.
struct WheelVoltage {
  float feed_forward_V;
  float wanted_V;  ///< with the speed control's share
};
struct WheelVoltages {
  WheelVoltage wheel[kMostWheels];
};

/// Stage 6.
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
/// Writes all of `out`.
void make_output(const Config& config, const State& state, const Validated& validated, const LimitedVoltages& limited, Output& out);

// Parts of stage 1, in sensor_comparison.cpp.

inline float rim_speed_m_per_s(const Config& config, int i, float speed_rad_per_s) {
  return speed_rad_per_s * config.wheel[i].rim_per_speed_m;
}

/// Yaw rate that the sensed wheel speeds imply.
float yaw_rate_of_wheels(const Config& config, const Validated& validated);

/// Speeds that a wheel has by every smallest set of sensors that determines it: its own, two others and the gyro, or three others. Of
/// four wheels and a gyro any two may lie: one of these speeds is true, as long as the wheels roll.
struct SpeedRange {
  float slowest_rad_per_s = std::numeric_limits<float>::infinity();
  float fastest_rad_per_s = -std::numeric_limits<float>::infinity();

  void add(float speed_rad_per_s) {
    slowest_rad_per_s = smaller(slowest_rad_per_s, speed_rad_per_s);
    fastest_rad_per_s = larger(fastest_rad_per_s, speed_rad_per_s);
  }
  bool is_known() const { return slowest_rad_per_s <= fastest_rad_per_s; }
};
/// In speed_range.cpp. Empty where no such set is believed.
SpeedRange speed_range(const Config& config, const State& state, const Validated& validated, int wheel);

/// Two wheels whose rolling directions differ by less than 8 degrees (sine), or three that span a smaller doubled area, determine no speed.
inline constexpr float kLeastArea_ratio = 0.14F;
/// Twice the signed area of the triangle between the ends of three unit vectors along rolling directions.
inline float area(const WheelConfig& a, const WheelConfig& b, const WheelConfig& c) {
  return (b.rolling_x_share - a.rolling_x_share) * (c.rolling_y_share - a.rolling_y_share) -
         (b.rolling_y_share - a.rolling_y_share) * (c.rolling_x_share - a.rolling_x_share);
}
/// Sine of the angle from the rolling direction of `a` to that of `b`.
inline float cross(const WheelConfig& a, const WheelConfig& b) {
  return a.rolling_x_share * b.rolling_y_share - a.rolling_y_share * b.rolling_x_share;
}

/// Compares sensors with each other: stuck and swapped ones, and those that are believed again.
void compare_sensors(const Config& config, State& state, const Input& input, Validated& validated);

/// Copies the faults of wheel speeds and yaw rate to where a flipped bit in the rest of State does not reach them.
void note_faults(State& state);

/// Known sensor faults and the battery's voltage. They survive a flipped bit in the rest of State, so that no sensor is believed again.
struct KnownFaults {
  ComparisonState comparison;
  float battery_source_V;
};
void recall_faults(const KnownFaults& known, State& state);

/// Sets the check sum of the comparisons.
void seal(ComparisonState& comparison);

/// Steps the thermal guards that are due: each wheel's once per guard period, spread over the period.
void run_guards(const Config& config, State& state, const Input& input, const Validated& validated);

}  // namespace robot_core
