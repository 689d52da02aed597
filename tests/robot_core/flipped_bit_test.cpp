// Flips every single bit of State in the middle of a drive with faulty sensors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::Input;
using robot_core::is_fault;
using robot_core::Mode;
using robot_core::Output;
using robot_core::Reason;
using robot_core::State;

/// Flips one bit of State, which is an array of bytes for this test.
void flip(State& state, std::size_t byte, unsigned bit) {
  auto* const bytes = reinterpret_cast<unsigned char*>(&state);
  bytes[byte] = static_cast<unsigned char>(bytes[byte] ^ (1U << bit));
}

// Whichever bit flips, no NaN reaches the output, and in the next periods no sensor is accepted that was rejected before.
TEST(FlippedBit, OfAnyByteHidesNoFault) {
  const Config config = make_config(4);
  Random random(9);
  Plant plant(config, {});
  State state;
  ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
  const auto sample = [&] {
    Input input = plant.sense(random, 0.3F, true);
    std::swap(input.wheel_speed_rad_per_s[1], input.wheel_speed_rad_per_s[3]);
    input.wheel_speed_rad_per_s[0] = kNone;
    input.yaw_rate_rad_per_s = kNone;
    input.command.mode = Mode::body_velocity;
    input.command.velocity = {1.0F, 0.5F, 0.0F};
    return input;
  };
  for (int k = 0; k < 3; ++k) {
    robot_core::step(config, state, sample());
  }
  for (const int wheel : {1, 3}) {
    state.wheel[wheel].speed_fault = static_cast<std::uint8_t>(Reason::wheel_speed_swapped);
  }
  seal(state);
  for (int k = 0; k < 40; ++k) {
    plant.move(robot_core::step(config, state, sample()));
  }
  int found = 0;
  for (std::size_t byte = 0; byte < sizeof(State); ++byte) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      State damaged = state;
      flip(damaged, byte, bit);
      for (int k = 0; k < 12; ++k) {
        const Output out = robot_core::step(config, damaged, sample());
        found += out.robot_reason == Reason::state_corrupted ? 1 : 0;
        for (int i = 0; i < 4; ++i) {
          ASSERT_TRUE(std::isfinite(out.winding_C[i]) && std::isfinite(out.voltage_V[i])) << "byte " << byte << " bit " << bit;
        }
        ASSERT_TRUE(std::isfinite(out.time_to_guard_limit_s)) << "byte " << byte << " bit " << bit;
        ASSERT_GE(out.time_to_guard_limit_s, 0.0F) << "byte " << byte << " bit " << bit;
        ASSERT_TRUE(is_fault(out.reason[0])) << "byte " << byte << " bit " << bit << " period " << k;
        ASSERT_EQ(damaged.wheel[1].speed_fault, static_cast<std::uint8_t>(Reason::wheel_speed_swapped))
            << "byte " << byte << " bit " << bit;
        ASSERT_EQ(damaged.wheel[3].speed_fault, static_cast<std::uint8_t>(Reason::wheel_speed_swapped))
            << "byte " << byte << " bit " << bit;
        ASSERT_NE(damaged.yaw_fault, 0) << "byte " << byte << " bit " << bit;
      }
    }
  }
  EXPECT_GT(found, 1000);
}

// Without a guard nothing holds the robot back after the restart, so its references must not start at standstill.
TEST(FlippedBit, DoesNotBrakeARobotWithoutGuard) {
  const Config config = make_config(4, false);
  Plant plant(config, {});
  State state;
  Random random(4);
  ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
  double cruise_A = 0.0;
  double after_A = 0.0;
  for (int k = 0; k < 3000; ++k) {
    Input input = plant.sense(random, 0.3F, true);
    input.command.mode = Mode::body_velocity;
    input.command.velocity = {1.5F, 0.0F, 0.0F};
    if (k == 2500) {
      state.wheel[1].integral_V += 1.0F;
    }
    const Output out = robot_core::step(config, state, input);
    for (int i = 0; i < 4; ++i) {
      double& largest_A = k >= 2500 ? after_A : cruise_A;
      largest_A = k >= 2000 ? std::max(largest_A, std::abs(plant.coldest_current_A(out, i))) : 0.0;
    }
    plant.move(out);
  }
  EXPECT_LT(after_A, 2.0 * cruise_A);
}

}  // namespace
}  // namespace heatsoak::test_robot
