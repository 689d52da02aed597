#include "thermal/periodic_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "two_node.h"

namespace heatsoak::thermal {
namespace {

/// The repeating cycle in closed form: the map of a cycle is affine.
struct OnPaper {
  TwoNode::Pair start_C;
  TwoNode::Pair mean_C;
  TwoNode::Pair peak_C;
  long double growth;
};

TwoNode::Pair integral_K_s(const TwoNode& motor, TwoNode::Pair from_C, const Interval& interval) {
  const TwoNode::Linear x = motor.linear(interval.at);
  const TwoNode::Pair rest = motor.rest_C(interval.at);
  const TwoNode::Pair to_C = motor.after(interval.duration_s, from_C, interval.at);
  const long double u = to_C[0] - from_C[0];
  const long double v = to_C[1] - from_C[1];
  const long double determinant = x.a * x.d - x.b * x.c;
  return {rest[0] * interval.duration_s + (x.d * u - x.b * v) / determinant,
          rest[1] * interval.duration_s + (x.a * v - x.c * u) / determinant};
}

OnPaper on_paper(const TwoNode& motor, const std::vector<Interval>& cycle) {
  const TwoNode::Pair zero = motor.after(cycle, {0.0L, 0.0L});
  const TwoNode::Pair first = motor.after(cycle, {1.0L, 0.0L});
  const TwoNode::Pair second = motor.after(cycle, {0.0L, 1.0L});
  const long double a = first[0] - zero[0];
  const long double b = second[0] - zero[0];
  const long double c = first[1] - zero[1];
  const long double d = second[1] - zero[1];
  const long double determinant = (1.0L - a) * (1.0L - d) - b * c;
  const TwoNode::Pair start_C{((1.0L - d) * zero[0] + b * zero[1]) / determinant, ((1.0L - a) * zero[1] + c * zero[0]) / determinant};
  const TwoNode::Pair middle_C = motor.after(cycle[0].duration_s, start_C, cycle[0].at);
  const TwoNode::Pair on_K_s = integral_K_s(motor, start_C, cycle[0]);
  const TwoNode::Pair off_K_s = integral_K_s(motor, middle_C, cycle[1]);
  const long double cycle_s = static_cast<long double>(cycle[0].duration_s) + cycle[1].duration_s;
  return {start_C,
          {(on_K_s[0] + off_K_s[0]) / cycle_s, (on_K_s[1] + off_K_s[1]) / cycle_s},
          middle_C,
          0.5L * (a + d) + std::sqrt(0.25L * (a - d) * (a - d) + b * c)};
}

constexpr TwoNode kFlatMotor{.resistance_25C_ohm = 0.608,
                             .temperature_coefficient_per_K = 0.0039,
                             .winding_stator_K_per_W = 4.1,
                             .stator_ambient_K_per_W = 3.56,
                             .winding_J_per_K = 7.2,
                             .stator_J_per_K = 50.0};

std::vector<Interval> cycle_of(double current_A, double on_s, double off_s) { return on_off(current_A, on_s, off_s, 1); }

void add_body(Network& network, std::vector<double> parameters) {
  network.add_effect("body", *find_effect("third_node"), std::vector<std::string>{"stator", "body", "ambient"}, parameters);
}

TEST(PeriodicState, is_the_cycle_on_paper_for_random_motors_and_cycles) {
  Chance chance(90);
  int settled = 0;
  int lost = 0;
  double worst_K = 0.0;
  for (int i = 0; i < 300; ++i) {
    TwoNode motor = chance.motor();
    motor.temperature_coefficient_per_K = chance.between(0.001, 0.005);
    const double on_s = chance.by_ratio(1e-3, 1e4);
    const double off_s = chance.by_ratio(1e-3, 1e4);
    const double rms_A = chance.between(0.1, 1.1) * motor.critical_current_A();
    const std::vector<Interval> cycle = cycle_of(rms_A * std::sqrt((on_s + off_s) / on_s), on_s, off_s);
    const OnPaper expected = on_paper(motor, cycle);
    const PeriodicState result = periodic_state(motor.network(), cycle);
    const long double peak_C = expected.peak_C[winding];
    if (expected.growth < 1.0L && peak_C < 990.0L) {
      ++settled;
      ASSERT_FALSE(result.runaway) << i;
      for (const std::size_t node : {0U, 1U}) {
        const double error_K = std::max(std::abs(result.start_C[node] - static_cast<double>(expected.start_C[node])),
                                        std::abs(result.mean_C[node] - static_cast<double>(expected.mean_C[node])));
        worst_K = std::max(worst_K, error_K);
        EXPECT_LT(error_K, 1e-4) << i << " node " << node << ": " << on_s << " s, " << off_s << " s";
      }
      EXPECT_NEAR(result.peak_C[winding], static_cast<double>(peak_C), 1e-4) << i;
    } else if (expected.growth > 1.0L || peak_C > 1010.0L) {
      ++lost;
      EXPECT_TRUE(result.runaway) << i << ": grows by " << static_cast<double>(expected.growth) << ", " << static_cast<double>(peak_C);
    }
  }
  RecordProperty("worst_K", std::to_string(worst_K * 1e9) + "e-9");
  EXPECT_GT(settled, 30);
  EXPECT_GT(lost, 30);
}

TEST(PeriodicState, of_any_length_is_between_a_held_current_and_its_steady_parts) {
  const double held_C = static_cast<double>(kFlatMotor.rest_C(current_point(6.0 * std::sqrt(0.4)))[winding]);
  double before_C = held_C - 1e-3;
  for (const double cycle_s : {2e-9, 1e-6, 1e-3, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e6, 2e9}) {
    const PeriodicState result = periodic_state(kFlatMotor.network(), cycle_of(6.0, 0.4 * cycle_s, 0.6 * cycle_s));
    ASSERT_FALSE(result.runaway) << cycle_s;
    EXPECT_GE(result.mean_C[winding], before_C) << cycle_s;
    EXPECT_GE(result.peak_C[winding], result.mean_C[winding]) << cycle_s;
    before_C = result.mean_C[winding] - 1e-4;
  }
  const double apart_C = 0.4 * static_cast<double>(kFlatMotor.rest_C(current_point(6.0))[winding]) + 0.6 * 25.0;
  EXPECT_NEAR(before_C, apart_C, 1e-2);
}

TEST(PeriodicState, held_current_is_the_rest) {
  const PeriodicState result = periodic_state(kFlatMotor.network(), cycle_of(4.0, 10.0, 0.0));
  const TwoNode::Pair rest_C = kFlatMotor.rest_C(current_point(4.0));
  for (const std::size_t node : {0U, 1U}) {
    EXPECT_NEAR(result.mean_C[node], static_cast<double>(rest_C[node]), 1e-5);
    EXPECT_NEAR(result.peak_C[node], static_cast<double>(rest_C[node]), 1e-5);
  }
}

// A body with a time constant of hours: waiting until consecutive cycles are similar would stop much too early.
TEST(PeriodicState, a_slow_body_is_warm_however_short_the_cycle) {
  Network network = kFlatMotor.network();
  add_body(network, {0.15, 0.2, 3000.0});
  double shorter_C = 0.0;
  for (const double cycle_s : {0.1, 1.0, 10.0, 100.0}) {
    const std::vector<Interval> cycle = cycle_of(6.0, 0.4 * cycle_s, 0.6 * cycle_s);
    const PeriodicState result = periodic_state(network, cycle);
    TransientOptions options;
    options.start_C = result.start_C;
    // No drift within a quarter of an hour.
    const TransientResult later =
        run_transient(network, network.values(), on_off(6.0, 0.4 * cycle_s, 0.6 * cycle_s, static_cast<int>(900.0 / cycle_s)), options);
    for (std::size_t node = 0; node < result.start_C.size(); ++node) {
      EXPECT_NEAR(later.end_C[node], result.start_C[node], 1e-3) << cycle_s << " s, node " << node;
    }
    EXPECT_NEAR(later.peak_C[winding], result.peak_C[winding], 1e-3) << cycle_s;
    // The heat that the body receives, G·(T_stator − T_body), equals the heat that it gives off, r·G·(T_body − T_ambient).
    EXPECT_NEAR(result.mean_C[stator] - result.mean_C[2], 0.2 * (result.mean_C[2] - 25.0), 1e-3) << cycle_s;
    EXPECT_GT(result.peak_C[winding], shorter_C) << cycle_s;
    shorter_C = result.peak_C[winding];
  }
}

TEST(PeriodicState, a_body_that_nothing_touches_stays_at_ambient) {
  Network network = kFlatMotor.network();
  add_body(network, {0.0, 0.0, 100.0});
  const PeriodicState result = periodic_state(network, cycle_of(4.0, 4.0, 6.0));
  const PeriodicState without = periodic_state(kFlatMotor.network(), cycle_of(4.0, 4.0, 6.0));
  ASSERT_FALSE(result.runaway);
  EXPECT_NEAR(result.mean_C[2], 25.0, 1e-9);
  EXPECT_NEAR(result.mean_C[winding], without.mean_C[winding], 1e-4);
  EXPECT_NEAR(result.peak_C[winding], without.peak_C[winding], 1e-4);
}

// The current exceeds the critical current of the cold motor. The radiated heat, with the fourth power of the temperature, stabilises it
// when hot.
TEST(PeriodicState, radiation_may_stop_what_grows_at_first) {
  TwoNode motor = kFlatMotor;
  motor.stator_ambient_K_per_W = 20.0;
  Network network = motor.network();
  const double rms_A = 1.05 * motor.critical_current_A();
  const std::vector<Interval> cycle = cycle_of(rms_A * std::sqrt(2.5), 4.0, 6.0);
  EXPECT_TRUE(periodic_state(network, cycle).runaway);
  const EffectType& radiation = *find_effect("radiation");
  std::vector<double> parameters(radiation.parameters.size());
  std::ranges::copy(radiation.example.parameters, parameters.begin());
  network.add_effect("radiation", radiation, std::vector<std::string>{"stator", "ambient"}, parameters);
  const PeriodicState result = periodic_state(network, cycle);
  ASSERT_FALSE(result.runaway);
  EXPECT_GT(result.mean_C[winding], 60.0);
  std::vector<Interval> days;
  for (int i = 0; i < 5000; ++i) {
    days.insert(days.end(), cycle.begin(), cycle.end());
  }
  TransientOptions options;
  options.start_C = result.start_C;
  EXPECT_NEAR(run_transient(network, network.values(), days, options).end_C[winding], result.start_C[winding], 1e-2);
}

TEST(PeriodicState, destroyed_in_the_first_cycle_says_when) {
  const std::vector<Interval> cycle = cycle_of(20.0, 100.0, 1e5);
  const PeriodicState result = periodic_state(kFlatMotor.network(), cycle);
  EXPECT_TRUE(result.runaway);
  EXPECT_TRUE(result.mean_C.empty());
  ASSERT_TRUE(result.destroyed_s.has_value());
  const auto above = [&](long double time_s) { return kFlatMotor.after(time_s, {25.0L, 25.0L}, cycle[0].at)[winding] - kDestroyed_C; };
  EXPECT_NEAR(*result.destroyed_s, static_cast<double>(bisected(0.0L, 100.0L, above)), 3.0);
}

TEST(PeriodicState, destroyed_over_many_cycles_is_a_runaway_too) {
  // At 0.99 the steady state would be 2200 °C.
  for (const double share : {0.99, 1.05}) {
    const PeriodicState result = periodic_state(kFlatMotor.network(), cycle_of(share * kFlatMotor.critical_current_A(), 10.0, 0.0));
    EXPECT_TRUE(result.runaway) << share;
    EXPECT_FALSE(result.destroyed_s.has_value()) << share;
  }
}

}  // namespace
}  // namespace heatsoak::thermal
