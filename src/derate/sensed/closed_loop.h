// Closed-loop simulation of drawn motors with the worst sensor error. The allowed current depends on each motor through its sensor.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/lanes.h"
#include "derate/current_table.h"
#include "derate/guarantee.h"
#include "derate/sensed/sensor.h"

namespace heatsoak::derate {

/// Components of the loop. All referenced objects must outlive it.
struct SensedLoop {
  const motor::Motor& motor;
  const robot::Robot& robot;
  const BarrierRules& rules;
  const Observer& model_only;  ///< observer with the safety factor of the guard without a sensor
  const CurrentTable& table;   ///< table of that observer
  const SensorPlan& plan;
  double period_s = 0.01;  ///< firmware period, for which the gains are given
  double step_s = 0.01;    ///< simulation step, at least the period
};

/// Extremes of one drawn motor over all uses.
struct SensedPeak : MotorPeak {
  double cold_share = 1.0;    ///< smallest (rise of the node + margin)/(rise of the nominal motor's node), above the air
  double frozen_K = 0.0;      ///< largest change of the nominal node while the true node stayed within the band
  double rate_K_per_s = 0.0;  ///< fastest change of the node
};

/// Simulates kLanes drawn motors, from the random streams `first_stream` on, in every use with the full current that the sensed observer
/// allows. Every sensor reads too little by its whole accuracy, so the result holds for each distribution of the errors, also a mounting
/// error that all motors share. Omits the bound most_gain_A and the cross-check, because both only lower the current.
std::array<SensedPeak, base::kLanes> sensed_peaks(const SensedLoop& loop, std::span<const LoadPattern> uses, std::uint64_t seed,
                                                  std::uint64_t first_stream);

/// Returns the current in A that the nominal motor, with an exact sensor, is allowed at the end of a continuous use.
double nominal_lasting_current_A(const SensedLoop& loop, const LoadPattern& held);

}  // namespace heatsoak::derate
