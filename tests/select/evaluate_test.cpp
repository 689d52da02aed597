#include "select/evaluate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "given_demand.h"
#include "motor/datasheet_network.h"
#include "select/decision.h"
#include "select/drive_profile.h"
#include "select/spread.h"
#include "support/source_folder.h"
#include "thermal/steady_state.h"

namespace heatsoak::select {
namespace {

motor::Motor motor_of_file(const std::string& id) { return motor::read_motor(kSource / "motor_db" / (id + ".toml")); }
robot::Robot robot_of_file(const std::string& id) { return robot::read_robot(kSource / "robot_core/robots" / (id + ".toml")); }
duty::Duty duty_of_file(const std::string& id) { return duty::read_duty(kSource / "duty_profiles" / (id + ".toml")); }

constexpr double kResistance_ohm = 0.5;
constexpr double kAlpha_per_K = 0.0039;
constexpr double kInner_K_per_W = 4.0;
constexpr double kOuter_K_per_W = 2.0;

void set_figure(motor::Motor& motor, std::string_view key, double motor::MotorValues::*value, const base::ParameterValue& figure) {
  motor.parameters[key] = figure;
  motor.nominal.*value = figure.value;
}

/// A motor that heats up within a minute or two, without drag.
motor::Motor simple_motor() {
  motor::Motor motor;
  motor.id = "simple";
  motor::MotorValues& values = motor.nominal;
  values.terminal_resistance_ohm = kResistance_ohm;
  values.torque_constant_Nm_per_A = 0.03;
  values.no_load_current_A = 0.0;
  values.temperature_coefficient_per_K = kAlpha_per_K;
  values.thermal_resistance_winding_stator_K_per_W = kInner_K_per_W;
  values.thermal_resistance_stator_ambient_K_per_W = kOuter_K_per_W;
  values.thermal_time_constant_winding_s = 4.0;
  values.thermal_time_constant_stator_s = 20.0;
  values.winding_limit_C = 155.0;
  return motor;
}

robot::Robot simple_robot() {
  robot::Robot robot;
  robot.id = "simple";
  robot.wheels.radius_m = 0.03;
  robot.battery.nominal_V = 24.0;
  return robot;
}

duty::Duty constant_current(double current_A, double duration_s = 600.0) {
  duty::Duty duty;
  duty.kind = duty::DutyKind::current;
  duty.ambient_C.value = 25.0;
  duty.load.value = 1.0;
  give(duty, {{duration_s, 0.0, 0.0, current_A}});
  return duty;
}

MotorEvaluation evaluate_one(const motor::Motor& motor, const robot::Robot& robot, const duty::Duty& duty,
                             const EvaluateOptions& options = {.samples = 0}) {
  return evaluate(robot, duty, duty.demand(robot, options.seed), std::span(&motor, 1), options).front();
}

/// Winding temperature by the closed form, (9) and (12), for a constant current.
double rest_C(double resistance_ohm, double current_A) {
  return thermal::on_off_steady_state({resistance_ohm, kAlpha_per_K, kInner_K_per_W, kOuter_K_per_W}, {current_A, 1.0, 0.0, 25.0})
      .winding_C;
}

double quantile_of(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

// --- nominal ----------------------------------------------------------------------------------------------

TEST(Evaluate, a_long_constant_current_peaks_at_the_closed_form) {
  const MotorEvaluation result = evaluate_one(simple_motor(), simple_robot(), constant_current(5.0));
  EXPECT_NEAR(result.winding_peak_C.nominal, rest_C(kResistance_ohm, 5.0), 1e-5);
  EXPECT_NEAR(result.margin_K, 155.0 - rest_C(kResistance_ohm, 5.0), 1e-5);
  EXPECT_NEAR(result.current_rms_A, 5.0, 1e-12);
  EXPECT_EQ(result.verdict, Verdict::pass);
  EXPECT_EQ(result.limiting_factor, LimitingFactor::none);
  EXPECT_FALSE(result.time_to_limit_s.has_value());
  EXPECT_FALSE(result.winding_peak_C.p50);
  EXPECT_FALSE(result.probability_over_limit);
}

TEST(Evaluate, rms_current_is_that_of_the_whole_duty) {
  duty::Duty duty = constant_current(5.0, 4.0);
  give(duty, {{4.0, 0.0, 0.0, 5.0}, {12.0, 0.0, 0.0, 0.0}});
  EXPECT_NEAR(evaluate_one(simple_motor(), simple_robot(), duty).current_rms_A, 2.5, 1e-14);
}

// Sinusoidal commutation makes 9/π² of the heat of block commutation, so its RMS current is 3/π. A limited current heats by its limited
// value.
TEST(Evaluate, rms_current_is_the_one_that_heats) {
  robot::Robot robot = simple_robot();
  robot.drive.commutation = robot::Commutation::sinusoidal;
  EXPECT_NEAR(evaluate_one(simple_motor(), robot, constant_current(5.0)).current_rms_A, 15.0 / std::numbers::pi, 1e-13);
  robot.drive.commutation = robot::Commutation::block;
  robot.drive.current_limit_A = 4.0;
  EXPECT_NEAR(evaluate_one(simple_motor(), robot, constant_current(5.0)).current_rms_A, 4.0, 1e-14);
}

TEST(Evaluate, too_hot_fails_and_says_when) {
  const MotorEvaluation result = evaluate_one(simple_motor(), simple_robot(), constant_current(8.0));
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_EQ(result.limiting_factor, LimitingFactor::winding_temperature);
  ASSERT_TRUE(result.time_to_limit_s.has_value());
  // A duty that ends at this time ends exactly at the limit.
  EXPECT_NEAR(evaluate_one(simple_motor(), simple_robot(), constant_current(8.0, *result.time_to_limit_s)).winding_peak_C.nominal, 155.0,
              1e-4);
}

TEST(Evaluate, stator_limit_is_a_limit_too) {
  motor::Motor motor = simple_motor();
  motor.nominal.stator_limit_C = 40.0;
  const MotorEvaluation result = evaluate_one(motor, simple_robot(), constant_current(5.0));
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_EQ(result.limiting_factor, LimitingFactor::stator_temperature);
}

TEST(Evaluate, runaway_is_destroyed) {
  const MotorEvaluation result = evaluate_one(simple_motor(), simple_robot(), constant_current(20.0));
  EXPECT_TRUE(result.destroyed);
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_EQ(result.winding_peak_C.nominal, thermal::kDestroyed_C) << "where the calculation ends, as for samples";
}

TEST(Evaluate, infeasible_by_voltage) {
  duty::Duty duty = constant_current(5.0);
  duty.kind = duty::DutyKind::torque;
  give(duty, {{1.0, 0.06, 790.0, 0.0}});  // 23.7 V of back-EMF leave 0.3 V, which drive 0.6 A of the demanded 2 A
  const MotorEvaluation result = evaluate_one(simple_motor(), simple_robot(), duty);
  EXPECT_EQ(result.verdict, Verdict::infeasible);
  EXPECT_EQ(result.limiting_factor, LimitingFactor::voltage);
  const double hot_ratio = 1.0 + kAlpha_per_K * (result.winding_peak_C.nominal - 25.0);
  EXPECT_NEAR(result.least_torque_share, 0.3 / hot_ratio, 1e-9);
}

// At 780 rad/s the back-EMF is 23.4 V. The remaining voltage drives 1.2 A through 0.5 Ω; braking allows 95 A.
TEST(Evaluate, a_current_that_brakes_is_helped_by_the_back_emf) {
  duty::Duty duty = constant_current(0.0);
  give(duty, {{600.0, 0.0, 780.0, -3.0}});
  const MotorEvaluation brakes = evaluate_one(simple_motor(), simple_robot(), duty);
  EXPECT_EQ(brakes.least_torque_share, 1.0);
  EXPECT_NEAR(brakes.winding_peak_C.nominal, rest_C(kResistance_ohm, 3.0), 0.1);
  give(duty, {{600.0, 0.0, 780.0, 3.0}});
  const MotorEvaluation drives = evaluate_one(simple_motor(), simple_robot(), duty);
  EXPECT_LT(drives.least_torque_share, 0.41);
}

// At 1000 rad/s the back-EMF would be 30 V, so no current flows in either direction.
TEST(Evaluate, a_speed_out_of_reach_takes_no_current) {
  duty::Duty duty = constant_current(0.0);
  give(duty, {{600.0, 0.0, 1000.0, 5.0}});
  const MotorEvaluation result = evaluate_one(simple_motor(), simple_robot(), duty);
  EXPECT_EQ(result.verdict, Verdict::infeasible);
  EXPECT_EQ(result.least_torque_share, 0.0);
  EXPECT_NEAR(result.winding_peak_C.nominal, 25.0, 1e-6);
}

TEST(Evaluate, infeasible_by_current) {
  robot::Robot robot = simple_robot();
  robot.drive.current_limit_A = 4.0;
  const MotorEvaluation result = evaluate_one(simple_motor(), robot, constant_current(5.0));
  EXPECT_EQ(result.verdict, Verdict::infeasible);
  EXPECT_EQ(result.limiting_factor, LimitingFactor::current);
  EXPECT_NEAR(result.least_torque_share, 0.8, 1e-12);
}

// The motor controller gives 5.1 A for a nominal demand of 5 A with a tolerance of ±10 %. In 40 % of the truncated normal distribution the
// demand is more than 2 % higher.
TEST(Evaluate, samples_that_cannot_deliver_make_a_motor_marginal) {
  duty::Duty duty = constant_current(5.0);
  duty.load.spread = base::Spread{base::Spread::Kind::tolerance, 0.9, 1.1, true};
  robot::Robot robot = simple_robot();
  robot.drive.current_limit_A = 5.1;
  motor::Motor motor = simple_motor();
  motor.nominal.winding_limit_C = 390.0;
  const MotorEvaluation result = evaluate_one(motor, robot, duty, {.samples = 4000});
  EXPECT_EQ(result.verdict, Verdict::marginal);
  EXPECT_EQ(result.limiting_factor, LimitingFactor::current);
  EXPECT_EQ(result.probability_over_limit, 0.0);
  // A shortfall of more than 0.5 % needs a load factor above 5.1/0.995/5 = 1.0251, which is 0.502 of two standard deviations of ±0.05.
  const double above = 0.5 * std::erfc(0.5025 / std::sqrt(2.0));
  const double cut_off = 0.5 * std::erfc(2.0 / std::sqrt(2.0));
  EXPECT_NEAR(*result.short_probability, (above - cut_off) / (1.0 - 2.0 * cut_off), 0.03);
}

// The voltage suffices for the cold winding. The hot winding needs 5 A · 0.5 Ω · 1.35… instead of 2.5 V.
TEST(Evaluate, infeasible_where_the_voltage_suffices_only_cold) {
  duty::Duty duty = constant_current(5.0);
  give(duty, {{600.0, 0.0, 21.4 / 0.03, 5.0}});  // 21.4 V + 2.5 V = 23.9 V
  const MotorEvaluation result = evaluate_one(simple_motor(), simple_robot(), duty);
  // Only 2.6 V remain for the hot winding. Its steady state satisfies ΔT = 6 K/W · (2.6 V)²/R(T).
  double rest_at_voltage_C = 25.0;
  for (int i = 0; i < 100; ++i) {
    rest_at_voltage_C = 25.0 + 6.0 * 2.6 * 2.6 / (kResistance_ohm * (1.0 + kAlpha_per_K * (rest_at_voltage_C - 25.0)));
  }
  EXPECT_NEAR(result.winding_peak_C.nominal, rest_at_voltage_C, 0.01);
  EXPECT_LT(result.winding_peak_C.nominal, rest_C(kResistance_ohm, 5.0) - 5.0);
  const double hot_ohm = kResistance_ohm * (1.0 + kAlpha_per_K * (result.winding_peak_C.nominal - 25.0));
  EXPECT_NEAR(result.highest_voltage_V, 21.4 + 5.0 * hot_ohm, 1e-6);
  EXPECT_NEAR(result.least_torque_share, 2.6 / hot_ohm / 5.0, 1e-6);
  // The current at 2.6 V falls from its value at 25 °C to its value in the hot winding.
  EXPECT_GT(result.current_rms_A, 2.6 / hot_ohm);
  EXPECT_LT(result.current_rms_A, std::min(5.0, 2.6 / kResistance_ohm));
  EXPECT_EQ(result.verdict, Verdict::infeasible);
  EXPECT_EQ(result.limiting_factor, LimitingFactor::voltage);
}

// --- margin -----------------------------------------------------------------------------------------------

/// Peak with all currents of the duty scaled by the factor.
double peak_of_scaled_C(const motor::Motor& motor, const robot::Robot& robot, const duty::Duty& duty, double factor) {
  const motor::MotorSample sample = motor::nominal_sample(motor);
  const thermal::Network network = motor::datasheet_network(motor, sample);
  std::vector<thermal::Interval> scaled = intervals(sample.values, robot, duty.kind, duty.demand(robot, 1).front(), nominal_sample(duty));
  for (thermal::Interval& interval : scaled) {
    interval.at.current_rms_A *= factor;
  }
  return thermal::run_transient(network, network.values(), scaled, {}).peak_C[0];
}

TEST(Margin, of_a_constant_current_is_that_of_the_closed_form) {
  const MotorEvaluation result = evaluate_one(simple_motor(), simple_robot(), constant_current(5.0));
  ASSERT_TRUE(result.margin_A.has_value());
  // ΔT = c/(1 − α·c) at the limit: c = 130/(1 + 0.0039·130) K = 6 K/W · 0.5 Ω · I²
  const double sustainable_A = std::sqrt(130.0 / (1.0 + 0.0039 * 130.0) / 3.0);
  EXPECT_NEAR(*result.margin_A, sustainable_A - 5.0, 1e-3);
}

TEST(Margin, scaling_the_current_by_it_lands_on_the_limit) {
  const robot::Robot robot = robot_of_file("roboteam_twente_v2024");
  const duty::Duty duty = duty_of_file("paper_intermittent");
  for (const char* id : {"maxon_ecx_flat_32l_48v", "maxon_ecx_flat_42m_24v", "nanotec_df45l024048_a2"}) {
    const motor::Motor motor = motor_of_file(id);
    const MotorEvaluation result = evaluate_one(motor, robot, duty);
    ASSERT_TRUE(result.margin_A.has_value()) << id;
    EXPECT_NEAR(peak_of_scaled_C(motor, robot, duty, 1.0 + *result.margin_A / result.current_rms_A), result.winding_limit_C, 0.02) << id;
    EXPECT_EQ(*result.margin_A > 0.0, result.margin_K > 0.0) << id;
  }
}

TEST(Margin, of_a_small_current_reaches_as_far_as_that_of_a_large_one) {
  const double sustainable_A = std::sqrt(130.0 / (1.0 + 0.0039 * 130.0) / 3.0);
  for (const double current_A : {0.01, 0.1, 1.0}) {
    const MotorEvaluation result = evaluate_one(simple_motor(), simple_robot(), constant_current(current_A));
    ASSERT_TRUE(result.margin_A.has_value());
    EXPECT_NEAR(*result.margin_A, sustainable_A - current_A, 0.01) << current_A;
  }
}

TEST(Margin, ends_where_the_driver_does) {
  robot::Robot robot = simple_robot();
  robot.drive.current_limit_A = 4.0;
  EXPECT_NEAR(*evaluate_one(simple_motor(), robot, constant_current(3.0)).margin_A, 1.0, 0.03);
  robot.drive.current_limit_A = 400.0;
  // The voltage for 4 A through 0.5 Ω with the winding at its limit.
  robot.drive.voltage_limit_V = 0.5 * 4.0 * (1.0 + 0.0039 * 130.0);
  EXPECT_NEAR(*evaluate_one(simple_motor(), robot, constant_current(3.0)).margin_A, 1.0, 0.03);
}

TEST(Margin, there_is_none_where_drag_alone_is_too_much) {
  motor::Motor motor = simple_motor();
  motor.nominal.no_load_current_A = 10.0;
  duty::Duty duty = constant_current(5.0);
  give(duty, {{600.0, 0.0, 300.0, 5.0}});  // 0.3 N m · 300 rad/s = 90 W across 2 K/W
  EXPECT_FALSE(evaluate_one(motor, simple_robot(), duty).margin_A.has_value());
}

// --- uncertainty ------------------------------------------------------------------------------------------

TEST(Samples, same_seed_same_bits_for_any_number_of_threads) {
  const robot::Robot robot = robot_of_file("roboteam_twente_v2024");
  duty::Duty duty = duty_of_file("paper_intermittent");
  shorten(duty, 60);
  const std::vector<motor::Motor> motors{motor_of_file("maxon_ecx_flat_32l_48v"), motor_of_file("maxon_ecx_flat_42m_24v"),
                                         motor_of_file("nanotec_df45l024048_a2")};
  EvaluateOptions options{.samples = 61, .seed = 7, .threads = 1, .with_curves = true, .with_bands = true};
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  const std::vector<MotorEvaluation> one = evaluate(robot, duty, duty.demand(robot, options.seed), motors, options);
  for (const int threads : {1, 2, 3, 8}) {
    options.threads = threads;
    const std::vector<MotorEvaluation> many = evaluate(robot, duty, duty.demand(robot, options.seed), motors, options);
    ASSERT_EQ(many.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].motor_id, many[i].motor_id);
      for (const auto& [a, b] :
           {std::pair{one[i].winding_peak_C, many[i].winding_peak_C}, std::pair{one[i].stator_peak_C, many[i].stator_peak_C}}) {
        EXPECT_EQ(bits(a.nominal), bits(b.nominal));
        EXPECT_EQ(bits(*a.p05), bits(*b.p05));
        EXPECT_EQ(bits(*a.p50), bits(*b.p50));
        EXPECT_EQ(bits(*a.p95), bits(*b.p95));
      }
      EXPECT_EQ(one[i].probability_over_limit, many[i].probability_over_limit);
      EXPECT_EQ(one[i].curves.winding_p95_C, many[i].curves.winding_p95_C);
      EXPECT_EQ(one[i].curves.winding_C, many[i].curves.winding_C);
    }
  }
}

TEST(Samples, another_seed_is_another_draw) {
  const motor::Motor motor = motor_of_file("maxon_ecx_flat_32l_48v");
  const robot::Robot robot = robot_of_file("roboteam_twente_v2024");
  duty::Duty duty = duty_of_file("paper_intermittent");
  shorten(duty, 20);
  const MotorEvaluation one = evaluate_one(motor, robot, duty, {.samples = 40, .seed = 1});
  const MotorEvaluation two = evaluate_one(motor, robot, duty, {.samples = 40, .seed = 2});
  EXPECT_NE(one.winding_peak_C.p50, two.winding_peak_C.p50);
  EXPECT_EQ(one.winding_peak_C.nominal, two.winding_peak_C.nominal);
}

TEST(Samples, without_any_spread_all_are_the_nominal_one) {
  const MotorEvaluation result = evaluate_one(simple_motor(), simple_robot(), constant_current(5.0), {.samples = 20});
  EXPECT_NEAR(*result.winding_peak_C.p05, result.winding_peak_C.nominal, 0.01);
  EXPECT_NEAR(*result.winding_peak_C.p95, result.winding_peak_C.nominal, 0.01);
  EXPECT_EQ(result.probability_over_limit, 0.0);
}

base::ParameterValue resistance_within_10_percent() {
  base::ParameterValue figure;
  figure.value = kResistance_ohm;
  figure.origin = base::Origin::measured;
  figure.spread = base::Spread{base::Spread::Kind::tolerance, 0.9 * kResistance_ohm, 1.1 * kResistance_ohm, true};
  return figure;
}

// Independent reference: the standard library's normal distribution, truncated at the tolerance by rejection, with the closed form.
TEST(Samples, spread_of_the_resistance_alone_is_that_of_an_independent_monte_carlo) {
  motor::Motor motor = simple_motor();
  set_figure(motor, "terminal_resistance", &motor::MotorValues::terminal_resistance_ohm, resistance_within_10_percent());
  const MotorEvaluation result = evaluate_one(motor, simple_robot(), constant_current(7.0), {.samples = 4000, .seed = 11});
  std::mt19937_64 engine(12);
  std::normal_distribution<double> share(0.0, 0.05);
  std::vector<double> peaks_C;
  int over = 0;
  while (peaks_C.size() < 200000) {
    const double deviation = share(engine);
    if (std::abs(deviation) <= 0.1) {
      peaks_C.push_back(rest_C(kResistance_ohm * (1.0 + deviation), 7.0));
      over += peaks_C.back() > 155.0 ? 1 : 0;
    }
  }
  const double width_K = quantile_of(peaks_C, 0.95) - quantile_of(peaks_C, 0.05);
  ASSERT_GT(width_K, 20.0);
  // The standard error of a 5 % quantile of 4000 draws is √(0.05·0.95/4000)/density ≈ 0.011 of the width; the tolerance is four of them.
  EXPECT_NEAR(*result.winding_peak_C.p05, quantile_of(peaks_C, 0.05), 0.05 * width_K);
  EXPECT_NEAR(*result.winding_peak_C.p50, quantile_of(peaks_C, 0.50), 0.03 * width_K);
  EXPECT_NEAR(*result.winding_peak_C.p95, quantile_of(peaks_C, 0.95), 0.05 * width_K);
  const double probability = static_cast<double>(over) / static_cast<double>(peaks_C.size());
  ASSERT_GT(probability, 0.02);
  EXPECT_NEAR(*result.probability_over_limit, probability, 4.0 * std::sqrt(probability * (1.0 - probability) / 4000.0));
}

TEST(Samples, median_of_symmetric_spreads_is_near_the_nominal_peak) {
  motor::Motor motor = simple_motor();
  set_figure(motor, "terminal_resistance", &motor::MotorValues::terminal_resistance_ohm, resistance_within_10_percent());
  base::ParameterValue inner;
  inner.value = kInner_K_per_W;
  inner.origin = base::Origin::measured;
  inner.spread = base::Spread{base::Spread::Kind::tolerance, 0.9 * kInner_K_per_W, 1.1 * kInner_K_per_W, true};
  set_figure(motor, "thermal_resistance_winding_stator", &motor::MotorValues::thermal_resistance_winding_stator_K_per_W, inner);
  const MotorEvaluation result = evaluate_one(motor, simple_robot(), constant_current(5.0), {.samples = 2000, .seed = 5});
  EXPECT_NEAR(*result.winding_peak_C.p50, result.winding_peak_C.nominal, 0.01 * (result.winding_peak_C.nominal - 25.0));
  EXPECT_LT(*result.winding_peak_C.p05, result.winding_peak_C.nominal - 3.0);
  EXPECT_GT(*result.winding_peak_C.p95, result.winding_peak_C.nominal + 3.0);
}

// In half of the draws the limit is uniform between 105 and 155 °C, so it is below 130 °C in a quarter of all draws.
TEST(Samples, a_limit_that_may_be_lower_makes_a_pass_marginal) {
  motor::Motor motor = simple_motor();
  base::ParameterValue limit;
  limit.value = 155.0;
  limit.spread = base::Spread{base::Spread::Kind::range, 105.0, 165.0, false};
  set_figure(motor, "winding_limit", &motor::MotorValues::winding_limit_C, limit);
  const double current_A = std::sqrt(105.0 / (1.0 + 0.0039 * 105.0) / 3.0);  // has its steady state at 130 °C
  const MotorEvaluation result = evaluate_one(motor, simple_robot(), constant_current(current_A), {.samples = 2000, .seed = 3});
  EXPECT_EQ(result.verdict, Verdict::marginal);
  EXPECT_EQ(result.limiting_factor, LimitingFactor::winding_temperature);
  EXPECT_NEAR(*result.probability_over_limit, 0.25, 4.0 * std::sqrt(0.25 * 0.75 / 2000.0));
}

TEST(Samples, ambient_of_the_duty_moves_the_peak_with_it) {
  duty::Duty duty = constant_current(5.0);
  duty.ambient_C.spread = base::Spread{base::Spread::Kind::range, 15.0, 35.0, false};
  const MotorEvaluation result = evaluate_one(simple_motor(), simple_robot(), duty, {.samples = 2000, .seed = 3});
  // T_W = T_A + c·(1+α(T_A−25))/(1−α·c) with c = 75 K: 1 + α·75/(1−α·75) = 1.4134 K per K. The 5th percentile of 15 … 35 °C is 16 °C.
  EXPECT_NEAR(*result.winding_peak_C.p05, result.winding_peak_C.nominal - 9.0 * 1.4134, 1.0);
  EXPECT_NEAR(*result.winding_peak_C.p95, result.winding_peak_C.nominal + 9.0 * 1.4134, 1.0);
}

// --- the paper's case -------------------------------------------------------------------------------------

TEST(PaperCase, ecx_flat_32l_peaks_at_162_C_and_fails_by_its_winding) {
  const MotorEvaluation result =
      evaluate_one(motor_of_file("maxon_ecx_flat_32l_48v"), robot_of_file("roboteam_twente_v2024"), duty_of_file("paper_intermittent"));
  EXPECT_NEAR(result.winding_peak_C.nominal, 162.0, 0.5);
  EXPECT_EQ(result.winding_limit_C, 155.0);
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_EQ(result.limiting_factor, LimitingFactor::winding_temperature);
  EXPECT_TRUE(result.time_to_limit_s.has_value());
  EXPECT_LT(*result.margin_A, 0.0);
  EXPECT_EQ(result.data_quality, "estimated");
}

TEST(PaperCase, the_larger_motors_pass) {
  const robot::Robot robot = robot_of_file("roboteam_twente_v2024");
  const duty::Duty duty = duty_of_file("paper_intermittent");
  for (const char* id : {"maxon_ecx_flat_42m_24v", "nanotec_df45l024048_a2"}) {
    const MotorEvaluation result = evaluate_one(motor_of_file(id), robot, duty);
    EXPECT_EQ(result.verdict, Verdict::pass) << id;
    EXPECT_GT(result.margin_K, 0.0) << id;
  }
}

TEST(Ranking, best_first) {
  std::vector<motor::Motor> motors;
  for (const auto& file : std::filesystem::directory_iterator(kSource / "motor_db")) {
    if (file.path().extension() == ".toml") {
      motors.push_back(motor::read_motor(file.path()));
    }
  }
  const robot::Robot robot = robot_of_file("roboteam_twente_v2024");
  const duty::Duty duty = duty_of_file("paper_intermittent");
  const std::vector<MotorEvaluation> all = evaluate(robot, duty, duty.demand(robot, 1), motors, {.samples = 0});
  ASSERT_EQ(all.size(), motors.size());
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_LE(all[i - 1].verdict, all[i].verdict);
    if (all[i - 1].verdict == all[i].verdict) {
      EXPECT_GE(all[i - 1].margin_K, all[i].margin_K);
    }
  }
}

