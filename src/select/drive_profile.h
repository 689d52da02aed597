// Converts the demand of one wheel to the inputs of a motor's thermal network, and checks whether the motor can deliver it.
#pragma once

#include <vector>

#include "duty/duty.h"
#include "motor/motor.h"
#include "robot/motor_drive.h"
#include "thermal/transient.h"

namespace heatsoak::select {

/// Ambient temperature and load of a duty, nominal or drawn from their ranges.
struct DutySample {
  double ambient_C = 25.0;
  double load = 1.0;  ///< factor on torque or current
};
DutySample nominal_sample(const duty::Duty& duty);
DutySample draw_sample(const duty::Duty& duty, base::Random& random);

/// Returns the operating point of the thermal network for one bin. The RMS current for its torque is limited by the voltage (at the bin's
/// mean speed, winding at 25 °C) and by the driver. Shaft and input power are exact means of the bin if the current is not limited, and are
/// reduced with the current if it is. The modulation is calculated from RMS current and mean speed.
thermal::OperatingPoint<double> operating_point(const motor::MotorValues& motor, const robot::Robot& robot, duty::DutyKind kind,
                                                const duty::LoadBin& bin, const DutySample& sample);

std::vector<thermal::Interval> intervals(const motor::MotorValues& motor, const robot::Robot& robot, duty::DutyKind kind,
                                         const duty::WheelDemand& demand, const DutySample& sample);

/// Returns the RMS of the heating current over all intervals, with the voltage limit of a winding at 25 °C; 0 if the duration is 0.
double current_rms_A(const std::vector<thermal::Interval>& intervals);

/// Worst shortfall of voltage or current over the points of a demand.
struct Feasibility {
  double least_share = 1.0;                           ///< smallest ratio of delivered to demanded current
  robot::DriveLimit limit = robot::DriveLimit::none;  ///< limit that acts at that point
  double short_time_share = 0.0;                      ///< share of the time in which the shortfall exceeds kTolerableShortage
  double highest_voltage_V = 0.0;                     ///< largest demanded voltage at the terminals
};
inline constexpr double kTolerableShortage = 0.005;  ///< relative shortfall of the current
Feasibility feasibility(const motor::MotorValues& motor, const robot::Robot& robot, duty::DutyKind kind, const duty::WheelDemand& demand,
                        const DutySample& sample, double winding_C);

}  // namespace heatsoak::select
