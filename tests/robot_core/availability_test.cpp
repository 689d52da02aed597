// Availability: speed of healthy robots while the core does not yet know whether sensors are swapped. Too strict limits would be useless.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

/// Speed of the robot at the end of each leg of 1.5 s, in m/s. The command is forward, left, back, right at 2 m/s while the robot turns.
std::vector<double> speeds_m_per_s(int wheels, bool has_gyro, int legs) {
  constexpr int kLeg = 1500;
  const robot_core::Config config = make_config(wheels);
  Plant plant(config, {});
  robot_core::State state;
  Random random(5);
  EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
  std::vector<double> speeds;
  for (int k = 0; k < legs * kLeg; ++k) {
    robot_core::Input input = plant.sense(random, 0.3F, false);
    if (!has_gyro) {
      input.yaw_rate_rad_per_s = std::numeric_limits<float>::quiet_NaN();
    }
    const int leg = k / kLeg % 4;
    const float along = leg < 2 ? 2.0F : -2.0F;
    input.command.mode = robot_core::Mode::body_velocity;
    input.command.velocity = {leg % 2 == 0 ? along : 0.0F, leg % 2 == 0 ? 0.0F : along, leg % 2 == 0 ? -2.0F : 2.0F};
    plant.move(robot_core::step(config, state, input));
    if (k % kLeg == kLeg - 1) {
      speeds.push_back(std::hypot(plant.x_m_per_s(), plant.y_m_per_s()));
    }
  }
  return speeds;
}

/// Speed of the slowest leg from `first` on.
double slowest_m_per_s(const std::vector<double>& speeds, std::ptrdiff_t first = 0) {
  return *std::min_element(speeds.begin() + first, speeds.end());
}

TEST(Availability, FourWheelsDriveAtFullSpeedFromTheStart) {
  const std::vector<double> speeds = speeds_m_per_s(4, true, 12);
  // The first four legs cover all turns. When swapped sensors are ruled out later, the same legs are no faster.
  for (std::size_t leg = 0; leg < 4; ++leg) {
    EXPECT_GT(speeds[leg], 0.95 * speeds[leg + 8]) << leg;
  }
  EXPECT_GT(slowest_m_per_s(speeds), 1.2);
}

TEST(Availability, ThreeWheelsDriveSlowerUntilSwappedSensorsAreRuledOut) {
  const std::vector<double> speeds = speeds_m_per_s(3, true, 12);
  EXPECT_GT(slowest_m_per_s(speeds), 1.0);
  EXPECT_GT(slowest_m_per_s(speeds, 5), 1.2);
}

TEST(Availability, FourWheelsWithoutGyroStillPlay) { EXPECT_GT(slowest_m_per_s(speeds_m_per_s(4, false, 8)), 1.0); }

// Without a spare sensor the limp current applies, which is enough to drive home.
TEST(Availability, ThreeWheelsWithoutGyroDriveHome) { EXPECT_GT(slowest_m_per_s(speeds_m_per_s(3, false, 8)), 0.2); }

}  // namespace
}  // namespace heatsoak::test_robot
