// What it costs to keep a wheel turning at constant speed, apart from what happens in its motor.
#pragma once

#include <array>
#include <cmath>

#include "motor/motor.h"
#include "robot/wheels.h"

namespace heatsoak {

// Two descriptions. The physical one: a torque against the turning of each wheel, and the drag of the rollers along
// the axles (traction.h). The drag is a force on the body that the wheels must make up for; how it falls on them
// depends on the direction of travel, and so friction "depends on the driving angle" although no wheel knows it. It
// vanishes in pure rotation, where the rollers do not turn. With it
//   RoboTeam Twente:  0.3 V in rotation, 1.23 V in translation, more ahead than sideways,
//   TIGERs:           0.097 N m in rotation (9.8 mN m per wheel), 2.65 N in translation,
//   a Festo Robotino: currents over 72 headings (tests/robot/robotino_test.cpp)
// are one model. The other description is the curve that a team measured, taken as it is.

/// An angle by its direction, for what is evaluated a million times.
struct Direction {
  double cosine_ratio = 1.0;
  double sine_ratio = 0.0;

  static Direction of(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }
};

/// The curve of wheel i over the direction of travel θ (local frame), as torque at the wheel:
///   f(θ) = a_i·sin(θ + φ_i) + b_i·sign(sin(θ + φ_i)) + sign(ω_i)·A·sin(2θ + ψ_i),
/// the first two terms those of ETDP 2025, equation (3), A that of the firmware. Without an offset φ_i is the wheel's
/// rolling direction, sin(θ + φ_i) = t_i·v/|v|. Its sign is taken from the wheel's speed, so that friction never drives.
/// In rotation it goes over to a constant c: (1 − γ)·f + γ·sign(ω)·c, γ = ½·(1 − cos(π·min(1, R·|yaw rate|/|v|))).
/// The firmware counts θ from the left to straight ahead: its phase is −ψ here.
struct HeadingFriction {
  PerWheel constant_Nm{};                                   ///< b
  PerWheel sine_Nm{};                                       ///< a
  std::array<Direction, kMostWheels> phase_offset{};        ///< φ_i less that of the rolling direction
  double double_angle_Nm = 0.0;                             ///< A, at most b
  std::array<Direction, kMostWheels> double_angle_phase{};  ///< ψ
  double rotation_Nm = 0.0;                                 ///< c
};

/// φ of the wheel's rolling direction t: sin(θ + φ) = t·(cos θ, sin θ).
double rolling_phase_rad(const WheelDirections& wheel);

struct FrictionConfig {
  double wheel_torque_Nm = 0.0;             ///< against the turning, at each wheel
  double wheel_damping_Nm_s_per_rad = 0.0;  ///< and what grows with the speed
  double smoothing_rad_per_s = 0.5;         ///< sign ω is ω/√(ω² + smoothing²)
  bool by_heading = false;                  ///< `heading` stands in place of wheel torque and roller drag
  HeadingFriction heading;
};

/// x/√(x² + width²). S is double or Wheels.
template <class S>
S smooth_sign(const S& x, double width) {
  using std::sqrt;
  return x / sqrt(x * x + width * width);
}

/// Magnitude of the dry friction torque of each wheel in N m: wheel_torque_Nm, or the curve over the direction of travel.
Wheels dry_friction_Nm(const FrictionConfig& friction, const Kinematics& kinematics, const BodyVelocity& local);

/// Torque against the turning of each wheel, signed like the wheel's speed: subtract it from what drives the wheel.
PerWheel friction_torques_Nm(const FrictionConfig& friction, const Kinematics& kinematics, const BodyVelocity& local,
                             const PerWheel& wheel_speed_rad_per_s);

/// What stands between the voltage of a driver and the torque at its wheel.
struct DriveConstants {
  double resistance_ohm = 1.0;  ///< that the current meets, winding at 25 °C and driver
  double torque_constant_Nm_per_A = 0.0;
  double drag_torque_Nm = 0.0;  ///< of the motor, K_t·I_0
  double gear_ratio = 1.0;
  double gear_efficiency = 1.0;
};
/// A robot without driver_resistance has none.
DriveConstants drive_constants(const Robot& robot, const MotorValues& motor);

/// Friction that a team states as voltage, as torque at the wheel: at standstill the voltage drives the current V/R, so
/// (V/R·K_t − motor drag)·gear ratio·efficiency. The drag K_t·I_0 of the motor is taken off because it is booked in the
/// motor; where it is larger the result is 0.
double friction_torque_of_voltage_Nm(const DriveConstants& drive, double voltage_V);

/// Damping that a team states as voltage per wheel speed contains the back-EMF: (d/n − K_t)·K_t/R·n²·efficiency is left
/// for the mechanics, n the gear ratio; where the back-EMF is larger, 0.
double damping_of_voltage_Nm_s_per_rad(const DriveConstants& drive, double damping_V_s_per_rad);

/// And back: what a driver must put out to keep a wheel turning against a torque, (T/(n·efficiency) + drag·sign ω)·R/K_t + K_t·n·ω.
double steady_voltage_V(const DriveConstants& drive, double wheel_torque_Nm, double wheel_speed_rad_per_s);

}  // namespace heatsoak
