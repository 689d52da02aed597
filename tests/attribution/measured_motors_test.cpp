// Motors that others measured, with effects that nobody declared. The recordings are no part of the product; without them the tests say so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "../support/measured_data.h"
#include "identify/attribution/model_file.h"
#include "identify/calibration/calibrate.h"
#include "identify/measurement/mapping.h"
#include "identify/measurement/read_recording.h"

namespace heatsoak {
namespace {

const std::filesystem::path kReports = std::filesystem::path(HEATSOAK_SOURCE_DIR) / "reports/diagnosis";

Recording read(const std::filesystem::path& log, const std::filesystem::path& map) {
  RecordingReport report;
  return read_recording(log, mapping_for(log.string(), map.string()), report);
}

DiagnosisInput input_of(const ModelOfLogs& model, const std::vector<Recording>& train, const std::vector<Recording>& holdout) {
  DiagnosisInput input;
  input.model = model.model;
  MeasuredRunOptions how;
  how.needed = model.needed;
  for (const Recording& recording : train) {
    for (MeasuredRun& run : measured_runs(recording, how).runs) {
      input.free.push_back(free_signals(recording, run));
      input.train.push_back(std::move(run));
    }
  }
  for (const Recording& recording : holdout) {
    for (MeasuredRun& run : measured_runs(recording, how).runs) {
      input.holdout.push_back(std::move(run));
    }
  }
  return input;
}

/// Of a signal over all samples of the runs, free-running.
double rms_K(const ExtendedModel& model, const std::vector<MeasuredRun>& runs, const char* signal) {
  return open_loop_errors(model, runs, {}).at(signal).rmse_K;
}

TEST(MeasuredMotors, a_fan_that_nobody_told_of_is_found_in_the_run_that_had_it) {
  const std::optional<std::filesystem::path> found = measured_data("tasrv_uav_motor");
  if (!found) {
    GTEST_SKIP() << "the recordings are not at hand (HEATSOAK_MEASURED_DATA)";
  }
  const std::filesystem::path& folder = *found;
  const std::filesystem::path map = kReports / "uav_fan/recordings.map.toml";
  std::map<std::string, Recording> run;
  for (const char* const name : {"run1", "run2", "run3", "run4", "run5"}) {
    run[name] = read(folder / (std::string(name) + ".csv"), map);
    EXPECT_THAT(run[name].conditions, testing::IsEmpty());
  }
  const Motor start = read_motor(kReports / "uav_motor.toml");
  const Calibration calibration = calibrate(start, std::vector{run["run1"], run["run3"], run["run5"]}, {}, {});
  const Motor motor = calibrated_motor(start, calibration);
  const std::vector<Recording> train{run["run1"], run["run3"], run["run5"], part_of(run["run4"], 0.0, 0.6)};
  const ModelOfLogs model = model_of_logs(motor, train);
  const DiagnosisInput input = input_of(model, train, {part_of(run["run4"], 0.6, 1.0), run["run2"]});
  const Diagnosis diagnosis = diagnose(input, {});
  EXPECT_EQ(diagnosis.verdict, DiagnosisVerdict::effect_found) << diagnosis.description;
  const auto fan = std::ranges::find_if(diagnosis.effects, [](const FoundEffect& each) { return each.id.starts_with("airflow"); });
  ASSERT_NE(fan, diagnosis.effects.end()) << diagnosis.description;
  EXPECT_EQ(fan->node, "stator");
  EXPECT_THAT(fan->condition, testing::ElementsAre(testing::Pair("run", "run4")));
  EXPECT_GT(fan->parameters.front().low, 0.0);
  const std::vector<MeasuredRun> run4 = input_of(model, {run["run4"]}, {}).train;
  const std::vector<MeasuredRun> run2 = input_of(model, {run["run2"]}, {}).train;
  for (const char* const signal : {"winding_C", "stator_C"}) {
    EXPECT_GT(rms_K(input.model, run4, signal), 40.0) << signal;
    EXPECT_LE(rms_K(diagnosis.selection.after.model, run4, signal), 3.0) << signal;
    EXPECT_LE(rms_K(diagnosis.selection.after.model, run2, signal), rms_K(input.model, run2, signal)) << signal;
  }
}

}  // namespace
}  // namespace heatsoak
