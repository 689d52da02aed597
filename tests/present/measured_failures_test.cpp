// Wording of findings that end a verb on measured logs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "calibration/admission.h"
#include "calibration/calibrate.h"
#include "diagnosis/findings.h"
#include "estimation/findings.h"
#include "friction/friction_job.h"
#include "friction/robot_file.h"
#include "present/failure_words.h"
#include "recording/quality.h"

namespace heatsoak::present {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

template <class Failure>
base::Failure told(const Failure& failure) {
  try {
    with_words([&failure]() -> int { throw failure; });
  } catch (const base::Failure& words) {
    EXPECT_EQ(words.code(), failure.code());
    return words;
  }
  return {base::ExitCode::bug, "nothing was thrown"};
}

TEST(WordsOfFailures, FindingsOfLogs) {
  EXPECT_STREQ(told(recording::NothingAboutHeat({{"a/run1.csv", {recording::TooFewRows{2, 20}, recording::NoHeatInput{}}},
                                                 {"a/run2.csv", {recording::TooFewRows{3, 20}}}}))
                   .what(),
               "a/run1.csv: error: no information about heat: it has 2 rows; at least 20 are needed; it has no heat input "
               "(current_A, power_in_W, torque_Nm, speed_rad_per_s, …)\n"
               "a/run2.csv: error: no information about heat: it has 3 rows; at least 20 are needed");
  const base::Failure wrong = told(calibration::LogsLookWrong({{"run1.csv", recording::CurrentTooLarge{"current_A", 8000.0}}}));
  EXPECT_THAT(wrong.message(), EndsWith("or use --as-is if they are right"));
  ASSERT_EQ(wrong.diagnostics().size(), 1U);
  EXPECT_EQ(to_string(wrong.diagnostics()[0]),
            "run1.csv: error: current_A reaches 8000 A: is it in milliamperes? If so, state unit = \"mA\" in a mapping (--map)");
  const base::Failure plain(base::ExitCode::numerics_failed, "did not converge");
  EXPECT_STREQ(told(plain).what(), plain.what());
}

TEST(WordsOfFailures, OfRunsAndDiagnoses) {
  EXPECT_EQ(in_words(estimation::NoUsableInterval("run1", "logs/run1.csv", 10, {estimation::UsablePartsTooShort{}})).message(),
            "run1: no interval of 10 rows or more has temperatures and all heat inputs: intervals are too short; see `heatsoak log inspect "
            "logs/run1.csv`");
  const base::Failure heat = in_words(diagnosis::NothingHeatsModel("ecx"));
  EXPECT_EQ(heat.code(), base::ExitCode::bad_input);
  EXPECT_EQ(heat.message(),
            "no log has a heat input for ecx; expected current_A, or power_in_W with an effect input_power_loss; add one to the logs");
}

TEST(WordsOfFailures, OfRunsThatCountTwiceOrCannotBeSimulated) {
  const base::Failure twice = in_words(
      recording::RowsGivenTwice({{{"logs/b.csv", {2, 90}}, {"logs/a.csv", {2, 90}}}, {{"logs/a.csv", {40, 90}}, {"logs/a.csv", {2, 60}}}}));
  EXPECT_EQ(twice.code(), base::ExitCode::bad_input);
  ASSERT_EQ(twice.diagnostics().size(), 2U);
  EXPECT_EQ(
      to_string(twice.diagnostics()[1]),
      "logs/a.csv:40:1: error: lines 40 to 90 share rows with lines 2 to 60 of logs/a.csv; give each row once, to fit or as hold-out");
  const base::Failure again = in_words(calibration::RunsOfTheFile("ecx", {"logs/a.csv"}));
  EXPECT_EQ(again.code(), base::ExitCode::bad_input);
  ASSERT_EQ(again.diagnostics().size(), 1U);
  EXPECT_EQ(again.diagnostics()[0].message, "the motor file of ecx was fitted to these rows (fit.runs)");
  const base::Failure cause(base::ExitCode::numerics_failed, "too fast");
  const base::Failure failed = in_words(estimation::RunNotSimulated("run1", cause));
  EXPECT_EQ(failed.code(), base::ExitCode::numerics_failed);
  EXPECT_THAT(failed.message(), testing::StartsWith("run1: too fast; check the units of the log's columns"));
}

TEST(WordsOfFailures, NothingLearned) {
  calibration::OpenDirection open;
  open.parameters = {"no_load_current"};
  open.reason = calibration::OpenReason::motor_hardly_turns;
  open.remedy = calibration::Remedy::no_load_run;
  EXPECT_EQ(told(calibration::NothingLearned({open}, false)).message(),
            "no parameter of this motor is identifiable from these logs\n  not identifiable: no_load_current: the motor hardly turns in "
            "these runs\n  cheapest experiment: 10 minutes at no load and full speed");
  EXPECT_THAT(told(calibration::NothingLearned({open}, true)).message(),
              EndsWith("also check the units of the heat inputs (kiloamperes, kilowatts); `heatsoak log inspect` shows each channel"));
}

TEST(WordsOfFailures, NothingFollows) {
  constexpr auto kParameters = calibration::NothingFollows::Tried::parameters;
  EXPECT_EQ(
      told(calibration::NothingFollows(kParameters, {{"winding_C", 30.0, 20.0}, {"stator_C", 30.0, 40.0}}, false)).message(),
      "no parameter values make the model follow these logs\n  winding_C has an error of 30 K rms, more than its variation (standard "
      "deviation 20 K)\n  stator_C has an error of 30 K rms, close to its variation (standard deviation 40 K)\n  a log lacks the speed "
      "(speed_rad_per_s), so the loss at speed is unknown\n  check for another motor, a wrong unit (degrees Fahrenheit, minutes, "
      "milliamperes), a misplaced sensor, or heat that no column contains; `heatsoak log inspect` shows each channel");
  EXPECT_THAT(told(calibration::NothingFollows(kParameters, {{"winding_C", 30.0, 20.0}}, true)).message(),
              testing::Not(HasSubstr("a log lacks the speed")));
  EXPECT_THAT(
      told(calibration::NothingFollows(calibration::NothingFollows::Tried::effects, {{"stator_C", 31.26, 8.04}}, true)).message(),
      HasSubstr("no effect makes the model follow these logs\n  stator_C has an error of 31 K rms, more than its variation (standard "
                "deviation 8 K)\n  check for another motor"));
}

TEST(WordsOfFailures, FindingsOfFriction) {
  const base::Failure wrong = told(friction::LogsLookWrong({{"run1.csv", friction::WheelWithoutVoltage{2}}}));
  ASSERT_EQ(wrong.diagnostics().size(), 1U);
  EXPECT_THAT(wrong.diagnostics()[0].message, HasSubstr("wheel 2 turns with hardly any voltage"));
  EXPECT_EQ(told(friction::NothingIdentifiable({.legs = 3,
                                                .headings = 1,
                                                .of_first_wheel = friction::WheelProblem::too_few_legs,
                                                .suspicions = {{"run1", recording::PowerOppositeToBus{}}}}))
                .message(),
            "nothing is identifiable from 3 steady legs on 1 heading: of wheel 1, it has too few steady legs\n"
            "suspicious: run1: power_in_W and bus_V × bus_A have opposite signs: is the sign of one of them wrong? If so, state sign = "
            "\"-\" in a mapping (--map)");
  EXPECT_EQ(told(friction::NothingIdentifiable({})).message(),
            "nothing is identifiable: in no interval do the wheels turn steadily; legs of one speed and direction must last a second or "
            "more");
  EXPECT_THAT(told(friction::WheelNotIdentifiable(2, friction::WheelProblem::hardly_turns)).message(),
              EndsWith("friction of wheel 2 over the directions is not identifiable: it hardly turns in any steady leg"));
  EXPECT_THAT(told(friction::WheelNotIdentifiable(2, std::nullopt)).message(), EndsWith("its logs only turn on the spot"));
}

}  // namespace
}  // namespace heatsoak::present
