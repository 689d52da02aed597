// Current of the stop after the radio link is lost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::Input;
using robot_core::Mode;
using robot_core::Output;
using robot_core::State;

/// Noise of 0.3 rad/s and one period of the contact's largest force.
double margin_A(const Config& config) {
  return static_cast<double>(config.derived.geared_constant_V_s_per_rad) * (Plant(config, {}).contact_change_rad_per_s() + 0.3) /
         static_cast<double>(config.lowest_resistance_ohm);
}

/// Largest current in a stop from 2 m/s above the guard's limit without braking reserve.
struct Stop {
  double peak_A = 0.0;
  double over_guard_A = -1e9;
};
Stop stop_from_2_m_per_s(float body_C, float age_s) {
  const Config config = make_config(4);
  Plant plant(config, {});
  plant.warm_up(static_cast<double>(body_C));
  plant.set_velocity(2.0, 0.0, 0.0);
  State state;
  Random random(11);
  EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = body_C}));
  Stop stop;
  for (int k = 0; k < 400; ++k) {
    Input input = plant.sense(random, 0.3F, true);
    input.command.mode = Mode::body_velocity;
    input.command.velocity = {k < 50 ? 2.0F : 0.0F, 0.0F, 0.0F};
    input.command_age_s = k < 50 ? 0.0F : age_s;
    const Output out = robot_core::step(config, state, input);
    for (int i = 0; i < config.wheel_count && k >= 50; ++i) {
      const double current_A = std::abs(plant.coldest_current_A(out, i));
      stop.peak_A = std::max(stop.peak_A, current_A);
      stop.over_guard_A = std::max(stop.over_guard_A, current_A - static_cast<double>(state.wheel[i].allowed_A));
    }
    plant.move(out);
  }
  return stop;
}

// The stop was not commanded: it is gentler than a commanded one and leaves the guard's reserve unused.
TEST(StaleCommand, BrakesWithNoMoreThanTheGuardAllows) {
  const Stop commanded = stop_from_2_m_per_s(25.0F, 0.0F);
  const Stop stale = stop_from_2_m_per_s(25.0F, 1.0F);
  std::printf("stop from 2 m/s: commanded %.2f A, stale command %.2f A\n", commanded.peak_A, stale.peak_A);
  EXPECT_LT(stale.peak_A, commanded.peak_A);
  for (const float body_C : {140.0F, 150.0F, 154.0F}) {
    const Stop hot = stop_from_2_m_per_s(body_C, 1.0F);
    std::printf("%.0f C: stale command %.2f A, %.2f A beyond the guard\n", static_cast<double>(body_C), hot.peak_A, hot.over_guard_A);
    EXPECT_LE(hot.over_guard_A, margin_A(make_config(4)));
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
