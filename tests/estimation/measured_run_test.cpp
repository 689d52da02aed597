#include "estimation/measured_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/diagnostic.h"
#include "estimation/log_columns.h"
#include "estimation/turning_rows.h"

namespace heatsoak::estimation {
namespace {

struct LogRow {
  double time_s;
  double current_A;
  double winding_C = 30.0;
};

recording::Recording recording_of(const std::vector<LogRow>& rows) {
  recording::Recording log;
  log.name = "log";
  log.file = "log.csv";
  log.run_begins = {0};
  std::vector<double> current_A, winding_C;
  for (const LogRow& row : rows) {
    log.time_s.push_back(row.time_s);
    current_A.push_back(row.current_A);
    winding_C.push_back(row.winding_C + 0.1 * static_cast<double>(winding_C.size() % 3));
  }
  log.channels.push_back({*recording::quantity_named("current_A"), current_A});
  log.channels.push_back({*recording::quantity_named("winding_C"), winding_C});
  return log;
}

/// Rows at 1 Hz with 2 A in the first ten seconds and 6 A afterwards.
std::vector<LogRow> rows_of_a_step() {
  std::vector<LogRow> rows;
  for (int k = 0; k < 20; ++k) {
    rows.push_back({static_cast<double>(k), k < 10 ? 2.0 : 6.0});
  }
  return rows;
}

MeasuredRuns runs_of(const std::vector<LogRow>& rows, double longest_step_s = 2.0) {
  return measured_runs(recording_of(rows), {.longest_step_s = longest_step_s, .needed = {thermal::Signal::current}, .ambient_C = 25.0});
}

/// Returns ∫ I² dt.
double heat_A2s(const MeasuredRun& run) {
  double heat = 0.0;
  for (std::size_t k = 0; k < run.at.size(); ++k) {
    heat += run.at[k].current_rms_A * run.at[k].current_rms_A * (run.time_s[k + 1] - run.time_s[k]);
  }
  return heat;
}

TEST(MeasuredRun, a_lost_row_is_no_loss_of_certainty_where_nothing_changed) {
  std::vector<LogRow> rows = rows_of_a_step();
  rows.erase(rows.begin() + 4);
  const MeasuredRuns all = runs_of(rows);
  ASSERT_EQ(all.runs.size(), 1U);
  EXPECT_DOUBLE_EQ(heat_A2s(all.runs[0]), 10 * 4.0 + 9 * 36.0);
  for (const UnknownInputs& each : all.runs[0].unknown_inputs) {
    EXPECT_EQ(each.other.current_rms_A, all.runs[0].at[static_cast<std::size_t>(each.interval)].current_rms_A);
  }
}

TEST(MeasuredRun, where_the_current_changed_beside_a_lost_row_the_heat_is_the_middle_and_both_ends_are_within_the_uncertainty) {
  std::vector<LogRow> rows = rows_of_a_step();
  rows.erase(rows.begin() + 10);  // the row at 9 s has 2 A, the next one at 11 s has 6 A
  const MeasuredRun run = runs_of(rows).runs.at(0);
  EXPECT_DOUBLE_EQ(heat_A2s(run), 10 * 4.0 + 0.5 * (4.0 + 36.0) + 8 * 36.0);
  ASSERT_EQ(run.unknown_inputs.size(), 1U);
  EXPECT_EQ(run.unknown_inputs[0].interval, 9);
  const double mean_A2s = 2.0 * std::pow(run.at[9].current_rms_A, 2);
  const double other_A2s = 2.0 * std::pow(run.unknown_inputs[0].other.current_rms_A, 2);
  EXPECT_NEAR(std::abs(other_A2s - mean_A2s), 0.5 * (36.0 - 4.0), 1e-12);
}

TEST(MeasuredRun, bursts_of_one_row_are_within_the_uncertainty_of_a_lost_row_between_equal_ones) {
  std::vector<LogRow> rows;
  for (int k = 0; k < 61; ++k) {
    rows.push_back({static_cast<double>(k), k % 6 == 3 ? 6.0 : 0.0});
  }
  rows.erase(rows.begin() + 27);  // the row of a load pulse
  const MeasuredRun run = runs_of(rows).runs.at(0);
  ASSERT_EQ(run.unknown_inputs.size(), 1U);
  const auto place = static_cast<std::size_t>(run.unknown_inputs[0].interval);
  EXPECT_EQ(run.at[place].current_rms_A, 0.0);
  // One of four rows between equal rows differs by 36 A²: 18 A² RMS.
  EXPECT_NEAR(2.0 * std::pow(run.unknown_inputs[0].other.current_rms_A, 2), 18.0, 1.5);
}

TEST(MeasuredRun, a_mean_over_the_time_before_its_row_speaks_of_the_end_of_a_gap) {
  std::vector<LogRow> rows = rows_of_a_step();
  rows.erase(rows.begin() + 12);  // 6 A on both sides; to_interval_values() moves the value of 13 s to the row at 11 s
  recording::Recording log = recording_of(rows);
  log.inputs = recording::InputConvention::previous_interval;
  log.channels[0].values[11] = 3.0;
  const MeasuredRun run = measured_runs(log, {.needed = {thermal::Signal::current}, .ambient_C = 25.0}).runs.at(0);
  ASSERT_EQ(run.unknown_inputs.size(), 1U);
  EXPECT_EQ(run.unknown_inputs[0].interval, 11);
  EXPECT_DOUBLE_EQ(2.0 * std::pow(run.at[11].current_rms_A, 2), 9.0 + 0.5 * (36.0 + 9.0)) << "3 A in its last second";
}

TEST(MeasuredRun, rows_that_came_when_something_changed_lack_none) {
  recording::Recording log = recording_of(rows_of_a_step());
  double time_s = 0.0;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    log.time_s[row] = time_s;
    time_s += 1.0 + static_cast<double>(row * row % 7) / 3.0;
  }
  const MeasuredRuns all = measured_runs(log, {.needed = {thermal::Signal::current}, .ambient_C = 25.0});
  ASSERT_EQ(all.runs.size(), 1U);
  EXPECT_THAT(all.runs[0].unknown_inputs, testing::IsEmpty());
  EXPECT_EQ(all.runs[0].at[9].current_rms_A, 2.0);
}

TEST(MeasuredRun, a_speed_is_unlogged_in_the_rows_that_lack_it_and_where_something_drives) {
  recording::Recording log = recording_of(rows_of_a_step());
  std::vector<double> speed_rad_per_s(log.rows(), 100.0);
  std::fill(speed_rad_per_s.begin() + 5, speed_rad_per_s.begin() + 15, std::nan(""));
  log.channels.push_back({*recording::quantity_named("speed_rad_per_s"), speed_rad_per_s});
  MeasuredRunOptions how{.needed = {thermal::Signal::current}, .ambient_C = 25.0};
  const MeasuredRun driven = measured_runs(log, how).runs.at(0);
  EXPECT_EQ(driven.at[4].unlogged_speed_share, 0.0);
  EXPECT_EQ(driven.at[5].unlogged_speed_share, 1.0);
  how.least_current_A = 6.5;
  const MeasuredRun standing = measured_runs(log, how).runs.at(0);
  EXPECT_EQ(standing.at[5].unlogged_speed_share, 0.0);
}

/// The drive reverses within a row of its log. The signed mean underestimates the distance that bearings and iron experience.
TEST(MeasuredRun, a_row_in_which_the_motor_turns_round_has_more_speed_than_its_mean) {
  constexpr int kFine = 1000;
  constexpr double kSteepest_rad_per_s2 = 700.0;
  std::vector<LogRow> rows;
  std::vector<double> mean_rad_per_s;
  double speed_rad_per_s = 0.0, truth_rad = 0.0, truth_rad2_per_s = 0.0, short_of_it_rad = 0.0, short_of_it_rad2_per_s = 0.0;
  for (int row = 0; row < 600; ++row) {
    double turned_rad = 0.0;
    for (int k = 0; k < kFine; ++k) {
      // Reversal periods incommensurable with the row, and halts.
      const double time_s = row + k / static_cast<double>(kFine);
      const double wanted_rad_per_s =
          std::fmod(time_s, 17.3) > 15.0 ? 0.0 : 300.0 * std::sin(0.37 * time_s) * (std::sin(0.83 * time_s) > 0.0 ? 1.0 : -1.0);
      const double step_rad_per_s = kSteepest_rad_per_s2 / kFine;
      speed_rad_per_s += std::clamp(wanted_rad_per_s - speed_rad_per_s, -step_rad_per_s, step_rad_per_s);
      turned_rad += speed_rad_per_s / kFine;
      truth_rad += std::abs(speed_rad_per_s) / kFine;
      truth_rad2_per_s += speed_rad_per_s * speed_rad_per_s / kFine;
    }
    rows.push_back({static_cast<double>(row), 2.0});
    mean_rad_per_s.push_back(turned_rad);
    short_of_it_rad += std::abs(turned_rad);
    short_of_it_rad2_per_s += turned_rad * turned_rad;
  }
  recording::Recording log = recording_of(rows);
  log.channels.push_back({*recording::quantity_named("speed_rad_per_s"), mean_rad_per_s});
  const MeasuredRun held =
      measured_runs(log, {.longest_step_s = 2.0, .needed = {thermal::Signal::current, thermal::Signal::speed}, .ambient_C = 25.0})
          .runs.front();
  EXPECT_TRUE(may_turn_within_rows(held));
  const MeasuredRun run = turning_within_rows(held);
  double seen_rad = 0.0, seen_rad2_per_s = 0.0, turned_rad = 0.0;
  for (std::size_t k = 0; k < run.at.size(); ++k) {
    const double duration_s = run.time_s[k + 1] - run.time_s[k];
    seen_rad += duration_s * run.at[k].speed_mean_rad_per_s;
    seen_rad2_per_s += duration_s * run.at[k].speed_rms_rad_per_s * run.at[k].speed_rms_rad_per_s;
    turned_rad += duration_s * run.at[k].velocity_rad_per_s;
    EXPECT_LE(std::abs(run.at[k].velocity_rad_per_s), run.at[k].speed_mean_rad_per_s + 1e-9);
    EXPECT_LE(run.at[k].speed_mean_rad_per_s, run.at[k].speed_rms_rad_per_s + 1e-9);
  }
  EXPECT_LT(short_of_it_rad, 0.95 * truth_rad) << "an easy case shows nothing";
  EXPECT_NEAR(seen_rad, truth_rad, 0.5 * (truth_rad - short_of_it_rad)) << short_of_it_rad;
  // The reverse speed is harder to recover than the reversal itself, so the limit is one third.
  EXPECT_GT(seen_rad2_per_s - short_of_it_rad2_per_s, (truth_rad2_per_s - short_of_it_rad2_per_s) / 3.0);
  EXPECT_LT(seen_rad2_per_s, truth_rad2_per_s);
  EXPECT_NEAR(turned_rad, std::accumulate(mean_rad_per_s.begin(), mean_rad_per_s.end() - 1, 0.0), 1e-6);
}

TEST(MeasuredRun, current_replaces_an_unlogged_torque) {
  recording::Recording log = recording_of(rows_of_a_step());
  log.channels.push_back({*recording::quantity_named("speed_rad_per_s"), std::vector<double>(log.rows(), -100.0)});
  MeasuredRunOptions how{.needed = {thermal::Signal::current}, .ambient_C = 25.0};
  EXPECT_FALSE(measured_runs(log, how).runs.at(0).has(thermal::Signal::shaft_power));
  how.torque = {.per_current_Nm_per_A = 0.03, .drag_Nm = 0.002};
  const MeasuredRun driven = measured_runs(log, how).runs.at(0);
  EXPECT_TRUE(driven.has(thermal::Signal::shaft_power));
  // 0.03 N m/A · 2 A · 100 rad/s = 6 W, minus 0.2 W of drag. The current is unsigned, so turning backwards does not mean braking.
  EXPECT_NEAR(driven.at[0].shaft_power_W, 5.8, 1e-9);
  // A signed current brakes if its sign is opposite to the speed's.
  for (double& current_A : log.channels[0].values) {
    current_A -= 4.0;
  }
  const MeasuredRun signed_run = measured_runs(log, how).runs.at(0);
  EXPECT_NEAR(signed_run.at[0].shaft_power_W, 5.8, 1e-9);
  EXPECT_NEAR(signed_run.at[15].shaft_power_W, -6.2, 1e-9);
  log.channels.push_back({*recording::quantity_named("torque_Nm"), std::vector<double>(log.rows(), 0.01)});
  EXPECT_NEAR(measured_runs(log, how).runs.at(0).at[0].shaft_power_W, -1.0, 1e-9);
}

testing::Matcher<const RowsLack&> without_current(std::size_t lacking, std::size_t rows) {
  return testing::AllOf(testing::Field(&RowsLack::signal, testing::Optional(thermal::Signal::current)),
                        testing::Field(&RowsLack::lacking, lacking), testing::Field(&RowsLack::rows, rows));
}

TEST(MeasuredRun, reports_why_no_segment_remains) {
  std::vector<LogRow> rows = rows_of_a_step();
  for (std::size_t row = 0; row < rows.size(); row += 5) {
    rows[row].current_A = rows[row + 1].current_A = rows[row + 2].current_A = std::nan("");
  }
  try {
    runs_of(rows);
    FAIL();
  } catch (const NoUsableInterval& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::cannot_answer);
    EXPECT_THAT(failure.reasons(), testing::Contains(testing::VariantWith<RowsLack>(without_current(12, 20))));
  }
}

