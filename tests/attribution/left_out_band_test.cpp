// Bands of the forecasts with an extended motor file, on unseen runs of motors with eight parts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calibration/forecast/prediction.h"
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
  const motor::Motor motor = sheet_of(runs.make);
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

/// A left-out recording with an effect of its own is predicted by a model with fewer effects than the others.
TEST(LeftOutBand, DoesNotDependOnTheOrderOfTheRecordings) {
  Case one;
  one.seed = 2;
  one.missing = subjects()[2].make(1.0);
  const diagnosis::DiagnosisAnswer answer = answer_of(one);
  ASSERT_FALSE(answer.diagnosis.effects.empty());
  const Runs runs = record(one);
  const std::vector<recording::Recording> logs = logs_of(runs.training);
  motor::Motor without = answer.motor;
  without.effects.clear();
  const std::vector<calibration::LeftOutRecording> all{{logs[0], {answer.diagnosis.runs[0]}, answer.motor},
                                                       {logs[1], {answer.diagnosis.runs[1]}, without}};
  const motor::ForecastBand band = calibration::band_of_left_out(all);
  const motor::ForecastBand reversed = calibration::band_of_left_out(std::vector{all[1], all[0]});
  EXPECT_NEAR(band.width_ratio, reversed.width_ratio, 1e-6);
  EXPECT_NEAR(band.unknown_heat_share[0], reversed.unknown_heat_share[0], 1e-6);
  EXPECT_NEAR(band.heat_factor_sd, reversed.heat_factor_sd, 1e-6);
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
