// Flips every single bit of State in the middle of a drive with faulty sensors, and pairs of bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include "robot_core/drive_stages.h"
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

// A gap lies outside of the guard's check sum.
TEST(FlippedBit, OfAGapIsStillReportedAfterAnotherGap) {
  const Config config = make_config(4);
  for (unsigned bit = 0; bit < 64; ++bit) {
    robot_core::GuardState guard;
    robot_core::start_guard(*config.guard, guard, 25.0F);
    robot_core::add_gap(guard, 0.02F);
    ASSERT_TRUE(robot_core::is_started(*config.guard, guard));
    EXPECT_FLOAT_EQ(robot_core::gap_s(guard), 0.02F);
    std::uint32_t& word = bit < 32 ? guard.gap_bits : guard.gap_complement;
    word ^= 1U << (bit % 32);
    EXPECT_FALSE(robot_core::is_started(*config.guard, guard)) << bit;
    robot_core::add_gap(guard, 0.02F);
    EXPECT_FALSE(std::isfinite(robot_core::gap_s(guard))) << bit;
  }
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

/// State in the middle of a drive.
State driven_state(const Config& config) {
  Random random(11);
  Plant plant(config, {});
  State state;
  robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F});
  for (int k = 0; k < 210; ++k) {
    Input input = plant.sense(random, 0.3F, true);
    input.command.mode = Mode::body_velocity;
    input.command.velocity = {1.5F, 0.5F, 1.0F};
    plant.move(robot_core::step(config, state, input));
  }
  return state;
}

/// Fraction of all pairs of bits in the first bytes of an object, its check sum included, whose flips leave the check sum valid. No single
/// flip may.
template <typename Object>
double unnoticed_pairs_ratio(const Object& object, std::size_t bytes, void (*seal_object)(Object&)) {
  Object damaged = object;
  auto* const at = reinterpret_cast<unsigned char*>(&damaged);
  const auto flip_bit = [&](std::size_t bit) { at[bit / 8] = static_cast<unsigned char>(at[bit / 8] ^ (1U << (bit % 8))); };
  const auto is_unnoticed = [&] {
    const auto shown = damaged.check_sum;
    seal_object(damaged);
    const bool is_same = damaged.check_sum == shown;
    damaged.check_sum = shown;
    return is_same;
  };
  const std::size_t bits = 8 * bytes;
  long unnoticed = 0;
  for (std::size_t first = 0; first < bits; ++first) {
    flip_bit(first);
    EXPECT_FALSE(is_unnoticed()) << "bit " << first;
    for (std::size_t second = first + 1; second < bits; ++second) {
      flip_bit(second);
      unnoticed += is_unnoticed() ? 1 : 0;
      flip_bit(second);
    }
    flip_bit(first);
  }
  return static_cast<double>(unnoticed) / (0.5 * static_cast<double>(bits) * static_cast<double>(bits - 1));
}

TEST(FlippedBit, OfNearlyAnyPairChangesTheCheckSum) {
  const Config config = make_config(4);
  for (const State& state : {driven_state(config), State{}}) {
    State sealed = state;
    seal(sealed);
    robot_core::seal(sealed.comparison);
    robot_core::seal(sealed.guard[1]);
    // A plain sum of the words misses 5e-3 of them.
    constexpr double kMost_ratio = 1e-4;
    EXPECT_LT(unnoticed_pairs_ratio<State>(sealed, offsetof(State, comparison), seal), kMost_ratio);
    EXPECT_LT(unnoticed_pairs_ratio<robot_core::ComparisonState>(sealed.comparison, sizeof(sealed.comparison), robot_core::seal),
              kMost_ratio);
    EXPECT_LT(unnoticed_pairs_ratio<robot_core::GuardState>(sealed.guard[1], offsetof(robot_core::GuardState, gap_bits), robot_core::seal),
              kMost_ratio);
  }
}

// The same position in two words: flips of opposite direction cancel in a plain sum of the words.
TEST(FlippedBit, OfAPairInOneLaneIsReported) {
  const Config config = make_config(4);
  const State before = driven_state(config);
  Plant plant(config, {});
  Random random(3);
  Input input = plant.sense(random, 0.3F, true);
  constexpr int kWords = offsetof(State, comparison) / 8;
  for (int k = 0; k < 100'000; ++k) {
    const int first = 1 + random.below(kWords - 1);
    const int second = 1 + random.below(kWords - 1);
    const auto bit = static_cast<unsigned>(random.below(64));
    if (first == second) {
      continue;
    }
    State damaged = before;
    flip(damaged, static_cast<std::size_t>(8 * first) + bit / 8, bit % 8);
    flip(damaged, static_cast<std::size_t>(8 * second) + bit / 8, bit % 8);
    ASSERT_EQ(robot_core::step(config, damaged, input).robot_reason, Reason::state_corrupted)
        << "words " << first << " and " << second << ", bit " << bit;
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