TEST(MeasuredRun, empty_cells_of_a_heat_input_are_one_unknown_from_the_row_before_to_the_row_after) {
  std::vector<LogRow> rows;
  for (int k = 0; k < 40; ++k) {
    rows.push_back({static_cast<double>(k), k >= 15 && k < 18 ? std::nan("") : (k < 15 ? 2.0 : 6.0)});
  }
  const MeasuredRuns bridged = runs_of(rows);
  ASSERT_EQ(bridged.runs.size(), 1U);
  EXPECT_EQ(bridged.runs[0].samples(), 37);
  EXPECT_DOUBLE_EQ(heat_A2s(bridged.runs[0]), 15 * 4.0 + 3 * 0.5 * (4.0 + 36.0) + 21 * 36.0);
  ASSERT_EQ(bridged.runs[0].unknown_inputs.size(), 1U);
  EXPECT_EQ(bridged.runs[0].unknown_inputs[0].interval, 14);
  for (std::size_t k = 15; k < 26; ++k) {
    rows[k].current_A = std::nan("");
  }
  const MeasuredRuns split = runs_of(rows);
  EXPECT_THAT(split.runs, testing::SizeIs(2)) << "12 s from the row at 14 s to that at 26 s";
  EXPECT_THAT(split.notes, testing::Contains(testing::VariantWith<RowsUnused>(testing::Field(
                               &RowsUnused::reasons, testing::Contains(testing::VariantWith<RowsLack>(without_current(11, 40)))))));
}

