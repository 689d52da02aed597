// Current after the radio link is lost.
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

/// Largest currents of a robot that drives at 2 m/s, loses its commands for half a second, and gets them again.
struct Loss {
  double before_A = 0.0;
  double during_A = 0.0;
  double after_A = 0.0;
  double rolled_to_m_per_s = 0.0;
};

Loss lose_commands(Mode mode, float body_C) {
  const Config config = make_config(4);
  Plant plant(config, {});
  plant.warm_up(static_cast<double>(body_C));
  State state;
  Random random(11);
  EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = body_C}));
  Loss loss;
  for (int k = 0; k < 3000; ++k) {
    const bool is_lost = k >= 2000 && k < 2500;
    Input input = plant.sense(random, 0.3F, true);
    input.command.mode = mode;
    input.command.velocity = {2.0F, 0.0F, 0.0F};
    std::fill_n(input.command.wheel_speed_rad_per_s, 4, 40.0F);
    std::fill_n(input.command.wheel_torque_Nm, 4, 0.02F);
    input.command_age_s = is_lost ? 1.0F : 0.0F;
    const Output out = robot_core::step(config, state, input);
    for (int i = 0; i < config.wheel_count; ++i) {
      double& most_A = is_lost ? loss.during_A : k < 2000 ? loss.before_A : loss.after_A;
      most_A = std::max(most_A, std::abs(plant.coldest_current_A(out, i)));
    }
    plant.move(out);
    loss.rolled_to_m_per_s = k == 2499 ? std::hypot(plant.x_m_per_s(), plant.y_m_per_s()) : loss.rolled_to_m_per_s;
  }
  return loss;
}

// Braking takes more current than rolling, so a stale command opens the bridges.
TEST(StaleCommand, TakesNoCurrent) {
  for (const Mode mode : {Mode::body_velocity, Mode::wheel_speed, Mode::wheel_torque}) {
    for (const float body_C : {25.0F, 150.0F}) {
      const Loss loss = lose_commands(mode, body_C);
      std::printf("mode %d, %.0f C: %.2f A, without commands %.2f A, rolled to %.2f m/s, again with commands %.2f A\n",
                  static_cast<int>(mode), static_cast<double>(body_C), loss.before_A, loss.during_A, loss.rolled_to_m_per_s, loss.after_A);
      EXPECT_EQ(loss.during_A, 0.0);
      // The robot goes on from its present speed.
      EXPECT_LE(loss.after_A, loss.before_A + margin_A(make_config(4)));
    }
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
