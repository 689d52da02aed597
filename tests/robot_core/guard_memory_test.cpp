// Restores the guards of the drive core after a loss of power.
#include "robot_core/guard_memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "robot_core/drive_stages.h"
#include "test_robot.h"

namespace heatsoak {
namespace {

using namespace robot_core;
using test_robot::make_config;

constexpr float kUnknown_s = std::numeric_limits<float>::quiet_NaN();

/// Returns a guard that has carried a current for a while.
GuardState worked(const GuardModel& model, int steps, float current_A = 4.0F) {
  GuardState guard;
  start_guard(model, guard, 30.0F);
  float signal[kGuardSignals] = {};
  signal[guard_current_A] = current_A;
  signal[guard_ambient_C] = 30.0F;
  for (int i = 0; i < steps; ++i) {
    step_guard(model, guard, signal, 0.0F);
  }
  return guard;
}

TEST(GuardMemory, WithoutTimeItIsWhatWasSaved) {
  const Config config = make_config(4);
  const GuardState saved = worked(*config.guard, 3000);
  GuardState found;
  EXPECT_EQ(restore_guard(*config.guard, found, saved, 0.0F, 20.0F), Restored::cooled);
  for (int node = 0; node < config.guard->node_count; ++node) {
    EXPECT_EQ(found.state_C[node], saved.state_C[node]);
  }
}

// Reference: the guard itself, stepped without current for the same time.
TEST(GuardMemory, CoolsAsTheGuardDoesAndNoFaster) {
  const Config config = make_config(4);
  const GuardModel& model = *config.guard;
  const GuardState saved = worked(model, 3000);
  for (const float elapsed_s : {0.3F, 2.0F, 20.0F, 100.0F, 400.0F}) {
    GuardState stepped = saved;
    float signal[kGuardSignals] = {};
    signal[guard_ambient_C] = model.hottest_ambient_C;
    for (int i = 0; i < static_cast<int>(std::lround(elapsed_s / model.period_s)); ++i) {
      step_guard(model, stepped, signal, 0.0F);
    }
    GuardState found;
    restore_guard(model, found, saved, elapsed_s, 20.0F);
    for (int node = 0; node < model.node_count; ++node) {
      EXPECT_GE(found.state_C[node], stepped.state_C[node] - 0.02F) << elapsed_s << " " << node;
      EXPECT_LE(found.state_C[node], stepped.state_C[node] + 2.0F) << elapsed_s << " " << node;
    }
  }
}

TEST(GuardMemory, UnknownTimeIsAsHotAsAnyTime) {
  const Config config = make_config(4);
  const GuardState saved = worked(*config.guard, 600);
  GuardState unknown;
  EXPECT_EQ(restore_guard(*config.guard, unknown, saved, kUnknown_s, 20.0F), Restored::time_unknown);
  for (const float elapsed_s : {0.0F, 1.0F, 5.0F, 20.0F, 60.0F, 300.0F}) {
    GuardState known;
    restore_guard(*config.guard, known, saved, elapsed_s, 20.0F);
    for (int node = 0; node < config.guard->node_count; ++node) {
      EXPECT_GE(unknown.state_C[node], known.state_C[node] - 0.05F) << elapsed_s << " " << node;
    }
  }
}

// Clocks that divide by zero or overflow. The longest known time is just below.
TEST(GuardMemory, ATimeThatIsNotFiniteIsUnknown) {
  const Config config = make_config(4);
  const GuardState saved = worked(*config.guard, 600);
  GuardState unknown;
  restore_guard(*config.guard, unknown, saved, kUnknown_s, 20.0F);
  constexpr float kInfinite_s = std::numeric_limits<float>::infinity();
  for (const float elapsed_s : {kInfinite_s, -kInfinite_s, std::numeric_limits<float>::max(), 1e9F, -1.0F}) {
    GuardState found;
    EXPECT_EQ(restore_guard(*config.guard, found, saved, elapsed_s, 20.0F), Restored::time_unknown) << elapsed_s;
    for (int node = 0; node < config.guard->node_count; ++node) {
      EXPECT_EQ(found.state_C[node], unknown.state_C[node]) << elapsed_s << " " << node;
    }
  }
  GuardState rested;
  EXPECT_EQ(restore_guard(*config.guard, rested, saved, 9.9e8F, 20.0F), Restored::cooled);
  EXPECT_LT(rested.state_C[0], unknown.state_C[0]);
}

TEST(GuardMemory, AFlippedBitCountsAsAtTheLimit) {
  const Config config = make_config(4);
  const GuardState saved = worked(*config.guard, 1000);
  for (std::size_t bit = 0; bit < 8 * sizeof(GuardState); ++bit) {
    GuardState broken = saved;
    reinterpret_cast<unsigned char*>(&broken)[bit / 8] ^= static_cast<unsigned char>(1U << (bit % 8));
    GuardState found;
    ASSERT_EQ(restore_guard(*config.guard, found, broken, 1.0F, 20.0F), Restored::nothing) << bit;
    EXPECT_EQ(found.state_C[0], config.guard->winding_limit_C);
  }
}

/// Returns a State whose guards have carried a current for a while.
State worked_state(const Config& config, int steps, float current_A) {
  State saved;
  EXPECT_TRUE(start(config, saved, {}));
  for (GuardState& each : saved.guard) {
    each = worked(*config.guard, steps, current_A);
  }
  return saved;
}

Input standing(const Config& config) {
  Input input;
  input.elapsed_s = config.period_s;
  input.battery_V = config.battery_full_V;
  return input;
}

/// A State that has seen currents, stator temperatures and air of 30 degC.
State with_all_sensors(const Config& config) {
  State state;
  EXPECT_TRUE(start(config, state, {.is_rested = true, .body_C = 30.0F}));
  Input input = standing(config);
  input.ambient_C = 30.0F;
  for (int i = 0; i < kMostWheels; ++i) {
    input.motor_current_A[i] = 0.0F;
    input.stator_C[i] = 30.0F;
  }
  for (int k = 0; k < 40; ++k) {
    EXPECT_EQ(step(config, state, input).robot_reason, Reason::none);
  }
  return state;
}

TEST(GuardMemory, TheDriveCoreGoesOnFromIt) {
  const Config config = make_config(4);
  State state;
  ASSERT_TRUE(start(config, state, {}));
  EXPECT_TRUE(restore(config, state, worked_state(config, 500, 2.0F), 2.0F, 25.0F));
  const Output out = step(config, state, standing(config));
  EXPECT_NE(out.robot_reason, Reason::state_corrupted);
  EXPECT_GT(out.allowed_current_A[0], 0.0F);
  EXPECT_LT(out.winding_C[0], config.guard->winding_limit_C - 10.0F);
}

TEST(GuardMemory, AWheelWithoutACopyStaysAtItsLimit) {
  const Config config = make_config(4);
  State state;
  ASSERT_TRUE(start(config, state, {}));
  State saved = worked_state(config, 500, 2.0F);
  saved.guard[1] = {};
  EXPECT_FALSE(restore(config, state, saved, 2.0F, 25.0F));
  EXPECT_LT(state.guard[0].state_C[0], config.guard->winding_limit_C);
  EXPECT_EQ(state.guard[1].state_C[0], config.guard->winding_limit_C);
}

// The mark contains the places of the members that restore() reads. Firmware with another layout writes another one.
TEST(GuardMemory, ACopyFromFirmwareWithAnotherLayoutIsRefused) {
  const Config config = make_config(4);
  for (const unsigned bits : {1U, 0x80000000U, 0x4452564EU, ~0U}) {
    State saved = with_all_sensors(config);
    saved.is_valid ^= bits;
    saved.check_sum = check_sum_of(saved);
    State state;
    ASSERT_TRUE(start(config, state, {.is_rested = true, .body_C = 30.0F}));
    EXPECT_FALSE(restore(config, state, saved, 1.0F, 25.0F));
    for (const GuardState& guard : state.guard) {
      EXPECT_EQ(guard.state_C[0], config.guard->winding_limit_C);
    }
    EXPECT_EQ(state.wheel[2].has_current, 0);
    const Output out = step(config, state, standing(config));
    EXPECT_EQ(out.allowed_current_A[0], 0.0F);
    EXPECT_EQ(out.reason[0], Reason::guard_unknown);
  }
}

// A guard whose data lack them would restore too cold.
TEST(GuardMemory, AGuardNeedsRestingTemperatures) {
  const Config whole = make_config(4);
  for (int node = 0; node < whole.guard->node_count; ++node) {
    GuardModel model = *whole.guard;
    model.resting_C[node] = 0.0F;
    Config config = whole;
    config.guard = &model;
    State state;
    EXPECT_FALSE(start(config, state, {})) << node;
  }
}

// Guards need some steps between two restarts.
TEST(GuardMemory, AGuardThatCouldNotCountForTwoPeriodsStartsAtItsLimit) {
  const Config config = make_config(4);
  const int most_periods = static_cast<int>(std::lround(2.0F * config.guard->period_s / config.period_s));
  for (const int more : {0, 1}) {
    State saved = with_all_sensors(config);
    saved.wheel[1].guard_clock = static_cast<std::uint16_t>(saved.guard_clock - most_periods - more);
    saved.check_sum = check_sum_of(saved);
    State state;
    ASSERT_TRUE(start(config, state, {}));
    EXPECT_EQ(restore(config, state, saved, 1.0F, 25.0F), more == 0);
    EXPECT_EQ(state.guard[1].state_C[0] == config.guard->winding_limit_C, more == 1);
  }
}

// An invalid State must stay invalid.
TEST(GuardMemory, HealsNoCorruptState) {
  const Config config = make_config(4);
  State state;
  ASSERT_TRUE(start(config, state, {}));
  state.yaw_integral_rad = 3.0F;
  restore(config, state, worked_state(config, 100, 4.0F), 2.0F, 25.0F);
  EXPECT_EQ(step(config, state, standing(config)).robot_reason, Reason::state_corrupted);
}

/// Runs without these sensors and expects faults 150 of the robot, and 120 or else 151 of a wheel.
void expect_missing(const Config& config, State state, bool are_currents_missing) {
  Input input = standing(config);
  for (float& current_A : input.motor_current_A) {
    current_A = are_currents_missing ? kNoSample : 0.0F;
  }
  Output out;
  for (int k = 0; k < 40; ++k) {
    out = step(config, state, input);
  }
  EXPECT_EQ(out.robot_reason, Reason::ambient_missing);
  EXPECT_EQ(out.reason[2], are_currents_missing ? Reason::current_missing : Reason::stator_missing);
}

// A sensor that had samples before the restart is missing afterwards.
TEST(GuardMemory, KeepsTheListOfSensors) {
  const Config config = make_config(4);
  const State saved = with_all_sensors(config);
  for (const bool are_currents_missing : {true, false}) {
    State restored;
    ASSERT_TRUE(start(config, restored, {}));
    restore(config, restored, saved, 1.0F, 25.0F);
    expect_missing(config, saved, are_currents_missing);
    State flipped = saved;
    flipped.yaw_integral_rad = 1.0F;
    Input input = standing(config);
    EXPECT_EQ(step(config, flipped, input).robot_reason, Reason::state_corrupted);
    for (const auto& each : {&restored, &flipped}) {
      EXPECT_EQ(each->wheel[2].has_current, 1);
      EXPECT_EQ(each->wheel[2].has_stator, 1);
      EXPECT_EQ(each->ambient_C, saved.ambient_C);
    }
    if (are_currents_missing) {
      expect_missing(config, flipped, true);
    }
  }
  // Without any sample before, a missing sensor is no fault.
  State empty;
  ASSERT_TRUE(start(config, empty, {}));
  State restored = empty;
  restore(config, restored, empty, 1.0F, 25.0F);
  EXPECT_EQ(step(config, restored, standing(config)).robot_reason, Reason::none);
}

}  // namespace
}  // namespace heatsoak
