// Estimates wheel damping from a robot that rolls out with its motors off.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "friction/friction_log.h"
#include "friction/robust_fit.h"
#include "robot/body.h"

namespace heatsoak::friction {

// With open motor terminals, a friction torque τ and a damping D act on each wheel. They reduce the kinetic energy of body, wheels and
// rotors:
//   E(t) = E_0 − τ·Σ∫|ω_i| dt − D·Σ∫ω_i² dt.
// This is linear in τ and D and needs no derivative. It also holds while the robot turns, when the dry friction of some wheels does not
// point against the travel. If the robot is lifted, every wheel rolls out by itself. Losses of the rollers count as τ. A segment begins
// when all drivers are off (in a log without voltages, at the largest speed) and ends at 15 % of its first speed.

enum class RollOut { translation, rotation, lifted_wheel };

struct RollOutRun {
  RollOut kind = RollOut::translation;
  std::optional<int> wheel = {};            ///< index of the lifted wheel; empty: the robot is on the floor
  double heading_rad = 0.0;                 ///< direction of a translation in the robot's frame
  double force_N = 0.0;                     ///< friction force against a translation at zero speed
  double wheel_damping_Nm_s_per_rad = 0.0;  ///< D; equal for all wheels if the robot is on the floor
  double wheel_torque_Nm = 0.0;             ///< τ; equal for all wheels if the robot is on the floor
  double r2_ratio = 0.0;                    ///< coefficient of determination of the energy
  int rows_used = 0;
};

struct RollOutResult {
  std::vector<RollOutRun> runs;
  /// Mechanical damping per wheel, without back-EMF. The interval follows from the scatter between runs and is empty with
  /// fewer than three runs. The entry of a wheel without a run is empty.
  std::vector<std::optional<Estimate>> wheel_damping_Nm_s_per_rad;
  std::vector<std::optional<Estimate>> wheel_torque_Nm;
  std::size_t rows = 0;
};

/// Evaluates the roll-outs of all logs. `body` has the masses and inertias.
RollOutResult roll_out(const std::vector<FrictionLog>& logs, const robot::BodyConfig& body, bool is_lifted);
/// Evaluates the roll-outs of all logs. The intervals include the uncertainty of masses and inertias in the robot file, with which all
/// results scale.
RollOutResult roll_out(const std::vector<FrictionLog>& logs, const robot::Robot& robot, const motor::MotorValues& motor, bool is_lifted);

}  // namespace heatsoak::friction
