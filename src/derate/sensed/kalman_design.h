// Designs the constant Kalman gain of the observer from the spread of drawn motors.
#pragma once

#include <cstdint>
#include <vector>

#include "derate/hot_cases.h"
#include "derate/sensed/sensor.h"

namespace heatsoak::derate {

struct SensorGain {
  std::vector<double> gain;     ///< per state: correction per period and kelvin of innovation
  double lag_gain_ratio = 0.0;  ///< 0 without a lag
};

/// Returns the steady-state Kalman gain per period of the network linearised at a hot operating point. The process noise is the second
/// moment of the rate differences between `samples` ≥ 1 drawn motors and the nominal one. Neither these differences nor the sensor's offset
/// average out over the motor's time constants. Both have the same correlation time, which cancels in the gain.
SensorGain sensor_gain(const motor::Motor& motor, const robot::Robot& robot, const BarrierRules& rules, const SensorOptions& options,
                       double period_s, double lasting_current_A, int samples, std::uint64_t seed);

}  // namespace heatsoak::derate
