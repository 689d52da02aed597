// Reasons why a wheel gets less than the command asks for. Limits are normal operation, faults are not.
//
// Fault table. W concerns one wheel, R the whole robot. No fault raises a limit of the current, and no reaction does. Within the limits a
// faulty sensor can make the control drive more current, for example a wheel sensor with a wrong scale or sign. Wheels without a fault
// still take their normal current while another one is held to Config::limp_current_A.
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
// | 114 W  | speed unknown: too few other wheels to estimate it          | limp_current_A by the current sensor; bridge open | as 110                          |
// |        |                                                             | without it, or if no voltage suits all samples    |                                 |
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
// | 130 R  | battery voltage not finite, below half of the lowest or     | PWM for a full battery, limits for an empty one   | next valid sample               |
// |        | above 1.1 times the full voltage                            |                                                   |                                 |
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
// Without a code:
//   - A low battery sample is no fault: a kicker may be charging. Limits use the sample; the PWM ratio uses the last open-circuit voltage.
//   - If a current sensor reads too low, the guard still counts the heat: it compares all samples with all voltages and speeds. This
//     includes a sensor that fails in step with the control loop, such as one with a shared ADC. In tests a winding was at most 2.2 K above
//     its guard (tests/robot_core/sensor_heat_test.cpp).
//   - Without a trusted current sensor a wrong wheel speed would hide heat. In every period the guard therefore calculates two currents:
//     one from the wheel's own speed, and one from the speed that follows from the other wheels and the gyro. It counts the larger one. A
//     wheel that slides more than the others then seems hotter than it is: with a grip of 0.3 the guards were 1.3 K hotter, and 6 K with
//     wheels that work against each other.
//     Without a spare sensor it counts at least the limp current, and a sample rejected by code 111 to 113 may be the correct one, unless
//     it stays constant for a second: the voltage then keeps the limp current for that sample, too, or the bridge opens.
//   - If the sample of the air temperature falls, the core follows it by at most 0.02 K/s; if it rises, by at most 0.01 K per step. A
//     stator sample above the guard's temperature raises it by at most 20 K/s.
//   - Periods of unequal length are rounded up for heat; a guard cools only for the time that has passed.
//   - After restore(), the guards continue their periods and count the largest current for the time in which the last voltage
//     may have acted. With restarts every 1 to 100 periods a winding was at most 0.3 K above its guard. A guard that could not count for
//     two guard periods gets code 160, and so does a guard whose copy comes from firmware with another layout of the State.
//   - Each voltage keeps the current limit for every speed that the wheel may have. These speeds come from its own sensor, from each two
//     other wheels with the gyro, and from three other wheels. With four wheel sensors and a gyro, any two may be wrong without a higher
//     current while the wheels roll. With one sensor less (three wheels, or after a fault) one may be wrong. Swapped wheel sensors are then
//     assumed until driving has ruled them out (kConfirmations). The search for fault 113 also ends there. Without a spare sensor every
//     current is limited to limp_current_A (limit 17). If two wheels have fault 117 and both contradict the rest, the correct samples may be
//     the rejected ones. All samples then count: a bridge opens unless one voltage keeps the limp current for every sufficient set of them.
//   - The bridge opens if no voltage keeps the limit by the current sensor and by the speeds, or if the sensed current is far above it
//     (code 16 or 18). The other wheels are not scaled then, because the robot must still
//     drive home.
//   - If sensed current or slip hold one wheel back, all are scaled from the next period on, so that the direction of travel is kept: to a
//     quarter at least, because the sensor of that wheel may be wrong.
//   - A command fault (104 to 106) opens the bridges, because braking takes more current than rolling. A robot that must brake gets
//     Mode::brake.
//
// Not recognised (tests/robot_core/adversarial_test.cpp has the magnitudes). Current limits and guard hold unless stated otherwise:
//   - Swapped wheel sensors until they are found, which depends on the drive: in one smooth drive of RoboTeam Twente's robot of 2024 after
//     0.15 s for wheels 1 and 3 or 2 and 4, 0.7 s for 2 and 3, 2.8 s for 1 and 4, 4.9 s for 3 and 4, not within 6 s for 1 and 2. Swapped
//     samples of opposite wheels, or of any two of three wheels, fit another motion of the robot equally well. Only the reaction to
//     currents shows the swap. On three wheels a current may exceed the limit by up to 1.7 A for 0.2 s, also after fault 113. With
//     torque commands it may exceed the limit for two periods at a time.
//   - Wrong wiring or units of motors: one motor reversed, the leads of two motors swapped, all encoders reversed, all with one wrong scale.
//     Most drives show no code, others code 116 for about a second, or 113, 117 or 121 for a correct sensor. All encoders at half scale give
//     twice the speed limit. With swapped leads the current exceeds the limit by up to 1.7 A for 0.1 s at a time, with wheel speeds or
//     torques as commands by up to 5 A. docs/firmware.md has a first drive that finds each of these.
//   - One wheel sensor with a wrong scale, sign or offset, or stuck with noise, until fault 117. In 77 of 80 drives of 12 s a wrong sign
//     was found, after 1.4 s on average; a scale of a half in 70, after 4.5 s (tests/robot_core/wrong_wheel_sensor_test.cpp). The robot
//     then turns and its wheels work against each other. In the modes wheel_speed and wheel_torque fault 117 is not searched for. With a
//     torque command the wheel of a sensor that reads too much then accelerates up to its current limit. On three wheels its current
//     exceeds the limit for some periods at a time, because a bridge that its correct current sensor (121) opens closes again. Errors below
//     0.06 m/s plus 6 % of the speed limit are not found, larger ones of a fifth come and go with the speed, and none is found on three
//     wheels. Where opposite wheels are parallel, nothing tells which one is wrong: both stay rejected until the robot turns, without
//     current sensors with open bridges (114). A slipping wheel with a faulty speed sensor and no current sensor may exceed its limit.
//   - A wheel speed that is wrong except in the periods that are compared (every 16), for example by a triangle of 200 rad/s, in the mode
//     body_velocity: a correct wheel can get rejected (117). The robot then spins until its gyro is out of range (140), and even with
//     correct current sensors a wheel had twice its current limit for 0.3 s, several times.
//   - Three wheels without current sensors that spin faster than the gyro can measure, with one wrong speed: the gyro stays rejected (140),
//     and the wheel exceeds the limp current up to fourfold for a minute; the winding is up to 21 K hotter than the guard, with four wheels
//     up to 6 K. If two wheel sensors report twice their speed, a winding reaches 187 degC at a computed 120 degC.
//   - Three wheels, one of whose speeds drifts: its correct current sensor is distrusted (121), and a current of twice the limp current may
//     flow for seconds. The guard counts it.
//   - Three wheels with a dead current sensor, pushed: fault 113 comes more often (13 of 25 robots instead of 3) and with it currents above
//     1.3 times the limit. The guard was at most 3 K too cold with pushes below the grip, 11 K if all current sensors are dead as well.
//   - A current sensor that lies slightly above the limit makes a robot creep that should stand: up to 0.6 m in 3 s, within the limit.
//   - Two wheel sensors that show three to ten times the speed, for example turns per minute: until both are rejected (117), and while one
//     agrees with the correct sensors by chance. In 32 minutes of a wheel its current was above the limit for 0.5 s, by up to 7 A.
//   - A wheel speed and the current sensor of the same wheel, both wrong: 166 degC at a computed 144 degC.
//   - A wheel that carries less than a third of its load slides so often that it can get fault 117, and recovers only now and then: with a
//     tenth of its load the robot loses up to 40 % of its speed.
//   - Three wheels without current sensors, pushed with more than half of their grip in the first 10 s: half of them get fault 113 for two
//     wheels, and with it open bridges (114) until start().
//   - Without a spare sensor, fault 115 is shown while the robot stands. It clears with the first motion.
//   - More faulty speed sensors than spare ones: the current may exceed its limit for some periods. If all wheel sensors show 0, the robot
//     accelerates for kStanding_s before the limp current limits it (115). Rolling, it may then brake with up to twice the limp current.
//   - Pushes on a moving robot can look like swapped sensors until these are ruled out: two wheels then keep the limp current until
//     start(). Of robots pushed with three quarters of their grip for half of the first 10 s, fewer than 5 % with current sensors and 33 %
//     without (tests/robot_core/swapped_sensors_test.cpp). Of 10 000 robots pushed while they should stand, none.
//   - All wheel sensors dead with noise: they agree with each other, so the robot is not limited to the limp current. If they freeze
//     while it moves, currents exceed the limit by up to 1.9 A for 0.6 s at a time, with wheel speeds as commands by up to 3.3 A.
//   - A gyro with a wrong sign, scale or offset: the robot turns at a wrong rate. If the axles of the front wheels are within 20 degrees of
//     the x axis, or those of the rear wheels beyond 160 degrees, it can look like a wrong wheel sensor (117).
//   - A pose that jumps, or is wrong although its age is valid: a pose target then leads to a wrong place.
//   - An air temperature that is too low, from the start or later: in the end the guard is too cold by the same amount.
//   - A correct robot on slippery ground (grip below a half) with three wheels and a coarse encoder: short faults 112. A robot with a grip
//     of 0.3 was once in 400 drives left with fault 113 without a push.
//   - An invalid timer (102) that hides a gap longer than kWatchdog_s, in firmware without such a watchdog. If the timer reports half of
//     the true period, the winding is up to 18 K hotter than the guard. The same holds for firmware without a timer whose loop is too slow.
//   - A battery sensor with a constant wrong factor since the start or a fault, or one that sinks more slowly than 0.4 % of the full
//     battery per second, or reads too low for minutes: the voltage exceeds its limit by that factor and the current by more: twice its
//     limit for a second with a factor of 1.25. Without current sensors a sensor that reads 20 % too little hides up to 7 K.
//   - A wrong command with plausible values.
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
