#include "present/verdict_words.h"

#include <fmt/format.h>

namespace heatsoak::present {

std::string duration_text(double duration_s) {
  return duration_s < 120.0 ? fmt::format("{:.0f} s", duration_s) : fmt::format("{:.0f} min", duration_s / 60.0);
}

std::string slip_text(const duty::WheelDemand& wheel) {
  constexpr double kReported_share = 0.01;
  return wheel.slip_share < kReported_share ? ""
                                            : fmt::format(
                                                  "the motion exceeds the grip in {:.0f} % of the time: a wheel slides there, and may heat "
                                                  "its motor more than is shown (`heatsoak simulate` includes this)\n",
                                                  100.0 * wheel.slip_share);
}

std::string why_infeasible(const select::MotorEvaluation& motor, const robot::Robot& robot) {
  if (motor.verdict != select::Verdict::infeasible) {
    return "";
  }
  const std::string what =
      motor.limiting_factor == select::LimitingFactor::voltage
          ? fmt::format("needs up to {:.1f} V when hot, {:.1f} V are available:", motor.highest_voltage_V, robot.available_V())
          : fmt::format("the driver's {:.1f} A are", robot.drive.current_limit_A);
  return fmt::format("{}: {} {:.0f} % of the demanded current at the worst moment, too little for {:.0f} % of the time\n", motor.motor_id,
                     what, 100.0 * motor.least_torque_share, 100.0 * motor.short_time_share);
}

}  // namespace heatsoak::present
