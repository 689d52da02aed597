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

}  // namespace
}  // namespace heatsoak::test_robot
