// Friction of a robot in the form of the drive core's feed-forward: a voltage over the direction of travel, per wheel.
#pragma once

#include <array>

#include "robot/body.h"

namespace heatsoak::firmware {

/// V_i = d·ω_i + f_i(θ), f_i(θ) = a_i·sin(θ + φ_i) + b_i·sign(sin(θ + φ_i)): equations (2) and (3) of RoboTeam Twente, ETDP 2025. Voltages
/// are those of the driver; unlike the torques of a robot file they contain the drag of the motor, and d its back-EMF.
struct FrictionVoltage {
  bool is_known = false;             ///< false: the robot's file has no friction; d is the back-EMF alone, all else is 0
  double damping_V_s_per_rad = 0.0;  ///< d, per wheel speed
  robot::PerWheel sine_V{};          ///< a
  robot::PerWheel sign_V{};          ///< b
  robot::PerWheel phase_rad{};       ///< φ
  double rotation_V = 0.0;           ///< friction voltage in pure rotation, replaces f
  robot::PerWheel
      residual_rms_V{};  ///< RMS over the directions of travel of the part of the file's friction that this form cannot represent
};

/// Converts the friction of the robot's file. Method:
///   d = K_t·n + D·R/(K_t·n·η)            back-EMF, and the damping D of the file at the wheel (n gear ratio, η gear efficiency);
///   V(T) = (T/(n·η) + K_t·I_0)·R/K_t     voltage for a torque T at a turning wheel (steady_voltage_V() without back-EMF).
/// A measured curve ([friction.heading]) without double angle already has this form: a and b are converted by V(T), with the phases of the
/// file. A curve with double angle, and roller drag, do not have it. For these, the steady torque of each wheel at 72 directions of travel
/// follows from inverse_dynamics() without damping, and a_i and b_i from linear least squares. φ_i is the phase of the file or, without
/// one, that of the wheel's rolling direction.
/// Needs the parameters of make_body() except [friction]. Throws Failure (bad_input) with the names of those that are missing.
FrictionVoltage friction_voltage(const robot::Robot& robot, const motor::MotorValues& motor);

/// Returns the body with the friction of the file; without friction if the file has none.
robot::BodyConfig make_body_with_known_friction(const robot::Robot& robot, const motor::MotorValues& motor);

}  // namespace heatsoak::firmware
