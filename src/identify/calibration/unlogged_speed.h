// The loss at a speed that no log tells: anything from none, where the motor stood still, to what it is at no-load speed.
#pragma once

#include <span>
#include <vector>

#include "identify/calibration/motor_model.h"
#include "identify/measured_run.h"
#include "motor/motor.h"

namespace heatsoak {

/// The loss of a motor that turns at its no-load speed; 0 where it has none or its file does not tell.
double most_loss_at_speed_W(const Motor& motor);

/// Whether something drives the motor while its speed is not known; without any current it stands.
bool turns_unseen(const MeasuredRun& run);

/// Lets the runs tell how much of that loss there is, throughout and while current flows; what is left comes and goes as unknown heat.
void open_loss_at_speed(MotorModel& motor, double most_W);

/// What open_loss_at_speed() asks of a run that turns unseen; others have none of it.
void fill_loss_at_speed(std::span<MeasuredRun> runs, const Motor& motor);

}  // namespace heatsoak
