// From the spread of drawn motors to the constant gain with which a reading corrects the observer.
#pragma once

#include <cstdint>
#include <vector>

#include "derate/hot_cases.h"
#include "derate/sensed/sensor.h"

namespace heatsoak {

struct SensorGain {
  std::vector<double> gain;     ///< of each state
  double lag_gain_ratio = 0.0;  ///< 0 without a lag
};

/// Steady-state Kalman gain per period of the network linearised while it works hot. Process noise: second moments of the difference
/// between the rates of drawn motors and of the nominal one. Neither those differences nor the sensor's offset average out over the
/// motor's time constants, so both count with the same correlation time, which cancels in the gain.
/// `samples` ≥ 1 motors are drawn.
SensorGain sensor_gain(const Motor& motor, const Robot& robot, const BarrierRules& rules, const SensorOptions& options, double period_s,
                       double lasting_current_A, int samples, std::uint64_t seed);

}  // namespace heatsoak
