#include "friction/friction_suspicions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace heatsoak::friction {
namespace {

constexpr double kFarOff_deg = 20.0;
constexpr double kContradicting_share = 0.15;
constexpr double kLeastOfBackEmf_ratio = 0.6;
constexpr double kMostOfBackEmf_ratio = 2.3;
constexpr double kLeastExplained_ratio = 0.7;
constexpr double kDead_share = 0.05;

/// Median angle in degrees between the log's direction of travel and that computed from the wheel speeds; 0 without legs.
double direction_off_deg(const SteadyParts& steady, const robot::Kinematics& kinematics) {
  std::vector<double> off_deg;
  for (const SteadyPart& part : steady.parts) {
    if (!part.is_rotation) {
      const robot::BodyVelocity velocity = robot::body_velocity(kinematics, part.wheel_speed_rad_per_s);
      const double wheels_rad = std::atan2(velocity.y_m_per_s, velocity.x_m_per_s);
      off_deg.push_back(std::abs(std::remainder(part.heading_rad - wheels_rad, 2.0 * std::numbers::pi)) * 180.0 / std::numbers::pi);
    }
  }
  return off_deg.empty() ? 0.0 : median(off_deg);
}

/// Median share of the wheel speeds that no motion of the robot explains; always 0 with three wheels.
double contradiction_share(const SteadyParts& steady, const robot::Kinematics& kinematics) {
  std::vector<double> shares;
  for (const SteadyPart& part : steady.parts) {
    const robot::PerWheel expected =
        robot::wheel_speeds_rad_per_s(kinematics, robot::body_velocity(kinematics, part.wheel_speed_rad_per_s));
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

/// Largest voltage of a wheel divided by the median of the other wheels' largest voltages.
double voltage_share(const SteadyParts& steady, int wheel, int wheel_count) {
  std::vector<double> tops_V;
  double own_V = 0.0;
  for (int i = 0; i < wheel_count; ++i) {
    double top_V = 0.0;
    for (const SteadyPart& part : steady.parts) {
      top_V = std::max(top_V, std::isfinite(part.voltage_V[i]) ? std::abs(part.voltage_V[i]) : 0.0);
    }
    if (i == wheel) {
      own_V = top_V;
    } else {
      tops_V.push_back(top_V);
    }
  }
  const double others_V = median(tops_V);
  return others_V > 0.0 ? own_V / others_V : 1.0;
}

/// Returns a suspicion if one wheel is implausible by itself.
std::optional<FrictionSuspicion> suspicion_of_wheel(const SteadyParts& steady, const WheelFriction& wheel, std::size_t number,
                                                    int wheel_count, double back_emf_V_s_per_rad) {
  if (voltage_share(steady, static_cast<int>(number) - 1, wheel_count) < kDead_share) {
    return WheelWithoutVoltage{number};
  }
  if (!wheel.is_learned()) {
    return std::nullopt;
  }
  const double damping = wheel.damping_is_given ? back_emf_V_s_per_rad : wheel.damping_V_s_per_rad->value;
  if (damping < 0.0) {
    return WheelVoltageFallsWithSpeed{number};
  }
  if (wheel.sine_V && wheel.sine_V->interval && wheel.constant_V && wheel.constant_V->interval) {
    const double highest_V = wheel.constant_V->interval->high;
    if (highest_V < 0.0 || wheel.sine_V->interval->high + highest_V < 0.0) {
      return FrictionDrivesWheel{number, wheel.sine_V->value, wheel.constant_V->value};
    }
  }
  if (wheel.r2_ratio && *wheel.r2_ratio < kLeastExplained_ratio) {
    return WheelVoltageUnexplained{number, *wheel.r2_ratio};
  }
  const double ratio = damping / back_emf_V_s_per_rad;
  if (!wheel.damping_is_given && (ratio < kLeastOfBackEmf_ratio || ratio > kMostOfBackEmf_ratio)) {
    return WheelDampingDiffers{number, ratio};
  }
  return std::nullopt;
}

}  // namespace

std::vector<FrictionSuspicion> friction_suspicions(const SteadyParts& steady, const FrictionFit& fit, const robot::Kinematics& kinematics,
                                                   const std::optional<robot::DriveConstants>& drive) {
  std::vector<FrictionSuspicion> found;
  if (const double off_deg = direction_off_deg(steady, kinematics); off_deg > kFarOff_deg) {
    found.emplace_back(DirectionDiffers{off_deg});
  }
  if (const double share = contradiction_share(steady, kinematics); share > kContradicting_share) {
    found.emplace_back(SpeedsContradict{share});
  }
  std::vector<double> dampings;
  for (const WheelFriction& wheel : fit.wheels) {
    if (wheel.is_learned() && !wheel.damping_is_given) {
      dampings.push_back(wheel.damping_V_s_per_rad->value);
    }
  }
  const double damping = dampings.empty() ? std::numeric_limits<double>::quiet_NaN() : median(dampings);
  // Problems that not all wheels have are reported per wheel below.
  const auto all = [&dampings](auto is_wrong) { return std::ranges::all_of(dampings, is_wrong); };
  if (damping < 0.0 && all([](double each) { return each < 0.0; })) {
    found.emplace_back(VoltageFallsWithSpeed{});
  } else if (drive) {
    const double back_emf_V_s_per_rad = drive->torque_constant_Nm_per_A * drive->gear_ratio;
    const double ratio = damping / back_emf_V_s_per_rad;
    if (std::isfinite(ratio) && (all([&](double each) { return each < kLeastOfBackEmf_ratio * back_emf_V_s_per_rad; }) ||
                                 all([&](double each) { return each > kMostOfBackEmf_ratio * back_emf_V_s_per_rad; }))) {
      found.emplace_back(DampingDiffersFromBackEmf{ratio});
    }
  }
  // Report single wheels only if no common problem was found.
  const bool is_of_single_wheels = found.empty();
  const double back_emf_V_s_per_rad =
      drive ? drive->torque_constant_Nm_per_A * drive->gear_ratio : std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; is_of_single_wheels && i < fit.wheels.size(); ++i) {
    if (const auto of_wheel = suspicion_of_wheel(steady, fit.wheels[i], i + 1, kinematics.wheel_count, back_emf_V_s_per_rad)) {
      found.push_back(*of_wheel);
    }
  }
  return found;
}

}  // namespace heatsoak::friction
