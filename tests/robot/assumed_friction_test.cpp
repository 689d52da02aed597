// Assumed friction of a robot whose file states none.
#include "robot/assumed_friction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/random.h"

namespace heatsoak::robot {
namespace {

const std::filesystem::path kRobots = std::filesystem::path(HEATSOAK_SOURCE_DIR) / "robot_core/robots";

Robot without_friction(Robot robot) {
  for (const RobotParameterSpec& each : robot_parameter_specs()) {
    if (each.table.starts_with("friction")) {
      each.value.of(robot).reset();
    }
  }
  robot.friction.heading.wheels.clear();
  return robot;
}

TEST(AssumedFriction, stated_friction_stays) {
  const Robot stated = read_robot(kRobots / "tigers_v2020.toml");
  const Robot same = with_assumed_friction(stated);
  EXPECT_FALSE(same.friction.is_assumed);
  EXPECT_EQ(same.friction.wheel_torque_Nm.value(), stated.friction.wheel_torque_Nm.value());
}

/// The ranges must include the friction that both teams measured.
TEST(AssumedFriction, ranges_include_the_measured_robots) {
  for (const char* const id : {"tigers_v2020", "roboteam_twente_v2024"}) {
    const Robot stated = read_robot(kRobots / (std::string(id) + ".toml"));
    const Robot assumed = with_assumed_friction(without_friction(stated));
    ASSERT_TRUE(assumed.friction.is_assumed);
    EXPECT_FALSE(has_friction(assumed));
    for (const RobotParameterSpec& each : robot_parameter_specs()) {
      if (each.table == "friction" && each.value.in(stated)) {
        const base::Spread& range = assumed.parameters.at("friction." + std::string(each.spec.key)).spread.value();
        EXPECT_GE(*each.value.in(stated), range.low) << id << " " << each.spec.key;
        EXPECT_LE(*each.value.in(stated), range.high) << id << " " << each.spec.key;
      }
    }
  }
}

TEST(AssumedFriction, draws_stay_in_their_ranges) {
  const Robot assumed = with_assumed_friction(without_friction(read_robot(kRobots / "tigers_v2020.toml")));
  const base::Spread drag = assumed.parameters.at("friction.roller_drag").spread.value();
  base::Random random(1, 0);
  double least = 1.0;
  double most = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double drawn = draw_sample(assumed, random).friction.roller_drag_ratio.value();
    least = std::min(least, drawn);
    most = std::max(most, drawn);
  }
  EXPECT_GE(least, drag.low);
  EXPECT_LE(most, drag.high);
  EXPECT_GT(most - least, 0.8 * (drag.high - drag.low));
}

}  // namespace
}  // namespace heatsoak::robot
