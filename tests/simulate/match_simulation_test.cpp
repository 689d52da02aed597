// The answer of `simulate` for a match: the table, the rows of the chart and the verdict must agree with the score of the run.
#include "simulate/match_simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "base/diagnostic.h"
#include "support/shipped.h"

namespace heatsoak::simulate {
namespace {

MatchJob short_job() {
  MatchJob job{.robot = twente(), .motor = shipped_motor("maxon_ecx_flat_42m_24v"), .duty = {}};
  job.duty = duty::read_duty(kSource / "duty_profiles/division_b_match.toml");
  job.guard = GuardUse::off;
  return job;
}

/// Returns a column of the table.
std::vector<double> column(const std::string& csv, const std::string& name) {
  const auto cells_of = [](const std::string& line) {
    std::istringstream stream(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(stream, cell, ',');) {
      cells.push_back(cell);
    }
    return cells;
  };
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> header = cells_of(line);
  const auto place = static_cast<std::size_t>(std::ranges::find(header, name) - header.begin());
  std::vector<double> values;
  while (std::getline(lines, line)) {
    values.push_back(std::stod(cells_of(line).at(place)));
  }
  return values;
}

TEST(MatchSimulation, table_and_rows_are_those_of_the_scored_run) {
  MatchJob job = short_job();
  job.with_table = true;
  job.with_rows = true;
  job.every_s = 0.5;
  const MatchSimulation answer = simulate_match(job);
  ASSERT_EQ(answer.runs.size(), 1U);
  const DrivenMatch& only = answer.runs.front();
  const std::vector<double> time_s = column(only.csv, "time_s");
  ASSERT_GT(time_s.size(), 2U);
  for (std::size_t row = 1; row < time_s.size(); ++row) {
    EXPECT_NEAR(time_s[row] - time_s[row - 1], job.every_s, 1e-6);
  }
  EXPECT_NEAR(time_s.back(), only.run.score.time_s, 2.0 * job.every_s);
  double hottest_C = 0.0;
  double rows_C = 0.0;
  for (int wheel = 1; wheel <= 4; ++wheel) {
    const std::vector<double> winding_C = column(only.csv, "winding_" + std::to_string(wheel) + "_C");
    hottest_C = std::max(hottest_C, std::ranges::max(winding_C));
  }
  for (const MatchRow& row : only.rows) {
    rows_C = std::max(rows_C, std::ranges::max(row.winding_peak_C));
  }
  // Rows of the table are moments, so that they miss short peaks; rows of the chart hold the peak since the row before.
  EXPECT_LE(hottest_C, only.run.score.winding_peak_C + 1e-3);
  EXPECT_GT(hottest_C, only.run.score.winding_peak_C - 2.0);
  EXPECT_NEAR(rows_C, only.run.score.winding_peak_C, 1e-3);
}

// A motor whose winding limit is below the peak of the same drive fails. Without a guard no part of the drive reads the limit.
TEST(MatchSimulation, fails_over_the_limit_and_drives_the_same) {
  MatchJob job = short_job();
  const MatchSimulation cool = simulate_match(job);
  EXPECT_EQ(cool.verdict(), select::Verdict::pass);
  const double peak_C = cool.runs.front().run.score.winding_peak_C;
  ASSERT_LT(peak_C, job.motor.nominal.winding_limit_C);
  job.motor.nominal.winding_limit_C = peak_C - 0.1;
  const MatchSimulation hot = simulate_match(job);
  EXPECT_EQ(hot.verdict(), select::Verdict::fail);
  EXPECT_EQ(hot.runs.front().run.score.winding_peak_C, peak_C);
}

// The heat of a run is known to 10 % (one standard deviation). The firmware gets the nominal motor, so the drive stays nearly the same.
TEST(MatchSimulation, is_marginal_if_only_the_upper_end_of_the_band_is_too_hot) {
  MatchJob job = short_job();
  EXPECT_FALSE(simulate_match(job).runs.front().upper);
  job.motor.fit.emplace();
  job.motor.fit->band = motor::ForecastBand{{0.0, 0.0}, 100.0, 0.1, 1.0};
  const MatchSimulation cool = simulate_match(job);
  EXPECT_EQ(cool.verdict(), select::Verdict::pass);
  const double ambient_C = job.duty.ambient_C.value;
  const double nominal_C = cool.runs.front().run.score.winding_peak_C;
  const double upper_C = cool.runs.front().upper.value().winding_peak_C;
  // e^(1.645 · 0.1) = 1.18; the resistance of the copper grows with its temperature.
  EXPECT_GT(upper_C - ambient_C, 1.12 * (nominal_C - ambient_C));
  EXPECT_LT(upper_C - ambient_C, 1.30 * (nominal_C - ambient_C));
  // A loss has no influence on voltages: the drive is the same, up to the resistance of the warmer copper.
  EXPECT_NEAR(cool.runs.front().upper->current_rms_A, cool.runs.front().run.score.current_rms_A,
              1e-3 * cool.runs.front().run.score.current_rms_A);
  job.motor.nominal.winding_limit_C = 0.5 * (nominal_C + upper_C);
  EXPECT_EQ(simulate_match(job).verdict(), select::Verdict::marginal);
}

TEST(MatchSimulation, is_decided_by_the_worst_run) {
  using select::Verdict;
  const auto deciding = [](const std::vector<Verdict>& verdicts) {
    MatchSimulation simulation;
    for (const Verdict verdict : verdicts) {
      simulation.runs.emplace_back().verdict = verdict;
    }
    EXPECT_EQ(simulation.verdict(), simulation.deciding().verdict);
    return &simulation.deciding() - simulation.runs.data();
  };
  EXPECT_EQ(deciding({Verdict::pass, Verdict::pass}), 0);
  EXPECT_EQ(deciding({Verdict::pass, Verdict::fail}), 1);
  EXPECT_EQ(deciding({Verdict::infeasible, Verdict::fail}), 1);
  EXPECT_EQ(deciding({Verdict::pass, Verdict::infeasible}), 1);
  EXPECT_EQ(deciding({Verdict::pass, Verdict::marginal}), 1);
  EXPECT_EQ(deciding({Verdict::marginal, Verdict::infeasible}), 1);
}

TEST(MatchSimulation, refuses_one_table_for_two_planners_and_a_huge_one) {
  MatchJob job = short_job();
  job.with_table = true;
  job.every_s = 1e-3;
  EXPECT_THROW(simulate_match(job), base::Failure);
  job.every_s = 1.0;
  job.planners = {duty::Planner::jerk_limited, duty::Planner::bang_bang};
  EXPECT_THROW(simulate_match(job), base::Failure);
}

}  // namespace
}  // namespace heatsoak::simulate
