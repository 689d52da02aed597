// One motor on one duty of one robot: the intervals that its thermal network sees.
#pragma once

#include <vector>

#include "duty/duty.h"
#include "motor/motor.h"
#include "robot/motor_drive.h"
#include "thermal/transient.h"

namespace heatsoak {

/// What one draw of the duty's own unknowns is.
struct DutySample {
  double ambient_C = 25.0;
  double load = 1.0;  ///< factor on torque or current
};
DutySample nominal_sample(const Duty& duty);
DutySample draw_sample(const Duty& duty, Random& random);

/// What one piece of the duty asks of this motor.
DrivePoint drive_point(const MotorValues& motor, const Robot& robot, const Duty& duty, const DutyPiece& piece, const DutySample& sample);

struct DriveProfile {
  std::vector<DrivePoint> points;    ///< one per piece
  std::vector<Interval> intervals;   ///< one per piece
  double current_rms_A = 0.0;        ///< over the whole duty, heating current
  double least_torque_share = 1.0;   ///< smallest ratio of delivered to demanded current
  DriveLimit limit = DriveLimit::none;  ///< what cut it there
};
DriveProfile drive_profile(const MotorValues& motor, const Robot& robot, const Duty& duty, const DutySample& sample);

}  // namespace heatsoak
