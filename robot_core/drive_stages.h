// The stages of step(), in order, and the signals between them. One file each: input_validation.cpp, body_velocity_control.cpp,
// wheel_speeds.cpp, feed_forward.cpp, wheel_speed_control.cpp, limits.cpp, output.cpp. block_diagram.h declares the same for people.
#pragma once

#include "robot_core/drive_core.h"

namespace robot_core {

/// Stage 1: what is believed.
struct Believed {
  PerWheel wheel_speed_rad_per_s = {};
  PerWheel implied_speed_rad_per_s = {};  ///< of each wheel, by the other wheels and the gyro; its own where that cannot be had
  PerWheel motor_current_A = {};          ///< sensed, else the largest that voltage and speed allow
  float yaw_rate_rad_per_s = 0.0F;
  Vector3 velocity;            ///< of the body, local frame
  float battery_V = 0.0F;      ///< for limits: never more than the true one is likely to be
  float pwm_battery_V = 0.0F;  ///< for the PWM ratio: never less
  float ambient_C = 0.0F;
  float elapsed_s = 0.0F;  ///< since the last step: a whole number of periods
  int elapsed_periods = 1;
  bool are_all_sensed = true;
  bool is_speed_known[kMostWheels] = {};  ///< sensed or implied
  bool is_speed_sensed[kMostWheels] = {};
  bool is_current_sensed[kMostWheels] = {};
  Mode mode = Mode::coast;  ///< after faults of the command
  Reason command_fault = Reason::none;
  Reason robot_fault = Reason::none;
};

/// Stage 2.
struct BodyReference {
  Vector3 velocity;      ///< local frame
  Vector3 acceleration;  ///< as seen from the field, resolved in the local frame
  Vector3 push;
  bool is_wheelwise = false;  ///< wheel_speed or wheel_torque: no body motion is asked for
  bool is_open = false;       ///< coast
};

/// Stage 3.
struct WheelReference {
  PerWheel speed_rad_per_s = {};
  PerWheel acceleration_rad_per_s2 = {};
};

/// Stage 4 and 5: voltages that are asked for.
struct WheelVoltage {
  PerWheel feed_forward_V = {};
  PerWheel wanted_V = {};
};

/// Stage 6.
struct LimitedVoltage {
  PerWheel voltage_V = {};
  PerWheel allowed_A = {};
  bool is_open[kMostWheels] = {};
  Reason reason[kMostWheels] = {};
};

Believed validate_input(const Config& config, State& state, const Input& input);
BodyReference control_body_velocity(const Config& config, State& state, const Input& input, const Believed& believed);
WheelReference find_wheel_speeds(const Config& config, const Input& input, const BodyReference& body);
WheelVoltage feed_forward(const Config& config, const Input& input, const Believed& believed, const BodyReference& body,
                          const WheelReference& wheels);
void control_wheel_speeds(const Config& config, State& state, const Believed& believed, const WheelReference& wheels,
                          WheelVoltage& voltage);
LimitedVoltage apply_limits(const Config& config, State& state, const Believed& believed, const BodyReference& body,
                            const WheelVoltage& voltage);
Output make_output(const Config& config, const State& state, const Believed& believed, const LimitedVoltage& limited);

/// Steps the thermal guards that are due: each wheel's once per guard period, spread over the period.
void run_guards(const Config& config, State& state, const Input& input, const Believed& believed);

}  // namespace robot_core