TEST(MeasuredRun, rows_that_lack_a_speed_alone_stay_rows_and_keep_their_current) {
  std::vector<LogRow> rows;
  for (int k = 0; k < 40; ++k) {
    rows.push_back({static_cast<double>(k), 2.0 + k % 3});
  }
  recording::Recording log = recording_of(rows);
  std::vector<double> speed_rad_per_s(log.rows(), 100.0);
  std::fill(speed_rad_per_s.begin() + 20, speed_rad_per_s.end(), 300.0);
  std::fill(speed_rad_per_s.begin() + 18, speed_rad_per_s.begin() + 21, std::nan(""));
  log.channels.push_back({*recording::quantity_named("speed_rad_per_s"), speed_rad_per_s});
  const MeasuredRun run = measured_runs(log, {.needed = {thermal::Signal::current, thermal::Signal::speed}, .ambient_C = 25.0}).runs.at(0);
  EXPECT_EQ(run.samples(), 40);
  for (std::size_t k = 18; k < 21; ++k) {
    EXPECT_EQ(run.at[k].current_rms_A, 2.0 + static_cast<double>(k % 3));
    EXPECT_EQ(run.at[k].speed_mean_rad_per_s, 200.0);
    EXPECT_EQ(run.at[k].unlogged_speed_share, 0.0);
  }
  ASSERT_EQ(run.unknown_inputs.size(), 3U);
  for (const UnknownInputs& each : run.unknown_inputs) {
    EXPECT_EQ(each.other.current_rms_A, run.at[static_cast<std::size_t>(each.interval)].current_rms_A);
    EXPECT_NE(each.other.speed_mean_rad_per_s, 200.0);
  }
}

