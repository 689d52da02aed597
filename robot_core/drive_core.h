// The drive core: one control step of a robot on three or four omni wheels. The same source runs in simulation, under QEMU and on the
// robot.
//
//   State state{};
//   start(config, state, {.is_rested = true, .body_C = board_C});
//   every config.period_s:  Output out = step(config, state, input);
//
// step() is pure: no clock, no heap, no globals, no exceptions, no C library, single precision, bounded time. The seven stages and the
// signals between them are declared in drive_stages.h; reason.h has the fault table.
//
// Frames: local, x straight ahead, y to the left, angles counter-clockwise. Field frame: fixed. Wheel 1 first. A wheel with its axle at
// the angle alpha rolls along alpha + 90 degrees: all wheels positive turn the robot counter-clockwise. Speeds, torques, voltages and
// currents have the sign of the wheel's rotation. Currents are equivalent DC currents: motor torque per torque constant.
#pragma once

#include <cstdint>
#include <limits>

#include "robot_core/reason.h"
#include "robot_core/thermal_guard.h"
#include "robot_core/trajectory.h"

namespace robot_core {

inline constexpr int kMostWheels = 4;
/// A sensor that is not fitted, or has no sample.
inline constexpr float kNoSample = std::numeric_limits<float>::quiet_NaN();

/// Values per wheel; of a robot with three wheels the last is ignored.
using PerWheel = float[kMostWheels];

struct Vector3 {
  float x = 0.0F;
  float y = 0.0F;
  float yaw = 0.0F;
};

/// One wheel's geometry and drive.
struct WheelConfig {
  float rolling_x_share = 0.0F;  ///< unit vector t along which the wheel rolls, local frame
  float rolling_y_share = 0.0F;
  float inverse_x_factor = 0.0F;  ///< column of the pseudo-inverse of [t_x t_y R]: rim speeds to body velocity
  float inverse_y_factor = 0.0F;
  float inverse_yaw_per_m = 0.0F;
  float slip_factor = 1.0F;        ///< wheel speed per speed of a wheel that does not slip, measured; 1 where it is not
  float level_load_share = 0.25F;  ///< part of the weight that this wheel bears on level ground
  // Feed-forward, equations (2) and (3) of RoboTeam Twente, ETDP 2025: V = d·ω + f(θ), f(θ) = a·sin(θ+φ) + b·sign(sin(θ+φ)).
  float damping_V_s_per_rad = 0.0F;  ///< d, back-EMF included
  float sine_V = 0.0F;               ///< a
  float sign_V = 0.0F;               ///< b
  float phase_cosine_ratio = 1.0F;   ///< of φ
  float phase_sine_ratio = 0.0F;
  // Filled in by complete().
  float rim_per_speed_m = 0.0F;          ///< r/slip factor
  float speed_per_rim_per_m = 0.0F;      ///< and back
  float per_damping_rad_per_V_s = 0.0F;  ///< 1/d
  /// 1/(1 − tᵀ·P·t): turns the residual of the fit over all wheels into that of a fit without this wheel; 0: no such fit.
  float others_factor = 0.0F;
  float body_limit_A = 0.0F;        ///< smaller one of driver limit and grip on level ground
  std::uint32_t is_grip_limit = 0;  ///< grip is the smaller one
};

/// What follows from the rest of a Config; complete() fills it in, so that no step calculates it again.
struct DerivedConfig {
  float geared_constant_V_s_per_rad = 0.0F;  ///< K_t·n: back-EMF per wheel speed, torque per current at the wheel without loss
  float per_lowest_resistance_A_per_V = 0.0F;
  float per_resistance_A_per_V = 0.0F;
  float volt_per_Nm = 0.0F;         ///< at the wheel, driving
  float most_battery_sag_A = 0.0F;  ///< per V of sag: 1/R of the battery; 0 without one
  float per_tracking_time_per_s = 0.0F;
  float yaw_correction_per_s = 0.0F;  ///< yaw rate per integral of its error
  // P, inverse of Σ t·tᵀ over all wheels: body velocity in the plane from rim speeds, the yaw rate being known.
  float plane_xx_factor = 0.0F;
  float plane_xy_factor = 0.0F;
  float plane_yy_factor = 0.0F;
  float jump_rad_per_s = 0.0F;    ///< largest change of a wheel speed per period that is believed
  float current_margin_A = 0.0F;  ///< by which current sensor and motor equation may differ
  float most_sensed_A = 0.0F;     ///< more no battery can drive
  /// Largest difference between two estimates of one back-EMF, per sum of the sizes of the rim speeds' residuals.
  float spread_V_s_per_m = 0.0F;
  float sensed_slack_V = 0.0F;  ///< noise of a current sensor that does not take voltage away, while the speeds agree
};

/// What does not change while the robot runs. Written by `heatsoak generate core`, or by make_core_config() on the host.
struct Config {
  std::uint32_t check_sum = 0;  ///< config_check_sum(); start() refuses a Config without it
  std::int32_t wheel_count = 4;
  float period_s = 0.001F;
  // Geometry and mass.
  float wheel_radius_m = 0.0F;
  float contact_radius_m = 0.0F;  ///< R, from the robot's axis to the contacts
  float mass_kg = 0.0F;
  float yaw_inertia_kg_m2 = 0.0F;
  float wheel_inertia_kg_m2 = 0.0F;  ///< wheel and rotor, at the wheel
  WheelConfig wheel[kMostWheels];
  // Motor and gear.
  float torque_constant_Nm_per_A = 0.0F;  ///< K_t at the motor; also its back-EMF in V·s/rad
  float resistance_ohm = 0.0F;            ///< winding at 25 °C and driver: for the feed-forward
  float resistance_rise_per_K = 0.0F;     ///< of it, per winding temperature
  float lowest_resistance_ohm = 0.0F;     ///< of the coldest motor within its tolerance: for limits
  float gear_ratio = 1.0F;                ///< motor turns per wheel turn
  float gear_efficiency = 1.0F;
  float fastest_wheel_rad_per_s = 0.0F;          ///< that the battery or a push can reach
  float largest_acceleration_rad_per_s2 = 0.0F;  ///< of a wheel in the air under the largest current
  // Battery and driver.
  float battery_full_V = 0.0F;
  float battery_lowest_V = 0.0F;  ///< below this the electronics may reset; the sag limit keeps above
  float battery_resistance_ohm = 0.0F;
  float voltage_limit_V = 0.0F;  ///< of the command to one motor
  float current_limit_A = 0.0F;  ///< of one motor's driver
  // Friction.
  float rotation_friction_V = 0.0F;         ///< in pure rotation, in place of f(θ)
  float friction_smoothing_m_per_s = 0.0F;  ///< rim speed over which sign() is smoothed
  // Control.
  float body_gain_per_s = 0.0F;      ///< acceleration per error of body velocity
  float yaw_gain_per_s = 0.0F;       ///< the same for the yaw rate, by the gyro
  float yaw_integral_per_s2 = 0.0F;  ///< and for its integral
  float wheel_gain_V_s_per_rad = 0.0F;
  float wheel_integral_V_per_rad = 0.0F;
  float tracking_time_s = 0.05F;  ///< of the back-calculation (Åström and Hägglund, PID controllers, 1995, section 3.5)
  // Limits of motion.
  float speed_limit_m_per_s = 0.0F;
  float yaw_rate_limit_rad_per_s = 0.0F;
  float acceleration_limit_m_per_s2 = 0.0F;  ///< a command that jumps is approached with this
  float yaw_acceleration_limit_rad_per_s2 = 0.0F;
  float jerk_limit_m_per_s3 = 0.0F;  ///< of pose targets
  float traction_ratio = 0.0F;       ///< largest rolling force per normal force that is asked for
  float command_timeout_s = 0.2F;
  // Guard.
  float braking_reserve_K = 0.0F;  ///< heating by one full stop, kept free for braking
  float limp_current_A = 0.0F;     ///< of a wheel without speed sensor; see make_core_config() for its derivation
  float warning_time_s = 10.0F;    ///< Output::is_warning when the guard will limit within this time
  DerivedConfig derived;
  bool has_friction = false;  ///< false: the robot file has no friction, and d·ω is the back-EMF alone
  bool shadow_mode = false;   ///< the guard computes and counts what it would limit, and limits nothing
  std::uint8_t unused[2] = {};
  // Pointers stay last: the check sum covers what stands before them, which has the same layout on host and target.
  const GuardModel* guard = nullptr;  ///< none: no thermal limit
  /// Planner of pose targets: plan_to_pose, or none where the firmware has no pose. Kept apart so that the linker can leave it out.
  bool (*plan_step)(const Config& config, const Vector3& pose, const Vector3& target, Vector3& velocity, Vector3& acceleration) = nullptr;
};

enum class Mode : std::uint8_t { coast, brake, body_velocity, wheel_speed, wheel_torque, pose_target };

/// As sent by whoever decides where the robot goes. Only the members of the mode count.
struct Command {
  Mode mode = Mode::coast;
  /// body_velocity: local frame at the time of the command, m/s and rad/s; of the origin.
  Vector3 velocity;
  /// body_velocity: as seen from the field, resolved in that local frame, m/s2 and rad/s2; the velocity is continued by it.
  Vector3 acceleration;
  /// body_velocity: force and moment on something outside, local frame, N and N m.
  Vector3 push;
  PerWheel wheel_speed_rad_per_s = {};
  PerWheel wheel_torque_Nm = {};  ///< at the wheel
  Vector3 pose;                   ///< pose_target: at rest, field frame, m and rad
};

struct Input {
  PerWheel wheel_speed_rad_per_s = {};                                      ///< at the wheel
  PerWheel motor_current_A = {kNoSample, kNoSample, kNoSample, kNoSample};  ///< equivalent DC; none where not fitted
  float battery_V = 0.0F;                                                   ///< at the drivers
  float yaw_rate_rad_per_s = 0.0F;                                          ///< gyro
  float ambient_C = kNoSample;                                              ///< air at the motors
  PerWheel stator_C = {kNoSample, kNoSample, kNoSample, kNoSample};
  Vector3 pose{kNoSample, kNoSample, kNoSample};  ///< field frame; for pose targets
  float pose_age_s = 0.0F;                        ///< since the camera or another sensor saw the robot at `pose`
  float elapsed_s = kNoSample;                    ///< since the last call, by the caller's timer; without a timer Config::period_s
  float command_age_s = 0.0F;                     ///< since `command` was received
  Command command;
};

/// Of one wheel, read and written in every step.
struct WheelState {
  float raw_speed_rad_per_s = 0.0F;  ///< last sample
  float integral_V = 0.0F;
  float voltage_V = 0.0F;            ///< applied over the last period
  float earlier_V = 0.0F;            ///< and over the period before
  float current_squared_A2 = 0.0F;   ///< sum since the guard's last step
  float allowed_A = 0.0F;            ///< by the guard, as the current of a motor with the lowest resistance
  float allowed_braking_A = 0.0F;    ///< the same where the current brakes
  float conductance_A_per_V = 0.0F;  ///< nominal motor: 1/resistance at its winding temperature in the guard's last step
  float current_bound_A = 0.0F;      ///< recent current limit, decaying; a sensed current of 1.3 times this and a margin opens the bridge
  std::uint16_t guard_steps = 0;     ///< periods since the guard's last step
  std::uint16_t same_steps = 0;      ///< periods in which the speed sample has not changed by a bit, up to kMostSameSteps
  std::uint8_t speed_fault = 0;      ///< Reason, or 0
  std::uint8_t current_fault = 0;
  std::uint8_t guard_fault = 0;
  std::uint8_t is_open = 1;                ///< the bridge was open over the last period
  std::uint8_t has_current = 0;            ///< a sample of the current has been seen: its absence is a fault from then on
  std::uint8_t is_current_distrusted = 0;  ///< the current sensor has contradicted voltage and speed for too long
  std::uint8_t has_spoken_wrongly = 0;     ///< a sample spoke against itself since the last comparison
  std::uint8_t has_stator = 0;             ///< a stator temperature has been seen: its absence is a fault from then on
};

/// Result of stages 2 to 4. With a body velocity it serves two periods.
struct HeldReference {
  PerWheel speed_rad_per_s = {};
  PerWheel feed_forward_V = {};
  float since_s = 0.0F;        ///< time that has passed since they were run
  std::uint32_t is_fresh = 0;  ///< they were run in the last period, for a body velocity
};

/// What compares sensors with each other over tens of milliseconds; looked at once in kStepsPerComparison steps. The check sum covers
/// the rest.
struct alignas(8) ComparisonState {
  std::uint64_t check_sum = 0;
  float disagreement_s[kMostWheels] = {};   ///< how long the speed sample has contradicted the other evidence
  float agreement_s[kMostWheels] = {};      ///< how long it has agreed while the sensor counts as faulty
  float current_error_s[kMostWheels] = {};  ///< how long the current sensor has contradicted voltage and speed
  float last_rad_per_s[kMostWheels] = {};   ///< speed samples of the last comparison of pairs
  float with_V_rad_per_s[6] = {};           ///< per pair of wheels: leaky sum of how much its currents accelerate its difference of speeds
  float against_V_rad_per_s[6] = {};        ///< and of how much they seem to decelerate it
  float driven_V2[kMostWheels] = {};        ///< leaky mean square of the voltage less the back-EMF
  float counted_A2[kMostWheels] = {};       ///< the same of the current that the guard has counted: sensed, else calculated
  float residual_m2_per_s2 = 0.0F;          ///< leaky mean square by which the samples contradict each other as speeds of one body
  float yaw_disagreement_s = 0.0F;
  float yaw_agreement_s = 0.0F;
  /// Copies of WheelState::speed_fault and State::yaw_fault: they outlast a flipped bit in the rest of State.
  std::uint8_t speed_fault[kMostWheels] = {};
  std::uint8_t yaw_fault = 0;
  std::uint8_t is_checked = 0;         ///< no pair of wheel sensors is swapped: each has kConfirmations
  std::uint8_t confirmations[6] = {};  ///< per pair of wheels: comparisons that showed it not to be swapped
  std::uint8_t unused[4] = {};
  /// Time without any change of a speed sample, while the voltage would drive more than the limp current through blocked motors.
  float standing_s = 0.0F;
  float runaway_s = 0.0F;        ///< time in which the wheels turn without slowing down although the robot should stand, up to kRunaway_s
  float runaway_m_per_s = 0.0F;  ///< sum of the rim speeds at the beginning of that time
};

/// What evolves. Only start() and step() write it; a copy can be logged. The check sum covers what follows it up to `comparison`;
/// comparison and guards have their own, looked at when they are used.
struct alignas(8) State {
  std::uint64_t check_sum = 0;
  std::uint32_t is_valid = 0;  ///< a constant after start() with a valid Config
  std::uint32_t steps = 0;     ///< since the start
  WheelState wheel[kMostWheels];
  HeldReference held;
  Vector3 velocity_reference;      ///< of the body, local frame
  Vector3 acceleration_reference;  ///< smoothed
  float yaw_integral_rad = 0.0F;
  float speed_share = 1.0F;         ///< of the commanded velocity that the limits leave
  float yaw_rate_rad_per_s = 0.0F;  ///< last believed
  float raw_yaw_rate_rad_per_s = 0.0F;
  float battery_current_A = 0.0F;  ///< of the last period, estimated
  float battery_source_V = 0.0F;   ///< voltage without load that samples have shown, slowly sinking
  float late_periods = 0.0F;       ///< delays of less than a tenth of a period, added up
  std::uint32_t unused_word = 0;   ///< keeps the size a multiple of 8 without padding
  Vector3 plan_velocity;           ///< of the pose target's plan, field frame
  Vector3 plan_acceleration;
  std::uint32_t shadow_steps = 0;   ///< in which the guard would have limited
  float shadow_deficit_A_s = 0.0F;  ///< current time integral that it would have taken away
  std::uint8_t is_limited = 0;      ///< a limit scaled the wheels in the last period
  std::uint8_t yaw_fault = 0;
  std::uint8_t is_yaw_same = 0;             ///< the last two samples of the yaw rate are equal to the bit
  std::uint8_t has_yaw_spoken_wrongly = 0;  ///< a sample spoke against itself since the last comparison
  float ambient_C = kNoSample;              ///< last believed; not a number before the first sample, whose absence is no fault
  ComparisonState comparison;
  GuardState guard[kMostWheels];
};

/// Wheels that the robot does not have: no voltage, open.
struct Output {
  PerWheel pwm_ratio = {};                               ///< of the battery voltage, -1 to 1
  PerWheel voltage_V = {};                               ///< that the ratio stands for
  bool is_open[kMostWheels] = {true, true, true, true};  ///< switch the bridge off: no current, whatever the ratio
  Reason reason[kMostWheels] = {};                       ///< strongest per wheel: faults before limits
  PerWheel allowed_current_A = {};                       ///< magnitude, of driver and guard, for the present direction of the current
  PerWheel winding_C = {};                               ///< guard's observer: hotter than the nominal motor by the safety factor on heat
  float time_to_guard_limit_s = 0.0F;                    ///< until the guard limits if the load goes on; kLongTime_s where it will not
  bool is_warning = false;                               ///< within Config::warning_time_s
  Reason robot_reason = Reason::none;                    ///< fault of the whole robot
};

inline constexpr float kLongestGap_periods = 3.0F;
/// A sensor that was faulty is believed again after so long in agreement with the rest.
inline constexpr float kSteadyAgain_s = 0.25F;
/// Wheels that are driven for so long without any sample changing: their sensors are dead, or the robot is held.
inline constexpr float kStanding_s = 0.3F;

/// Wheels that turn for so long without slowing down although the robot should stand: the bridges are opened.
inline constexpr float kRunaway_s = 1.0F;

/// Comparisons, one in 16 periods, in which the currents of a pair of wheels clearly accelerate the difference of their speeds, after which
/// its sensors count as not swapped.
inline constexpr int kConfirmations = 16;

/// What is known when the robot is switched on.
struct StartUp {
  bool is_rested = false;  ///< the motors have rested until they are as warm as body_C; false: unknown time since power loss
  float body_C = 0.0F;
};

/// Puts `state` at rest. Without a rest the guard begins as hot as its limit. False if the Config is invalid: then step() opens all
/// bridges.
bool start(const Config& config, State& state, const StartUp& start_up);

/// One period.
Output step(const Config& config, State& state, const Input& input);
/// The same without a copy of the output: writes all of `out`.
void step(const Config& config, State& state, const Input& input, Output& out);

/// Fills in Config::derived and Config::check_sum. Call it last when a Config is made.
void complete(Config& config);
/// Over all values of the Config but the check sum itself and the pointers.
std::uint32_t config_check_sum(const Config& config);
/// Whether all values are finite and possible; the check sum is not looked at.
bool is_possible(const Config& config);

/// For Config::plan_step: one period of the time-optimal way to `target` with robot_core/trajectory.h, from `pose` and the velocity and
/// acceleration that the last call left (field frame, in and out). False where no plan exists.
bool plan_to_pose(const Config& config, const Vector3& pose, const Vector3& target, Vector3& velocity, Vector3& acceleration);

}  // namespace robot_core