TEST(Progress, counts_up_to_all_of_the_work) {
  const motor::Motor motor = simple_motor();
  std::size_t before = 0;
  std::size_t all = 0;
  const duty::Duty duty = constant_current(5.0);
  evaluate(simple_robot(), duty, duty.demand(simple_robot(), 1), std::span(&motor, 1), {.samples = 50},
           [&](std::size_t done, std::size_t total) {
             EXPECT_EQ(done, before + 1);
             before = done;
             all = total;
           });
  EXPECT_EQ(before, all);
  EXPECT_GT(all, 0U);
}

// --- curves -----------------------------------------------------------------------------------------------

TEST(Curves, enclose_the_nominal_run_and_reach_its_peak) {
  const motor::Motor motor = motor_of_file("maxon_ecx_flat_32l_48v");
  const MotorEvaluation result = evaluate_one(motor, robot_of_file("roboteam_twente_v2024"), duty_of_file("paper_intermittent"),
                                              {.samples = 100, .seed = 1, .with_curves = true, .with_bands = true});
  EXPECT_NEAR(*std::ranges::max_element(result.curves.winding_C), result.winding_peak_C.nominal, 1e-3);
  EXPECT_TRUE(std::ranges::is_sorted(result.curves.time_s));
  for (std::size_t i = 0; i < result.curves.band_time_s.size(); ++i) {
    EXPECT_LT(result.curves.winding_p05_C[i], result.curves.winding_p95_C[i]);
    EXPECT_LT(result.curves.stator_p05_C[i], result.curves.stator_p95_C[i]);
  }
  EXPECT_NEAR(*std::ranges::max_element(result.curves.winding_p95_C), *result.winding_peak_C.p95, 8.0);
}

