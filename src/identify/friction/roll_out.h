// Damping from a robot that rolls out with its motors off.
#pragma once

#include <string>
#include <vector>

#include "identify/friction/friction_log.h"
#include "identify/friction/robust_fit.h"
#include "robot/body.h"

namespace heatsoak {

// With open motors a wheel has a torque τ and a damping D against its turning, and the kinetic energy of what rolls out,
// body, wheels and rotors, falls by what they take:
//   E(t) = E_0 − τ·Σ∫|ω_i| dt − D·Σ∫ω_i² dt,
// linear in τ and D, without a derivative, and true whichever way the robot turns aside while it rolls (a dry torque of
// all wheels does not point against the travel). Lifted, every wheel rolls out by itself. What the rollers take counts
// to τ. A stretch counts where every driver is off (or, in a log without voltages, from the greatest speed on) and ends
// at 15 % of its first speed.

enum class RollOut { translation, rotation, lifted_wheel };

struct RollOutRun {
  RollOut kind = RollOut::translation;
  int wheel = -1;                           ///< of a lifted wheel
  double heading_rad = 0.0;                 ///< of a translation, in the robot's frame
  double force_N = 0.0;                     ///< against a translation at no speed
  double wheel_damping_Nm_s_per_rad = 0.0;  ///< D, the same for all wheels of a robot on the floor
  double wheel_torque_Nm = 0.0;             ///< τ likewise
  double r2_ratio = 0.0;
  int rows_used = 0;
};

struct RollOutResult {
  std::vector<RollOutRun> runs;
  /// Per wheel, mechanical: without back-EMF. The interval is from run to run, and unknown with less than three.
  std::vector<Estimate> wheel_damping_Nm_s_per_rad;
  std::vector<Estimate> wheel_torque_Nm;
  std::size_t rows = 0;
};

/// `body` gives masses and inertias.
RollOutResult roll_out(const std::vector<FrictionLog>& logs, const BodyConfig& body, bool is_lifted);
/// The same, with what the robot's file leaves open of masses and inertias in the intervals: all results scale with them.
RollOutResult roll_out(const std::vector<FrictionLog>& logs, const Robot& robot, const MotorValues& motor, bool is_lifted);

}  // namespace heatsoak
