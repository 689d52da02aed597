// The loss at a speed that no log tells: anything from none, where the motor stood still, to what it is at no-load speed.
#pragma once

#include "identify/calibration/motor_model.h"
#include "identify/measured_run.h"
#include "motor/motor.h"

namespace heatsoak {

/// The loss of a motor that turns at its no-load speed; 0 where it has none or its file does not tell.
double most_loss_at_speed_W(const Motor& motor);

/// What of it is expected where no run tells, throughout or while current flows.
double expected_loss_at_speed_W(const Motor& motor, bool is_driven);

/// Less turns no motor.
double least_driving_current_A(const Motor& motor);

/// Whether the motor may turn while its speed is not known.
bool turns_unseen(const MeasuredRun& run);

/// Lets the runs tell how much of that loss there is, throughout and while current flows; what is left comes and goes as unknown heat.
void open_loss_at_speed(MotorModel& model, const Motor& motor);

}  // namespace heatsoak
