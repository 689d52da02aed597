#include "robot/assumed_friction.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "robot/traction.h"

namespace heatsoak::robot {
namespace {

struct Assumed {
  std::string_view key;
  double low;
  double nominal;
  double high;
  bool is_per_load;  ///< the value is multiplied by weight and wheel radius
};

// TIGERs: 4.2 mN m at 2.78 kg and 32 mm, 0.11, no damping, 0.72. Twente: 1 mN m at 2.63 kg, 0.16, 0.144 mN m s/rad, no separate efficiency.
constexpr std::array<Assumed, 4> kAssumed{{
    {"wheel_torque", 0.0, 0.003, 0.008, true},
    {"wheel_damping", 0.0, 1e-4, 3e-4, true},
    {"roller_drag", 0.05, 0.14, 0.25, false},
    {"rolling_efficiency", 0.65, 0.8, 1.0, false},
}};

std::optional<double>& friction_value(Robot& robot, std::string_view key) {
  const auto is_it = [&](const RobotParameterSpec& each) { return each.table == "friction" && each.spec.key == key; };
  return std::ranges::find_if(robot_parameter_specs(), is_it)->value.of(robot);
}

}  // namespace

bool has_friction(const Robot& robot) {
  return !robot.friction.is_assumed &&
         (!robot.friction.heading.wheels.empty() || std::ranges::any_of(robot_parameter_specs(), [&](const RobotParameterSpec& each) {
           return each.table.starts_with("friction") && each.value.in(robot);
         }));
}

Robot with_assumed_friction(Robot robot) {
  if (has_friction(robot)) {
    return robot;
  }
  const double load_Nm = robot.mass_kg * kGravity_m_per_s2 * robot.wheels.radius_m;
  for (const Assumed& each : kAssumed) {
    const double scale = each.is_per_load ? load_Nm : 1.0;
    base::ParameterValue parameter;
    parameter.value = scale * each.nominal;
    parameter.derivation = "assumed: that of other robots, per weight and wheel radius";
    parameter.spread = base::Spread{base::Spread::Kind::range, scale * each.low, scale * each.high, each.low > 0.0};
    friction_value(robot, each.key) = parameter.value;
    robot.parameters.insert_or_assign(fmt::format("friction.{}", each.key), parameter);
  }
  robot.friction.is_assumed = true;
  return robot;
}

}  // namespace heatsoak::robot
