// Logs that lack a signal on which an effect of the motor file depends, in whole or for a part of their time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/diagnostic.h"
#include "calibration/forecast/prediction.h"
#include "calibration/prediction_job.h"
#include "study.h"

namespace heatsoak::calibration::study {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

motor::Motor with_effect(motor::Motor motor, const char* name, const char* type, const std::vector<double>& values) {
  motor::MotorEffect effect{
      .name = name, .type = thermal::find_effect(type), .nodes = {"stator", "ambient"}, .parameters = {}, .condition = {}, .column = {}};
  for (const double value : values) {
    effect.parameters.emplace_back().value = value;
  }
  motor.effects.push_back(std::move(effect));
  return motor;
}

recording::Recording log_with(const std::string& name, const std::string& column, double value) {
  recording::Recording log = estimation::generated_log({}, {.duration_s = 900.0}, 5, 0);
  log.name = name;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    log.line.push_back(static_cast<int>(row) + 2);
  }
  log.channels.push_back({*recording::quantity_named(column), std::vector<double>(log.rows(), value)});
  return log;
}

void blank(recording::Recording& log, std::size_t begin, std::size_t end) {
  std::fill(log.channels.back().values.begin() + static_cast<std::ptrdiff_t>(begin),
            log.channels.back().values.begin() + static_cast<std::ptrdiff_t>(end), std::nan(""));
}

template <class Kind, class Note>
std::vector<Kind> of_kind(const std::vector<Note>& notes) {
  std::vector<Kind> found;
  for (const Note& note : notes) {
    if (const auto* const own = std::get_if<Kind>(&note)) {
      found.push_back(*own);
    }
  }
  return found;
}

std::vector<estimation::RunNote> notes_on(const motor::Motor& motor, const recording::Recording& log) {
  return of_kind<estimation::RunNote>(predict(motor, std::vector{log}, {}).notes);
}

/// One of two logs has the speed of the vehicle. The other is named; the effect is not said to lack its signal everywhere.
TEST(EffectSignals, CalibrateNamesTheLogsThatLackOne) {
  const Folder folder;
  const motor::Motor motor = with_effect(Sheet{}.motor(folder), "wind", "vehicle_airflow", {0.1, 0.7});
  const recording::Recording windy = log_with("windy", "vehicle_speed_m_per_s", 1.0);
  recording::Recording still = estimation::generated_log({}, {.duration_s = 900.0}, 5, 1);
  still.name = "still";
  const Calibration found = calibrate(motor, std::vector{windy, still}, {}, {});
  const std::vector<SignalsMissing> missing = of_kind<SignalsMissing>(found.findings);
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_EQ(missing[0].recording, "still");
  EXPECT_EQ(missing[0].effect, "wind");
  EXPECT_THAT(missing[0].signals, ElementsAre(thermal::Signal::vehicle_speed));
}

/// The rows are 1 s apart: a blank of 90 rows is longer than the 60 s over which a temperature is interpolated, one of 40 rows is not.
TEST(EffectSignals, ALongBlankOfANeighbourIsReported) {
  const Folder folder;
  const motor::Motor motor = with_effect(Sheet{}.motor(folder), "next", "neighbour_coupling", {0.05});
  recording::Recording log = log_with("warm", "neighbour_C", 60.0);
  blank(log, 100, 140);
  EXPECT_TRUE(of_kind<estimation::ColumnBlank>(notes_on(motor, log)).empty());
  blank(log, 300, 390);
  const auto blanks = of_kind<estimation::ColumnBlank>(notes_on(motor, log));
  ASSERT_EQ(blanks.size(), 1U);
  EXPECT_EQ(blanks[0].recording, "warm");
  EXPECT_EQ(blanks[0].column, "neighbour_C");
  EXPECT_NEAR(blanks[0].blank_s, 90.0, 1e-9);
  EXPECT_FALSE(blanks[0].is_held);
}

/// Hours of running cannot be negative. The row is named, whatever else the log contains.
TEST(EffectSignals, ANegativeAgeIsRefused) {
  const Folder folder;
  recording::Recording log = log_with("old", "age_h", 20.0);
  log.channels.back().values[3] = -2.0;
  const auto file = write_log(log, folder.path() / "old.csv");
  const PredictionJob job{Sheet{}.motor(folder), recording::read_usable_logs({}, {file.string()}, {})};
  try {
    run_prediction(job);
    FAIL() << "a negative age was accepted";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), testing::AllOf(HasSubstr("old.csv:5: error: age_h: is -2 h"), HasSubstr("0 or more")));
  }
}

}  // namespace
}  // namespace heatsoak::calibration::study
