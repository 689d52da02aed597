// Peaks, limits and verdicts of a motor on one duty.
#include "select/evaluate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "given_demand.h"
#include "select/decision.h"
#include "simple_motor.h"
#include "support/seed_rate.h"
#include "support/source_folder.h"

namespace heatsoak::select {
namespace {

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
  base::ParameterValue parameter;
  parameter.value = 0.3;
  parameter.spread = base::Spread{base::Spread::Kind::range, 0.1, 0.6, false};
  robot.parameters["drive.driver_resistance"] = parameter;
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

TEST(Curves, enclose_the_nominal_run_and_reach_its_peak) {
  const motor::Motor motor = motor_of_file("maxon_ecx_flat_32l_48v");
  // The samples near the percentile need not peak in the same cell, so the band may stay some kelvins below the percentile of the peaks.
  EXPECT_TRUE(holds_for_share(0.95, 20, [&](std::uint64_t seed) {
    const MotorEvaluation result = evaluate_one(motor, robot_of_file("roboteam_twente_v2024"), duty_of_file("paper_intermittent"),
                                                {.samples = 100, .seed = seed, .with_curves = true, .with_bands = true});
    EXPECT_NEAR(*std::ranges::max_element(result.curves.winding_C), result.winding_peak_C.nominal, 1e-3);
    EXPECT_TRUE(std::ranges::is_sorted(result.curves.time_s));
    for (std::size_t i = 0; i < result.curves.band_time_s.size(); ++i) {
      EXPECT_LT(result.curves.winding_p05_C[i], result.curves.winding_p95_C[i]);
      EXPECT_LT(result.curves.stator_p05_C[i], result.curves.stator_p95_C[i]);
    }
    return std::abs(*std::ranges::max_element(result.curves.winding_p95_C) - *result.winding_peak_C.p95) <= 8.0;
  }));
}

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

// A motor that is cool in the nominal game and hot in others must not rank before one that is warm in all.
TEST(Ranking, of_a_drawn_duty_follows_the_95th_percentile) {
  MotorEvaluation varied;
  varied.motor_id = "varied";
  varied.winding_limit_C = 155.0;
  varied.winding_peak_C = {.nominal = 60.0, .p05 = 40.0, .p50 = 65.0, .p95 = 140.0};
  varied.margin_K = 95.0;
  varied.samples = 600;
  MotorEvaluation steady = varied;
  steady.motor_id = "steady";
  steady.winding_peak_C = {.nominal = 80.0, .p05 = 70.0, .p50 = 80.0, .p95 = 90.0};
  steady.margin_K = 75.0;
  for (const int games : {0, 75}) {
    varied.games = steady.games = games;
    std::vector<MotorEvaluation> results{steady, varied};
    sort_by_verdict(results);
    EXPECT_EQ(results.front().motor_id, games > 0 ? "steady" : "varied");
    EXPECT_EQ(nearest_margin_K(varied), games > 0 ? 15.0 : 95.0);
  }
  steady.stator_limit_C = 100.0;
  steady.stator_peak_C = {.nominal = 70.0, .p05 = 60.0, .p50 = 70.0, .p95 = 92.0};
  EXPECT_EQ(nearest_margin_K(steady), 8.0) << "the stator is nearer";
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

}  // namespace
}  // namespace heatsoak::select