TEST(MeasuredRun, a_pause_of_ten_seconds_ends_no_run_unless_the_temperature_jumps) {
  std::vector<LogRow> rows;
  for (int k = 0; k < 60; ++k) {
    if (k <= 25 || k >= 35) {
      rows.push_back({static_cast<double>(k), k < 30 ? 2.0 : 6.0});
    }
  }
  recording::Recording log = recording_of(rows);
  log.run_begins = {0, 26};  // the split that the reader makes
  const MeasuredRunOptions how{.needed = {thermal::Signal::current}, .ambient_C = 25.0};
  const MeasuredRuns one = measured_runs(log, how);
  ASSERT_EQ(one.runs.size(), 1U);
  ASSERT_EQ(one.runs[0].unknown_inputs.size(), 1U);
  EXPECT_DOUBLE_EQ(heat_A2s(one.runs[0]), 26 * 4.0 + 9 * 0.5 * (4.0 + 36.0) + 24 * 36.0);
  for (std::size_t row = 26; row < log.rows(); ++row) {
    log.channels[1].values[row] += 8.0;
  }
  EXPECT_THAT(measured_runs(log, how).runs, testing::SizeIs(2));
}

// A pushing motor stands still, and a fast motor pushes little. An unlogged row may be either, so motion and current have separate
// uncertainties.
TEST(MeasuredRun, motion_and_current_have_separate_uncertainties) {
  std::vector<LogRow> rows = rows_of_a_step();
  recording::Recording log = recording_of(rows);
  std::vector<double> speed_rad_per_s(log.rows(), 300.0);
  std::fill(speed_rad_per_s.begin() + 10, speed_rad_per_s.end(), 0.0);
  log.channels.push_back({*recording::quantity_named("speed_rad_per_s"), speed_rad_per_s});
  for (recording::Channel& channel : log.channels) {
    channel.values.erase(channel.values.begin() + 10);
  }
  log.time_s.erase(log.time_s.begin() + 10);
  const MeasuredRun run = measured_runs(log, {.needed = {thermal::Signal::current, thermal::Signal::speed}, .ambient_C = 25.0}).runs.at(0);
  ASSERT_EQ(run.unknown_inputs.size(), 2U);
  EXPECT_EQ(run.unknown_inputs[0].interval, 9);
  EXPECT_EQ(run.unknown_inputs[1].interval, 9);
  EXPECT_EQ(run.unknown_inputs[0].other.speed_mean_rad_per_s, run.at[9].speed_mean_rad_per_s);
  EXPECT_EQ(run.unknown_inputs[1].other.current_rms_A, run.at[9].current_rms_A);
}

