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

TEST(Jobs, AllLogsWithoutHeatAreReportedAtOnce) {
  const recording::NamedLogs logs = recording::read_named_logs({(kSource / "reports/soak/bench.csv").string()}, {}, {});
  recording::Recording without_heat = logs.fitted[0];
  std::erase_if(without_heat.channels, [](const recording::Channel& channel) { return channel.quantity.key != "winding_C"; });
  recording::Recording cut = logs.fitted[0].slice(0, 5);
  try {
    admit(motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml"), std::vector{without_heat}, {}, false);
    FAIL();
  } catch (const recording::NothingAboutHeat& failure) {
    EXPECT_EQ(failure.logs().size(), 1U);
  }
  without_heat.content = "another";
  try {
    admit(motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml"), std::vector{cut, without_heat}, {}, false);
    FAIL();
  } catch (const recording::NothingAboutHeat& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::cannot_answer);
    EXPECT_EQ(failure.logs().size(), 2U);
  }
}

}  // namespace
}  // namespace heatsoak::calibration
