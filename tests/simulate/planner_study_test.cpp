// Compares both planners in closed loop: cases in which they must agree, and cases with a physically known result.
#include "simulate/planner_study.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "base/diagnostic.h"
#include "duty/match/match_duty.h"
#include "firmware/core_config.h"
#include "jump_energy.h"
#include "simulate/match_run.h"
#include "support/shipped.h"

namespace heatsoak::simulate {
namespace {

constexpr double kBangBang = std::numeric_limits<double>::infinity();

// A very high jerk must match bang-bang, which other code plans. The control rate is 1 kHz because the two would differ at 100 Hz: the
// first command has no acceleration and is held.
TEST(PlannerStudy, much_jerk_is_bang_bang) {
  robot::Robot robot = twente();
  robot.drive.control_rate_Hz = 1000.0;
  const std::vector<StudyCase> cases{{2.0, 10000.0}, {2.0, kBangBang}};
  const std::vector<StudyResult> results = study_planners(robot, ecx_32(), cases, ideal_drive(), 2);
  const auto& [jerk, bang] = std::tie(results[0], results[1]);
  EXPECT_NEAR(jerk.planned_s, bang.planned_s, 0.005);
  EXPECT_NEAR(jerk.settled_s, bang.settled_s, 0.01);
  EXPECT_NEAR(jerk.slip_share, bang.slip_share, 0.02 * bang.slip_share);
  EXPECT_NEAR(jerk.copper_J, bang.copper_J, 0.01 * bang.copper_J);
  EXPECT_NEAR(jerk.tracking_rms_m, bang.tracking_rms_m, 0.05 * bang.tracking_rms_m);
}

TEST(PlannerStudy, below_the_grip_nothing_slides_and_beyond_it_the_jerk_limit_helps) {
  const double grip = grip_m_per_s2(twente());
  const std::vector<StudyCase> cases{{0.6 * grip, 6.0}, {0.6 * grip, kBangBang}, {1.5 * grip, 6.0}, {1.5 * grip, kBangBang}};
  const std::vector<StudyResult> results = study_planners(twente(), ecx_32(), cases, ideal_drive(), 2);
  EXPECT_LT(results[0].sliding_share, 1e-3);
  EXPECT_LT(results[1].sliding_share, 1e-3);
  EXPECT_GT(results[3].sliding_share, 10.0 * results[2].sliding_share);
  EXPECT_GT(results[3].overshoot_mean_m, 5.0 * results[2].overshoot_mean_m);
  EXPECT_GT(results[3].copper_J, results[2].copper_J);
}

// The first wheel that slides carries less than its share of the load. μ·g is therefore unreachable, and grip grows with μ.
TEST(PlannerStudy, grip_is_that_of_the_first_wheel) {
  robot::Robot robot = twente();
  const double grip = grip_m_per_s2(robot);
  EXPECT_LT(grip, robot.traction.coefficient_ratio.value() * robot::kGravity_m_per_s2);
  robot.body.center_of_gravity_height_m = 0.0;
  const double flat = grip_m_per_s2(robot);
  EXPECT_GT(flat, grip);  // no load transfer away from the pushing wheels
  robot.traction.coefficient_ratio.value() *= 0.5;
  EXPECT_NEAR(grip_m_per_s2(robot), 0.5 * flat, 1e-4 * flat);
}

// Twente uses two thirds of its grip, the TIGERs use all of it.
TEST(JerkSweep, has_no_acceleration_twice) {
  const robot::Robot tigers = robot::read_robot(kSource / "robot_core/robots/tigers_v2020.toml");
  for (const auto& [robot, count] : {std::pair{twente(), 3U}, std::pair{tigers, 2U}}) {
    std::vector<double> accelerations_m_per_s2;
    for (const StudyCase& each : jerk_sweep(robot)) {
      if (std::isinf(each.jerk_m_per_s3)) {
        accelerations_m_per_s2.push_back(each.acceleration_m_per_s2);
      }
    }
    ASSERT_EQ(accelerations_m_per_s2.size(), count) << robot.id;
    EXPECT_EQ(accelerations_m_per_s2.front(), std::min(robot.limits.acceleration_m_per_s2.value(), robot.limits.braking_m_per_s2.value()));
    EXPECT_GT(accelerations_m_per_s2.back(), 1.4 * grip_m_per_s2(robot));
  }
}

// A plan from rest to rest over the distance d takes 2·√(d/a) if it does not reach the speed limit, and d/v + v/a if it does. A jerk limit
// makes it longer, and more so the lower it is.
TEST(JerkSweep, plans_take_longer_with_less_jerk_and_the_shortest_has_a_closed_form) {
  const robot::Robot robot = shipped_robot("tigers_v2020");
  const JerkSweep sweep = sweep_jerk(robot, shipped_motor(robot.drive.motor), true, 1);
  const std::vector<StudyCase> cases = jerk_sweep(sweep.robot);
  ASSERT_EQ(sweep.results.size(), cases.size());
  const double fastest_m_per_s = robot.limits.speed_m_per_s.value();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const StudyResult& each = sweep.results[i];
    EXPECT_EQ(each.limits.acceleration_m_per_s2, cases[i].acceleration_m_per_s2);
    EXPECT_EQ(each.limits.jerk_m_per_s3, cases[i].jerk_m_per_s3);
    EXPECT_GT(each.copper_J, 0.0);
    if (i > 0 && each.limits.acceleration_m_per_s2 == cases[i - 1].acceleration_m_per_s2) {
      EXPECT_LT(each.planned_s, sweep.results[i - 1].planned_s) << each.limits.jerk_m_per_s3;
    }
    if (each.is_bang_bang()) {
      double expected_s = 0.0;
      for (const double distance_m : {0.5, 1.0, 2.0}) {
        const double a = each.limits.acceleration_m_per_s2;
        const double top_m_per_s = std::min(fastest_m_per_s, std::sqrt(a * distance_m));
        expected_s += (distance_m / top_m_per_s + top_m_per_s / a) / 3.0;
      }
      EXPECT_NEAR(each.planned_s, expected_s, 0.02 * expected_s) << each.limits.acceleration_m_per_s2;
    }
  }
}

TEST(JerkSweep, needs_the_rotor_inertia) {
  motor::Motor motor = ecx_32();
  motor.nominal.rotor_inertia_kg_m2.reset();
  EXPECT_THROW(sweep_jerk(twente(), motor, true, 1), base::Failure);
}

/// One game, driven with both planners.
struct BothPlanners {
  MatchRun jerk, bang;
  double jerk_jumps_J = 0.0;
  double bang_jumps_J = 0.0;
};

BothPlanners drive_both(const duty::MatchInputs& inputs, const robot::Robot& robot, std::uint64_t seed) {
  const motor::Motor motor = ecx_32();
  const Game game = play_game(inputs, robot, seed);
  const robot_core::Config core = firmware::make_core_config(robot, motor.nominal, {});
  MatchRunOptions options;
  options.drive = real_drive(robot, 1);
  JumpEnergy jerk_jumps(robot, motor);
  MatchRun jerk = run_match(game, robot, motor, core, options, [&](const LoopMoment& moment) { jerk_jumps.take(*moment.out); });
  options.planner = duty::Planner::bang_bang;
  JumpEnergy bang_jumps(robot, motor);
  MatchRun bang = run_match(game, robot, motor, core, options, [&](const LoopMoment& moment) { bang_jumps.take(*moment.out); });
  return {std::move(jerk), std::move(bang), jerk_jumps.unresolved_J(), bang_jumps.unresolved_J()};
}

TEST(MatchRun, both_planners_drive_the_same_game) {
  constexpr std::uint64_t kGames = 3;
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/division_a_match.toml");
  duty::MatchInputs inputs = dynamic_cast<const duty::MatchDuty&>(*duty.shape_data).inputs();
  const robot::Robot robot = twente();
  std::uint64_t faster = 0;
  for (std::uint64_t seed = 1; seed <= kGames; ++seed) {
    const duty::MatchLoad ideal = duty::play_match(inputs, inputs.nominal(), robot, seed, duty::Planner::jerk_limited);
    const auto [jerk, bang, jerk_jumps_J, bang_jumps_J] = drive_both(inputs, robot, seed);
    double phases_J = 0.0;
    double phases_s = 0.0;
    for (std::size_t i = 0; i < jerk.phases.size(); ++i) {
      EXPECT_EQ(jerk.phases[i].time_s, bang.phases[i].time_s) << seed;
      EXPECT_NEAR(jerk.phases[i].time_s, ideal.phases[i].time_s, 0.5) << seed;
      phases_J += jerk.phases[i].copper_J;
      phases_s += jerk.phases[i].time_s;
    }
    EXPECT_NEAR(phases_J, jerk.score.energy.copper_J, 1e-6 * phases_J) << seed;
    EXPECT_NEAR(phases_s, ideal.duration_s, 0.002) << seed;
    EXPECT_NEAR(jerk.score.distance_m, ideal.distance_m, 0.02 * ideal.distance_m) << seed;
    EXPECT_NEAR(jerk.score.energy.residual_J(), 0.0, 1e-4 * jerk.score.energy.battery_J + jerk_jumps_J) << seed;
    EXPECT_LT(jerk_jumps_J, 5e-3 * jerk.score.energy.battery_J) << seed;
    EXPECT_NEAR(bang.score.energy.residual_J(), 0.0, 1e-4 * bang.score.energy.battery_J + bang_jumps_J) << seed;
    // The faster planner makes more heat. The winding's peak depends on single duels and is not compared.
    faster += bang.score.distance_m > jerk.score.distance_m && bang.score.energy.copper_J > jerk.score.energy.copper_J ? 1 : 0;
  }
  EXPECT_EQ(faster, kGames);
}

}  // namespace
}  // namespace heatsoak::simulate