std::vector<duty::WheelDemand> steady_wheels(double torque_Nm, double duration_s) {
  duty::WheelDemand idle{.wheel = "idle", .bins = {duty::constant_bin(duration_s, 0.0, 0.0, 0.0)}, .points = {}};
  duty::WheelDemand busy{.wheel = "busy", .bins = {duty::constant_bin(duration_s, torque_Nm, 0.0, 0.0)}, .points = {}};
  return {idle, busy};
}

// The steady state with I = U/(R·(1 + α·ΔT) + R_driver) is found by bisection, independent of the program's method.
TEST(Evaluate, resistance_of_the_driver_takes_its_share_of_the_voltage) {
  const motor::Motor motor = simple_motor();
  robot::Robot robot = simple_robot();
  robot.battery.nominal_V = 1.5;
  robot.drive.driver_resistance_ohm = 0.3;
  double low_K = 0.0;
  double high_K = 1000.0;
  for (int i = 0; i < 60; ++i) {
    const double rise_K = 0.5 * (low_K + high_K);
    const double resistance_ohm = kResistance_ohm * (1.0 + kAlpha_per_K * rise_K);
    const double current_A = 1.5 / (resistance_ohm + 0.3);
    (current_A * current_A * resistance_ohm * (kInner_K_per_W + kOuter_K_per_W) > rise_K ? low_K : high_K) = rise_K;
  }
  const duty::Duty duty = constant_current(5.0);
  const MotorEvaluation result = evaluate(robot, duty, duty.demand(robot, 1), std::span(&motor, 1), {.samples = 0}).front();
  EXPECT_NEAR(result.winding_peak_C.nominal, 25.0 + low_K, 0.01);
}

