// Rest of a hot motor before it can play on.
#include "select/rest.h"

#include <gtest/gtest.h>

#include "simple_motor.h"

namespace heatsoak::select {
namespace {

std::vector<RestOfHotMotor> rests_on(const duty::Duty& duty, const motor::Motor& motor) {
  return rests_of_hot_motor(simple_robot(), duty, duty.demand(simple_robot(), 1).front(), motor);
}

/// Temperatures of simple_motor(), by Euler's method with steps that are far below its time constants.
struct TwoBodies {
  double winding_C = 25.0;
  double stator_C = 25.0;

  void advance(double time_s, double current_A) {
    constexpr double kStep_s = 1e-3;
    for (double at_s = 0.0; at_s < time_s - 0.5 * kStep_s; at_s += kStep_s) {
      const double copper_W = current_A * current_A * kResistance_ohm * (1.0 + kAlpha_per_K * (winding_C - 25.0));
      const double inner_W = (winding_C - stator_C) / kInner_K_per_W;
      winding_C += kStep_s * (copper_W - inner_W) * kInner_K_per_W / 4.0;
      stator_C += kStep_s * (inner_W - (stator_C - 25.0) / kOuter_K_per_W) * kOuter_K_per_W / 20.0;
    }
  }
};

/// Returns the highest winding temperature of a minute with the current, after a rest from the hot steady state.
double peak_after_rest_C(double rest_s, double current_A) {
  const double stator_C = 25.0 + 130.0 * kOuter_K_per_W / (kInner_K_per_W + kOuter_K_per_W);
  TwoBodies bodies{155.0, stator_C};
  bodies.advance(rest_s, 0.0);
  double peak_C = bodies.winding_C;
  for (int second = 0; second < 60; ++second) {
    bodies.advance(1.0, current_A);
    peak_C = std::max(peak_C, bodies.winding_C);
  }
  return peak_C;
}

TEST(RestOfHotMotor, is_the_shortest_that_keeps_the_limit) {
  constexpr double kPlayed_A = 5.45;  // its steady state is just above the limit, so a minute of play needs some rest
  const std::vector<RestOfHotMotor> rests = rests_on(constant_current(kPlayed_A), simple_motor());
  ASSERT_EQ(rests.size(), kPlays_s.size());
  ASSERT_TRUE(rests.front().all_s);
  const double rest_s = *rests.front().all_s;
  EXPECT_GT(rest_s, 1.0);
  EXPECT_LT(peak_after_rest_C(rest_s, kPlayed_A), 155.0);
  EXPECT_GT(peak_after_rest_C(rest_s - 1.0, kPlayed_A), 155.0);
  EXPECT_EQ(rests.front().half_s, rests.front().all_s) << "a constant load is the same from every place";
}

TEST(RestOfHotMotor, grows_with_the_play_until_no_rest_suffices) {
  const std::vector<RestOfHotMotor> rests = rests_on(constant_current(6.1), simple_motor());
  EXPECT_FALSE(rests.back().all_s) << "20 min are as long as a steady state for a motor of 20 s";
  EXPECT_EQ(rests.back().starts_never, rests.back().starts);
}

TEST(RestOfHotMotor, is_none_before_a_light_load) {
  for (const RestOfHotMotor& each : rests_on(constant_current(1.0), simple_motor())) {
    EXPECT_EQ(each.all_s, 0.0);
    EXPECT_EQ(each.starts_never, 0);
  }
}

TEST(RestOfHotMotor, begins_at_the_limit_of_the_stator_if_that_comes_first) {
  motor::Motor motor = simple_motor();
  motor.nominal.stator_limit_C = 40.0;
  const std::vector<RestOfHotMotor> free = rests_on(constant_current(4.0), simple_motor());
  const std::vector<RestOfHotMotor> limited = rests_on(constant_current(4.0), motor);
  EXPECT_EQ(free.back().all_s, 0.0);
  EXPECT_FALSE(limited.back().all_s) << "4 A hold the stator above 40 °C";
}

TEST(RestOfHotMotor, never_suffices_for_a_limit_below_the_air) {
  motor::Motor motor = simple_motor();
  for (const bool is_of_stator : {false, true}) {
    motor.nominal.winding_limit_C = is_of_stator ? 155.0 : 20.0;
    motor.nominal.stator_limit_C = is_of_stator ? std::optional(24.0) : std::nullopt;
    const std::vector<RestOfHotMotor> rests = rests_on(constant_current(1.0), motor);
    ASSERT_EQ(rests.size(), kPlays_s.size());
    for (const RestOfHotMotor& each : rests) {
      EXPECT_TRUE(each.over_without_current);
      EXPECT_FALSE(each.half_s || each.all_s);
      EXPECT_GT(each.starts, 0);
      EXPECT_EQ(each.starts_never, each.starts);
    }
  }
}

// Copper loss without a rise of resistance or a limit above every reachable temperature has no hot state.
TEST(RestOfHotMotor, is_empty_if_no_current_reaches_a_limit) {
  motor::Motor motor = simple_motor();
  motor.nominal.winding_limit_C = 1e12;
  motor.nominal.temperature_coefficient_per_K = 0.0;
  EXPECT_TRUE(rests_on(constant_current(1.0), motor).empty());
}

}  // namespace
}  // namespace heatsoak::select
