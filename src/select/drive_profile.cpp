#include "select/drive_profile.h"

#include <cmath>

namespace heatsoak {

DutySample nominal_sample(const Duty& duty) { return {duty.ambient_C.value, duty.load.value}; }

DutySample draw_sample(const Duty& duty, Random& random) {
  DutySample sample;
  sample.ambient_C = duty.ambient_C.quantile(random.uniform());
  sample.load = duty.load.quantile(random.uniform());
  return sample;
}

DrivePoint drive_point(const MotorValues& motor, const Robot& robot, const Duty& duty, const DutyPiece& piece, const DutySample& sample) {
  return duty.kind == DutyKind::torque
             ? drive_point(motor, robot, {piece.torque_Nm * sample.load, piece.speed_rad_per_s})
             : drive_point_of_current(motor, robot, piece.current_A * sample.load, piece.speed_rad_per_s);
}

DriveProfile drive_profile(const MotorValues& motor, const Robot& robot, const Duty& duty, const DutySample& sample) {
  DriveProfile profile;
  profile.points.reserve(duty.pieces.size());
  profile.intervals.reserve(duty.pieces.size());
  double charge_A2s = 0.0;
  double duration_s = 0.0;
  for (const DutyPiece& piece : duty.pieces) {
    const DrivePoint point = drive_point(motor, robot, duty, piece, sample);
    profile.points.push_back(point);
    profile.intervals.push_back({piece.duration_s, operating_point(point, robot, sample.ambient_C)});
    const double heating_A = profile.intervals.back().at.current_rms_A;
    charge_A2s += heating_A * heating_A * piece.duration_s;
    duration_s += piece.duration_s;
    if (point.limit != DriveLimit::none && point.current_wanted_A != 0.0) {
      const double share = point.current_A / point.current_wanted_A;
      if (share < profile.least_torque_share) {
        profile.least_torque_share = share;
        profile.limit = point.limit;
      }
    }
  }
  profile.current_rms_A = duration_s > 0.0 ? std::sqrt(charge_A2s / duration_s) : 0.0;
  return profile;
}

}  // namespace heatsoak