TEST(Evaluate, declared_range_of_the_driver_s_resistance_is_propagated) {
  const motor::Motor motor = simple_motor();
  robot::Robot robot = simple_robot();
  robot.battery.nominal_V = 1.5;
  robot.drive.driver_resistance_ohm = 0.3;
  const auto spread_K = [&] {
    const duty::Duty duty = constant_current(5.0);
    const MotorEvaluation result = evaluate(robot, duty, duty.demand(robot, 1), std::span(&motor, 1), {.samples = 200}).front();
    return *result.winding_peak_C.p95 - *result.winding_peak_C.p05;
  };
  EXPECT_NEAR(spread_K(), 0.0, 1e-9);
  base::ParameterValue figure;
  figure.value = 0.3;
  figure.spread = base::Spread{base::Spread::Kind::range, 0.1, 0.6, false};
  robot.parameters["drive.driver_resistance"] = figure;
  EXPECT_GT(spread_K(), 5.0);
}

TEST(Evaluate, nearer_limit_decides_margins) {
  motor::Motor motor = simple_motor();
  const robot::Robot robot = simple_robot();
  const duty::Duty duty = constant_current(3.0, 2000.0);
  const MotorEvaluation without = evaluate(robot, duty, duty.demand(robot, 1), std::span(&motor, 1), {.samples = 0}).front();
  EXPECT_FALSE(without.stator_margin_K.has_value());
  EXPECT_EQ(nearest_margin_K(without), without.margin_K);
  motor.nominal.stator_limit_C = without.stator_peak_C.nominal + 5.0;
  const MotorEvaluation with = evaluate(robot, duty, duty.demand(robot, 1), std::span(&motor, 1), {.samples = 0}).front();
  EXPECT_NEAR(nearest_margin_K(with), 5.0, 1e-6);
  EXPECT_LT(*with.margin_A, *without.margin_A);
  // This additional current brings the stator to its limit.
  const duty::Duty more = constant_current(3.0 + *with.margin_A, 2000.0);
  const MotorEvaluation at_limit = evaluate(robot, more, more.demand(robot, 1), std::span(&motor, 1), {.samples = 0}).front();
  EXPECT_NEAR(at_limit.stator_peak_C.nominal, *motor.nominal.stator_limit_C, 0.05);
}

