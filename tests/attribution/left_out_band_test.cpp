// Bands of the forecasts with an extended motor file, on unseen runs of motors with eight parts.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "diagnosis/diagnosis_job.h"
#include "examination.h"
#include "scoring.h"

namespace heatsoak::attribution::truth {
namespace {

std::vector<recording::Recording> logs_of(const std::vector<TrueRun>& runs) {
  std::vector<recording::Recording> logs;
  std::ranges::transform(runs, std::back_inserter(logs), &TrueRun::log);
  return logs;
}

diagnosis::DiagnosisAnswer answer_of(const Case& sealed) {
  const Runs runs = record(sealed);
  const auto file = std::filesystem::path(testing::TempDir()) / fmt::format("left_out_band_{}.toml", getpid());
  const motor::Motor motor = sheet_of(runs.make, file);
  std::filesystem::remove(file);
  recording::NamedLogs logs;
  logs.fitted = logs_of(runs.training);
  logs.held_out = logs_of(runs.unseen);
  return diagnosis::run_diagnosis({motor, logs});
}

/// Every second motor lacks an effect. Errors within a run are correlated, so that single runs are far from 90 %.
TEST(LeftOutBand, CoversUnseenRuns) {
  constexpr std::uint64_t kMotors = 12;
  double covered = 0.0;
  double count = 0.0;
  for (std::uint64_t seed = 1; seed <= kMotors; ++seed) {
    Case one;
    one.seed = seed;
    if (seed % 2 == 0) {
      one.missing = subjects()[seed % subjects().size()].make(1.0);
    }
    const diagnosis::DiagnosisAnswer answer = answer_of(one);
    ASSERT_TRUE(answer.motor.fit && answer.motor.fit->band && answer.band) << seed;
    EXPECT_EQ(answer.band->recordings, 4U) << seed;
    for (const calibration::PredictedRun& run : answer.score.runs_after) {
      for (const calibration::PredictedSignal& signal : run.signals) {
        // The reported size is that of the training runs, and the unseen runs have similar loads.
        const double last_K = 0.5 * (signal.high_C.back() - signal.low_C.back());
        EXPECT_LT(std::abs(std::log(last_K / answer.band->half_width_K.at(signal.signal))), std::log(3.0)) << seed << signal.signal;
        covered += signal.coverage_share;
        count += 1.0;
      }
    }
  }
  EXPECT_GE(covered / count, 0.85);
  EXPECT_LE(covered / count, 0.98);
}

TEST(LeftOutBand, NeedsTwoRecordings) {
  Case one;
  one.training_runs = 1;
  const diagnosis::DiagnosisAnswer answer = answer_of(one);
  EXPECT_FALSE(answer.motor.fit->band);
  EXPECT_FALSE(answer.band);
}

}  // namespace
}  // namespace heatsoak::attribution::truth
