#include "select/drive_profile.h"

#include <algorithm>
#include <cmath>

#include "base/copper.h"
#include "motor/datasheet_network.h"
#include "robot/machine_point.h"

namespace heatsoak::select {

DutySample nominal_sample(const duty::Duty& duty) { return {duty.ambient_C.value, duty.load.value}; }

DutySample draw_sample(const duty::Duty& duty, base::Random& random) {
  DutySample sample;
  sample.ambient_C = duty.ambient_C.quantile(random.uniform());
  sample.load = duty.load.quantile(random.uniform());
  return sample;
}

thermal::OperatingPoint<double> operating_point(const motor::MotorValues& motor, const robot::Robot& robot, duty::DutyKind kind,
                                                const duty::LoadBin& bin, const DutySample& sample) {
  const double to_shaft = robot::shaft_torque_factor(robot, bin.torque_along_motion_Nm >= 0.0) * sample.load;
  const double torque_rms_Nm = bin.torque_rms_Nm * to_shaft;
  const double drag_Nm = motor::drag_torque_Nm(motor);
  const double torque2 =
      torque_rms_Nm * torque_rms_Nm + 2.0 * drag_Nm * bin.torque_along_motion_Nm * to_shaft + drag_Nm * drag_Nm * bin.moving_share;
  const double wanted_A =
      kind == duty::DutyKind::torque ? std::sqrt(std::max(0.0, torque2)) / motor.torque_constant_Nm_per_A : bin.current_rms_A * sample.load;
  const double direction = bin.torque_along_motion_Nm < 0.0 || bin.current_along_motion_A < 0.0 ? -1.0 : 1.0;
  const double speed_rad_per_s = bin.speed_mean_rad_per_s * robot.drive.gear_ratio;
  const robot::DrivePoint point = robot::clamped_point(motor, robot, direction * wanted_A, speed_rad_per_s);
  thermal::OperatingPoint<double> at = robot::operating_point(point, motor, robot, sample.ambient_C);
  at.speed_rms_rad_per_s = bin.speed_rms_rad_per_s * robot.drive.gear_ratio;
  at.velocity_rad_per_s = bin.velocity_mean_rad_per_s * robot.drive.gear_ratio;
  at.acceleration_rad_per_s2 = bin.acceleration_rad_per_s2 * robot.drive.gear_ratio;
  if (kind == duty::DutyKind::torque) {
    const double delivered_ratio = wanted_A > 0.0 ? std::abs(point.current_A) / wanted_A : 1.0;
    at.shaft_power_W = bin.power_mean_W * robot::shaft_torque_factor(robot, bin.power_mean_W >= 0.0) * robot.drive.gear_ratio *
                       sample.load * delivered_ratio;
    at.input_power_W = robot::input_power_W(motor, at.current_rms_A, at.shaft_power_W, at.speed_mean_rad_per_s);
  }
  return at;
}

std::vector<thermal::Interval> intervals(const motor::MotorValues& motor, const robot::Robot& robot, duty::DutyKind kind,
                                         const duty::WheelDemand& demand, const DutySample& sample) {
  std::vector<thermal::Interval> result;
  result.reserve(demand.bins.size());
  for (const duty::LoadBin& bin : demand.bins) {
    result.push_back({bin.duration_s, operating_point(motor, robot, kind, bin, sample)});
  }
  return result;
}

double current_rms_A(const std::vector<thermal::Interval>& intervals) {
  double current2_s = 0.0;
  double duration_s = 0.0;
  for (const thermal::Interval& each : intervals) {
    current2_s += each.at.current_rms_A * each.at.current_rms_A * each.duration_s;
    duration_s += each.duration_s;
  }
  return duration_s > 0.0 ? std::sqrt(current2_s / duration_s) : 0.0;
}

Feasibility feasibility(const motor::MotorValues& motor, const robot::Robot& robot, duty::DutyKind kind, const duty::WheelDemand& demand,
                        const DutySample& sample, double winding_C) {
  Feasibility result;
  motor::MotorValues warm = motor;
  warm.terminal_resistance_ohm *= base::resistance_ratio(motor.temperature_coefficient_per_K, winding_C);
  double short_s = 0.0;
  for (const duty::LoadPoint& each : demand.points) {
    const robot::DrivePoint point = kind == duty::DutyKind::torque
                                        ? robot::drive_point(warm, robot, {each.torque_Nm * sample.load, each.speed_rad_per_s})
                                        : robot::drive_point_of_current(warm, robot, each.current_A * sample.load, each.speed_rad_per_s);
    robot::DrivePoint wanted = point;
    wanted.current_A = point.current_wanted_A;
    result.highest_voltage_V =
        std::max(result.highest_voltage_V, std::abs(robot::driver_voltage_V(warm, robot, wanted, base::kSheetTemperature_C)));
    const double share = point.limit == robot::DriveLimit::none ? 1.0 : point.current_A / point.current_wanted_A;
    if (share < result.least_share) {
      result.least_share = share;
      result.limit = point.limit;
    }
    short_s += share < 1.0 - kTolerableShortage ? each.time_s : 0.0;
  }
  result.short_time_share = short_s / demand.duration_s();
  return result;
}

}  // namespace heatsoak::select