TEST(MeasuredRun, says_how_short_a_log_is) {
  std::vector<LogRow> rows;
  for (int k = 0; k < 700; ++k) {
    rows.push_back({0.02 * k, 2.0});
  }
  try {
    runs_of(rows);
    FAIL();
  } catch (const NoUsableInterval& failure) {
    ASSERT_EQ(failure.reasons().size(), 1U);
    const auto& found = std::get<TooFewIntervals>(failure.reasons().front());
    EXPECT_NEAR(found.duration_s, 14.0, 0.05);
    EXPECT_EQ(found.needed, 9U);
    EXPECT_EQ(found.interval_s, 2.0);
  }
}

TEST(MeasuredRun, a_run_that_begins_or_ends_without_inputs_loses_those_rows_only) {
  std::vector<LogRow> rows = rows_of_a_step();
  rows.front().current_A = rows.back().current_A = std::nan("");
  const MeasuredRun run = runs_of(rows).runs.at(0);
  EXPECT_EQ(run.time_s.front(), 1.0);
  EXPECT_EQ(run.time_s.back(), 19.0);
  EXPECT_THAT(run.unknown_inputs, testing::IsEmpty());
}

TEST(MeasuredRun, merging_keeps_heat_and_uncertainty) {
  std::vector<LogRow> rows;
  for (int k = 0; k < 200; ++k) {
    rows.push_back({0.1 * k, k % 50 < 25 ? 2.0 : 6.0});
  }
  rows.erase(rows.begin() + 75);
  const MeasuredRun run = runs_of(rows).runs.at(0);
  EXPECT_LT(run.samples(), 20);
  EXPECT_NEAR(heat_A2s(run), 0.1 * (100 * 4.0 + 99 * 36.0 - 0.5 * (36.0 - 4.0)), 1e-9);
  ASSERT_EQ(run.unknown_inputs.size(), 1U);
  const auto place = static_cast<std::size_t>(run.unknown_inputs[0].interval);
  const double duration_s = run.time_s[place + 1] - run.time_s[place];
  const double uncertainty_A2s =
      duration_s * (std::pow(run.unknown_inputs[0].other.current_rms_A, 2) - std::pow(run.at[place].current_rms_A, 2));
  EXPECT_NEAR(std::abs(uncertainty_A2s), 0.1 * 0.5 * (36.0 - 4.0), 1e-9);
  const MeasuredRun thin = thinned(run, 2);
  EXPECT_NEAR(heat_A2s(thin), heat_A2s(run), 1e-9);
  EXPECT_EQ(thin.unknown_inputs.size(), 1U);
}

