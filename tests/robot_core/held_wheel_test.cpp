// A wheel that its sensed current holds back: from the next period on all wheels are scaled together, and the reason names the cause.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::Input;
using robot_core::Output;
using robot_core::Reason;
using robot_core::State;

constexpr std::size_t kHeld = 1;

/// Robot in the middle of its acceleration from rest, 20 degrees to the left of straight ahead.
struct Accelerating {
  Config config = make_config(4);
  Plant plant{config, {}};
  State state;
  Input input;

  Accelerating() {
    Random random(4);
    robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F});
    constexpr int kPeriods = 120;
    for (int k = 0; k <= kPeriods; ++k) {
      input = plant.sense(random, 0.0F, true);
      input.command.mode = robot_core::Mode::body_velocity;
      input.command.velocity = {2.8F, 1.0F, 0.0F};
      if (k < kPeriods) {
        plant.move(robot_core::step(config, state, input));
      }
    }
  }

  /// Currents that one step gives to the coldest motors, with another sample of the held wheel's current.
  std::array<double, 4> currents_A(State& now, float sensed_A, Output& out) const {
    Input sensed = input;
    sensed.motor_current_A[kHeld] = sensed_A;
    out = robot_core::step(config, now, sensed);
    std::array<double, 4> result{};
    for (int i = 0; i < 4; ++i) {
      result.at(static_cast<std::size_t>(i)) = plant.coldest_current_A(out, i);
    }
    return result;
  }
};

TEST(HeldWheel, SensedCurrentIsNamedAndScalesAllWheels) {
  const Accelerating robot;
  const float true_A = robot.input.motor_current_A[kHeld];
  State usual_state = robot.state;
  State held_state = robot.state;
  Output usual;
  Output held;
  const std::array<double, 4> first_A = robot.currents_A(usual_state, true_A, usual);
  ASSERT_GT(std::abs(first_A[kHeld]), 1.0);
  EXPECT_TRUE(std::ranges::none_of(usual.reason, [](Reason reason) { return reason == Reason::sensed_current; }));
  EXPECT_GT(usual_state.kept_share, 0.98F);
  // More than the limit and its noise, less than an overcurrent.
  const float high_A = std::copysign(1.2F * robot.config.wheel[kHeld].body_limit_A, true_A);
  const std::array<double, 4> held_A = robot.currents_A(held_state, high_A, held);
  EXPECT_EQ(held.reason[kHeld], Reason::sensed_current);
  EXPECT_TRUE(std::ranges::none_of(held.is_open, [](bool is_open) { return is_open; }));
  const double kept = held_A[kHeld] / first_A[kHeld];
  EXPECT_GT(kept, 0.3);
  EXPECT_LT(kept, 0.95);
  EXPECT_NEAR(held_state.kept_share, kept, 0.02);
  // In the next period, with a true sample again, all wheels keep this fraction, so the force keeps its direction.
  const std::array<double, 4> usual_A = robot.currents_A(usual_state, true_A, usual);
  const std::array<double, 4> scaled_A = robot.currents_A(held_state, true_A, held);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(scaled_A.at(i), kept * usual_A.at(i), 0.05 * std::abs(usual_A[kHeld])) << i;
    EXPECT_NE(held.reason[i], Reason::none) << i;
  }
}

// Without a voltage that current sensor and speeds allow, only this bridge opens: the other wheels drive the robot home.
TEST(HeldWheel, OvercurrentOpensItsOwnBridgeOnly) {
  const Accelerating robot;
  Output usual;
  Output open;
  State usual_state = robot.state;
  State open_state = robot.state;
  const std::array<double, 4> usual_A = robot.currents_A(usual_state, robot.input.motor_current_A[kHeld], usual);
  const float sensed_A = std::copysign(1.6F * robot.config.wheel[kHeld].body_limit_A, static_cast<float>(usual_A[kHeld]));
  const std::array<double, 4> open_A = robot.currents_A(open_state, sensed_A, open);
  EXPECT_TRUE(open.is_open[kHeld]);
  EXPECT_EQ(open.reason[kHeld], Reason::sensed_current);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(i == kHeld || std::abs(open_A.at(i) - usual_A.at(i)) < 0.02 * std::abs(usual_A[kHeld])) << i;
  }
}

/// One step from rest with commands for single wheels.
Output first_step(robot_core::Mode mode, const std::array<float, 4>& wanted) {
  const Config config = make_config(4);
  State state;
  robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F});
  Random random(1);
  Input input = Plant(config, {}).sense(random, 0.0F, true);
  input.command.mode = mode;
  std::ranges::copy(wanted, input.command.wheel_speed_rad_per_s);
  std::ranges::copy(wanted, input.command.wheel_torque_Nm);
  return robot_core::step(config, state, input);
}

// These modes command no direction of travel that a common factor could keep.
TEST(LimitedWheel, LeavesTheOthersAsTheyAreWhereEachHasItsOwnCommand) {
  struct Case {
    robot_core::Mode mode;
    float much, little;
  };
  for (const auto& [mode, much, little] :
       {Case{robot_core::Mode::wheel_torque, 2.0F, 0.04F}, Case{robot_core::Mode::wheel_speed, 150.0F, 3.0F}}) {
    for (std::size_t limited = 0; limited < 4; ++limited) {
      std::array<float, 4> wanted{little, -little, 0.5F * little, little};
      const Output alone = first_step(mode, wanted);
      wanted.at(limited) = much;
      const Output out = first_step(mode, wanted);
      EXPECT_EQ(out.reason[limited], Reason::driver_current);
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(alone.reason[i], Reason::none);
        EXPECT_TRUE(i == limited || (out.reason[i] == Reason::none && out.voltage_V[i] == alone.voltage_V[i])) << limited << ' ' << i;
      }
    }
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
