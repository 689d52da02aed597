// Reasons why a wheel gets less than the command asks for. Limits are normal operation, faults are not.
//
// Fault table. W concerns one wheel, R the whole robot. No fault in this table raises a limit of the current, and no reaction to one does,
// up to the highest speed of the guard's table and as long as faulty speed sensors do not agree with each other. Within the limits a faulty
// sensor can make the control drive more current until it is detected, for example a wheel sensor with a wrong scale or sign. Wheels
// without a fault still take their normal current while another one is held to Config::limp_current_A.
// clang-format off
//
// | code   | condition                                                   | reaction                                          | clears                          |
// |--------|-------------------------------------------------------------|---------------------------------------------------|---------------------------------|
// | 100 R  | start() found that Config fails its check sum or holds an   | all bridges open                                  | start() with a valid Config     |
// |        | impossible value                                            |                                                   |                                 |
// | 101 R  | State fails its check sum: a bit flip                       | bridges open for this step; State restarts, keeps | next step; guard cools down     |
// |        |                                                             | known faults, guard at its limit. ComparisonState |                                 |
// |        |                                                             | fails: currents distrusted, limp current for all  | sensors agree again             |
// |        | State was never started, or several bits of its mark flip   | all bridges open                                  | start()                         |
// | 102 R  | Input::elapsed_s not finite or below half a period          | all bridges open for this step; the guard counts  | next valid step                 |
// |        |                                                             | the largest current for kWatchdog_s if the bridge |                                 |
// |        |                                                             | was not open before                               |                                 |
// | 103 R  | Input::elapsed_s above kLongestGap_periods periods          | integrators and references restart; the guard     | next valid step                 |
// |        |                                                             | counts the largest current for the whole gap      |                                 |
// | 104 R  | command with a value that is not finite, or unknown mode    | all bridges open: the robot rolls out             | next valid command              |
// | 105 R  | Input::command_age_s above Config::command_timeout_s, or    | all bridges open: the robot rolls out             | next fresh command              |
// |        | not a number, or negative                                   |                                                   |                                 |
// | 106 R  | pose target without planner, or with a pose not finite or   | all bridges open: the robot rolls out             | next valid pose                 |
// |        | Input::pose_age_s not a number, negative or above           |                                                   |                                 |
// |        | Config::command_timeout_s                                   |                                                   |                                 |
// | 110 W  | wheel speed not finite, or above fastest_wheel_rad_per_s    | speed from the other wheels and the gyro,         | kSteadyAgain_s of agreement     |
// |        | after a jump                                                | current at most Config::limp_current_A            |                                 |
// | 111 W  | wheel speed changes by more than the motor can accelerate   | as 110                                            | as 110                          |
// |        | within the periods since the last step, in a gap within one |                                                   |                                 |
// | 112 W  | wheel speed constant in contradiction to all other sensors  | as 110                                            | as 110                          |
// | 113 W  | speed of one wheel follows the current of another           | as 110, both wheels                               | start()                         |
// |        | (swapped), while the robot is commanded to move; the sensed |                                                   |                                 |
// |        | currents and four speeds must not contradict the swap       |                                                   |                                 |
// | 114 W  | speed unknown: too few other wheels to estimate it          | limp_current_A by the current sensor, or less if  | as 110                          |
// |        |                                                             | the hot motor may not get it at every speed;      |                                 |
// |        |                                                             | bridge open without that sensor, or if no voltage |                                 |
// |        |                                                             | suits all samples                                 |                                 |
// | 115 W  | no wheel speed changes for kStanding_s while more than      | every current at most Config::limp_current_A, at  | a wheel speed changes           |
// |        | limp_current_A would flow through standing motors: all      | its estimated speed and standing: no runaway      |                                 |
// |        | sensors dead, or the robot is held                          |                                                   |                                 |
// | 116 R  | wheels turn for kRunaway_s without slowing down although    | all bridges open                                  | the wheels stand, or a body     |
// |        | the robot should stand, before swapped sensors are ruled    |                                                   | velocity is commanded           |
// |        | out: swapped sensors, or a push                             |                                                   |                                 |
// | 117 W  | one of four wheel speeds alone contradicts the others and   | as 110; also an opposite wheel that contradicts   | kSteadyAgain_s of agreement     |
// |        | the gyro for a second more than not, while a velocity or    | the rest as much, until it agrees with the rest   | while the wheel turns           |
// |        | pose is commanded: wrong sign, scale or offset, or long     |                                                   |                                 |
// |        | slipping; the other sensors must be accepted. Or a speed    |                                                   |                                 |
// |        | rises above fastest_wheel_rad_per_s without a jump          |                                                   |                                 |
// | 120 W  | motor current seen once, also before a restart; now not     | current from voltage, speed and guard temperature | next valid sample               |
// |        | finite or more than the battery can drive                   |                                                   |                                 |
// | 121 W  | motor current contradicts voltage and speed: a stuck        | as 120; the guard uses the larger magnitude; a    | kSteadyAgain_s of agreement     |
// |        | sensor, or a wrong wheel speed                              | sample far above the limit opens the bridge       |                                 |
// | 130 R  | battery voltage not finite, below half of the lowest or     | PWM for a full battery, limits for an empty one   | next valid sample; among the    |
// |        | above 1.1 times the full voltage                            |                                                   | first 20: the PWM's later, with |
// |        |                                                             |                                                   | 0.4 % of a full battery per s   |
// | 140 R  | yaw rate not finite, out of sensor range, or jumping        | yaw rate from the wheels                          | kSteadyAgain_s of agreement     |
// | 141 R  | yaw rate constant while the wheels turn the robot           | as 140                                            | as 140                          |
// | 150 R  | air temperature seen once, also before a restart; now not   | hottest declared air temperature                  | next valid sample               |
// |        | finite or out of range                                      |                                                   |                                 |
// | 151 W  | stator temperature seen once, also before a restart; now    | guard model without the sample                    | next valid sample               |
// |        | not finite or impossible                                    |                                                   |                                 |
// | 160 W  | guard state unknown: power-up without known rest, bit flip  | guard starts at its temperature limit             | guard cools down                |
// clang-format on
//
// A robot fault hides those after it in this order: 102, 101, 103, 130, 140 or 141, 150, 116, faults of the command. Fault 160 comes with
// 101.
//
// docs/firmware.md of Heatsoak lists what happens without a code, and the errors that are not recognised.
//
// A restart is one by fault 101, or one after a loss of power with restore() of guard_memory.h.
// Faults 111, 112 and 121 are found later or never if the robot file has no current limit of the driver.
#pragma once

#include <cstdint>

namespace robot_core {

/// Codes of limits and faults: 0 none, 1 to 99 limits, 100 and above faults. The numbers are stable because telemetry contains them.
enum class Reason : std::uint8_t {
  none = 0,
  // Limits of one wheel.
  voltage = 10,         ///< battery voltage or Config::voltage_limit_V
  driver_current = 11,  ///< Config::current_limit_A
  battery_sag = 12,     ///< without this limit the battery would sag below Config::battery_lowest_V
  traction = 13,        ///< the wheel contact cannot transmit more force
  guard = 14,           ///< current limit of the thermal guard
  other_wheel = 15,     ///< scaled together with a limited wheel to keep the direction of travel
  slip = 16,            ///< the current is within its limit for the wheel's own speed, but not for the speed that the other wheels imply
  unchecked = 17,       ///< too few sensors are left to detect another faulty one: Config::limp_current_A
  sensed_current = 18,  ///< the current sensor shows more current than voltage and speed explain
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
  wheel_speed_wrong = 117,
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