TEST(MeasuredRun, brings_columns_of_the_log_into_the_operating_points) {
  recording::Recording log = recording_of(rows_of_a_step());
  log.channels.push_back({*recording::quantity_named("thrust_N"), {}});
  for (int k = 0; k < 20; ++k) {
    log.channels.back().values.push_back(k < 15 ? k : std::nan(""));
    log.channels.front().values[static_cast<std::size_t>(k)] *= k < 5 ? -1.0 : 1.0;
  }
  MeasuredRunOptions options{.longest_step_s = 2.0, .needed = {thermal::Signal::current}, .columns = {"thrust_N"}, .ambient_C = 25.0};
  MeasuredRun run = measured_runs(log, options).runs.at(0);
  ASSERT_EQ(run.columns.size(), 2U) << "a current of both signs is one";
  for (std::size_t k = 0; k < run.at.size(); ++k) {
    const double begin_s = run.time_s[k], end_s = std::min(run.time_s[k + 1], 15.0);
    EXPECT_TRUE(run.at[k].knows(thermal::column_bit(0))) << begin_s;
    EXPECT_EQ(run.at[k].first_column, begin_s < 15.0 ? 0.5 * (begin_s + end_s - 1.0) : run.at[k - 1].first_column) << begin_s;
  }
  EXPECT_GT(thinned(run, 1000).at.at(0).first_column, 5.0);
  const thermal::OperatingPoint<double> before = run.at.front();
  set_columns(run, std::vector<std::string>{"current_A", "not_logged_V", "thrust_N"});
  const thermal::OperatingPoint<double>& first = run.at.front();
  EXPECT_EQ(first.first_column, -2.0);
  EXPECT_FALSE(first.knows(thermal::column_bit(1)));
  EXPECT_EQ(first.third_column, before.first_column);
  EXPECT_TRUE(first.knows(thermal::column_bit(2)));
}

TEST(MeasuredRun, a_gap_of_a_column_is_filled_from_its_nearer_side) {
  MeasuredRun run = runs_of(rows_of_a_step()).runs.at(0);
  run.at.resize(6);
  const double unknown = std::nan("");
  run.columns["fan_ratio"] = Eigen::Map<const Eigen::VectorXd>(std::array{unknown, 1.0, unknown, unknown, 3.0, unknown}.data(), 6);
  set_columns(run, std::vector<std::string>{"fan_ratio"});
  std::vector<double> column;
  std::ranges::transform(run.at, std::back_inserter(column), &thermal::OperatingPoint<double>::first_column);
  EXPECT_THAT(column, testing::ElementsAre(1.0, 1.0, 1.0, 3.0, 3.0, 3.0));
}

TEST(MeasuredRun, a_column_that_one_run_lacks_is_used_for_none) {
  std::vector<MeasuredRun> runs(3);
  for (MeasuredRun& run : runs) {
    run.columns["fan_ratio"].setOnes(3);
    run.columns["thrust_N"].setOnes(3);
    run.columns["steps_ratio"].setOnes(3);
  }
  runs[1].columns.erase("thrust_N");
  runs[2].columns["steps_ratio"].setConstant(std::nan(""));
  EXPECT_THAT(keep_common_columns(runs, std::vector<std::string>{"thrust_N"}), testing::ElementsAre("steps_ratio"));
  EXPECT_THAT(keep_common_columns(runs, {}), testing::ElementsAre("thrust_N"));
  EXPECT_EQ(runs[0].columns.size(), 1U);
  EXPECT_EQ(runs[2].columns.count("fan_ratio"), 1U);
}

}  // namespace
}  // namespace heatsoak::estimation
