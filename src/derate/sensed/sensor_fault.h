// Worst case of a faulty sensor that reads colder than its node and is not detected by the cross-check.
#pragma once

#include <span>

#include "derate/derating.h"
#include "derate/sensed/sensor.h"

namespace heatsoak::derate {

/// Simulates one use with a sensor that always reads the air temperature. The current is that of the sensed table for a cold motor, at most
/// `gain_A` above the current that the guard without a sensor allows. That guard integrates only its own allowed current. All nodes of
/// motor and guard start at `start_C`.
UsePlayed play_sensor_fault(const SensorPlan& plan, const Derating& model_only, const motor::Motor& motor, const robot::Robot& robot,
                            const LoadPattern& use, double gain_A, double start_C);

/// Sets most_gain_A to the largest gain at which the nominal motor keeps its limits if it starts at the hottest air temperature; sets
/// sensor_fault_nominal_C, sensor_fault_warm_C and sensor_fault_over accordingly.
void set_sensor_fault(SensorPlan& plan, const motor::Motor& motor, const robot::Robot& robot, const Derating& model_only,
                      std::span<const LoadPattern> uses);

}  // namespace heatsoak::derate
