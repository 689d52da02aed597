// Damping from a robot that rolls out with its motors off.
#pragma once

#include <string>
#include <vector>

#include "identify/friction/friction_log.h"
#include "identify/friction/robust_fit.h"
#include "robot/body.h"

namespace heatsoak {

// With open motors a wheel has a torque τ and a damping D against it, and what rolls out obeys
//   J·dω/dt = −τ − D·ω,  so  ω(t) = ω_0 − (τ/J)·t − (D/J)·∫ω dt :
// a line over time and the way covered, without a derivative. On the floor ω is the robot's own speed along its heading
// (or its turning rate), J what moves with it, wheels and rotors included, and every wheel takes its part: with the
// share s_i of rolling, v = ω_i·r/s_i, the sum D·Σ s_i²/r² damps the robot. Lifted, every wheel rolls out by itself.
// A stretch counts where every driver is off (or, in a log without voltages, from the greatest speed on) and ends at
// 15 % of its first speed, where the sign of the friction is no longer sure.

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

}  // namespace heatsoak
