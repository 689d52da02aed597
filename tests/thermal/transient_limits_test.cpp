// Limit crossings and peaks of transients.
#include <gtest/gtest.h>

#include <algorithm>

#include "thermal/transient.h"
#include "transient_cases.h"
#include "two_node.h"

namespace heatsoak::thermal {
namespace {

// --- limits -----------------------------------------------------------------------------------------------

TEST_P(EveryMethod, adiabatic_heating_crosses_the_limit_at_C_dT_over_P) {
  Network network;
  network.add_node("winding", 4.0);
  const std::vector<std::string> node{"winding"};
  network.add_effect("copper", *find_effect("copper_loss"), node, std::vector<double>{0.5, 0.0});
  const std::vector<Interval> duty{{100.0, current_point(6.0, 20.0)}};
  TransientOptions options = tight(1e-9);
  options.limits = {{0, 110.0}, {0, 155.0}, {0, 1000.0}};
  const TransientResult result = run_transient(network, network.values(), duty, options);
  // 36 A² · 0.5 Ω = 18 W: 90 K · 4 J/K / 18 W = 20 s and 135 · 4 / 18 = 30 s
  ASSERT_TRUE(result.time_to_limit_s[0] && result.time_to_limit_s[1]);
  EXPECT_NEAR(*result.time_to_limit_s[0], 20.0, 1e-3);
  EXPECT_NEAR(*result.time_to_limit_s[1], 30.0, 1e-3);
  EXPECT_FALSE(result.time_to_limit_s[2].has_value());
}

TEST_P(EveryMethod, single_exponential_crosses_the_limit_at_the_logarithm) {
  Network network;
  network.add_node("winding", 4.0);
  network.add_effect("copper", *find_effect("copper_loss"), std::vector<std::string>{"winding"}, std::vector<double>{0.5, 0.0});
  network.add_effect("cooling", *find_effect("conduction"), std::vector<std::string>{"winding", "ambient"}, std::vector<double>{8.0});
  const std::vector<Interval> duty{{500.0, current_point(6.0, 20.0)}};
  TransientOptions options = tight(1e-9);
  options.limits = {{0, 155.0}};
  const TransientResult result = run_transient(network, network.values(), duty, options);
  // Its steady state is 20 + 144 °C with a time constant of 32 s: 135 of 144 K after 32 s · ln(144/9) = 32 s · 4 · ln 2
  ASSERT_TRUE(result.time_to_limit_s[0].has_value());
  EXPECT_NEAR(*result.time_to_limit_s[0], 128.0 * std::log(2.0), 1e-3);
}

TEST_P(EveryMethod, limits_of_random_motors_are_crossed_within_1_ms) {
  Chance chance(400);
  int crossed = 0;
  for (int i = 0; i < 60; ++i) {
    const TwoNode motor = chance.motor();
    const OperatingPoint<double> at = chance.point(motor);
    const TwoNode::Pair start_C{at.ambient_C, at.ambient_C};
    const double duration_s = chance.by_ratio(5.0, 500.0);
    const TwoNode::Pair end_C = motor.after(duration_s, start_C, at);
    if (end_C[winding] < at.ambient_C + 2.0L || end_C[stator] < at.ambient_C + 2.0L) {
      continue;
    }
    ++crossed;
    const double share = chance.between(0.1, 0.9);
    TransientOptions options = tight(1e-9);
    for (const int node : {winding, stator}) {
      options.limits.push_back({node, at.ambient_C + share * (static_cast<double>(end_C[static_cast<std::size_t>(node)]) - at.ambient_C)});
    }
    const TransientResult result = run(motor, std::vector<Interval>{{duration_s, at}}, options);
    for (std::size_t node : {0U, 1U}) {
      const auto above = [&](long double time_s) { return motor.after(time_s, start_C, at)[node] - options.limits[node].limit_C; };
      ASSERT_TRUE(result.time_to_limit_s[node].has_value()) << "sweep " << i << " node " << node;
      EXPECT_NEAR(*result.time_to_limit_s[node], static_cast<double>(bisected(0.0L, duration_s, above)), 1e-3)
          << "sweep " << i << " node " << node;
    }
  }
  EXPECT_GT(crossed, 30);
}

TEST_P(EveryMethod, the_first_of_many_crossings_is_reported) {
  const std::vector<Interval> duty = on_off(7.0, 4.0, 6.0, 40);
  TransientOptions options = tight(1e-9);
  options.limits = {{winding, 120.0}};
  const TransientResult result = run(kMotor, duty, options);
  TwoNode::Pair state_C{25.0L, 25.0L};
  long double start_s = 0.0L;
  std::size_t piece = 0;
  while (kMotor.after(duty[piece].duration_s, state_C, duty[piece].at)[winding] < 120.0L) {
    state_C = kMotor.after(duty[piece].duration_s, state_C, duty[piece].at);
    start_s += duty[piece++].duration_s;
    ASSERT_LT(piece, duty.size());
  }
  const auto above = [&](long double time_s) { return kMotor.after(time_s, state_C, duty[piece].at)[winding] - 120.0L; };
  ASSERT_TRUE(result.time_to_limit_s[0].has_value());
  EXPECT_NEAR(*result.time_to_limit_s[0], static_cast<double>(start_s + bisected(0.0L, duty[piece].duration_s, above)), 1e-3);
}

// The slower a limit is crossed, the longer its event function is zero within rounding.
TEST_P(EveryMethod, a_limit_crossed_at_a_crawl_is_found) {
  const OperatingPoint<double> at{5.0, 300.0, 300.0, 25.0};
  const TwoNode::Pair rest_C = kMotor.rest_C(at);
  for (const std::size_t node : {0U, 1U}) {
    for (double below_K = 10.0; below_K > 1e-5; below_K *= 0.3) {
      TransientOptions options = tight(1e-10);
      options.limits = {{static_cast<int>(node), static_cast<double>(rest_C[node]) - below_K}};
      const auto above = [&](long double time_s) { return kMotor.after(time_s, {25.0L, 25.0L}, at)[node] - options.limits[0].limit_C; };
      const auto expected_s = static_cast<double>(bisected(0.0L, 1e5L, above));
      const TransientResult result = run(kMotor, std::vector<Interval>{{1e5, at}}, options);
      ASSERT_TRUE(result.time_to_limit_s[0].has_value()) << below_K;
      EXPECT_EQ(result.end_s, 1e5);
      // The state has an error of about 1e-7 K, so the time has this error divided by the slope.
      const double slope_K_per_s = static_cast<double>(kMotor.rate_K_per_s(kMotor.after(expected_s, {25.0L, 25.0L}, at), at)[node]);
      EXPECT_NEAR(*result.time_to_limit_s[0], expected_s, 1e-3 + 1e-7 / slope_K_per_s) << below_K;
    }
  }
}

TEST(Transient, already_above_the_limit_is_crossed_at_the_start) {
  TransientOptions options;
  options.start_C = {160.0, 90.0};
  options.limits = {{winding, 155.0}, {stator, 100.0}};
  const TransientResult result = run(kMotor, std::vector<Interval>{{5.0, current_point(0.0)}}, options);
  EXPECT_EQ(result.time_to_limit_s[0], 0.0);
  EXPECT_FALSE(result.time_to_limit_s[1].has_value());
}

TEST_P(EveryMethod, leaving_the_limit_upwards_from_it_is_a_crossing_at_the_start) {
  TransientOptions options = tight(1e-9);
  options.start_C = {155.0, 90.0};
  options.limits = {{winding, 155.0}};
  const TransientResult heated = run(kMotor, std::vector<Interval>{{5.0, current_point(10.0)}}, options);
  ASSERT_GT(heated.peak_C[winding], 160.0);
  ASSERT_TRUE(heated.time_to_limit_s[0].has_value());
  EXPECT_NEAR(*heated.time_to_limit_s[0], 0.0, 1e-3);
}

TEST_P(EveryMethod, cooling_through_a_limit_is_no_crossing) {
  TransientOptions options = tight(1e-9);
  options.start_C = {120.0, 90.0};
  options.limits = {{stator, 95.0}, {winding, 121.0}};
  const TransientResult result = run(kMotor, std::vector<Interval>{{300.0, current_point(0.0)}}, options);
  EXPECT_FALSE(result.time_to_limit_s[1].has_value());
}

// --- peaks ------------------------------------------------------------------------------------------------

// After switch-off the winding continues to heat the stator, whose maximum lies between the solver's steps.
TEST_P(EveryMethod, heat_soak_peak_of_the_stator_is_found_between_the_steps) {
  Chance chance(500);
  double worst_K = 0.0;
  for (int i = 0; i < 100; ++i) {
    const TwoNode motor = chance.motor();
    const OperatingPoint<double> on = chance.point(motor);
    OperatingPoint<double> off = on;
    off.current_rms_A = off.speed_mean_rad_per_s = off.speed_rms_rad_per_s = 0.0;
    const double on_s = chance.by_ratio(2.0, 60.0);
    const TwoNode::Pair at_switch_C = motor.after(on_s, {on.ambient_C, on.ambient_C}, on);
    if (motor.rate_K_per_s(at_switch_C, off)[stator] <= 0.0L) {
      continue;
    }
    const auto slope = [&](long double time_s) { return motor.rate_K_per_s(motor.after(time_s, at_switch_C, off), off)[stator]; };
    const long double peak_s = bisected(0.0L, -10.0L / motor.eigenvalues_per_s(off)[0], slope);
    const double peak_C = static_cast<double>(motor.after(peak_s, at_switch_C, off)[stator]);
    const TransientResult result = run(motor, std::vector<Interval>{{on_s, on}, {5000.0, off}}, tight(1e-9));
    worst_K = std::max(worst_K, std::abs(result.peak_C[stator] - peak_C));
    EXPECT_NEAR(result.peak_C[stator], peak_C, 1e-3) << i;
    // A maximum is flat, so its time is less accurate than its height.
    const double share = std::abs(result.peak_time_s[stator] - on_s - static_cast<double>(peak_s)) / static_cast<double>(peak_s);
    EXPECT_LT(share, 0.02) << i;
    EXPECT_NEAR(result.peak_C[winding], static_cast<double>(at_switch_C[winding]), 1e-6);
    EXPECT_NEAR(result.peak_time_s[winding], on_s, 1e-9);
  }
  RecordProperty("worst_K", std::to_string(worst_K));
}

// A limit just below the peak is exceeded and left again within one step.
TEST_P(EveryMethod, a_peak_above_a_limit_has_a_time_to_limit) {
  const OperatingPoint<double> off = current_point(0.0);
  const std::vector<Interval> duty{{12.0, current_point(6.0)}, {400.0, off}};
  const TwoNode::Pair at_switch_C = kMotor.after(12.0L, {25.0L, 25.0L}, duty[0].at);
  const auto slope = [&](long double time_s) { return kMotor.rate_K_per_s(kMotor.after(time_s, at_switch_C, off), off)[stator]; };
  const long double peak_s = bisected(0.0L, 400.0L, slope);
  const double peak_C = static_cast<double>(kMotor.after(peak_s, at_switch_C, off)[stator]);
  for (const double tolerance : {1e-6, 1e-9}) {
    for (const double below_K : {1.0, 0.1, 0.03, 1e-2, 1e-3, 1e-4}) {
      TransientOptions options = tight(tolerance);
      options.limits = {{stator, peak_C - below_K}, {stator, peak_C + 0.03}};
      const TransientResult result = run(kMotor, duty, options);
      const auto above = [&](long double time_s) { return kMotor.after(time_s, at_switch_C, off)[stator] - options.limits[0].limit_C; };
      if (tolerance > 1e-8 && below_K < 0.03) {  // the peak itself is less accurate
        EXPECT_EQ(result.time_to_limit_s[0].has_value(), result.peak_C[stator] > options.limits[0].limit_C);
        continue;
      }
      ASSERT_GT(result.peak_C[stator], options.limits[0].limit_C);
      ASSERT_TRUE(result.time_to_limit_s[0].has_value()) << below_K << " K below the peak, tolerance " << tolerance;
      EXPECT_FALSE(result.time_to_limit_s[1].has_value());
      const auto expected_s = static_cast<double>(bisected(0.0L, peak_s, above));
      if (tolerance < 1e-8 && below_K >= 1.0) {
        EXPECT_NEAR(*result.time_to_limit_s[0] - 12.0, expected_s, 1e-3);
      }
      EXPECT_GT(*result.time_to_limit_s[0] - 12.0, 0.9 * expected_s) << below_K;
      EXPECT_LT(*result.time_to_limit_s[0] - 12.0, static_cast<double>(peak_s) * 1.05) << below_K;
    }
  }
}

TEST_P(EveryMethod, peaks_do_not_depend_much_on_the_tolerance) {
  const std::vector<Interval> duty{{12.0, current_point(6.0)}, {400.0, current_point(0.0)}};
  const double reference_C = run(kMotor, duty, tight(1e-12)).peak_C[stator];
  EXPECT_NEAR(run(kMotor, duty, tight(1e-6)).peak_C[stator], reference_C, 2e-2);
  EXPECT_NEAR(run(kMotor, duty, tight(1e-9)).peak_C[stator], reference_C, 1e-3);
}

TEST(Transient, peak_of_a_cooling_motor_is_its_start) {
  TransientOptions options;
  options.start_C = {120.0, 40.0};
  const TransientResult result = run(kMotor, std::vector<Interval>{{50.0, current_point(0.0)}}, options);
  EXPECT_EQ(result.peak_C[winding], 120.0);
  EXPECT_EQ(result.peak_time_s[winding], 0.0);
  EXPECT_GT(result.peak_C[stator], 40.0);
}

}  // namespace
}  // namespace heatsoak::thermal
