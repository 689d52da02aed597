// Control steps that take longer than a period: the guards share the work of the steps and count all heat.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::State;

struct Guards {
  double winding_C = 0.0;          ///< lowest temperature of the observers
  std::uint32_t most_at_once = 0;  ///< guard steps within one control step
  int most_waiting = 0;            ///< periods that a guard has not counted
};

/// Sensed currents of 6 A for 20 s. Each step takes `least` to `most` periods.
Guards run(int least, int most) {
  constexpr double kDuration_s = 20.0;
  const Config config = make_config(4);
  const Plant plant(config, {});
  Random random(5);
  State state;
  robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F});
  Guards guards;
  const auto steps = [&] {
    std::uint32_t sum = 0;
    for (const robot_core::GuardState& guard : state.guard) {
      sum += guard.steps;
    }
    return sum;
  };
  for (double time_s = 0.0; time_s < kDuration_s;) {
    robot_core::Input input = plant.sense(random, 0.3F, true);
    for (float& current_A : input.motor_current_A) {
      current_A = 6.0F;
    }
    input.elapsed_s = config.period_s * static_cast<float>(least + random.below(most - least + 1));
    time_s += static_cast<double>(input.elapsed_s);
    const std::uint32_t before = steps();
    robot_core::step(config, state, input);
    guards.most_at_once = std::max(guards.most_at_once, steps() - before);
    for (const robot_core::WheelState& wheel : state.wheel) {
      guards.most_waiting = std::max<int>(guards.most_waiting, wheel.guard_steps);
    }
  }
  guards.winding_C = 1000.0;
  for (const robot_core::GuardState& guard : state.guard) {
    guards.winding_C = std::min(guards.winding_C, static_cast<double>(guard.state_C[0]));
  }
  return guards;
}

TEST(LateSteps, GuardsCountAllHeatInTurns) {
  const Guards usual = run(1, 1);
  EXPECT_EQ(usual.most_at_once, 1U);
  EXPECT_GT(usual.winding_C, 60.0);
  for (const auto& [least, most] : {std::pair{1, 2}, std::pair{1, 3}, std::pair{2, 2}, std::pair{3, 3}}) {
    const Guards late = run(least, most);
    EXPECT_EQ(late.most_at_once, 1U) << least << " to " << most;
    EXPECT_LE(late.most_waiting, 24) << least << " to " << most;
    // 6 A heat the observer by less than 10 K/s, and up to 24 ms of it may not be counted yet.
    EXPECT_GT(late.winding_C, usual.winding_C - 0.24) << least << " to " << most;
    EXPECT_LT(late.winding_C, usual.winding_C + 3.0) << least << " to " << most;
  }
}

// Steps of unequal length count as whole periods for heat. A guard that cools must not take them for more time than has passed.
TEST(LateSteps, UnevenStepsCoolNoFaster) {
  const auto rested_C = [](float periods) {
    const Config config = make_config(4);
    const Plant plant(config, {});
    Random random(5);
    State state;
    robot_core::start(config, state, {.is_rested = true, .body_C = 120.0F});
    for (double time_s = 0.0; time_s < 20.0;) {
      robot_core::Input input = plant.sense(random, 0.3F, true);
      input.elapsed_s = periods * config.period_s;
      time_s += static_cast<double>(input.elapsed_s);
      robot_core::step(config, state, input);
    }
    return state.guard[0].state_C[0];
  };
  const float usual_C = rested_C(1.0F);
  EXPECT_LT(usual_C, 118.0F);
  for (const float periods : {0.5F, 0.7F, 0.95F, 1.05F, 1.12F, 1.5F, 2.0F, 2.6F}) {
    // Up to a tenth of a period is jitter and counts as a whole one.
    const float jitter_share = periods > 0.9F && periods < 1.0F ? 1.3F * (1.0F / periods - 1.0F) : 0.0F;
    EXPECT_GE(rested_C(periods), usual_C - 0.05F - jitter_share * (120.0F - usual_C)) << periods;
    EXPECT_LE(rested_C(periods), 120.0F) << periods;
  }
}

// A wrong sample of a temperature is one step; a hotter motor or air is followed within seconds.
TEST(LateSteps, AWrongTemperatureSampleHardlyCounts) {
  const Config config = make_config(4);
  const Plant plant(config, {});
  Random random(5);
  State state;
  robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F});
  robot_core::Output out;
  const auto run = [&](int steps, float stator_C, float ambient_C) {
    for (int k = 0; k < steps; ++k) {
      robot_core::Input input = plant.sense(random, 0.3F, true);
      std::fill_n(input.stator_C, robot_core::kMostWheels, stator_C);
      input.ambient_C = ambient_C;
      out = robot_core::step(config, state, input);
    }
  };
  run(2000, 25.0F, 25.0F);
  const float usual_A = out.allowed_current_A[0];
  run(1, 390.0F, 119.0F);
  run(50, 25.0F, 25.0F);
  EXPECT_GE(out.allowed_current_A[0], 0.97F * usual_A);
  EXPECT_LE(state.ambient_C, 25.1F);
  // A plausible but wrong sensor of two seconds must not stop a cold robot for minutes.
  run(2000, 390.0F, 25.0F);
  run(50, 25.0F, 25.0F);
  EXPECT_GE(out.allowed_current_A[0], config.limp_current_A);
  run(12'000, 120.0F, 60.0F);
  EXPECT_GE(state.guard[0].state_C[1], 119.0F);
  EXPECT_NEAR(state.ambient_C, 60.0F, 0.1F);
}

}  // namespace
}  // namespace heatsoak::test_robot
