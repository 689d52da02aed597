// Friction of a wheel at constant speed, without the losses inside its motor.
#pragma once

#include <array>
#include <cmath>

#include "motor/motor.h"
#include "robot/kinematics.h"

namespace heatsoak::robot {

// Two descriptions exist. The physical one consists of a friction torque at each wheel and of the drag of the rollers along the axles
// (traction.h). The drag is a force on the body that the wheels must overcome. How it is distributed depends on the direction of travel, so
// the friction of a wheel seems to depend on the driving angle. It vanishes in pure rotation, because the rollers do not turn then. This
// one model reproduces
//   RoboTeam Twente:  0.3 V in rotation, 1.23 V in translation, more ahead than sideways,
//   TIGERs:           0.097 N m in rotation (9.8 mN m per wheel), 2.65 N in translation,
//   a Festo Robotino: currents over 72 headings (tests/robot/robotino_test.cpp).
// The other description is a curve that a team has measured, used as it is.

/// An angle stored as cosine and sine, because it is used millions of times.
struct Direction {
  double cosine_ratio = 1.0;
  double sine_ratio = 0.0;

  static Direction of(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }
};

/// Friction torque of wheel i at the wheel over the direction of travel θ (local frame):
///   f(θ) = a_i·sin(θ + φ_i) + b_i·sign(sin(θ + φ_i)) + sign(ω_i)·A·sin(2θ + ψ_i).
/// The first two terms are equation (3) of the ETDP 2025 of RoboTeam Twente; the term with A is in their firmware. For φ_i of the wheel's
/// rolling direction t_i, sin(θ + φ_i) = t_i·v/|v|; a measured φ_i differs by phase_offset. The sign of ω_i, the
/// wheel's speed, makes friction always brake.
/// In rotation the torque blends into a constant c: (1 − γ)·f + γ·sign(ω)·c, γ = ½·(1 − cos(π·min(1, R·|yaw rate|/|v|))). The firmware
/// counts θ from the left to straight ahead: its phase is −ψ here.
struct HeadingFriction {
  PerWheel constant_Nm{};                                   ///< b
  PerWheel sine_Nm{};                                       ///< a
  std::array<Direction, kMostWheels> phase_offset{};        ///< φ_i minus that of the rolling direction
  double double_angle_Nm = 0.0;                             ///< A, at most b
  std::array<Direction, kMostWheels> double_angle_phase{};  ///< ψ
  double rotation_Nm = 0.0;                                 ///< c
};

/// Returns φ of the wheel's rolling direction t: sin(θ + φ) = t·(cos θ, sin θ).
double rolling_phase_rad(const WheelDirections& wheel);

struct FrictionConfig {
  double wheel_torque_Nm = 0.0;             ///< dry friction torque at each wheel
  double wheel_damping_Nm_s_per_rad = 0.0;  ///< viscous friction at each wheel
  double smoothing_rad_per_s = 0.5;         ///< the sign of ω is smoothed to ω/√(ω² + smoothing²)
  bool by_heading = false;                  ///< `heading` replaces wheel torque and roller drag
  HeadingFriction heading;
};

/// Returns x/√(x² + width²), a smoothed sign. S is double or Wheels.
template <class S>
S smooth_sign(const S& x, double width) {
  using std::sqrt;
  return x / sqrt(x * x + width * width);
}

/// Constants that relate the driver's voltage to the torque at the wheel.
struct DriveConstants {
  double resistance_ohm = 1.0;  ///< resistance of the circuit: winding at 25 °C (with heating factor) and driver
  double torque_constant_Nm_per_A = 0.0;
  double drag_torque_Nm = 0.0;  ///< drag torque of the motor, K_t·I_0
  double gear_ratio = 1.0;
  double gear_efficiency = 1.0;
};
/// Returns the constants of the robot with this motor. A missing driver_resistance counts as 0.
DriveConstants drive_constants(const Robot& robot, const motor::MotorValues& motor);

/// Converts friction that a team states as a voltage to a torque at the wheel: at standstill the voltage drives the current V/R, so the
/// torque is (V/R·K_t − motor drag)·gear ratio·efficiency. The drag K_t·I_0 is subtracted because the motor model includes it; at least 0.
double friction_torque_of_voltage_Nm(const DriveConstants& drive, double voltage_V);

/// Converts damping that a team states as voltage per wheel speed, which includes the back-EMF: the mechanical part is
/// (d/n − K_t)·K_t/R·n²·efficiency with the gear ratio n; at least 0.
double damping_of_voltage_Nm_s_per_rad(const DriveConstants& drive, double damping_V_s_per_rad);

/// Returns the driver voltage that keeps a wheel turning against a torque: (T/(n·efficiency) + drag·sign ω)·R/K_t + K_t·n·ω.
double steady_voltage_V(const DriveConstants& drive, double wheel_torque_Nm, double wheel_speed_rad_per_s);

}  // namespace heatsoak::robot
