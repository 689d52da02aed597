// Drawn motors with drawn sensor errors in the loop of the guard: here the allowed current depends on the motor, through its sensor.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/lanes.h"
#include "derate/current_table.h"
#include "derate/guarantee.h"
#include "derate/sensed/sensor.h"

namespace heatsoak {

/// What the loop is made of. Observers, table and motor must outlive it.
struct SensedLoop {
  const Motor& motor;
  const Robot& robot;
  const BarrierRules& rules;
  const Observer& model_only;  ///< counts heat by the safety factor without a sensor
  const CurrentTable& table;   ///< of that observer
  const SensorPlan& plan;
  double period_s = 0.01;  ///< of the firmware: the unit of the gains
  double step_s = 0.01;    ///< of the loop, at least the period
};

/// Of one drawn motor over all uses.
struct SensedPeak {
  double winding_C = 0.0;
  bool is_over = false;
  double cold_share = 1.0;    ///< smallest (rise of the node + margin)/(rise of the nominal motor's node), above the air
  double frozen_K = 0.0;      ///< most that the nominal node changed while the true one stayed within the band
  double rate_K_per_s = 0.0;  ///< fastest change of the node
};

/// Eight drawn motors, streams of chance `first_stream` to +7, through every use with all current that the sensed observer allows. The
/// bound over the guard without a sensor and the cross-check are left out: both only lower the current.
std::array<SensedPeak, kLanes> sensed_peaks(const SensedLoop& loop, std::span<const Use> uses, std::uint64_t seed,
                                            std::uint64_t first_stream);

/// Current that the nominal motor with an exact sensor still gets at the end of a held use.
double nominal_lasting_current_A(const SensedLoop& loop, const Use& held);

}  // namespace heatsoak
