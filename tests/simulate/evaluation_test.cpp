// Tests run_evaluation(): order of results and ranks, and changes only on request or if the motor does not pass.
#include "simulate/evaluation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/diagnostic.h"
#include "robot/assumed_friction.h"
#include "support/shipped.h"

namespace heatsoak::simulate {
namespace {

duty::Duty shipped_duty(const std::string& id) { return duty::read_duty(kSource / "duty_profiles" / (id + ".toml")); }

EvaluationJob nominal_job(const std::string& duty, std::vector<motor::Motor> motors) {
  return {.robot = twente(), .duty = shipped_duty(duty), .motors = std::move(motors), .samples = 0};
}

TEST(Evaluation, closed_loop_needs_a_match) {
  EvaluationJob job = nominal_job("paper_intermittent", {ecx_32()});
  job.closed_loop.emplace();
  EXPECT_THROW(run_evaluation(job), base::Failure);
}

TEST(Evaluation, refuses_more_samples_than_possible) {
  EvaluationJob job = nominal_job("division_a_match", {ecx_32()});
  job.samples = 1'000'000;
  EXPECT_THROW(run_evaluation(job), base::Failure);
}

TEST(Evaluation, ranks_and_results_have_the_same_order) {
  EvaluationJob job = nominal_job("division_a_match", {ecx_32(), shipped_motor("maxon_ecx_flat_42m_24v")});
  job.closed_loop = ClosedLoopJob{.games = 1, .guard = GuardUse::off};
  job.with_changes = false;
  const EvaluationAnswer answer = run_evaluation(job);
  ASSERT_EQ(answer.results.size(), 2U);
  ASSERT_EQ(answer.ranks.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(answer.ranks[i].drives.motor_id, answer.results[i].motor_id);
  }
  EXPECT_LE(answer.ranks[0].verdict, answer.ranks[1].verdict);
  EXPECT_EQ(answer.worst_verdict(), answer.ranks[1].verdict);
  EXPECT_TRUE(answer.robot.friction.is_assumed || robot::has_friction(answer.robot));
}

TEST(Evaluation, reads_the_database_only_to_search_another_motor) {
  int reads = 0;
  EvaluationJob job = nominal_job("paper_intermittent", {shipped_motor("maxon_ec45_flat_70w_24v"), ecx_32()});
  job.database = [&reads] {
    ++reads;
    return std::vector<motor::Motor>{shipped_motor("maxon_ecx_flat_42m_48v")};
  };
  const EvaluationAnswer answer = run_evaluation(job);
  const auto own = std::ranges::find(answer.results, twente().drive.motor, &select::MotorEvaluation::motor_id);
  ASSERT_NE(own, answer.results.end());
  ASSERT_TRUE(answer.changes);
  EXPECT_EQ(answer.changes->motor_id, twente().drive.motor);
  EXPECT_EQ(reads, own->verdict != select::Verdict::pass ? 1 : 0);
  job.with_changes = false;
  reads = 0;
  EXPECT_FALSE(run_evaluation(job).changes);
  EXPECT_EQ(reads, 0);
}

// A game is played again for every change, which takes most of the time if only the headline is wanted.
TEST(Evaluation, searches_changes_for_a_motor_that_passes_only_if_they_are_wanted) {
  EvaluationJob job = nominal_job("paper_intermittent", {shipped_motor("maxon_ecx_flat_42m_24v")});
  job.samples = 600;
  ASSERT_EQ(run_evaluation(job).results.front().verdict, select::Verdict::pass);
  EXPECT_TRUE(run_evaluation(job).changes);
  job.with_changes_if_passing = false;
  EXPECT_FALSE(run_evaluation(job).changes);
  job.motors = {ecx_32()};
  EXPECT_TRUE(run_evaluation(job).changes) << "the headline names the largest improvement";
}

// Who names candidates wants to know which of them to take. Another motor is suggested only if none of them passes.
TEST(Evaluation, a_motor_of_the_database_is_suggested_only_if_no_chosen_one_passes) {
  const auto suggested_motor = [](std::vector<motor::Motor> motors) {
    EvaluationJob job = nominal_job("paper_intermittent", std::move(motors));
    job.has_chosen_motors = true;
    job.database = [] { return std::vector<motor::Motor>{shipped_motor("maxon_ecx_flat_42m_48v")}; };
    const EvaluationAnswer answer = run_evaluation(job);
    const auto found = std::ranges::find(answer.changes->effects, select::ChangedQuantity::motor, &select::ChangeEffect::quantity);
    return found == answer.changes->effects.end() ? std::string() : found->other_motor;
  };
  ASSERT_EQ(run_evaluation(nominal_job("paper_intermittent", {ecx_32()})).worst_verdict(), select::Verdict::fail);
  EXPECT_EQ(suggested_motor({ecx_32()}), "maxon_ecx_flat_42m_48v");
  EXPECT_EQ(suggested_motor({ecx_32(), shipped_motor("maxon_ecx_flat_42m_24v")}), "maxon_ecx_flat_42m_24v");
}

// A gate must not open by chance: the verdict that counts is the worst that the samples of any motor allow.
TEST(Evaluation, counts_the_worst_verdict_that_more_samples_could_give) {
  EvaluationAnswer answer = run_evaluation(nominal_job("paper_intermittent", {shipped_motor("maxon_ecx_flat_42m_24v")}));
  EXPECT_EQ(answer.worst_verdict(), select::Verdict::marginal) << "no samples were drawn";
  select::MotorEvaluation& motor = answer.results.front();
  motor.samples = 600;
  motor.games = 75;
  motor.probability_interval = select::Interval95{0.0, 0.04};
  motor.short_interval = select::Interval95{0.0, 0.04};
  EXPECT_EQ(answer.worst_verdict(), select::Verdict::pass);
  motor.verdict = select::Verdict::marginal;
  motor.probability_interval = select::Interval95{0.3, 0.5};
  EXPECT_EQ(answer.worst_verdict(), select::Verdict::marginal);
  motor.probability_interval = select::Interval95{0.3, 0.51};
  EXPECT_EQ(answer.worst_verdict(), select::Verdict::fail);
  motor.short_interval = select::Interval95{0.3, 0.51};
  EXPECT_EQ(answer.worst_verdict(), select::Verdict::infeasible);
  answer.ranks.resize(1);
  answer.ranks.front().verdict = select::Verdict::pass;
  EXPECT_EQ(answer.worst_verdict(), select::Verdict::pass) << "games in closed loop decide";
}

}  // namespace
}  // namespace heatsoak::simulate
