// One motor at one wheel: what the demand becomes for its thermal network, and whether it can be met at all.
#pragma once

#include <vector>

#include "duty/duty.h"
#include "motor/motor.h"
#include "robot/motor_drive.h"
#include "thermal/transient.h"

namespace heatsoak::select {

/// One draw of the duty's own unknowns.
struct DutySample {
  double ambient_C = 25.0;
  double load = 1.0;  ///< factor on torque or current
};
DutySample nominal_sample(const duty::Duty& duty);
DutySample draw_sample(const duty::Duty& duty, base::Random& random);

/// What the thermal network sees of a bin: the rms current that its torque takes, clamped to what voltage (at
/// the bin's mean speed, 25 °C) and driver let through. Shaft and input power are exact means of the bin where the current is
/// not cut, and shrink with it where it is; the modulation is that of rms current and mean speed.
thermal::OperatingPoint<double> operating_point(const motor::MotorValues& motor, const robot::Robot& robot, duty::DutyKind kind,
                                                const duty::LoadBin& bin, const DutySample& sample);

std::vector<thermal::Interval> intervals(const motor::MotorValues& motor, const robot::Robot& robot, duty::DutyKind kind,
                                         const duty::WheelDemand& demand, const DutySample& sample);

/// Root mean square of the heating current over the whole of it, as far as a winding at 25 °C lets it through.
double current_rms_A(const std::vector<thermal::Interval>& intervals);

/// Whether voltage and current suffice, point by point of the demand.
struct Feasibility {
  double least_share = 1.0;                           ///< smallest ratio of delivered to demanded current
  robot::DriveLimit limit = robot::DriveLimit::none;  ///< what cut it there
  double short_time_share = 0.0;                      ///< part of the time in which more than kTolerableShortage is missing
  double highest_voltage_V = 0.0;                     ///< demanded at the terminals
};
inline constexpr double kTolerableShortage = 0.005;
Feasibility feasibility(const motor::MotorValues& motor, const robot::Robot& robot, duty::DutyKind kind, const duty::WheelDemand& demand,
                        const DutySample& sample, double winding_C);

}  // namespace heatsoak::select
