#include "thermal/steady_state.h"

#include <gtest/gtest.h>

#include "two_node.h"

namespace heatsoak::thermal {
namespace {

TwoNodeMotor closed_form_motor(const TwoNode& motor) {
  return {motor.resistance_25C_ohm, motor.temperature_coefficient_per_K, motor.winding_stator_K_per_W, motor.stator_ambient_K_per_W};
}

void expect_relative(double value, long double expected, double tolerance, const char* what) {
  EXPECT_LE(std::abs(static_cast<double>(value - expected)), tolerance * static_cast<double>(std::abs(expected))) << what << ": " << value;
}

// --- the paper's equations --------------------------------------------------------------------------------

// Hand calculation: I_RMS = 5 A · √(4/16) = 2.5 A; (2+6) K/W · 0.8 Ω · 6.25 A² = 40 K; 1 − 0.004·40 = 0.84; 40/0.84 = 47.619… K; 6/8 of it
// are 35.714… K.
TEST(OnOffSteadyState, numbers_computed_by_hand_at_25_C) {
  const OnOffSteadyState result = on_off_steady_state({0.8, 0.004, 2.0, 6.0}, {5.0, 4.0, 12.0, 25.0});
  EXPECT_FALSE(result.runaway);
  expect_relative(result.current_rms_A, 2.5L, 1e-15, "(8)");
  expect_relative(result.winding_C, 25.0L + 1000.0L / 21.0L, 1e-12, "(9), (12)");
  expect_relative(result.stator_C, 25.0L + 250.0L / 7.0L, 1e-12, "(10), (11)");
}

// At 40 °C: R_TA = 0.8·1.06 = 0.848 Ω, so 42.4 K without feedback; α·R25/R_TA = 0.004/1.06, so the denominator is 0.84 again; 42.4/0.84 =
// 50.476190476… K and 37.857142857… K.
TEST(OnOffSteadyState, numbers_computed_by_hand_at_40_C) {
  const OnOffSteadyState result = on_off_steady_state({0.8, 0.004, 2.0, 6.0}, {5.0, 4.0, 12.0, 40.0});
  expect_relative(result.winding_C, 40.0L + 42.4L / 0.84L, 1e-12, "winding");
  expect_relative(result.stator_C, 40.0L + 31.8L / 0.84L, 1e-12, "stator");
}

TEST(OnOffSteadyState, paper_equations_in_long_double) {
  Chance chance(8);
  for (int i = 0; i < 500; ++i) {
    const TwoNode motor = chance.motor();
    const long double share = chance.between(0.01, 1.0);
    const long double alpha = motor.temperature_coefficient_per_K;
    const long double total = static_cast<long double>(motor.winding_stator_K_per_W) + motor.stator_ambient_K_per_W;
    const double on_s = chance.by_ratio(0.1, 100.0);
    const double off_s = static_cast<double>(static_cast<long double>(on_s) / share) - on_s;
    const double current_A = chance.between(0.05, 0.9) * std::min(motor.critical_current_A(), std::sqrt(60.0 / motor.resistance_25C_ohm));
    const OnOffSteadyState result = on_off_steady_state(closed_form_motor(motor), {current_A, on_s, off_s, 25.0});
    const long double rms_A = current_A * std::sqrt(static_cast<long double>(on_s) / (static_cast<long double>(on_s) + off_s));
    const long double cold_K = total * motor.resistance_25C_ohm * rms_A * rms_A;
    const long double winding_K = cold_K / (1.0L - alpha * cold_K);
    const long double stator_K = motor.stator_ambient_K_per_W / total * winding_K;
    expect_relative(result.current_rms_A, rms_A, 1e-12, "(8)");
    expect_relative(result.winding_C, 25.0L + winding_K, 1e-12, "(12)");
    expect_relative(result.stator_C, 25.0L + stator_K, 1e-12, "(11)");
  }
}

TEST(OnOffSteadyState, runaway_where_the_denominator_is_not_positive) {
  // α·(R_th1+R_th2)·R·I² = (2+6)·2·16/256 = 1 without rounding.
  const TwoNodeMotor motor{2.0, 1.0 / 256.0, 2.0, 6.0};
  EXPECT_TRUE(on_off_steady_state(motor, {4.0, 1.0, 0.0, 25.0}).runaway);
  EXPECT_TRUE(on_off_steady_state(motor, {8.0, 1.0, 3.0, 25.0}).runaway);
  EXPECT_TRUE(on_off_steady_state(motor, {5.0, 1.0, 0.0, 25.0}).runaway);
  EXPECT_FALSE(on_off_steady_state(motor, {4.0 * (1.0 - 1e-12), 1.0, 0.0, 25.0}).runaway);
}

TEST(OnOffSteadyState, whether_it_runs_away_does_not_depend_on_ambient) {
  const TwoNodeMotor motor{2.0, 1.0 / 256.0, 2.0, 6.0};
  for (const double ambient_C : {-20.0, 0.0, 25.0, 60.0}) {
    EXPECT_FALSE(on_off_steady_state(motor, {4.0 * (1.0 - 1e-9), 1.0, 0.0, ambient_C}).runaway) << ambient_C;
    EXPECT_TRUE(on_off_steady_state(motor, {4.0 * (1.0 + 1e-9), 1.0, 0.0, ambient_C}).runaway) << ambient_C;
  }
}

TEST(OnOffSteadyState, no_current_rests_at_ambient) {
  const OnOffSteadyState result = on_off_steady_state({0.8, 0.004, 2.0, 6.0}, {0.0, 4.0, 12.0, 17.0});
  EXPECT_EQ(result.winding_C, 17.0);
  EXPECT_EQ(result.stator_C, 17.0);
  EXPECT_FALSE(result.runaway);
}

// --- steady state of the network --------------------------------------------------------------------------

TEST(SteadyState, network_with_copper_loss_only_is_the_closed_form_at_any_ambient) {
  Chance chance(12);
  for (int i = 0; i < 300; ++i) {
    const TwoNode motor = chance.motor();
    OperatingPoint<double> at = chance.point(motor);
    at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = 0.0;
    const OnOffSteadyState closed = on_off_steady_state(closed_form_motor(motor), {at.current_rms_A, 1.0, 0.0, at.ambient_C});
    const std::optional<SteadyState> rest = steady_state(motor.network(), at);
    ASSERT_TRUE(rest.has_value()) << i;
    EXPECT_NEAR(rest->temperature_C[winding] - at.ambient_C, closed.winding_C - at.ambient_C, 1e-9 * std::abs(closed.winding_C)) << i;
    EXPECT_NEAR(rest->temperature_C[stator] - at.ambient_C, closed.stator_C - at.ambient_C, 1e-9 * std::abs(closed.winding_C)) << i;
  }
}

TEST(SteadyState, is_the_rest_of_the_linear_system_with_drag_too) {
  Chance chance(13);
  for (int i = 0; i < 300; ++i) {
    const TwoNode motor = chance.motor();
    const OperatingPoint<double> at = chance.point(motor);
    const TwoNode::Pair expected = motor.rest_C(at);
    const std::optional<SteadyState> rest = steady_state(motor.network(), at);
    ASSERT_TRUE(rest.has_value()) << i;
    EXPECT_NEAR(rest->temperature_C[winding], static_cast<double>(expected[winding]),
                1e-9 * static_cast<double>(std::abs(expected[winding])));
    EXPECT_NEAR(rest->temperature_C[stator], static_cast<double>(expected[stator]),
                1e-9 * static_cast<double>(std::abs(expected[winding])));
  }
}

TEST(SteadyState, nothing_above_the_critical_current) {
  Chance chance(14);
  for (int i = 0; i < 50; ++i) {
    TwoNode motor = chance.motor();
    motor.temperature_coefficient_per_K = chance.between(0.001, 0.006);
    const Network network = motor.network();
    EXPECT_FALSE(steady_state(network, current_point(motor.critical_current_A() * 1.0001)).has_value()) << i;
    EXPECT_TRUE(steady_state(network, current_point(motor.critical_current_A() * 0.9999)).has_value()) << i;
    EXPECT_FALSE(steady_state(network, current_point(motor.critical_current_A() * 20.0)).has_value()) << i;
  }
}

// --- comparison with the integrated model -----------------------------------------------------------------

/// Mean temperatures above ambient in the periodic state, from the heat through the two resistances.
TwoNode::Pair periodic_mean_K(const TwoNode& motor, double current_A, double on_s, double off_s, double ambient_C) {
  const Network network = motor.network();
  const std::vector<double> values = network.values();
  const double slowest_s =
      static_cast<double>(-1.0L / motor.eigenvalues_per_s(current_point(current_A * std::sqrt(on_s / (on_s + off_s))))[0]);
  TransientOptions options;
  options.tolerances = {1e-12, 1e-12};
  const OnOffSteadyState closed = on_off_steady_state(closed_form_motor(motor), {current_A, on_s, off_s, ambient_C});
  options.start_C = {closed.winding_C, closed.stator_C};
  const int settling_cycles = static_cast<int>(std::ceil(40.0 * slowest_s / (on_s + off_s)));
  options.start_C = run_transient(network, values, on_off(current_A, on_s, off_s, settling_cycles, ambient_C), options).end_C;
  options.with_ledger = true;
  const TransientResult cycle = run_transient(network, values, on_off(current_A, on_s, off_s, 1, ambient_C), options);
  enum Effect { copper, drag, inner, outer };
  const auto heat_J = [&](int effect, int node) {
    return cycle.heat_J[static_cast<std::size_t>(effect) * static_cast<std::size_t>(network.node_count()) + static_cast<std::size_t>(node)];
  };
  const double stator_K = heat_J(outer, network.state_count()) / cycle.end_s * motor.stator_ambient_K_per_W;
  const double inner_K = heat_J(inner, stator) / cycle.end_s * motor.winding_stator_K_per_W;
  return {stator_K + inner_K, stator_K};
}

constexpr TwoNode kCycledMotor{.resistance_25C_ohm = 0.9,
                               .temperature_coefficient_per_K = 0.0039,
                               .winding_stator_K_per_W = 3.8,
                               .stator_ambient_K_per_W = 2.8,
                               .winding_J_per_K = 3.2,
                               .stator_J_per_K = 28.0};

TEST(OnOffSteadyState, is_the_mean_of_the_integrated_model_exactly_where_alpha_is_zero) {
  TwoNode motor = kCycledMotor;
  motor.temperature_coefficient_per_K = 0.0;
  for (const double cycle_s : {0.5, 10.0, 80.0}) {
    const OnOffSteadyState closed = on_off_steady_state(closed_form_motor(motor), {6.0, 0.4 * cycle_s, 0.6 * cycle_s, 31.0});
    const TwoNode::Pair mean_K = periodic_mean_K(motor, 6.0, 0.4 * cycle_s, 0.6 * cycle_s, 31.0);
    EXPECT_NEAR(static_cast<double>(mean_K[winding]), closed.winding_C - 31.0, 1e-7) << cycle_s;
    EXPECT_NEAR(static_cast<double>(mean_K[stator]), closed.stator_C - 31.0, 1e-7) << cycle_s;
  }
}

// With α the loss follows the ripple of the winding. The ripple is a saw tooth with zero mean over the on phase to first order. The error
// is therefore of second order in the cycle time.
TEST(OnOffSteadyState, is_the_mean_of_the_integrated_model_for_short_cycles_with_order_two) {
  std::vector<double> error_K;
  for (const double cycle_s : {8.0, 4.0, 2.0, 1.0}) {
    const OnOffSteadyState closed = on_off_steady_state(closed_form_motor(kCycledMotor), {6.0, 0.4 * cycle_s, 0.6 * cycle_s, 31.0});
    const TwoNode::Pair mean_K = periodic_mean_K(kCycledMotor, 6.0, 0.4 * cycle_s, 0.6 * cycle_s, 31.0);
    error_K.push_back(std::abs(static_cast<double>(mean_K[winding]) - (closed.winding_C - 31.0)));
    RecordProperty("error_K_at_cycle_" + std::to_string(static_cast<int>(cycle_s)) + "_s", std::to_string(error_K.back()));
  }
  for (std::size_t i = 1; i < error_K.size(); ++i) {
    EXPECT_NEAR(std::log2(error_K[i - 1] / error_K[i]), 2.0, 0.1) << i << ": " << error_K[i - 1] << " K, then " << error_K[i] << " K";
  }
  EXPECT_LT(error_K.back(), 0.05);
}

}  // namespace
}  // namespace heatsoak::thermal
