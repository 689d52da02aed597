// The worst that a sensor can do which shows colder than its node and is not noticed.
#pragma once

#include <span>

#include "derate/derating.h"
#include "derate/sensed/sensor.h"

namespace heatsoak {

/// The current of one use where the sensor hides all heat: the sensed table's current of a motor as cold as its air, but no
/// more than `gain_A` above what the guard without a sensor allows, which counts only its own allowed current.
UsePlayed play_lying(const SensorPlan& plan, const Derating& model_only, const Motor& motor, const Robot& robot, const Use& use,
                     double gain_A);

/// Sets most_gain_A, lying_nominal_C and lying_over: the largest gain with which the nominal motor keeps its limits.
void set_lying_sensor(SensorPlan& plan, const Motor& motor, const Robot& robot, const Derating& model_only, std::span<const Use> uses);

}  // namespace heatsoak
