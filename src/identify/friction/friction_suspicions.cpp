#include "identify/friction/friction_suspicions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/quantity.h"

namespace heatsoak {
namespace {

constexpr double kFarOff_deg = 20.0;
constexpr double kContradicting_share = 0.15;
constexpr double kLeastOfBackEmf_ratio = 0.6;
constexpr double kMostOfBackEmf_ratio = 3.0;

/// The log's direction of travel against what the wheels amount to, in the median; 0 without legs.
double direction_off_deg(const SteadyParts& steady, const Kinematics& kinematics) {
  std::vector<double> off_deg;
  for (const SteadyPart& part : steady.parts) {
    if (!part.is_rotation) {
      const BodyVelocity velocity = body_velocity(kinematics, part.wheel_speed_rad_per_s);
      const double wheels_rad = std::atan2(velocity.y_m_per_s, velocity.x_m_per_s);
      off_deg.push_back(std::abs(std::remainder(part.heading_rad - wheels_rad, 2.0 * std::numbers::pi)) * 180.0 / std::numbers::pi);
    }
  }
  return off_deg.empty() ? 0.0 : median(off_deg);
}

/// Of four wheels, the share of their speeds that no motion of the robot explains, in the median; 0 of three.
double contradiction_share(const SteadyParts& steady, const Kinematics& kinematics) {
  std::vector<double> shares;
  for (const SteadyPart& part : steady.parts) {
    const PerWheel expected = wheel_speeds_rad_per_s(kinematics, body_velocity(kinematics, part.wheel_speed_rad_per_s));
    double off_rad2_per_s2 = 0.0;
    double all_rad2_per_s2 = 0.0;
    for (int i = 0; i < kinematics.wheel_count; ++i) {
      const double off_rad_per_s = part.wheel_speed_rad_per_s[i] - expected[i];
      off_rad2_per_s2 += off_rad_per_s * off_rad_per_s;
      all_rad2_per_s2 += part.wheel_speed_rad_per_s[i] * part.wheel_speed_rad_per_s[i];
    }
    shares.push_back(std::sqrt(off_rad2_per_s2 / all_rad2_per_s2));
  }
  return shares.empty() ? 0.0 : median(shares);
}

}  // namespace

std::vector<std::string> friction_suspicions(const SteadyParts& steady, const FrictionFit& fit, const Kinematics& kinematics,
                                             const std::optional<DriveConstants>& drive) {
  std::vector<std::string> found;
  if (const double off_deg = direction_off_deg(steady, kinematics); off_deg > kFarOff_deg) {
    found.push_back(
        fmt::format("the direction of travel is {:.0f}° off what the wheels' speeds amount to: are the wheels in another order than in the "
                    "robot's file, is an angle in degrees, or of another frame?",
                    off_deg));
  }
  if (const double share = contradiction_share(steady, kinematics); share > kContradicting_share) {
    found.push_back(
        fmt::format("{:.0f} % of the wheels' speeds fit to no motion of the robot: are they in another order, or of another sign, than in "
                    "the robot's file?",
                    100.0 * share));
  }
  std::vector<double> dampings;
  for (const WheelFriction& wheel : fit.wheels) {
    if (wheel.is_learned() && !wheel.damping_is_given) {
      dampings.push_back(wheel.damping_V_s_per_rad.value);
    }
  }
  const double damping = dampings.empty() ? std::numeric_limits<double>::quiet_NaN() : median(dampings);
  if (damping < 0.0) {
    found.emplace_back("voltage falls as the wheels turn faster: does one of them have the wrong sign?");
  } else if (drive) {
    const double ratio = damping / (drive->torque_constant_Nm_per_A * drive->gear_ratio);
    if (ratio < kLeastOfBackEmf_ratio || ratio > kMostOfBackEmf_ratio) {
      found.push_back(
          fmt::format("d is {} times the motor's back-EMF, where 1 to 2 is usual: is a speed in rpm or that of the wheel in place of its "
                      "motor, a modulation in percent, a voltage in millivolts, or the motor another one?",
                      significant(ratio, 2)));
    }
  }
  return found;
}

}  // namespace heatsoak
