// Writes measured friction into the text of a robot file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "friction/findings.h"
#include "friction/friction_fit.h"
#include "robot/friction.h"
#include "robot/robot.h"

namespace heatsoak::friction {

/// No robot file is written, because the friction of a wheel over the directions is not identifiable (cannot_answer).
class WheelNotIdentifiable : public base::Failure {
 public:
  WheelNotIdentifiable(std::size_t wheel, std::optional<WheelProblem> problem);
  /// nullopt: the logs only turn on the spot
  [[nodiscard]] std::optional<WheelProblem> problem() const { return problem_; }

 private:
  std::optional<WheelProblem> problem_;
};

/// No robot file is written, because the damping from the roll-outs is certainly negative: the motors drove the wheels (cannot_answer).
class DampingNegative : public base::Failure {
 public:
  explicit DampingNegative(double damping_Nm_s_per_rad);
  [[nodiscard]] double damping_Nm_s_per_rad() const { return damping_Nm_s_per_rad_; }

 private:
  double damping_Nm_s_per_rad_;
};

/// Returns the text of the robot file with new friction values of origin "measured"; everything else, comments included, is unchanged.
/// friction.wheel_damping is the mean of the wheels, [friction.heading] has one table per wheel. As in all robot files, they are torques
/// at the wheel without drag and back-EMF of the motor, so that they hold for another motor too. With the motor of the measurement,
/// steady_voltage_V() reproduces the measured voltages. If the motor's drag or back-EMF alone exceeds the measured value, 0 is written and
/// `notes` gets an entry. Throws WheelNotIdentifiable if a wheel was not fitted; Failure (bad_input) if the file has its friction in
/// another form than tables [friction] and [friction.heading].
std::string with_measured_friction(const std::string& text, const robot::Robot& robot, const robot::DriveConstants& drive,
                                   const FrictionFit& fit, const std::string& source, std::vector<WrittenAsZero>& notes);

/// Returns the text of the robot file with friction.wheel_damping of a roll-out; everything else is unchanged. Throws Failure
/// (cannot_answer) if a wheel has none, and DampingNegative if its whole interval is below 0.
std::string with_measured_damping(const std::string& text, const robot::Robot& robot,
                                  const std::vector<std::optional<Estimate>>& wheel_damping_Nm_s_per_rad, const std::string& source);

}  // namespace heatsoak::friction