// Clopper and Pearson's interval for 10 of 100 is 0.0490 to 0.1762. The binomial distribution gives the percentile's ranks among 100.
TEST(Spread, sampling_error_is_that_of_the_textbook) {
  std::vector<double> samples_C(100);
  std::vector<char> over(100, 0);
  for (std::size_t i = 0; i < 100; ++i) {
    samples_C[i] = static_cast<double>(99 - i);
    over[i] = i < 10 ? 1 : 0;
  }
  const DrawIntervals intervals = sample_intervals(samples_C, over);
  EXPECT_NEAR(intervals.probability.low, 0.0490, 5e-5);
  EXPECT_NEAR(intervals.probability.high, 0.1762, 5e-5);
  EXPECT_GE(intervals.p95.low, 88.0);
  EXPECT_LE(intervals.p95.low, 91.0);
  EXPECT_GE(intervals.p95.high, 98.0);
}

TEST(Spread, few_samples_tell_no_upper_end) {
  const std::vector<double> samples_C(71, 80.0);
  const std::vector<char> over(71, 0);
  EXPECT_TRUE(std::isinf(sample_intervals(samples_C, over).p95.high));
  const std::vector<double> more_C(72, 80.0);
  EXPECT_EQ(sample_intervals(more_C, std::vector<char>(72, 0)).p95.high, 80.0);
}

