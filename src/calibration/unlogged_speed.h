// Speed-dependent loss of a motor whose speed was not logged: from 0 at standstill to the loss at no-load speed.
#pragma once

#include "calibration/motor_model.h"
#include "estimation/measured_run.h"
#include "motor/motor.h"

namespace heatsoak::calibration {

/// Returns the loss at no-load speed in W; 0 for a motor without no-load current.
double most_loss_at_speed_W(const motor::Motor& motor);

/// Returns the prior mean of that loss in W; with `is_driven` while current flows, else at other times.
double expected_loss_at_speed_W(const motor::Motor& motor, bool is_driven);

/// Returns the smallest current that can turn the motor, in A: half of the no-load current, or 0 if that is unknown.
double least_driving_current_A(const motor::Motor& motor);

/// Returns true if the motor may turn at any time without a logged speed.
bool turns_unseen(const estimation::MeasuredRun& run);

/// Adds two free parameters for that loss, one for all times and one while current flows. Its variation is part of the unknown heat flux.
void open_loss_at_speed(MotorModel& model, const motor::Motor& motor);

}  // namespace heatsoak::calibration
