// Margin of the current up to a limit.
#include <gtest/gtest.h>

#include <cmath>

#include "given_demand.h"
#include "motor/datasheet_network.h"
#include "select/evaluate.h"
#include "simple_motor.h"
#include "support/source_folder.h"

namespace heatsoak::select {
namespace {

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

}  // namespace
}  // namespace heatsoak::select