// If none of n draws exceeds the limit, up to 3/n of all draws may do so (rule of three).
TEST(Spread, draws_that_are_all_alike_do_not_rule_the_others_out) {
  for (const std::size_t draws : {1U, 6U, 62U}) {
    const std::vector<double> samples_C(8 * draws, 80.0);
    const std::vector<char> none(8 * draws, 0);
    const std::vector<char> all(8 * draws, 1);
    const double unseen = 1.0 - std::pow(0.05, 1.0 / static_cast<double>(draws));
    EXPECT_NEAR(draw_intervals(samples_C, none, {draws, 8, 1}).probability.high, unseen, 1e-12);
    EXPECT_NEAR(draw_intervals(samples_C, all, {draws, 8, 1}).probability.low, 1.0 - unseen, 1e-12);
    EXPECT_EQ(std::isinf(draw_intervals(samples_C, none, {draws, 8, 1}).p95.high), draws < 20);
  }
}

// Blocks of samples use the draws in turn. Without other spread every peak has a closed form.
TEST(Evaluate, draws_of_a_duty_are_shared_by_the_samples) {
  const motor::Motor motor = simple_motor();
  const robot::Robot robot = simple_robot();
  duty::Duty duty = constant_current(1.0);
  duty.kind = duty::DutyKind::torque;
  const std::vector<double> torques_Nm{0.03, 0.06, 0.09, 0.12};  // currents of 1 A to 4 A
  std::vector<duty::WheelDemand> draws;
  for (const double torque_Nm : torques_Nm) {
    draws.push_back(steady_wheels(torque_Nm, 400.0).back());
  }
  const std::vector<duty::WheelDemand> nominal = steady_wheels(0.03, 600.0);
  EvaluateOptions options{.samples = 4 * 8 * 3, .with_curves = true, .with_bands = true};
  options.draws = draws;
  const MotorEvaluation result = evaluate(robot, duty, nominal, std::span(&motor, 1), options).front();
  EXPECT_NEAR(result.winding_peak_C.nominal, rest_C(kResistance_ohm, 1.0), 0.01);
  EXPECT_NEAR(*result.winding_peak_C.p05, rest_C(kResistance_ohm, 1.0), 0.01);
  EXPECT_NEAR(*result.winding_peak_C.p95, rest_C(kResistance_ohm, 4.0), 0.01);
  EXPECT_NEAR(*result.winding_peak_C.p50, 0.5 * (rest_C(kResistance_ohm, 2.0) + rest_C(kResistance_ohm, 3.0)), 0.01);
  // All four draws may be the same one: (1/4)^4 is less than 1/40. The interval therefore spans nearly all of them, and its upper end is
  // unknown.
  EXPECT_TRUE(std::isinf(result.winding_p95_interval_C->high));
  EXPECT_LE(result.winding_p95_interval_C->low, rest_C(kResistance_ohm, 3.0) + 0.01);
  // All draws end before the nominal duty, so the band in the chart also ends there.
  ASSERT_FALSE(result.curves.band_time_s.empty());
  EXPECT_LT(result.curves.band_time_s.back(), 410.0);
  EXPECT_EQ(result.curves.band_time_s.size(), result.curves.winding_p95_C.size());
  options.threads = 3;
  const MotorEvaluation again = evaluate(robot, duty, nominal, std::span(&motor, 1), options).front();
  EXPECT_EQ(again.winding_peak_C.p50, result.winding_peak_C.p50);
  EXPECT_EQ(again.curves.winding_p95_C, result.curves.winding_p95_C);
}

