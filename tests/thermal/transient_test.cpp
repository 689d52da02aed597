#include "thermal/transient.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "thermal/steady_state.h"
#include "two_node.h"

namespace heatsoak::thermal {
namespace {

enum Effect { copper, drag, inner, outer };

constexpr TwoNode kMotor{.resistance_25C_ohm = 0.9,
                         .temperature_coefficient_per_K = 0.0039,
                         .drag_torque_Nm = 0.008,
                         .winding_stator_K_per_W = 3.8,
                         .stator_ambient_K_per_W = 2.8,
                         .winding_J_per_K = 3.2,
                         .stator_J_per_K = 28.0};

TransientResult run(const TwoNode& motor, std::span<const Interval> intervals, const TransientOptions& options = {},
                    const TransientObserver& observer = {}) {
  const Network network = motor.network();
  return run_transient(network, network.values(), intervals, options, observer);
}

std::vector<Interval> random_duty(Chance& chance, const TwoNode& motor, int pieces) {
  std::vector<Interval> intervals;
  const double ambient_C = chance.between(0.0, 40.0);
  for (int i = 0; i < pieces; ++i) {
    intervals.push_back({chance.by_ratio(0.05, 50.0), chance.point(motor)});
    intervals.back().at.ambient_C = ambient_C;
  }
  return intervals;
}

class EveryMethod : public testing::TestWithParam<ode::OdeMethod> {
 protected:
  static TransientOptions tight(double tolerance) {
    TransientOptions options;
    options.method = GetParam();
    options.tolerances = {tolerance, tolerance};
    return options;
  }
};

std::string method_name(const testing::TestParamInfo<ode::OdeMethod>& info) {
  return info.param == ode::OdeMethod::cvodes_bdf ? "bdf" : info.param == ode::OdeMethod::cvodes_adams ? "adams" : "erk";
}
INSTANTIATE_TEST_SUITE_P(Transient, EveryMethod,
                         testing::Values(ode::OdeMethod::cvodes_bdf, ode::OdeMethod::cvodes_adams, ode::OdeMethod::arkode_erk),
                         method_name);

// --- against the two exponentials -------------------------------------------------------------------------

TEST_P(EveryMethod, two_exponentials_within_1e_6_K_for_200_random_motors) {
  Chance chance(200);
  const TransientOptions options = tight(1e-12);
  double worst_K = 0.0;
  for (int i = 0; i < 200; ++i) {
    const TwoNode motor = chance.motor();
    const std::vector<Interval> once{{chance.by_ratio(0.1, 2000.0), chance.point(motor)}};
    const TransientResult result = run(motor, once, options);
    const TwoNode::Pair expected = motor.after(once, {once[0].at.ambient_C, once[0].at.ambient_C});
    for (const int node : {winding, stator}) {
      const double error_K = std::abs(result.end_C[node] - static_cast<double>(expected[node]));
      worst_K = std::max(worst_K, error_K);
      EXPECT_LE(error_K, 1e-6) << "sweep " << i << " node " << node;
    }
  }
  RecordProperty("worst_K", std::to_string(worst_K * 1e9) + "e-9");
}

TEST_P(EveryMethod, random_duty_within_1e_6_K) {
  Chance chance(201);
  for (int i = 0; i < 20; ++i) {
    const TwoNode motor = chance.motor();
    const std::vector<Interval> duty = random_duty(chance, motor, 60);
    const TwoNode::Pair expected = motor.after(duty, {duty[0].at.ambient_C, duty[0].at.ambient_C});
    const TransientResult result = run(motor, duty, tight(1e-12));
    EXPECT_NEAR(result.end_C[winding], static_cast<double>(expected[winding]), 1e-6) << i;
    EXPECT_NEAR(result.end_C[stator], static_cast<double>(expected[stator]), 1e-6) << i;
  }
}

TEST_P(EveryMethod, error_follows_the_tolerance) {
  const std::vector<Interval> duty{{20.0, {5.0, 300.0, 300.0, 25.0}}, {40.0, {1.0, 50.0, 50.0, 25.0}}, {30.0, {4.0, 400.0, 400.0, 25.0}}};
  const TwoNode::Pair expected = kMotor.after(duty, {25.0L, 25.0L});
  const auto error_K = [&](double tolerance) {
    // Uses the largest error of several ends, because a single one may be small by chance.
    double largest_K = 0.0;
    const TransientResult result = run(kMotor, duty, tight(tolerance), [&](const TransientMoment& moment) {
      long double start_s = 0.0L;
      TwoNode::Pair start_C{25.0L, 25.0L};
      for (std::size_t i = 0; i < moment.interval; ++i) {
        start_C = kMotor.after(duty[i].duration_s, start_C, duty[i].at);
        start_s += duty[i].duration_s;
      }
      const TwoNode::Pair exact = kMotor.after(moment.time_s - start_s, start_C, duty[moment.interval].at);
      largest_K = std::max(largest_K, static_cast<double>(std::abs(moment.state_C[winding] - exact[winding])));
    });
    EXPECT_NEAR(result.end_C[winding], static_cast<double>(expected[winding]), largest_K + 1e-12);
    return largest_K;
  };
  const double coarse_K = error_K(1e-5);
  const double fine_K = error_K(1e-10);
  const double order = std::log10(coarse_K / fine_K) / 5.0;
  EXPECT_GT(order, 0.7) << coarse_K << " K, then " << fine_K << " K";
  EXPECT_LT(order, 1.3) << coarse_K << " K, then " << fine_K << " K";
}

// --- energy -----------------------------------------------------------------------------------------------

TEST_P(EveryMethod, ledger_closes_for_random_duties) {
  Chance chance(300);
  for (int i = 0; i < 30; ++i) {
    const TwoNode motor = chance.motor();
    const std::vector<Interval> duty = random_duty(chance, motor, 25);
    TransientOptions options = tight(1e-6);  // the balance closes within rounding at any tolerance
    options.with_ledger = true;
    const TransientResult result = run(motor, duty, options);
    ASSERT_EQ(result.heat_J.size(), 12U);
    const auto heat_J = [&](int effect, int node) {
      return result.heat_J[3 * static_cast<std::size_t>(effect) + static_cast<std::size_t>(node)];
    };
    const double scale_J = heat_J(copper, winding) + heat_J(drag, stator) + 1e-3;
    const std::array<double, 2> capacity_J_per_K{motor.winding_J_per_K, motor.stator_J_per_K};
    for (const int node : {winding, stator}) {
      const double booked_J = heat_J(copper, node) + heat_J(drag, node) + heat_J(inner, node) + heat_J(outer, node);
      const double stored_J = capacity_J_per_K[static_cast<std::size_t>(node)] * (result.end_C[node] - duty[0].at.ambient_C);
      EXPECT_NEAR(booked_J, stored_J, 1e-9 * scale_J) << "sweep " << i << " node " << node;
    }
    for (const int effect : {inner, outer}) {
      EXPECT_NEAR(heat_J(effect, winding) + heat_J(effect, stator) + heat_J(effect, ambient), 0.0, 1e-12 * scale_J);
    }
    EXPECT_GT(heat_J(copper, winding), 0.0);
    EXPECT_GT(heat_J(drag, stator), 0.0);
    EXPECT_EQ(heat_J(copper, stator), 0.0);
    EXPECT_EQ(heat_J(copper, ambient), 0.0);
  }
}

TEST(Transient, ledger_books_the_heat_that_was_made) {
  TwoNode motor = kMotor;
  motor.temperature_coefficient_per_K = 0.0;
  const std::vector<Interval> duty{{10.0, {3.0, 200.0, 210.0, 25.0}}, {5.0, {0.0, 0.0, 0.0, 25.0}}, {2.0, {5.0, 100.0, 100.0, 25.0}}};
  TransientOptions options;
  options.with_ledger = true;
  const TransientResult result = run(motor, duty, options);
  // 0.9 Ω · (9 A² · 10 s + 25 A² · 2 s) = 126 J; 0.008 N m · (200 · 10 + 100 · 2) = 17.6 J
  EXPECT_NEAR(result.heat_J[3 * copper + winding], 126.0, 1e-7);
  EXPECT_NEAR(result.heat_J[3 * drag + stator], 17.6, 1e-8);
}

TEST(Transient, the_ledger_does_not_change_the_temperatures) {
  const std::vector<Interval> duty = on_off(6.0, 4.0, 6.0, 30);
  TransientOptions options;
  const TransientResult without = run(kMotor, duty, options);
  options.with_ledger = true;
  const TransientResult with = run(kMotor, duty, options);
  EXPECT_TRUE(without.heat_J.empty());
  EXPECT_NEAR(with.end_C[winding], without.end_C[winding], 1e-6);
  EXPECT_NEAR(with.peak_C[winding], without.peak_C[winding], 1e-6);
}

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

// --- runaway ----------------------------------------------------------------------------------------------

TEST_P(EveryMethod, above_the_critical_current_the_run_ends_destroyed) {
  const double current_A = 1.02 * kMotor.critical_current_A();
  const std::vector<Interval> duty{{1e6, current_point(current_A)}, {10.0, current_point(0.0)}};
  TransientOptions options = tight(1e-9);
  options.limits = {{winding, 155.0}};
  const TransientResult result = run(kMotor, duty, options);
  EXPECT_TRUE(result.destroyed);
  EXPECT_EQ(result.peak_C[winding], kDestroyed_C);
  EXPECT_TRUE(result.time_to_limit_s[0].has_value());
  const auto above = [&](long double time_s) { return kMotor.after(time_s, {25.0L, 25.0L}, duty[0].at)[winding] - kDestroyed_C; };
  const auto expected_s = static_cast<double>(bisected(0.0L, 5000.0L, above));
  EXPECT_GE(result.end_s, expected_s * (1.0 - 1e-9));
  EXPECT_LT(result.end_s, 2.0 * expected_s) << "it should not go far beyond";
}

TEST_P(EveryMethod, just_below_the_critical_current_it_settles) {
  TwoNode motor = kMotor;
  motor.temperature_coefficient_per_K = 0.01;
  const OperatingPoint<double> at = current_point(std::sqrt(0.88) * motor.critical_current_A());
  const TwoNode::Pair rest_C = motor.rest_C(at);  // steady state at 25 + 100·0.88/0.12 °C
  ASSERT_NEAR(static_cast<double>(rest_C[winding]), 25.0 + 100.0 * 0.88 / 0.12, 1e-6);
  const TransientResult result = run(motor, std::vector<Interval>{{1e5, at}}, tight(1e-9));
  EXPECT_FALSE(result.destroyed);
  EXPECT_EQ(result.end_s, 1e5);
  EXPECT_NEAR(result.end_C[winding], static_cast<double>(rest_C[winding]), 1e-3);
  EXPECT_NEAR(result.end_C[stator], static_cast<double>(rest_C[stator]), 1e-3);
}

// --- limiting cases ---------------------------------------------------------------------------------------

TEST_P(EveryMethod, without_current_and_speed_it_stays_at_ambient) {
  const TransientResult result = run(kMotor, std::vector<Interval>{{3600.0, current_point(0.0, 31.5)}}, tight(1e-9));
  EXPECT_NEAR(result.end_C[winding], 31.5, 1e-9);
  EXPECT_NEAR(result.end_C[stator], 31.5, 1e-9);
  EXPECT_EQ(result.end_s, 3600.0);
}

// A trial step that is too long for an explicit method may evaluate the copper resistance below its zero. A headroom without limit has no
// current there.
TEST_P(EveryMethod, long_rests_after_long_loads_come_to_ambient) {
  for (const double current_A : {2.0, 4.0, 5.5, 5.9, 6.0, 6.1}) {
    for (const double phase_s : {900.0, 1200.0, 1800.0, 3600.0}) {
      const TwoNode motor{.resistance_25C_ohm = 0.608,
                          .winding_stator_K_per_W = 4.1,
                          .stator_ambient_K_per_W = 3.56,
                          .winding_J_per_K = 29.6 / 4.1,
                          .stator_J_per_K = 50.0};
      Network network = motor.network();
      network.limit_current_by("copper");
      const std::vector<Interval> duty = on_off(current_A, phase_s, phase_s, 3);
      const TransientResult result = run_transient(network, network.values(), duty, tight(1e-9));
      EXPECT_NEAR(result.end_C[winding], static_cast<double>(motor.after(duty, {25.0L, 25.0L})[winding]), 1e-4) << current_A;
    }
  }
}

TEST(Transient, a_headroom_without_limit_limits_nowhere) {
  Network network = kMotor.network();
  network.limit_current_by("copper");
  const std::vector<double> values = network.values();
  OperatingPoint<double> at = current_point(6.0);
  for (const double winding_C : {-1e6, -300.0, 25.0 - 1.0 / kMotor.temperature_coefficient_per_K, 25.0, 1e6}) {
    EXPECT_EQ(network.flowing_A(at, values.data(), std::array{winding_C, 25.0, 25.0}.data()), 6.0) << winding_C;
  }
}

TEST_P(EveryMethod, behind_a_huge_resistance_all_heat_stays) {
  TwoNode motor = kMotor;
  motor.stator_ambient_K_per_W = 1e12;
  motor.temperature_coefficient_per_K = 0.0;
  const TransientResult result = run(motor, std::vector<Interval>{{600.0, {2.0, 100.0, 100.0, 25.0}}}, tight(1e-9));
  // (3.6 W + 0.8 W) · 600 s = 2640 J in both nodes
  EXPECT_NEAR(3.2 * (result.end_C[winding] - 25.0) + 28.0 * (result.end_C[stator] - 25.0), 2640.0, 1e-4);
}

TEST_P(EveryMethod, behind_a_tiny_resistance_both_nodes_are_one_body) {
  TwoNode motor = kMotor;
  motor.winding_stator_K_per_W = 1e-3;
  motor.temperature_coefficient_per_K = 0.0;
  const TransientResult result = run(motor, std::vector<Interval>{{60.0, current_point(4.0)}}, tight(1e-9));
  // One body: 14.4 W on 31.2 J/K behind 2.8 K/W. The two nodes differ by at most 14.4 W · 1 mK/W.
  const double one_body_C = 25.0 + 14.4 * 2.8 * (1.0 - std::exp(-60.0 / (31.2 * 2.8)));
  EXPECT_NEAR(result.end_C[winding], one_body_C, 0.02);
  EXPECT_NEAR(result.end_C[stator], one_body_C, 0.02);
}

TEST_P(EveryMethod, without_a_source_the_hottest_never_gets_hotter_nor_the_coldest_colder) {
  Chance chance(600);
  for (int i = 0; i < 50; ++i) {
    const TwoNode motor = chance.motor();
    TransientOptions options = tight(1e-9);
    options.start_C = {chance.between(-20.0, 200.0), chance.between(-20.0, 200.0)};
    const double ambient_C = chance.between(-20.0, 60.0);
    double hottest_C = std::max({options.start_C[0], options.start_C[1], ambient_C});
    double coldest_C = std::min({options.start_C[0], options.start_C[1], ambient_C});
    const TransientResult result =
        run(motor, std::vector<Interval>{{2000.0, current_point(0.0, ambient_C)}}, options, [&](const TransientMoment& moment) {
          const double highest_C = std::max({moment.state_C[0], moment.state_C[1], ambient_C});
          const double lowest_C = std::min({moment.state_C[0], moment.state_C[1], ambient_C});
          EXPECT_LE(highest_C, hottest_C + 1e-6) << i;
          EXPECT_GE(lowest_C, coldest_C - 1e-6) << i;
          hottest_C = highest_C;
          coldest_C = lowest_C;
        });
    EXPECT_LE(result.peak_C[winding], std::max({options.start_C[0], options.start_C[1], ambient_C}) + 1e-6);
  }
}

TEST(Transient, more_current_is_nowhere_colder) {
  double before_C = -1e9;
  for (double current_A = 0.0; current_A < 8.0; current_A += 0.5) {
    const double peak_C = run(kMotor, on_off(current_A, 4.0, 6.0, 20)).peak_C[winding];
    EXPECT_GE(peak_C, before_C);
    before_C = peak_C;
  }
}

// --- intervals and calls ----------------------------------------------------------------------------------

TEST_P(EveryMethod, cutting_an_interval_in_pieces_changes_nothing) {
  const OperatingPoint<double> at{5.0, 300.0, 300.0, 25.0};
  const std::vector<Interval> pieces(300, {0.1, at});
  const TwoNode::Pair expected = kMotor.after(30.0L, {25.0L, 25.0L}, at);
  const TransientResult cut = run(kMotor, pieces, tight(1e-10));
  EXPECT_NEAR(cut.end_C[winding], static_cast<double>(expected[winding]), 1e-5);
  EXPECT_NEAR(cut.end_s, 30.0, 1e-9);
}

TEST(Transient, the_observer_sees_both_ends_of_every_interval) {
  const std::vector<Interval> duty = on_off(6.0, 0.7, 1.3, 5);
  std::vector<double> begins_s;
  double latest_s = 0.0;
  run(kMotor, duty, {}, [&](const TransientMoment& moment) {
    EXPECT_GE(moment.time_s, latest_s);
    if (moment.begins_interval) {
      EXPECT_EQ(moment.interval, begins_s.size());
      EXPECT_EQ(moment.time_s, latest_s) << "an interval begins where the one before ends";
      begins_s.push_back(moment.time_s);
    }
    latest_s = moment.time_s;
  });
  ASSERT_EQ(begins_s.size(), duty.size());
  for (std::size_t i = 0; i < begins_s.size(); ++i) {
    const std::size_t cycles = i / 2;
    EXPECT_NEAR(begins_s[i], 2.0 * static_cast<double>(cycles) + 0.7 * static_cast<double>(i % 2), 1e-12);
  }
  EXPECT_NEAR(latest_s, 10.0, 1e-12);
}

TEST(Transient, a_duty_without_intervals_is_its_start) {
  TransientOptions options;
  options.start_C = {80.0, 50.0};
  const TransientResult result = run(kMotor, {}, options);
  EXPECT_EQ(result.end_s, 0.0);
  EXPECT_EQ(result.end_C, (std::vector<double>{80.0, 50.0}));
  EXPECT_EQ(result.peak_C, (std::vector<double>{80.0, 50.0}));
}

TEST(Transient, intervals_of_no_length_do_no_harm) {
  std::vector<Interval> duty = on_off(6.0, 4.0, 6.0, 3);
  const TransientResult expected = run(kMotor, duty);
  duty.insert(duty.begin() + 1, {0.0, current_point(500.0)});
  duty.insert(duty.begin(), {0.0, current_point(500.0)});
  const TransientResult result = run(kMotor, duty);
  EXPECT_NEAR(result.end_C[winding], expected.end_C[winding], 1e-6);
  EXPECT_NEAR(result.peak_C[winding], expected.peak_C[winding], 1e-6);
}

TEST(Transient, same_input_same_bits) {
  const std::vector<Interval> duty = on_off(6.0, 4.0, 6.0, 50);
  EXPECT_EQ(run(kMotor, duty).end_C, run(kMotor, duty).end_C);
  EXPECT_EQ(run(kMotor, duty).peak_C, run(kMotor, duty).peak_C);
}

}  // namespace
}  // namespace heatsoak::thermal
