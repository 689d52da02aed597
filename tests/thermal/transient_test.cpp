// Temperatures of a two-node network against closed forms, energy and limiting cases.
#include "thermal/transient.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "thermal/steady_state.h"
#include "transient_cases.h"
#include "two_node.h"

namespace heatsoak::thermal {
namespace {

enum Effect { copper, drag, inner, outer };

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