/// Returns motors whose limit is below the given peak in a share of the samples. The share is either near the 5 % of a verdict or far from
/// it.
motor::Motor limited_between(double low_C, double high_C) {
  motor::Motor motor = simple_motor();
  base::ParameterValue limit;
  limit.value = 155.0;
  limit.spread = base::Spread{base::Spread::Kind::range, low_C, high_C, false};
  set_figure(motor, "winding_limit", &motor::MotorValues::winding_limit_C, limit);
  return motor;
}

TEST(UntilDecided, takes_more_samples_only_near_a_threshold) {
  const duty::Duty duty = constant_current(std::sqrt(105.0 / (1.0 + 0.0039 * 105.0) / 3.0), 60.0);
  motor::Motor near = limited_between(105.0, 165.0);
  near.id = "near";
  const double peak_C = evaluate_one(near, simple_robot(), duty).winding_peak_C.nominal;
  // Half of the draws are uniform between the lower end and the nominal limit, so 6.5 % of all draws are below the peak.
  near = limited_between(peak_C - 0.13 / 0.87 * (155.0 - peak_C), 165.0);
  near.id = "near";
  motor::Motor far = simple_motor();
  far.id = "far";
  const std::vector<motor::Motor> motors{near, far};
  std::vector<duty::WheelDemand> draws;
  const std::vector<MotorEvaluation> results =
      evaluate_until_decided(simple_robot(), duty, duty.demand(simple_robot(), 1), motors,
                             {.samples = first_samples(duty.shape_data->has_unknowns())}, most_samples(duty), draws);
  const auto of = [&](std::string_view id) { return *std::ranges::find(results, id, &MotorEvaluation::motor_id); };
  EXPECT_EQ(of("far").samples, 500);
  EXPECT_EQ(of("far").verdict, Verdict::pass);
  EXPECT_GT(of("near").samples, 500);
  EXPECT_FALSE(of("near").samples_needed);
  EXPECT_EQ(of("near").verdict, Verdict::marginal);
  // A single request with the final number of samples must give the same answer.
  const MotorEvaluation at_once = evaluate_one(near, simple_robot(), duty, {.samples = of("near").samples});
  EXPECT_EQ(at_once.verdict, of("near").verdict);
  EXPECT_EQ(at_once.probability_over_limit, of("near").probability_over_limit);
  EXPECT_FALSE(at_once.samples_needed);
}

