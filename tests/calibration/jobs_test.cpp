// The calls behind `calibrate` and `predict`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/diagnostic.h"
#include "calibration/calibration_job.h"
#include "calibration/prediction_job.h"
#include "support/source_folder.h"

namespace heatsoak::calibration {
namespace {

using testing::Contains;
using testing::Field;
using testing::VariantWith;

TEST(Jobs, AFittedRunIsRefusedAndItsPredictionSaysSo) {
  const std::string bench = (kSource / "reports/soak/bench.csv").string();
  const std::string match = (kSource / "reports/soak/match_1.csv").string();
  CalibrationJob job{motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml"), recording::read_named_logs({bench}, {}, {}), {}};
  const motor::Motor calibrated = run_calibration(job).motor;
  const PredictionAnswer both = run_prediction({calibrated, recording::read_named_logs({}, {bench, match}, {})});
  EXPECT_EQ(both.prediction.runs.size(), 2U);
  EXPECT_THAT(both.warnings, Contains(VariantWith<FittedRun>(Field(&FittedRun::recording, "bench"))));
  EXPECT_THAT(both.warnings, Not(Contains(VariantWith<FittedRun>(Field(&FittedRun::recording, "match_1")))));
  job.motor = calibrated;
  try {
    run_calibration(job);
    FAIL();
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
  }
}

}  // namespace
}  // namespace heatsoak::calibration
