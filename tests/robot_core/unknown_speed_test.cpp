// A wheel whose speed is unknown (fault 114) keeps the limp current while the robot rolls, if its current is sensed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::Input;
using robot_core::Output;
using robot_core::Reason;
using robot_core::State;

constexpr int kRolledPeriods = 400;

/// Currents of two wheels of unknown speed, of a robot with three wheels that brakes from some speed.
struct Braking {
  double largest_A = 0.0;  ///< from the second period on: the first one shows the current before the fault
  int closed_periods = 0;  ///< periods with a closed bridge, sum over both wheels
  double speed_at_end_m_per_s = 0.0;
};

Braking brake(double speed_m_per_s, double way_rad) {
  const Config config = make_config(3);
  Plant plant(config, {});
  plant.set_velocity(speed_m_per_s * std::cos(way_rad), speed_m_per_s * std::sin(way_rad), 0.0);
  State state;
  Random random(3);
  EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
  Braking braking;
  for (int k = 0; k < kRolledPeriods; ++k) {
    Input input = plant.sense(random, kNoise_rad_per_s, true);
    input.command.mode = robot_core::Mode::brake;
    if (k == 0) {
      robot_core::step(config, state, input);
      state.wheel[0].speed_fault = state.wheel[1].speed_fault = static_cast<std::uint8_t>(Reason::wheel_speed_swapped);
      seal(state);
    }
    const Output out = robot_core::step(config, state, input);
    EXPECT_EQ(out.reason[0], Reason::wheel_speed_unknown);
    for (int i = 0; i < 2; ++i) {
      braking.largest_A = k == 0 ? 0.0 : std::max(braking.largest_A, std::abs(plant.true_current_A(out, i)));
      braking.closed_periods += out.is_open[i] ? 0 : 1;
    }
    plant.move(out);
  }
  braking.speed_at_end_m_per_s = std::hypot(plant.x_m_per_s(), plant.y_m_per_s());
  return braking;
}

// With the voltage of a standing wheel a bridge would brake a rolling one with up to three times the limp current, then open, and close
// again in the next period.
TEST(UnknownSpeed, ABridgeClosesOnlyIfTheVoltageSuitsTheSamples) {
  const Config config = make_config(3);
  const double margin_A = static_cast<double>(config.derived.geared_constant_V_s_per_rad) *
                          (Plant(config, {}).contact_change_rad_per_s() + 2.0) / static_cast<double>(config.lowest_resistance_ohm);
  for (const double speed_m_per_s : {0.3, 1.0, 2.0, 3.0}) {
    for (const double way_rad : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
      const Braking braking = brake(speed_m_per_s, way_rad);
      EXPECT_LE(braking.largest_A, static_cast<double>(config.limp_current_A) + margin_A) << speed_m_per_s << " m/s, " << way_rad;
      EXPECT_EQ(braking.closed_periods, 2 * kRolledPeriods) << speed_m_per_s << " m/s, " << way_rad;
      EXPECT_LT(braking.speed_at_end_m_per_s, 0.8 * speed_m_per_s) << "does not brake, " << way_rad;
    }
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