/// A load of the wheel that is drawn: a share of the draws is far above the motor's limit, all others far below.
class DrawnLoad final : public duty::DutyShape {
 public:
  explicit DrawnLoad(double heavy_share) : heavy_share_(heavy_share) {}
  [[nodiscard]] std::vector<duty::WheelDemand> demand(const robot::Robot& /*robot*/, std::uint64_t /*seed*/) const override {
    return steady_wheels(kLight_Nm, 400.0);
  }
  [[nodiscard]] bool has_unknowns() const override { return true; }
  [[nodiscard]] duty::WheelDemand draw(const robot::Robot& /*robot*/, std::uint64_t /*seed*/, std::uint64_t draw) const override {
    const double before = std::floor(heavy_share_ * static_cast<double>(draw));
    const bool is_heavy = std::floor(heavy_share_ * static_cast<double>(draw + 1)) > before;
    return steady_wheels(is_heavy ? kHeavy_Nm : kLight_Nm, 400.0).back();
  }

 private:
  static constexpr double kLight_Nm = 0.03;
  static constexpr double kHeavy_Nm = 0.3;
  double heavy_share_;
};

MotorEvaluation until_decided(double heavy_share) {
  duty::Duty duty = constant_current(1.0);
  duty.kind = duty::DutyKind::torque;
  duty.shape_data = std::make_shared<DrawnLoad>(heavy_share);
  const motor::Motor motor = simple_motor();
  std::vector<duty::WheelDemand> draws;
  const MotorEvaluation result =
      evaluate_until_decided(simple_robot(), duty, duty.demand(simple_robot(), 1), std::span(&motor, 1),
                             {.samples = first_samples(duty.shape_data->has_unknowns())}, most_samples(duty), draws)
          .front();
  EXPECT_EQ(draws.size(), static_cast<std::size_t>(result.games));
  return result;
}

// A game takes a tenth of a second, so the number of games limits how long an answer takes. No heavy game among 75 decides, and 20 % do.
// For 37.5 % the upper end of Clopper and Pearson's interval is 0.51 after 75 games and 0.49 after 150: most games pass. 4 % need
// thousands.
TEST(UntilDecided, plays_more_games_only_if_few_of_them_decide) {
  EXPECT_EQ(until_decided(0.0).games, 75);
  EXPECT_EQ(until_decided(0.2).games, 75);
  const MotorEvaluation soon = until_decided(0.375);
  EXPECT_EQ(soon.games, 150);
  EXPECT_FALSE(soon.samples_needed);
  const MotorEvaluation late = until_decided(0.04);
  EXPECT_EQ(late.games, 75);
  ASSERT_TRUE(late.samples_needed);
  EXPECT_GT(*late.samples_needed, 8 * 150);
}

TEST(UntilDecided, as_many_games_are_played_as_are_asked_for) {
  const duty::Duty duty = duty_of_file("division_b_match");
  EXPECT_EQ(draw_count(duty, 4074), 510);
  EXPECT_EQ(draw_count(duty, most_samples_at_all(true)), most_samples_at_all(true) / 8);
}

TEST(Evaluate, draws_are_the_same_for_every_number_of_threads) {
  const duty::Duty duty = duty_of_file("division_b_match");
  const robot::Robot robot = robot_of_file("roboteam_twente_v2024");
  EXPECT_EQ(draw_count(duty, 0), 0);
  EXPECT_EQ(draw_count(duty, 9), 2);
  EXPECT_EQ(draw_count(constant_current(1.0), 500), 0);
  const auto torques = [&](int threads) {
    std::vector<double> all_Nm;
    for (const duty::WheelDemand& wheel : draw_demands(duty, robot, 5, 3, threads)) {
      all_Nm.push_back(wheel.bins.at(100).torque_rms_Nm);
      all_Nm.push_back(wheel.duration_s());
    }
    return all_Nm;
  };
  EXPECT_EQ(torques(1), torques(3));
}

}  // namespace
}  // namespace heatsoak::select
