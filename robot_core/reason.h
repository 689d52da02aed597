// Why a wheel gets less than was asked for: limits, which are normal, and faults, which are not.
//
// Fault table. W concerns one wheel, R the whole robot. No reaction allows more current than the limits allow without the fault. Braking to
// a stand takes current, and so do the other wheels where one is limited to Config::limp_current_A.
// clang-format off
//
// | code   | condition                                                   | reaction                                          | clears                          |
// |--------|-------------------------------------------------------------|---------------------------------------------------|---------------------------------|
// | 100 R  | start() found that Config fails its check sum or holds an   | all bridges open                                  | start() with a valid Config     |
// |        | impossible value                                            |                                                   |                                 |
// | 101 R  | State fails its check sum (bit flip, never started)         | State is started anew with the sensor faults that | next step; the guard cools down |
// |        |                                                             | were known, guard as hot as its limit; in         |                                 |
// |        |                                                             | ComparisonState: currents doubted, speeds limp    | sensors agree again             |
// | 102 R  | Input::elapsed_s not finite or below half a period          | all bridges open for this step                    | next valid step                 |
// | 103 R  | Input::elapsed_s above kLongestGap_periods periods          | integrators and references start anew; the guard  | next valid step                 |
// |        |                                                             | heats for the gap with the largest current        |                                 |
// | 104 R  | command with a value that is not finite, or unknown mode    | brake to a stand, then open                       | next valid command              |
// | 105 R  | Input::command_age_s above Config::command_timeout_s, or    | brake to a stand, then open                       | next fresh command              |
// |        | not a number, or negative                                   |                                                   |                                 |
// | 106 R  | pose target without a planner, or with a pose that is not   | brake to a stand, then open                       | next valid pose                 |
// |        | finite or whose age (Input::pose_age_s) is not a number,    |                                                   |                                 |
// |        | negative or above Config::command_timeout_s                 |                                                   |                                 |
// | 110 W  | wheel speed not finite or beyond what the motor reaches     | speed from the other wheels and the gyro,         | kSteadyAgain_s of agreement     |
// |        |                                                             | current at most Config::limp_current_A            |                                 |
// | 111 W  | wheel speed jumps by more than the motor can accelerate     | as 110                                            | as 110                          |
// | 112 W  | wheel speed stays at one value against all other evidence   | as 110                                            | as 110                          |
// | 113 W  | speed of one wheel changes with the current of another      | as 110, both wheels                               | start()                         |
// |        | (swapped), while the robot is asked to move                 |                                                   |                                 |
// | 114 W  | speed unknown: too few other wheels to estimate it          | voltage of at most limp_current_A times the       | as 110                          |
// |        |                                                             | resistance; open where current is not sensed      |                                 |
// | 115 W  | no wheel speed changes for kStanding_s while more than      | every current at most Config::limp_current_A, as  | a wheel speed changes           |
// |        | limp_current_A would flow through standing motors: all      | of standing motors: the robot does not run away   |                                 |
// |        | sensors dead, or the robot is held                          |                                                   |                                 |
// | 116 R  | the wheels turn for kRunaway_s without slowing down, by     | all bridges open                                  | the wheels stand                |
// |        | more than 0.1 m/s each, although the robot should stand:    |                                                   |                                 |
// |        | swapped sensors, or somebody pushes it                      |                                                   |                                 |
// | 120 W  | motor current not finite or beyond what the battery drives  | current from voltage, speed and guard temperature | next valid sample               |
// | 121 W  | motor current contradicts voltage and speed (stuck sensor)  | as 120; the guard takes the larger of both        | kSteadyAgain_s of agreement     |
// | 130 R  | battery voltage not finite, below half of the lowest or     | PWM as for a full battery, limits as for an empty | next valid sample               |
// |        | above 1.1 times the full voltage                            |                                                   |                                 |
// | 140 R  | yaw rate not finite, beyond the sensor, or jumping          | yaw rate from the wheels                          | kSteadyAgain_s of agreement     |
// | 141 R  | yaw rate stays at one value while the wheels turn the robot | as 140                                            | as 140                          |
// | 150 R  | air temperature seen once, now not finite or out of range   | hottest declared air                              | next valid sample               |
// | 151 W  | stator temperature seen once, now not finite or impossible  | model alone                                       | next valid sample               |
// | 160 W  | guard state unknown: power returned, rest unknown, bit flip | guard as hot as its limit                         | the guard cools down            |
// clang-format on
//
// A robot fault hides those below it: 102, 101, 103, 130, 140 or 141, 150, 116, then the command's. 160 comes with 101.
//
// Without a code:
//   - A low battery sample is no fault: a kicker may be charging. Limits use the sample. The PWM ratio uses the last voltage without load.
//   - A current sensor that reads too little hides no heat from the guard, which compares it with voltage and speed.
//   - The core follows an air temperature that falls by at most 0.02 K/s.
//   - Each voltage keeps the current limit for every speed that the wheel may have: the speed of its own sensor, the speeds that each two
//     other wheels imply with the gyro, and the speed that three other wheels imply. Any two sensors of four wheels and a gyro may be
//     wrong without more current as long as the wheels roll. With one sensor less (three wheels, or after a fault) any single one may be
//     wrong; swapped wheel sensors are assumed until enough driving (kConfirmations) has shown that none are swapped. Fault 113 is looked
//     for until then. If no sensor is to spare, every current is limited to limp_current_A (limit 17).
//   - The bridge opens if the current sensor and the speeds leave no common voltage.
//   - The stop after a fault of the command (104 to 106) keeps the acceleration limit and uses no braking reserve of the guard.
//
// Not recognised (tests/robot_core/adversarial_test.cpp has the sizes); current limits and guard hold unless stated:
//   - Swapped wheel sensors until they are found, after 0.1 to 0.4 s of driving on average. Swapped samples of opposite wheels, or of any
//     two of three, fit a different motion of the robot equally well; only the reaction to currents shows the swap.
//   - One wheel sensor with a wrong scale, sign or offset, or one that is stuck with noise: the robot turns and its wheels work against
//     each other. Sliding wheels look the same. A slipping wheel with a wrong speed sensor and no current sensor may exceed its limit.
//   - More wrong speed sensors than are to spare: the current may exceed its limit for some periods. If all wheel sensors show 0 the robot
//     accelerates for kStanding_s before it is held to the limp current (115).
//   - Pushes on a moving robot before swapped sensors are ruled out can look like swapped sensors: two wheels then keep the limp current
//     until start().
//   - All wheel sensors dead with noise: they agree with each other, so the robot is not held to the limp current.
//   - A gyro with a wrong sign, scale or offset: the robot turns wrongly.
//   - A pose that jumps, or one that is wrong with a valid age: a pose target then leads anywhere.
//   - An air temperature that is too low since the start: the guard is too cold by as much.
//   - A timer that is invalid (102) and hides a gap: the heat of that gap is not counted. The watchdog of the firmware bounds it.
//   - A battery sensor that is wrong by the same factor since the start or since a fault, that sinks more slowly than 0.4 % of the full
//     battery per second, or that stays too low for minutes: the current may exceed its limit by that factor.
//   - A command that is wrong but possible.
// Faults 111, 112 and 121 are found later, or not at all, if the robot's file has no current limit of the driver.
#pragma once

