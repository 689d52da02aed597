// Tests both passes of the screening with logs of an independent simulator that labels wrong samples. No threshold was tuned on these logs.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "../support/measured_data.h"
#include "attribution/selection.h"
#include "diagnosis/model_file.h"
#include "estimation/model_screening.h"
#include "recording/mapping.h"
#include "recording/read_recording.h"
#include "support/source_folder.h"

namespace heatsoak::attribution {
namespace {

using Intervals = std::vector<std::pair<double, double>>;

bool is_in(const Intervals& intervals, double time_s) {
  return std::ranges::any_of(intervals, [&](const auto& each) { return each.first <= time_s && time_s <= each.second; });
}

Intervals wrong_s(const nlohmann::json& motor, const std::string& log, const std::string& signal) {
  Intervals intervals;
  if (motor.contains("not_usable_s") && motor["not_usable_s"].contains(log) && motor["not_usable_s"][log].contains(signal)) {
    for (const auto& each : motor["not_usable_s"][log][signal]) {
      intervals.emplace_back(each[0].get<double>(), each[1].get<double>());
    }
  }
  return intervals;
}

struct Score {
  int wrong = 0;        ///< samples off by more than five standard deviations of the noise
  int wrong_found = 0;  ///< rejected samples among them
  int good = 0;
  int good_rejected = 0;
};

/// Returns the raw samples of one signal by time, without screening.
std::map<double, double> cells_of(const std::filesystem::path& log, const std::string& signal) {
  std::ifstream file(log);
  std::string line;
  std::getline(file, line);
  std::vector<std::string> names;
  std::stringstream header(line);
  for (std::string name; std::getline(header, name, ',');) {
    names.push_back(name);
  }
  const auto place = static_cast<std::size_t>(std::ranges::find(names, signal) - names.begin());
  std::map<double, double> cells;
  while (std::getline(file, line)) {
    std::vector<std::string> row;
    std::stringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) {
      row.push_back(cell);
    }
    if (row.size() > place && !row[place].empty() && !row[0].empty()) {
      try {
        cells.emplace(std::stod(row[0]), std::stod(row[place]));
      } catch (const std::exception&) {
        continue;
      }
    }
  }
  return cells;
}

/// Counts a sample as found if it is missing in the run or has no weight. The error of a wrong sample is its distance to a straight line
/// between its good neighbours.
void add(const estimation::MeasuredRun& run, const Eigen::VectorXd& weights, const std::filesystem::path& log, const nlohmann::json& motor,
         Score& score) {
  constexpr double kOff_sd = 5.0;
  for (std::size_t sensor = 0; sensor < run.sensors.size(); ++sensor) {
    const std::string& signal = run.sensors[sensor].signal;
    const double noise_K = motor["sensor_noise_K"][signal == "winding_C" ? 0 : 1].get<double>();
    const Intervals wrong = wrong_s(motor, log.filename(), signal);
    const std::map<double, double> cells = cells_of(log, signal);
    std::map<double, double> good;
    for (const auto& [time_s, value_C] : cells) {
      if (!is_in(wrong, time_s)) {
        good.emplace(time_s, value_C);
      }
    }
    for (Eigen::Index k = 0; k < run.samples(); ++k) {
      const double time_s = run.time_s[static_cast<std::size_t>(k)];
      const auto cell = cells.find(time_s);
      if (cell == cells.end()) {
        continue;
      }
      const bool is_found = std::isnan(run.measured_C(k, static_cast<Eigen::Index>(sensor))) ||
                            weights[k * static_cast<Eigen::Index>(run.sensors.size()) + static_cast<Eigen::Index>(sensor)] == 0.0;
      if (!is_in(wrong, time_s)) {
        ++score.good;
        score.good_rejected += is_found ? 1 : 0;
        continue;
      }
      const auto after = good.upper_bound(time_s);
      if (after == good.begin() || after == good.end()) {
        continue;
      }
      const auto before = std::prev(after);
      // Over longer gaps a straight line is no estimate of the temperature.
      constexpr double kStraight_s = 6.0;
      if (after->first - before->first > kStraight_s) {
        continue;
      }
      const double share = (time_s - before->first) / (after->first - before->first);
      if (std::abs(cell->second - (1.0 - share) * before->second - share * after->second) > kOff_sd * noise_K) {
        ++score.wrong;
        score.wrong_found += is_found ? 1 : 0;
      }
    }
  }
}

/// Scores the samples of stuck intervals. Only intervals of at least 18 s in which the file repeats one value count.
void add_stuck(const estimation::MeasuredRun& run, const Eigen::VectorXd& weights, const std::filesystem::path& log,
               const nlohmann::json& motor, const Eigen::MatrixXd& expected_C, Score& score) {
  constexpr double kOff_sd = 5.0;
  constexpr double kStuck_s = 17.0;
  for (std::size_t sensor = 0; sensor < run.sensors.size(); ++sensor) {
    const std::string& signal = run.sensors[sensor].signal;
    const double noise_K = motor["sensor_noise_K"][signal == "winding_C" ? 0 : 1].get<double>();
    const std::map<double, double> cells = cells_of(log, signal);
    for (const auto& [from_s, to_s] : wrong_s(motor, log.filename(), signal)) {
      if (to_s - from_s < kStuck_s) {
        continue;
      }
      for (Eigen::Index k = 0; k < run.samples(); ++k) {
        const double time_s = run.time_s[static_cast<std::size_t>(k)];
        const auto cell = cells.find(time_s);
        const auto column = static_cast<Eigen::Index>(sensor);
        if (time_s < from_s || time_s > to_s || cell == cells.end() || std::abs(cell->second - expected_C(k, column)) < kOff_sd * noise_K) {
          continue;
        }
        ++score.wrong;
        score.wrong_found +=
            std::isnan(run.measured_C(k, column)) || weights[k * static_cast<Eigen::Index>(run.sensors.size()) + column] == 0.0 ? 1 : 0;
      }
    }
  }
}

void print(const char* what, const Score& score) {
  std::printf("%s: wrong samples found %d of %d (%.1f %%), good ones rejected %d of %d (%.3f %%)\n", what, score.wrong_found, score.wrong,
              100.0 * score.wrong_found / std::max(1, score.wrong), score.good_rejected, score.good,
              100.0 * score.good_rejected / std::max(1, score.good));
}

TEST(Screening, FindsWrongSamplesAndLeavesGoodOnes) {
  SKIP_WITHOUT_MEASURED_DATA("examination_2");
  const std::optional<std::filesystem::path> folder = measured_data("examination_2");
  const nlohmann::json truth = nlohmann::json::parse(std::ifstream(*folder / "truth.json"));
  const motor::Motor sheet = motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml");
  Score single, stuck;
  for (const auto& motor : truth["motors"]) {
    std::vector<recording::Recording> recordings;
    std::vector<std::filesystem::path> logs;
    for (const char* const name : {"train_1.csv", "train_2.csv", "train_3.csv", "train_4.csv"}) {
      logs.push_back(*folder / motor["motor"].get<std::string>() / name);
      recording::RecordingReport report;
      recordings.push_back(recording::read_recording(logs.back(), recording::mapping_for(logs.back(), {}), report));
    }
    const diagnosis::ModelOfLogs model = diagnosis::model_of_logs(sheet, recordings);
    std::vector<estimation::MeasuredRun> runs;
    std::vector<std::filesystem::path> log_of_run;
    std::size_t log = 0;
    for (const recording::Recording& recording : recordings) {
      const estimation::MeasuredRuns of_one = estimation::measured_runs(recording, model.how);
      for (const estimation::MeasuredRun& run : of_one.runs) {
        runs.push_back(run);
        log_of_run.push_back(logs[log]);
      }
      ++log;
    }
    SelectionRules rules;
    rules.scans_regressors = false;
    const Selection selection = select_effects({model.model, runs, model.usual}, rules);
    for (std::size_t r = 0; r < runs.size(); ++r) {
      add(runs[r], selection.weights[r], log_of_run[r], motor, single);
      add_stuck(runs[r], selection.weights[r], log_of_run[r], motor, selection.after.fitted[r].sensor_C, stuck);
    }
  }
  print("single samples", single);
  print("stuck converters", stuck);
  EXPECT_GE(single.wrong_found + stuck.wrong_found, 0.95 * (single.wrong + stuck.wrong));
  EXPECT_LE(single.good_rejected, 0.001 * single.good);
}

}  // namespace
}  // namespace heatsoak::attribution
