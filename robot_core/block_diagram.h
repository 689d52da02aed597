// Blocks and signals of the drive core for readers: `heatsoak describe robot_core` prints these tables and draws them. drive_core.cpp and
// drive_stages.h declare the same for the compiler. A test compares both, so change both together.
#pragma once

namespace robot_core {

/// Blocks in the order in which step() calls them. The stage before the planner calls the planner; the firmware calls step().
enum class Block : unsigned char {
  firmware,
  validate_input,
  run_guards,
  control_body_velocity,
  plan_to_pose,
  find_wheel_speeds,
  feed_forward,
  control_wheel_speeds,
  apply_limits,
  make_output,
};

enum class BlockRate : unsigned char {
  every_period,             ///< Config::period_s
  every_second_period,      ///< every second period while a body velocity or braking is commanded, else every period
  every_guard_period,       ///< GuardModel::period_s, once per wheel
  every_period_of_command,  ///< Config::period_s while the command has the mode that uses the block
};

struct BlockText {
  Block block;
  const char* function;  ///< name in namespace robot_core
  const char* files;     ///< files of robot_core/; the first one defines the function
  const char* number;    ///< stage number, or a letter for a block beside the stages
  const char* title;
  const char* task;  ///< purpose in one sentence
  BlockRate rate;
};

inline constexpr BlockText kBlocks[] = {
    {Block::validate_input, "validate_input", "input_validation.cpp, sensor_comparison.cpp, speed_range.cpp", "1", "Input validation",
     "Decides which samples are accepted, replaces the others by estimates, and recognises faults of sensors, time and command.",
     BlockRate::every_period},
    {Block::run_guards, "run_guards", "guards.cpp, thermal_guard.cpp", "G", "Thermal guard",
     "Integrates the motor temperatures of each wheel and reads from the derating table how much current the motor may carry.",
     BlockRate::every_guard_period},
    {Block::control_body_velocity, "control_body_velocity", "body_velocity_control.cpp", "2", "Body velocity control",
     "Turns the command into velocity and acceleration of the body, within the limits of motion, and corrects errors of the motion.",
     BlockRate::every_second_period},
    {Block::plan_to_pose, "plan_to_pose", "pose_target.cpp, trajectory.cpp, trajectory_plane.cpp", "P", "Planner of pose targets",
     "Plans the time-optimal way to the pose target and returns its next period. Firmware that does not use it does not contain it.",
     BlockRate::every_period_of_command},
    {Block::find_wheel_speeds, "find_wheel_speeds", "wheel_speeds.cpp", "3", "Wheel speeds",
     "Calculates speed and acceleration of each wheel from the motion of the body, with measured slip.", BlockRate::every_second_period},
    {Block::feed_forward, "feed_forward", "feed_forward.cpp", "4", "Feed-forward",
     "Calculates the voltages that the motion needs: back-EMF, friction over the direction of travel, inertia.",
     BlockRate::every_second_period},
    {Block::control_wheel_speeds, "control_wheel_speeds", "wheel_speed_control.cpp", "5", "Wheel speed control",
     "Adds the voltages of a PI controller for each wheel's speed.", BlockRate::every_period},
    {Block::apply_limits, "apply_limits", "limits.cpp", "6", "Limits",
     "Scales the currents of all wheels to what voltage, driver, battery, grip and thermal guard leave, and opens bridges.",
     BlockRate::every_period},
    {Block::make_output, "make_output", "output.cpp", "7", "Output",
     "Converts voltages to PWM ratios of the battery voltage and collects reasons and warnings.", BlockRate::every_period},
};

/// Set of blocks, one bit per block.
using Blocks = unsigned;
constexpr Blocks only(Block block) { return 1U << static_cast<unsigned>(block); }
constexpr Blocks operator|(Block a, Block b) { return only(a) | only(b); }
constexpr Blocks operator|(Blocks a, Block b) { return a | only(b); }
constexpr bool contains(Blocks blocks, Block block) { return (blocks & only(block)) != 0; }

struct SignalText {
  const char* carrier;  ///< struct that is passed on, or State if the signal is kept between calls
  const char* name;     ///< member of the carrier; "wheel." stands for wheel[i].
  const char* unit;     ///< unit, of a vector those of plane and yaw; "flag", "code" or "count" if there is none
  Block from;
  Blocks to;
};

namespace diagram {

using enum Block;

/// Signals, sorted by carrier and writing block. A block that runs before the writer in the order above reads the value of the previous
/// period.
inline constexpr SignalText kSignals[] = {
    {"Input", "wheel_speed_rad_per_s", "rad/s", firmware, only(validate_input)},
    {"Input", "motor_current_A", "A", firmware, only(validate_input)},
    {"Input", "battery_V", "V", firmware, only(validate_input)},
    {"Input", "yaw_rate_rad_per_s", "rad/s", firmware, only(validate_input)},
    {"Input", "ambient_C", "°C", firmware, only(validate_input)},
    {"Input", "stator_C", "°C", firmware, only(run_guards)},
    {"Input", "pose", "m, rad", firmware, validate_input | control_body_velocity},
    {"Input", "pose_age_s", "s", firmware, validate_input | control_body_velocity},
    {"Input", "elapsed_s", "s", firmware, only(validate_input)},
    {"Input", "command_age_s", "s", firmware, validate_input | control_body_velocity},
    {"Input", "command.mode", "code", firmware, validate_input | find_wheel_speeds},
    {"Input", "command.velocity", "m/s, rad/s", firmware, validate_input | control_body_velocity},
    {"Input", "command.acceleration", "m/s2, rad/s2", firmware, validate_input | control_body_velocity},
    {"Input", "command.push", "N, N m", firmware, validate_input | control_body_velocity},
    {"Input", "command.wheel_speed_rad_per_s", "rad/s", firmware, validate_input | find_wheel_speeds},
    {"Input", "command.wheel_torque_Nm", "N m", firmware, validate_input | feed_forward},
    {"Input", "command.pose", "m, rad", firmware, validate_input | plan_to_pose},
    {"Validated", "wheel.speed_rad_per_s", "rad/s", validate_input, run_guards | feed_forward | control_wheel_speeds | apply_limits},
    {"Validated", "wheel.implied_rad_per_s", "rad/s", validate_input, only(apply_limits)},
    {"Validated", "spread_V", "V", validate_input, only(apply_limits)},
    {"Validated", "is_redundancy_reduced", "flag", validate_input, only(apply_limits)},
    {"Validated", "is_checked", "flag", validate_input, run_guards | apply_limits},
    {"Validated", "is_any_possible", "flag", validate_input, only(apply_limits)},
    {"Validated", "are_samples_compared", "flag", validate_input, only(apply_limits)},
    {"Validated", "common_reason", "code", validate_input, only(apply_limits)},
    {"Validated", "wheel.current_A", "A", validate_input, run_guards | apply_limits},
    {"Validated", "wheel.is_speed_known", "flag", validate_input, run_guards | apply_limits},
    {"Validated", "wheel.is_speed_sensed", "flag", validate_input, control_wheel_speeds | apply_limits},
    {"Validated", "wheel.is_current_sensed", "flag", validate_input, run_guards | apply_limits},
    {"Validated", "velocity", "m/s, rad/s", validate_input, only(control_body_velocity)},
    {"Validated", "battery_V", "V", validate_input, only(apply_limits)},
    {"Validated", "pwm_battery_V", "V", validate_input, apply_limits | make_output},
    {"Validated", "ambient_C", "°C", validate_input, only(run_guards)},
    {"Validated", "elapsed_s", "s", validate_input, run_guards | control_body_velocity | control_wheel_speeds | apply_limits},
    {"Validated", "guard_periods", "count", validate_input, only(run_guards)},
    {"Validated", "were_sensors_compared", "flag", validate_input, only(run_guards)},
    {"Validated", "mode", "code", validate_input, control_body_velocity | feed_forward | control_wheel_speeds},
    {"Validated", "command_fault", "code", validate_input, only(make_output)},
    {"Validated", "robot_fault", "code", validate_input, run_guards | control_body_velocity | control_wheel_speeds | make_output},
    {"State", "wheel.speed_fault", "code", validate_input, only(apply_limits)},
    {"State", "wheel.current_fault", "code", validate_input, only(apply_limits)},
    {"State", "rounded_up", "count", validate_input, only(run_guards)},
    {"State", "wheel.allowed_A", "A", run_guards, only(apply_limits)},
    {"State", "wheel.allowed_braking_A", "A", run_guards, only(apply_limits)},
    {"State", "wheel.guard_fault", "code", run_guards, only(apply_limits)},
    {"State", "wheel.has_stator", "flag", run_guards, only(validate_input)},
    {"State", "wheel.conductance_A_per_V", "A/V", run_guards, only(validate_input)},
    {"State", "guard.state_C", "°C", run_guards, only(make_output)},
    {"State", "guard.time_to_limit_s", "s", run_guards, only(make_output)},
    {"BodyReference", "velocity", "m/s, rad/s", control_body_velocity, find_wheel_speeds | feed_forward},
    {"BodyReference", "acceleration", "m/s2, rad/s2", control_body_velocity, find_wheel_speeds | feed_forward},
    {"BodyReference", "push", "N, N m", control_body_velocity, only(feed_forward)},
    {"BodyReference", "is_wheelwise", "flag", control_body_velocity, find_wheel_speeds | feed_forward | apply_limits},
    {"BodyReference", "is_open", "flag", control_body_velocity, only(apply_limits)},
    {"State", "velocity_reference", "m/s, rad/s", control_body_velocity, only(validate_input)},
    {"State", "plan_velocity", "m/s, rad/s", control_body_velocity, only(validate_input)},
    {"State", "plan_velocity", "m/s, rad/s", plan_to_pose, only(control_body_velocity)},
    {"State", "plan_acceleration", "m/s2, rad/s2", plan_to_pose, only(control_body_velocity)},
    {"WheelReferences", "wheel.speed_rad_per_s", "rad/s", find_wheel_speeds, feed_forward | control_wheel_speeds},
    {"WheelReferences", "wheel.acceleration_rad_per_s2", "rad/s2", find_wheel_speeds, only(feed_forward)},
    {"WheelVoltages", "wheel.feed_forward_V", "V", feed_forward, only(control_wheel_speeds)},
    {"WheelVoltages", "wheel.wanted_V", "V", control_wheel_speeds, only(apply_limits)},
    {"State", "wheel.integral_V", "V", control_wheel_speeds, only(apply_limits)},
    {"LimitedVoltages", "wheel.voltage_V", "V", apply_limits, only(make_output)},
    {"LimitedVoltages", "wheel.allowed_A", "A", apply_limits, only(make_output)},
    {"LimitedVoltages", "wheel.reason", "code", apply_limits, only(make_output)},
    {"LimitedVoltages", "wheel.is_open", "flag", apply_limits, only(make_output)},
    {"State", "wheel.integral_V", "V", apply_limits, only(control_wheel_speeds)},
    {"State", "wheel.voltage_V", "V", apply_limits, validate_input | run_guards},
    {"State", "wheel.driven_squared_V2", "V2", apply_limits, only(run_guards)},
    {"State", "wheel.earlier_V", "V", apply_limits, only(validate_input)},
    {"State", "wheel.is_open", "flag", apply_limits, validate_input | run_guards},
    {"State", "battery_current_A", "A", apply_limits, only(validate_input)},
    {"State", "is_limited", "flag", apply_limits, validate_input | control_body_velocity},
    {"Output", "pwm_ratio", "1", make_output, only(firmware)},
    {"Output", "voltage_V", "V", make_output, only(firmware)},
    {"Output", "is_open", "flag", make_output, only(firmware)},
    {"Output", "reason", "code", make_output, only(firmware)},
    {"Output", "allowed_current_A", "A", make_output, only(firmware)},
    {"Output", "winding_C", "°C", make_output, only(firmware)},
    {"Output", "time_to_guard_limit_s", "s", make_output, only(firmware)},
    {"Output", "is_warning", "flag", make_output, only(firmware)},
    {"Output", "robot_reason", "code", make_output, only(firmware)},
};

}  // namespace diagram
using diagram::kSignals;

}  // namespace robot_core
