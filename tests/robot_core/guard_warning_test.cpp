// The warning before the thermal guard limits, and the counters of shadow mode, on a robot that is held while it pushes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::Input;
using robot_core::Output;
using robot_core::Reason;
using robot_core::State;

/// Torque commands in pulses to wheels that cannot turn.
struct Pulses {
  float current_A = 0.0F;
  float period_s = 1.0F;
  float on_share = 1.0F;  ///< fraction of the period with current
};

struct Found {
  long limited_steps = 0;
  long silent_steps = 0;        ///< steps in which the guard limits while the output says that it does not, or later
  double first_warning_s = -1;  ///< negative: none
  double first_limit_s = -1;
};

class HeldRobot {
 public:
  explicit HeldRobot(const Config& config) : config_(config), plant_(config, {}) {
    robot_core::start(config_, state, {.is_rested = true, .body_C = 25.0F});
  }

  Output push(const Pulses& pulses) {
    Input input = plant_.sense(random_, kNoise_rad_per_s, true);
    const bool is_on = std::fmod(static_cast<float>(time_s()), pulses.period_s) < pulses.on_share * pulses.period_s;
    input.command.mode = robot_core::Mode::wheel_torque;
    std::ranges::fill(input.command.wheel_torque_Nm, is_on ? pulses.current_A * config_.derived.geared_constant_V_s_per_rad : 0.0F);
    input.elapsed_s = elapsed_s > 0.0F ? elapsed_s : config_.period_s;
    const Output out = robot_core::step(config_, state, input);
    plant_.move(out);
    plant_.set_velocity(0.0, 0.0, 0.0);
    ++steps_;
    return out;
  }

  Found push_for(const Pulses& pulses, double duration_s) {
    Found found;
    while (time_s() < duration_s) {
      const double now_s = time_s();
      const Output out = push(pulses);
      const bool is_limited = std::ranges::find(out.reason, Reason::guard) != std::end(out.reason);
      found.limited_steps += is_limited ? 1 : 0;
      found.silent_steps += is_limited && (out.time_to_guard_limit_s > 0.0F || !out.is_warning) ? 1 : 0;
      found.first_warning_s = found.first_warning_s < 0.0 && out.is_warning ? now_s : found.first_warning_s;
      found.first_limit_s = found.first_limit_s < 0.0 && is_limited ? now_s : found.first_limit_s;
    }
    return found;
  }

  State state;
  float elapsed_s = kNone;  ///< time that the timer reports; NaN: the period

 private:
  [[nodiscard]] double time_s() const { return static_cast<double>(steps_) * static_cast<double>(config_.period_s); }

  const Config& config_;
  Plant plant_;
  Random random_{5};
  long steps_ = 0;
};

// The guard may limit at the beginning of a pulse, when the mean load is far below its limit.
TEST(GuardWarning, IsShownInEveryStepThatTheGuardLimits) {
  const Config config = make_config(4);
  Random random(11);
  long limited_steps = 0;
  for (int k = 0; k < 12; ++k) {
    const Pulses pulses{random.between(4.0F, 14.0F), random.between(0.3F, 12.0F), random.between(0.2F, 1.0F)};
    HeldRobot robot(config);
    const Found found = robot.push_for(pulses, 60.0);
    limited_steps += found.limited_steps;
    EXPECT_EQ(found.silent_steps, 0) << pulses.current_A << " A, " << pulses.period_s << " s, " << pulses.on_share;
  }
  EXPECT_GT(limited_steps, 0);
}

// Pulses that a cold motor bears and a warm one does not.
TEST(GuardWarning, PrecedesTheFirstLimitUnderAPulsedLoad) {
  const Config config = make_config(4);
  for (const Pulses& pulses : {Pulses{13.5F, 2.2F, 0.4F}, Pulses{11.0F, 9.5F, 0.34F}, Pulses{14.0F, 1.0F, 0.3F}}) {
    HeldRobot robot(config);
    const Found found = robot.push_for(pulses, 100.0);
    ASSERT_GT(found.first_limit_s, 5.0) << pulses.current_A;
    EXPECT_GE(found.first_warning_s, 0.0);
    EXPECT_LT(found.first_warning_s, found.first_limit_s - 1.0);
  }
}

// A timer may report any gap.
TEST(ShadowMode, CountsAStepAfterAGapOfAnyLengthAsOnePeriod) {
  Config config = make_config(4);
  config.shadow_mode = true;
  robot_core::complete(config);
  HeldRobot robot(config);
  robot_core::start(config, robot.state, {.is_rested = true, .body_C = 154.0F});
  const Pulses pulses{6.0F, 1.0F, 1.0F};
  robot.push_for(pulses, 0.1);
  const float before_A_s = robot.state.shadow_deficit_A_s;
  ASSERT_GT(before_A_s, 0.0F);
  robot.elapsed_s = std::numeric_limits<float>::max();
  robot.push(pulses);
  EXPECT_GT(robot.state.shadow_deficit_A_s, before_A_s);
  EXPECT_LE(robot.state.shadow_deficit_A_s, before_A_s + 4.0F * config.current_limit_A * config.period_s);
}

}  // namespace
}  // namespace heatsoak::test_robot
