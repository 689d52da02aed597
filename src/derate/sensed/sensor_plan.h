// Adds a sensor to a guard: gain, lower safety factor on heat, cross-check, and the effect of an undetected sensor fault.
#pragma once

#include "derate/derating.h"
#include "derate/search_work.h"
#include "derate/sensed/sensor.h"

namespace heatsoak::derate {

/// Computes the parameters of the sensor. `model_only` is the guard of the same motor without a sensor.
/// 1. Gain: sensor_gain().
/// 2. Safety factor: the smallest one, below that without a sensor, at which enough independently drawn motors keep every limit in every
///    use. Enough: the lower bound of their share (kCertainty_share) reaches the confidence. Each motor has a drawn sensor error.
/// 3. Cross-check: bounds that at most 1 % of the correct sensors on drawn motors violate.
/// 4. most_gain_A: the largest current above the guard without a sensor at which the nominal motor keeps its limits although the sensor
///    always reads the air temperature.
/// Throws Failure: bad_input for a node that the motor lacks or an accuracy that is not positive; cannot_answer if the sensor allows no
/// lower safety factor.
SensorPlan plan_sensor(const motor::Motor& motor, const robot::Robot& robot, const Derating& model_only, const SensorOptions& options,
                       SearchWork* work = nullptr);

/// Sets the usual work of plan_sensor() with this many uses and drawn motors.
void expect_sensor_work(SearchWork& work, const motor::Motor& motor, const BarrierRules& rules, double period_s, std::size_t uses,
                        int samples);

}  // namespace heatsoak::derate
