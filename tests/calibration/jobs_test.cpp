// The calls behind `calibrate` and `predict`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/collected_failures.h"
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
  CalibrationJob job{
      motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml"), recording::read_usable_logs({bench}, {}, {}), {}};
  const motor::Motor calibrated = run_calibration(job).motor;
  const PredictionAnswer both = run_prediction({calibrated, recording::read_usable_logs({}, {bench, match}, {})});
  EXPECT_EQ(both.prediction.runs.size(), 2U);
  EXPECT_THAT(both.warnings, Contains(VariantWith<FittedRuns>(Field(&FittedRuns::recordings, testing::ElementsAre("bench")))));
  job.motor = calibrated;
  try {
    run_calibration(job);
    FAIL();
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
  }
}

TEST(Jobs, AllLogsWithoutHeatAreReportedAtOnce) {
  const recording::NamedLogs logs = recording::read_usable_logs({(kSource / "reports/soak/bench.csv").string()}, {}, {});
  recording::Recording without_heat = logs.fitted[0];
  std::erase_if(without_heat.channels, [](const recording::Channel& channel) { return channel.quantity.key != "winding_C"; });
  recording::Recording cut = logs.fitted[0].slice(0, 5);
  constexpr double kAir_C = 20.0;  // the log without heat has no ambient temperature either
  try {
    admit(motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml"), std::vector{without_heat}, {}, false, kAir_C);
    FAIL();
  } catch (const recording::NothingAboutHeat& failure) {
    EXPECT_EQ(failure.logs().size(), 1U);
  }
  without_heat.content = "another";
  try {
    admit(motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml"), std::vector{cut, without_heat}, {}, false, kAir_C);
    FAIL();
  } catch (const recording::NothingAboutHeat& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::cannot_answer);
    EXPECT_EQ(failure.logs().size(), 2U);
  }
}

TEST(Jobs, APredictedLogWhoseTemperaturesNeverChangeIsReportedAsAFittedOne) {
  const recording::NamedLogs logs = recording::read_usable_logs({(kSource / "reports/soak/bench.csv").string()}, {}, {});
  recording::Recording constant = logs.fitted[0];
  for (recording::Channel& channel : constant.channels) {
    if (channel.quantity.key == "winding_C" || channel.quantity.key == "stator_C") {
      channel.values.assign(constant.rows(), 60.0);
    }
  }
  for (const recording::Recording& held_out : {constant, logs.fitted[0].slice(0, 1)}) {
    try {
      admit(motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml"), {}, std::vector{held_out}, false);
      FAIL() << held_out.rows();
    } catch (const recording::NothingAboutHeat& failure) {
      EXPECT_EQ(failure.code(), base::ExitCode::cannot_answer);
      ASSERT_EQ(failure.logs().size(), 1U);
      EXPECT_THAT(failure.logs()[0].lacks, Contains(VariantWith<recording::TemperatureIsConstant>(testing::_)));
      EXPECT_EQ(failure.logs()[0].lacks.size(), held_out.rows() == 1 ? 2U : 1U);
    }
  }
}

std::vector<std::string> kinds_of(const base::SeveralFailures& several) {
  std::vector<std::string> kinds;
  for (const auto& [failure, thrown] : several.parts()) {
    try {
      std::rethrow_exception(thrown);
    } catch (const recording::RowsGivenTwice&) {
      kinds.emplace_back("twice");
    } catch (const recording::NothingAboutHeat&) {
      kinds.emplace_back("no heat");
    } catch (const LogsLookWrong&) {
      kinds.emplace_back("looks wrong");
    } catch (const base::Failure&) {
      kinds.push_back(failure.diagnostics().empty() ? failure.message() : failure.diagnostics().front().key);
    }
  }
  return kinds;
}

TEST(Jobs, EveryKindOfProblemOfTheLogsIsReportedAtOnce) {
  const motor::Motor motor = motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml");
  const std::string bench = (kSource / "reports/soak/bench.csv").string();
  recording::NamedLogs logs = recording::read_usable_logs({bench, "missing.csv"}, {bench}, {});
  ASSERT_FALSE(logs.unread.empty());
  recording::Recording without_heat = logs.fitted[0];
  std::erase_if(without_heat.channels, [](const recording::Channel& channel) { return channel.quantity.key != "winding_C"; });
  recording::Recording in_milliamperes = logs.fitted[0];
  for (recording::Channel& channel : in_milliamperes.channels) {
    const double scale = channel.quantity.key == "current_A" ? 1000.0 : 1.0;
    std::ranges::for_each(channel.values, [scale](double& each) { each *= scale; });
  }
  logs.fitted.insert(logs.fitted.end(), {without_heat, in_milliamperes});
  try {
    admit(motor, logs);
    FAIL();
  } catch (const base::SeveralFailures& several) {
    EXPECT_EQ(several.code(), base::ExitCode::bad_input);
    EXPECT_THAT(kinds_of(several), testing::ElementsAre("", "twice", "no heat", "ambient_C", "looks wrong"));
  }
}

TEST(Jobs, ARunMayBePredictedTwiceButNotWithoutHeat) {
  const motor::Motor motor = motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml");
  const std::string bench = (kSource / "reports/soak/bench.csv").string();
  PredictionJob job{motor, recording::read_usable_logs({}, {bench, bench}, {})};
  EXPECT_EQ(run_prediction(job).prediction.runs.size(), 2U);
  for (recording::Recording& each : job.logs.held_out) {
    std::erase_if(each.channels, [](const recording::Channel& channel) { return channel.quantity.key != "winding_C"; });
    each.file = "logs/" + std::to_string(each.channels.size() + (&each == job.logs.held_out.data() ? 0 : 1)) + ".csv";
  }
  try {
    run_prediction(job);
    FAIL();
  } catch (const base::SeveralFailures& several) {
    EXPECT_THAT(kinds_of(several), testing::ElementsAre("current_A", "current_A", "ambient_C"));
  }
}

}  // namespace
}  // namespace heatsoak::calibration
