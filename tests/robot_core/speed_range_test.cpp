// Compares the range of speeds that a wheel may have, and the bound that replaces it, with a search over all sets of sensors.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "robot_core/drive_stages.h"
#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::SpeedRange;
using robot_core::State;
using robot_core::Validated;

struct Range {
  double slowest = std::numeric_limits<double>::infinity();
  double fastest = -std::numeric_limits<double>::infinity();

  void add(double speed) {
    slowest = std::min(slowest, speed);
    fastest = std::max(fastest, speed);
  }
};

/// Robot with wheels at random angles.
Config random_config(Random& random, int wheels) {
  Config config = make_config(wheels);
  for (int i = 0; i < wheels; ++i) {
    const auto angle = random.between(0.0F, 2.0F * std::numbers::pi_v<float>);
    config.wheel[i].rolling_x_share = std::cos(angle);
    config.wheel[i].rolling_y_share = std::sin(angle);
    config.wheel[i].slip_factor = random.between(0.9F, 1.1F);
  }
  robot_core::complete(config);
  return config;
}

double x_of(const Config& config, int i) { return static_cast<double>(config.wheel[i].rolling_x_share); }
double y_of(const Config& config, int i) { return static_cast<double>(config.wheel[i].rolling_y_share); }
double sine(const Config& config, int i, int j) { return x_of(config, i) * y_of(config, j) - y_of(config, i) * x_of(config, j); }
double area(const Config& config, int i, int j, int k) { return sine(config, i, j) + sine(config, j, k) + sine(config, k, i); }

/// Reference: one sensor, every two others with the gyro, and three others, one after the other.
Range searched(const Config& config, const State& state, const Validated& validated, int i) {
  constexpr auto kLeast = static_cast<double>(robot_core::kLeastArea_ratio);
  const double turning = static_cast<double>(config.contact_radius_m) * static_cast<double>(validated.velocity.yaw);
  // If too few sensors are accepted, rejected samples count, too.
  const auto speed = [&](int j) {
    return validated.are_samples_compared ? state.wheel[j].raw_speed_rad_per_s : validated.wheel[j].speed_rad_per_s;
  };
  const auto rim = [&](int j) { return static_cast<double>(speed(j)) * static_cast<double>(config.wheel[j].rim_per_speed_m); };
  const auto sensed = [&](int j) { return validated.wheel[j].is_speed_sensed || validated.are_samples_compared; };
  const double per_rim = 1.0 / static_cast<double>(config.wheel[i].rim_per_speed_m);
  Range range;
  if (sensed(i)) {
    range.add(rim(i) * per_rim);
  }
  for (int j = 0; j < config.wheel_count && state.yaw_fault == 0; ++j) {
    for (int k = j + 1; k < config.wheel_count; ++k) {
      if (j != i && k != i && sensed(j) && sensed(k) && std::abs(sine(config, j, k)) >= kLeast) {
        const double sum = sine(config, i, k) * (rim(j) - turning) + sine(config, j, i) * (rim(k) - turning);
        range.add((sum / sine(config, j, k) + turning) * per_rim);
      }
    }
  }
  const int j = (i + 1) % 4, k = (i + 2) % 4, l = (i + 3) % 4;
  if (config.wheel_count == 4 && sensed(j) && sensed(k) && sensed(l) && std::abs(area(config, j, k, l)) >= kLeast) {
    const double sum = area(config, i, k, l) * rim(j) + area(config, j, i, l) * rim(k) + area(config, j, k, i) * rim(l);
    range.add(sum / area(config, j, k, l) * per_rim);
  }
  for (int other = 0; other < config.wheel_count && validated.is_any_possible && range.slowest <= range.fastest; ++other) {
    if (sensed(other)) {
      range.add(rim(other) * per_rim);
    }
  }
  return range;
}

/// Inputs of a step with some sensors missing or wrong.
robot_core::Input random_input(const Config& config, Random& random) {
  robot_core::Input input = Plant(config, {}).sense(random, 0.0F, true);
  const float x = random.between(-2.0F, 2.0F), y = random.between(-2.0F, 2.0F), yaw = random.between(-8.0F, 8.0F);
  for (int i = 0; i < config.wheel_count; ++i) {
    const robot_core::WheelConfig& wheel = config.wheel[i];
    const float rim = wheel.rolling_x_share * x + wheel.rolling_y_share * y + config.contact_radius_m * yaw;
    input.wheel_speed_rad_per_s[i] = random.happens(0.2F)   ? kNone
                                     : random.happens(0.2F) ? random.between(-300.0F, 300.0F)
                                                            : rim * wheel.speed_per_rim_per_m + random.between(-5.0F, 5.0F);
  }
  input.yaw_rate_rad_per_s = random.happens(0.2F) ? kNone : yaw;
  return input;
}

TEST(SpeedRange, IsThatOfASearchOverAllSetsOfSensors) {
  Random random(31);
  int known = 0;
  int bounded = 0;
  for (int run = 0; run < 40000; ++run) {
    const Config config = random_config(random, run % 3 == 0 ? 3 : 4);
    State state;
    ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
    state.comparison.is_checked = random.happens(0.7F) ? 1 : 0;
    robot_core::seal(state.comparison);
    const Validated validated = robot_core::validate_input(config, state, random_input(config, random));
    for (int i = 0; i < config.wheel_count; ++i) {
      const Range reference = searched(config, state, validated, i);
      const SpeedRange found = robot_core::speed_range(config, state, validated, i);
      ASSERT_EQ(found.is_known(), reference.slowest <= reference.fastest);
      if (!found.is_known()) {
        continue;
      }
      ++known;
      const double tolerance = 1e-4 + 1e-5 * std::max(std::abs(reference.slowest), std::abs(reference.fastest));
      ASSERT_NEAR(static_cast<double>(found.slowest_rad_per_s), reference.slowest, tolerance) << run;
      ASSERT_NEAR(static_cast<double>(found.fastest_rad_per_s), reference.fastest, tolerance) << run;
      // A voltage that is accepted by the bound alone must keep the limit for every speed of the range.
      if (std::isfinite(validated.spread_V) && validated.wheel[i].is_speed_known) {
        ++bounded;
        const auto speed = static_cast<double>(validated.wheel[i].speed_rad_per_s);
        const double apart_rad_per_s = std::max(reference.fastest - speed, speed - reference.slowest);
        const auto constant = static_cast<double>(config.derived.geared_constant_V_s_per_rad);
        ASSERT_GE(static_cast<double>(validated.spread_V), constant * (apart_rad_per_s - 10.0 * tolerance)) << run;
      }
    }
  }
  EXPECT_GT(known, 50000);
  EXPECT_GT(bounded, 20000);
}

}  // namespace
}  // namespace heatsoak::test_robot