#include <cstdint>

namespace robot_core {

/// Stable numbers: they travel in telemetry. 0 nothing, 1 to 99 limits, from 100 on faults.
enum class Reason : std::uint8_t {
  none = 0,
  // Limits of one wheel.
  voltage = 10,         ///< battery voltage or Config::voltage_limit_V
  driver_current = 11,  ///< Config::current_limit_A
  battery_sag = 12,     ///< the battery would sag below Config::battery_lowest_V
  traction = 13,        ///< the contact cannot pass on more
  guard = 14,           ///< allowed current of the thermal guard
  other_wheel = 15,     ///< scaled with a limited wheel, so that the direction of travel is kept
  slip = 16,            ///< the current is within its limit for the wheel's speed, but not for the speed that the other wheels imply
  unchecked = 17,       ///< too few sensors are left to show that another one lies: Config::limp_current_A
  // Faults.
  config_invalid = 100,
  state_corrupted = 101,
  period_invalid = 102,
  time_jump = 103,
  command_invalid = 104,
  command_stale = 105,
  pose_invalid = 106,
  wheel_speed_missing = 110,
  wheel_speed_jump = 111,
  wheel_speed_stuck = 112,
  wheel_speed_swapped = 113,
  wheel_speed_unknown = 114,
  wheel_speeds_dead = 115,
  runaway = 116,
  current_missing = 120,
  current_implausible = 121,
  battery_voltage_missing = 130,
  yaw_rate_missing = 140,
  yaw_rate_stuck = 141,
  ambient_missing = 150,
  stator_missing = 151,
  guard_unknown = 160,
};

constexpr bool is_fault(Reason reason) { return static_cast<std::uint8_t>(reason) >= 100; }

}  // namespace robot_core
