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
// Local frame: x points ahead, y to the left, angles count counter-clockwise. The field frame is fixed. Wheel 1 comes first. A wheel with
// its axle at the angle alpha rolls along alpha + 90 degrees: all wheels positive turn the robot counter-clockwise. Speeds, torques,
// voltages and currents have the sign of the wheel's rotation. Currents are equivalent DC currents: motor torque divided by torque
// constant.
#pragma once

#include <cstdint>
#include <limits>

#include "robot_core/reason.h"
#include "robot_core/thermal_guard.h"
#include "robot_core/trajectory.h"

namespace robot_core {

inline constexpr int kMostWheels = 4;
/// NaN marks a sensor that is not fitted or has no sample.
inline constexpr float kNoSample = std::numeric_limits<float>::quiet_NaN();

/// One value per wheel. A robot with three wheels ignores the last value.
using PerWheel = float[kMostWheels];

struct Vector3 {
  float x = 0.0F;
  float y = 0.0F;
  float yaw = 0.0F;
};

/// Geometry and drive parameters of one wheel.
struct WheelConfig {
  float rolling_x_share = 0.0F;  ///< x component of the unit vector t along which the wheel rolls, local frame
  float rolling_y_share = 0.0F;
  float inverse_x_factor = 0.0F;  ///< column of the pseudo-inverse of [t_x t_y R], which converts rim speeds to body velocity
  float inverse_y_factor = 0.0F;
  float inverse_yaw_per_m = 0.0F;
  float slip_factor = 1.0F;        ///< measured wheel speed divided by the speed of a wheel without slip; 1 if not measured
  float level_load_share = 0.25F;  ///< fraction of the weight that this wheel bears on level ground
  // Feed-forward, equations (2) and (3) of RoboTeam Twente, ETDP 2025: V = d·ω + f(θ), f(θ) = a·sin(θ+φ) + b·sign(sin(θ+φ)).
  float damping_V_s_per_rad = 0.0F;  ///< coefficient d; includes the back-EMF
  float sine_V = 0.0F;               ///< coefficient a
  float sign_V = 0.0F;               ///< coefficient b
  float phase_cosine_ratio = 1.0F;   ///< cos φ
  float phase_sine_ratio = 0.0F;
  // Filled in by complete().
  float rim_per_speed_m = 0.0F;      ///< wheel radius divided by slip_factor
  float speed_per_rim_per_m = 0.0F;  ///< reciprocal of rim_per_speed_m
  /// speed_per_rim_per_m/(1 − tᵀ·P·t): converts the rim speed's residual of the fit over all wheels into the difference between the wheel
  /// speed and the one that the other wheels imply. 0 if the other wheels do not determine this speed.
  float others_rad_per_m = 0.0F;
  // Sets of other wheels that determine this wheel's speed; a, b and c are the next three wheels. Sines of the angles between the rolling
  // directions, and doubled areas of triangles between their tips.
  float to_a_ratio = 0.0F;  ///< sine of the angle from this wheel's direction to that of wheel a
  float to_b_ratio = 0.0F;
  float to_c_ratio = 0.0F;
  float ab_ratio = 0.0F;  ///< sine of the angle from the direction of wheel a to that of wheel b
  float bc_ratio = 0.0F;
  float ca_ratio = 0.0F;
  float own_bc_ratio = 0.0F;  ///< doubled area of the triangle of this wheel, b and c
  float own_ca_ratio = 0.0F;
  float own_ab_ratio = 0.0F;
  float abc_ratio = 0.0F;
  std::uint32_t sets = 0;           ///< sets that determine the speed: bit 0 a and b, bit 1 b and c, bit 2 c and a, bit 3 all three
  float body_limit_A = 0.0F;        ///< smaller one of driver limit and grip limit on level ground
  std::uint32_t is_grip_limit = 0;  ///< 1 if the grip limit is the smaller one, else 0
};

/// Values that follow from the rest of a Config. complete() calculates them once, so that no step has to.
struct DerivedConfig {
  float geared_constant_V_s_per_rad = 0.0F;  ///< K_t·n: back-EMF per wheel speed, and torque per current at the wheel without losses
  float per_lowest_resistance_A_per_V = 0.0F;
  float per_resistance_A_per_V = 0.0F;
  float volt_per_Nm = 0.0F;         ///< voltage per driving torque at the wheel
  float most_battery_sag_A = 0.0F;  ///< 1/battery_resistance_ohm: current per volt of sag; 0 if that resistance is 0
  float per_tracking_time_per_s = 0.0F;
  float yaw_correction_per_s = 0.0F;  ///< correction of the yaw rate per integral of its error
  // P is the inverse of Σ t·tᵀ over all wheels. With a known yaw rate it gives the plane velocity of the body from the rim speeds.
  float plane_xx_factor = 0.0F;
  float plane_xy_factor = 0.0F;
  float plane_yy_factor = 0.0F;
  float jump_rad_per_s = 0.0F;    ///< largest accepted change of a wheel speed per period
  float current_margin_A = 0.0F;  ///< largest accepted difference between current sensor and motor equation
  float most_sensed_A = 0.0F;     ///< largest plausible current sample: the battery cannot drive more
  /// Largest difference between two estimates of one back-EMF, per sum of the absolute residuals of the rim speeds.
  float spread_V_s_per_m = 0.0F;
  float rim_spread_V_s_per_m = 0.0F;  ///< largest difference of one back-EMF per difference of rim speeds
  float sensed_slack_V = 0.0F;        ///< noise of a current sensor, as a voltage; ignored while the speed estimates agree
};

/// Parameters that stay constant while the robot runs. `heatsoak generate core` writes them, or make_core_config() on the host.
struct Config {
  std::uint32_t check_sum = 0;  ///< CRC-32: config_check_sum(); start() rejects a Config with any other value
  std::int32_t wheel_count = 4;
  float period_s = 0.001F;
  // Geometry and mass.
  float wheel_radius_m = 0.0F;
  float contact_radius_m = 0.0F;  ///< R, distance from the robot's vertical axis to the wheel contacts
  float mass_kg = 0.0F;
  float yaw_inertia_kg_m2 = 0.0F;
  float wheel_inertia_kg_m2 = 0.0F;  ///< wheel and rotor together, referred to the wheel
  WheelConfig wheel[kMostWheels];
  // Motor and gear.
  float torque_constant_Nm_per_A = 0.0F;  ///< K_t at the motor shaft; equals the back-EMF constant in V·s/rad
  float resistance_ohm = 0.0F;            ///< winding at 25 °C plus driver; the feed-forward uses it
  float resistance_rise_per_K = 0.0F;     ///< relative rise of resistance_ohm per K of winding temperature
  float lowest_resistance_ohm = 0.0F;     ///< coldest motor at the low end of its tolerance, plus driver; the limits use it
  float gear_ratio = 1.0F;                ///< motor turns per wheel turn
  float gear_efficiency = 1.0F;
  float fastest_wheel_rad_per_s = 0.0F;          ///< largest speed that the battery or a push can cause
  float largest_acceleration_rad_per_s2 = 0.0F;  ///< wheel off the ground under the largest current
  // Battery and driver.
  float battery_full_V = 0.0F;
  float battery_lowest_V = 0.0F;  ///< below this the electronics may reset; the sag limit keeps the battery above it
  float battery_resistance_ohm = 0.0F;
  float voltage_limit_V = 0.0F;  ///< largest voltage command to one motor; a wheel pushed beyond this voltage's speed gets its back-EMF
  float current_limit_A = 0.0F;  ///< limit of one motor driver
  // Friction.
  float rotation_friction_V = 0.0F;         ///< replaces f(θ) in pure rotation
  float friction_smoothing_m_per_s = 0.0F;  ///< rim speed over which sign() is smoothed
  // Control.
  float body_gain_per_s = 0.0F;      ///< body acceleration per error of body velocity
  float yaw_gain_per_s = 0.0F;       ///< yaw acceleration per error of the yaw rate, which the gyro measures
  float yaw_integral_per_s2 = 0.0F;  ///< yaw acceleration per integral of the yaw rate error
  float wheel_gain_V_s_per_rad = 0.0F;
  float wheel_integral_V_per_rad = 0.0F;
  float tracking_time_s = 0.05F;  ///< time constant of back-calculation (Åström and Hägglund, PID controllers, 1995, section 3.5)
  // Limits of motion.
  float speed_limit_m_per_s = 0.0F;
  float yaw_rate_limit_rad_per_s = 0.0F;
  float acceleration_limit_m_per_s2 = 0.0F;  ///< planned motions; the response to a command that jumps may use twice this value
  float yaw_acceleration_limit_rad_per_s2 = 0.0F;
  float jerk_limit_m_per_s3 = 0.0F;  ///< the planner of pose targets uses it
  float traction_ratio = 0.0F;       ///< largest allowed rolling force per normal force; 0: no grip limit
  float command_timeout_s = 0.2F;
  // Guard.
  float braking_reserve_K = 0.0F;  ///< heating of the winding by one full stop, reserved for braking
  float limp_current_A = 0.0F;     ///< limit of a wheel without speed sensor; make_core_config() derives it
  float warning_time_s = 10.0F;    ///< Output::is_warning is set if the guard will limit within this time
  DerivedConfig derived;
  bool has_friction = false;  ///< false: the robot file has no friction, and d·ω is the back-EMF alone
  bool shadow_mode = false;   ///< true: the guard calculates and counts its limits but does not apply them
  std::uint8_t unused[2] = {};
  // Pointers stay last: the check sum covers the members before them, whose layout is the same on host and target.
  const GuardModel* guard = nullptr;  ///< null: no thermal limit
  /// Planner of pose targets: plan_to_pose, or null if the firmware has no pose. Through a pointer the linker can leave the planner out.
  bool (*plan_step)(const Config& config, const Vector3& pose, const Vector3& target, Vector3& velocity, Vector3& acceleration) = nullptr;
  /// Predictor of the pose that plan_step starts from: predict_pose, or null without plan_step.
  void (*predict_pose)(const Vector3& velocity, float age_s, Vector3& pose) = nullptr;
};

enum class Mode : std::uint8_t { coast, brake, body_velocity, wheel_speed, wheel_torque, pose_target };

/// Command from the software that decides where the robot goes. Only the members that belong to `mode` are used.
struct Command {
  Mode mode = Mode::coast;
  /// body_velocity: velocity of the robot's origin, local frame at the time of the command, m/s and rad/s.
  Vector3 velocity;
  /// body_velocity: acceleration seen from the field, in the same local frame, m/s2 and rad/s2. It extrapolates the velocity.
  Vector3 acceleration;
  /// body_velocity: force and moment that the robot exerts on an external object, local frame, N and N m.
  Vector3 push;
  PerWheel wheel_speed_rad_per_s = {};
  PerWheel wheel_torque_Nm = {};  ///< torque at the wheel
  Vector3 pose;                   ///< pose_target: target pose at rest, field frame, m and rad
};

struct Input {
  PerWheel wheel_speed_rad_per_s = {};                                      ///< speed at the wheel
  PerWheel motor_current_A = {kNoSample, kNoSample, kNoSample, kNoSample};  ///< equivalent DC current; NaN if no sensor is fitted
  float battery_V = 0.0F;                                                   ///< voltage at the drivers
  float yaw_rate_rad_per_s = 0.0F;                                          ///< yaw rate of the gyro
  float ambient_C = kNoSample;                                              ///< temperature of the air at the motors
  PerWheel stator_C = {kNoSample, kNoSample, kNoSample, kNoSample};
  Vector3 pose{kNoSample, kNoSample, kNoSample};  ///< field frame, m and rad; needed for pose targets
  float pose_age_s = 0.0F;                        ///< time since the camera or another sensor saw the robot at `pose`
  float elapsed_s = kNoSample;                    ///< time since the last call; without a timer pass Config::period_s
  float command_age_s = 0.0F;                     ///< time since `command` was received
  Command command;
};

/// State of one wheel, read and written in every step.
struct WheelState {
  float raw_speed_rad_per_s = 0.0F;  ///< last plausible sample, else 0
  float integral_V = 0.0F;
  float voltage_V = 0.0F;            ///< voltage applied over the last period
  float earlier_V = 0.0F;            ///< voltage applied over the period before the last
  float current_squared_A2 = 0.0F;   ///< sum of squares of the counted current since the guard's last step
  float driven_squared_V2 = 0.0F;    ///< sum of squares of voltage minus back-EMF since then, while the bridge was not open
  float allowed_A = 0.0F;            ///< allowed by the guard, converted to the current of a motor with the lowest resistance
  float allowed_braking_A = 0.0F;    ///< the same limit for a current that brakes
  float conductance_A_per_V = 0.0F;  ///< nominal motor: 1/resistance at its winding temperature in the guard's last step
  float current_bound_A = 0.0F;      ///< decaying current limit; a sensed current above 1.3 times this plus a margin opens the bridge
  std::uint16_t guard_clock = 0;     ///< State::guard_clock at the end of the time that the guard has counted
  std::uint16_t same_steps = 0;      ///< periods in which the speed sample stayed bit-identical, up to kMostSameSteps
  std::uint8_t speed_fault = 0;      ///< Reason as a number, or 0
  std::uint8_t current_fault = 0;
  std::uint8_t guard_fault = 0;
  std::uint8_t is_open = 1;                ///< 1 if the bridge was open over the last period
  std::uint8_t has_current = 0;            ///< 1 after the first current sample; a missing sample is a fault from then on
  std::uint8_t is_current_distrusted = 0;  ///< 1 if the current sensor has contradicted voltage and speed for too long
  std::uint8_t was_implausible = 0;        ///< 1 if a sample was implausible since the last comparison
  std::uint8_t has_stator = 0;             ///< 1 after the first stator sample; a missing sample is a fault from then on
};

/// Result of stages 2 to 4. In the mode body_velocity it serves two periods.
struct HeldReference {
  PerWheel speed_rad_per_s = {};
  PerWheel feed_forward_V = {};
  float since_s = 0.0F;  ///< time since stages 2 to 4 were run
};

/// State of the comparisons of sensors with each other. They act over tens of milliseconds and run once in kStepsPerComparison steps. The
/// check sum covers all other members.
struct alignas(8) ComparisonState {
  std::uint64_t check_sum = 0;
  // A gap in time resets the members up to current_error_s.
  float disagreement_s[kMostWheels] = {};  ///< time for which the speed sample has contradicted the other evidence
  /// Evidence against the present verdict on the speed sensor, reset when the verdict changes. Accepted sensor: time for which it alone has
  /// contradicted all others, minus the time for which it has not, at least 0. Rejected sensor: time of its agreement with the others.
  float evidence_s[kMostWheels] = {};
  float with_V_rad_per_s[6] = {};      ///< per pair of wheels: leaky sum of evidence that its currents accelerate its speed difference
  float against_V_rad_per_s[6] = {};   ///< per pair of wheels: leaky sum of evidence that its currents decelerate that difference
  float residual_m2_per_s2 = 0.0F;     ///< leaky mean square of the samples' residuals against one motion of the body
  float yaw_evidence_s = 0.0F;         ///< evidence against the present verdict on the gyro, as evidence_s
  float runaway_s = 0.0F;              ///< time for which the wheels turn without slowing down although the robot should stand
  float runaway_m_per_s = 0.0F;        ///< sum of the rim speeds at the start of that time
  std::uint8_t confirmations[6] = {};  ///< per pair of wheels: comparisons that showed it not to be swapped
  std::uint8_t unused[2] = {};
  float current_error_s[kMostWheels] = {};  ///< time for which the current sensor has contradicted voltage and speed
  float last_rad_per_s[kMostWheels] = {};   ///< speed samples at the last comparison of pairs
  float standing_s = 0.0F;      ///< time without a change of any speed sample while blocked motors would draw more than the limp current
  std::uint8_t is_checked = 0;  ///< 1 if no pair of wheel sensors is swapped: each pair has kConfirmations
  /// Bit i: WheelState::has_current of wheel i, bit 4 + i: has_stator. This and the next three survive a flipped bit in the rest of State.
  std::uint8_t fitted = 0;
  std::uint8_t yaw_fault = 0;  ///< copy of State::yaw_fault
  std::uint8_t unused_too = 0;
  std::uint8_t speed_fault[kMostWheels] = {};  ///< copies of WheelState::speed_fault
  float ambient_C = kNoSample;                 ///< copy of State::ambient_C
};

/// State of the core between two steps. Only start() and step() write it; a copy can be logged. Every step verifies the check sum, which
/// covers the members up to `comparison`. The check sums of the comparisons and of the guards are verified before each update: in 3 of
/// kStepsPerComparison steps, and once per guard period.
struct alignas(8) State {
  std::uint64_t check_sum = 0;
  std::uint32_t is_valid = 0;  ///< a constant after start() with a valid Config, else 0
  std::uint32_t steps = 0;     ///< steps since start()
  WheelState wheel[kMostWheels];
  HeldReference held;
  Vector3 velocity_reference;      ///< reference of the body, local frame
  Vector3 acceleration_reference;  ///< smoothed reference of the body, local frame
  float yaw_integral_rad = 0.0F;
  float speed_share = 1.0F;             ///< fraction of the commanded velocity that the limits allow
  std::uint32_t rounded_up = 0;         ///< time by which periods were rounded up, sum in 1/1024 periods; wraps
  float raw_yaw_rate_rad_per_s = 0.0F;  ///< last sample of the yaw rate, or 0 if it was impossible
  float battery_current_A = 0.0F;       ///< estimate for the last period
  float battery_source_V = 0.0F;        ///< open-circuit voltage estimated from samples; sinks slowly between them
  float late_periods = 0.0F;            ///< sum of delays below a tenth of a period each
  float kept_share = 1.0F;  ///< fraction of their wanted currents that the most held-back wheel leaves to all wheels; rises slowly
  Vector3 plan_velocity;    ///< velocity of the pose target's plan, field frame
  Vector3 plan_acceleration;
  std::uint32_t shadow_steps = 0;   ///< steps in which the guard would have limited
  float shadow_deficit_A_s = 0.0F;  ///< time integral of the current that the guard would have taken away
  std::uint8_t is_limited = 0;      ///< 1 if a limit scaled the wheels in the last period
  std::uint8_t yaw_fault = 0;
  std::uint8_t is_yaw_same = 0;          ///< 1 if the last two samples of the yaw rate are equal
  std::uint8_t was_yaw_implausible = 0;  ///< 1 if a sample was implausible since the last comparison
  std::uint8_t is_held_fresh = 0;        ///< 1 if stages 2 to 4 were run in the last period for a body velocity
  std::uint8_t next_guard = 0;           ///< wheel whose guard has waited longest
  std::uint16_t guard_clock = 0;         ///< periods since start(); wraps
  float ambient_C = kNoSample;           ///< last validated air temperature; NaN before the first sample, whose absence is no fault
  ComparisonState comparison;
  GuardState guard[kMostWheels];
};

/// Result of a step. Wheels that the robot does not have get 0 V and an open bridge.
struct Output {
  PerWheel pwm_ratio = {};                               ///< motor voltage divided by battery voltage, -1 to 1
  PerWheel voltage_V = {};                               ///< motor voltage that pwm_ratio gives
  bool is_open[kMostWheels] = {true, true, true, true};  ///< true: switch the bridge off, so that no current flows
  Reason reason[kMostWheels] = {};                       ///< strongest reason per wheel: faults before limits
  PerWheel allowed_current_A = {};                       ///< magnitude of the limit for the present direction of the current
  PerWheel winding_C = {};                               ///< temperature of the guard's observer, which counts heat_ratio times the heat
  float time_to_guard_limit_s = 0.0F;                    ///< until the guard limits the load or its peaks; 0: now; kLongTime_s: never
  bool is_warning = false;                               ///< true if the guard limits now or within Config::warning_time_s
  Reason robot_reason = Reason::none;                    ///< fault of the whole robot
};

inline constexpr float kLongestGap_periods = 3.0F;
/// Longest time after which the watchdog of the firmware resets the controller, which opens the bridges, with the tolerance of its
/// oscillator. An invalid Input::elapsed_s may hide a gap of this length.
inline constexpr float kWatchdog_s = 0.02F;
/// A sensor that was faulty is accepted again after it has agreed with the other sensors for this time.
inline constexpr float kSteadyAgain_s = 0.25F;
/// If driven wheels show no changed sample for this time, their sensors are dead or the robot is held.
inline constexpr float kStanding_s = 0.3F;

/// If the wheels turn for this time without slowing down although the robot should stand, the bridges open.
inline constexpr float kRunaway_s = 1.0F;

/// A pair of wheels counts as not swapped after this many comparisons (one in 16 periods). In each, the pair's currents must clearly
/// accelerate the difference of its speeds.
inline constexpr int kConfirmations = 16;

/// Information about the motors when the robot is switched on.
struct StartUp {
  bool is_rested = false;  ///< true: the motors have cooled to body_C; false: the time since the power loss is unknown
  float body_C = 0.0F;
};

/// Initialises `state` at rest. If the motors have not rested, the guard starts at its temperature limit. Returns false if the Config is
/// invalid; step() then opens all bridges.
bool start(const Config& config, State& state, const StartUp& start_up);

/// Runs one period and returns its output.
Output step(const Config& config, State& state, const Input& input);
/// Runs one period without a copy of the output: writes all members of `out`.
void step(const Config& config, State& state, const Input& input, Output& out);

/// Calculates Config::derived and Config::check_sum. Call it last when a Config is made.
void complete(Config& config);
/// Returns the CRC-32 of all values of the Config except the check sum itself and the pointers.
std::uint32_t config_check_sum(const Config& config);
/// Returns true if all values are finite and plausible. Does not verify the check sum.
bool is_possible(const Config& config);

/// Planner for Config::plan_step: one period of the time-optimal motion from `pose` to `target` (robot_core/trajectory.h). `velocity` and
/// `acceleration` are those of the last call's plan, field frame, in and out. Returns false if no plan exists.
bool plan_to_pose(const Config& config, const Vector3& pose, const Vector3& target, Vector3& velocity, Vector3& acceleration);

/// Predictor for Config::predict_pose: moves a `pose` that is `age_s` old to the present, with the measured velocity of the body (local
/// frame) as constant.
void predict_pose(const Vector3& velocity, float age_s, Vector3& pose);

}  // namespace robot_core
