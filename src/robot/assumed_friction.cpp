#include "robot/assumed_friction.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "robot/traction.h"

namespace heatsoak {
namespace {

struct Assumed {
  double Robot::*value;
  double low;
  double nominal;
  double high;
  bool is_per_load;  ///< the value is multiplied by weight and wheel radius
};

// TIGERs: 4.2 mN m at 2.78 kg and 32 mm, 0.11, no damping, 0.72. Twente: 1 mN m at 2.63 kg, 0.16, 0.144 mN m s/rad, no separate efficiency.
constexpr std::array<Assumed, 4> kAssumed{{
    {&Robot::wheel_friction_torque_Nm, 0.0, 0.003, 0.008, true},
    {&Robot::wheel_damping_Nm_s_per_rad, 0.0, 1e-4, 3e-4, true},
    {&Robot::roller_drag_ratio, 0.05, 0.14, 0.25, false},
    {&Robot::rolling_efficiency, 0.65, 0.8, 1.0, false},
}};

std::string_view key_of(double Robot::*value) {
  const auto specs = robot_parameter_specs();
  return std::ranges::find(specs, value, &RobotParameterSpec::value)->spec.key;
}

}  // namespace

bool has_friction(const Robot& robot) {
  return !robot.is_friction_assumed &&
         (!robot.heading_wheels.empty() || std::ranges::any_of(robot_parameter_specs(), [&](const RobotParameterSpec& each) {
           return each.table.starts_with("friction") && !std::isnan(robot.*each.value);
         }));
}

Robot with_assumed_friction(Robot robot) {
  if (has_friction(robot)) {
    return robot;
  }
  const double load_Nm = robot.mass_kg * kGravity_m_per_s2 * robot.wheel_radius_m;
  for (const Assumed& each : kAssumed) {
    const double scale = each.is_per_load ? load_Nm : 1.0;
    ParameterValue parameter;
    parameter.value = scale * each.nominal;
    parameter.derivation = "assumed: that of other robots, per weight and wheel radius";
    parameter.spread = Spread{Spread::Kind::range, scale * each.low, scale * each.high, each.low > 0.0};
    robot.*each.value = parameter.value;
    robot.parameters.insert_or_assign(fmt::format("friction.{}", key_of(each.value)), parameter);
  }
  robot.is_friction_assumed = true;
  return robot;
}

std::string assumed_friction_text(const Robot& robot) {
  if (!robot.is_friction_assumed) {
    return {};
  }
  return fmt::format(
      "{} has no [friction]: the feed-forward of friction is off, and the simulated robot has the friction of other teams' robots "
      "(estimate: wheel torque {:.1f} mN m, roller drag {:.2f}, rolling efficiency {:.2f}); measure yours with `heatsoak friction`\n",
      robot.file.filename().string(), 1e3 * robot.wheel_friction_torque_Nm, robot.roller_drag_ratio, robot.rolling_efficiency);
}

}  // namespace heatsoak
