// Adds a sensor to a guard: its gain, the lower safety factor on heat, the cross-check and what a lying sensor can do.
#pragma once

#include "base/parallel.h"
#include "derate/derating.h"
#include "derate/sensed/sensor.h"

namespace heatsoak {

/// `model_only` is the guard of the same motor without a sensor.
/// 1. Gain: sensor_gain().
/// 2. Safety factor: the smallest one, no larger than without a sensor, with which the share of drawn motors that is asked for keeps every
///    limit in every use, each with a drawn sensor error, checked on motors that the search has not seen.
/// 3. Cross-check: bounds that at most 1 % of honest sensors at drawn motors violate.
/// 4. most_gain_A: the largest current above the guard without a sensor with which the nominal motor keeps its limits while the sensor
/// shows
///    the coldest that it may.
/// Throws Failure (bad_input) for a node that the motor lacks or an accuracy that is not positive.
SensorPlan plan_sensor(const Motor& motor, const Robot& robot, const Derating& model_only, const SensorOptions& options,
                       const Progress& progress = {});

}  // namespace heatsoak
