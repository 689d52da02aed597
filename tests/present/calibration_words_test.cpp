// Wording of the findings of calibrations and predictions, and of their runs.
#include "present/measured/calibration_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "calibration/admission.h"
#include "calibration/calibrate.h"
#include "calibration/calibration_job.h"
#include "calibration/prediction_job.h"
#include "estimation/findings.h"
#include "present/measured/calibration.h"
#include "present/measured/log_words.h"
#include "present/measured/prediction.h"
#include "present/measured/run_words.h"
#include "present/renderer.h"
#include "sentences_of_kinds.h"

namespace heatsoak::present {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(WordsOfCalibration, Admission) {
  using namespace calibration;
  expect_words<LogProblem>({
      {recording::PowerOppositeToBus{},
       "power_in_W and bus_V × bus_A have opposite signs: is the sign of one of them wrong? If so, state sign = \"-\" in a mapping "
       "(--map)"},
      {CurrentOutliers{900.0, 120.0, 302},
       "current_A reaches 900 A in line 302; at three times the nominal voltage this motor reaches 120 A, and less than 2 % of the rows "
       "exceed that: exclude outliers with valid = \"…\" in a mapping, or is it in milliamperes?"},
      {SpeedOutliers{9000.0, 2000.0, 302},
       "speed_rad_per_s reaches 9000 rad/s in line 302; at three times the nominal voltage this motor reaches 2000 rad/s, and less than 2 "
       "% "
       "of the rows exceed that: exclude outliers with valid = \"…\" in a mapping, or is it in rpm?"},
      {CurrentExceedsMotor{200.0, 120.0, 0.6},
       "current_A reaches 200 A; through 0.6 ohm at most 120 A flow at three times the nominal voltage: is it in milliamperes, or is it "
       "another motor?"},
      {SpeedExceedsMotor{5000.0, 2000.0},
       "speed_rad_per_s reaches 5000 rad/s; at three times the nominal voltage this motor turns at 2000 rad/s: is it in rpm (524 rad/s), "
       "or "
       "is it another motor?"},
      {RisesTooFast{"winding_C", 61.0, recording::TimeUnit::minutes},
       "winding_C rises about 60 times as fast as the losses of this motor can heat it: is the time in minutes, is a heat input in another "
       "unit, or is it another motor?"},
  });
  EXPECT_THAT(words_of(std::vector<AdmissionNote>{OfOtherMotor{"run1", "a", "b"},
                                                  recording::SuspicionOfLog{"run1", recording::PowerOppositeToBus{}},
                                                  SensorLags{"run1", {"winding_C", "current_A", 3.0, 0.2}}}),
              ElementsAre("run1 states that it is of the motor a, not of b",
                          "run1: power_in_W and bus_V × bus_A have opposite signs: is the sign of one of them wrong? If so, state sign = "
                          "\"-\" in a mapping (--map)",
                          "run1: winding_C follows current_A 3 s ± 0.2 s late: its sensor lags, or a clock is off (clock_offset of a "
                          "mapping); the values fitted to the winding (heat capacity, time constant, resistance to the stator) are biased "
                          "by more than their intervals"));
  EXPECT_THAT(lag_words("winding_C"), testing::StartsWith("winding_C lags: record one event"));
}

TEST(WordsOfCalibration, HeldValues) {
  using namespace calibration;
  const auto words = [](const HeldValue& held) { return words_of(CalibrationFinding(held)); };
  EXPECT_EQ(words(ResistanceHeld{}), "terminal_resistance is held at its stated value: all heat capacities and resistances scale with it");
  EXPECT_EQ(words(NoLoadCurrentUnused{}), "no_load_current is not used: the loss other than copper loss is the measured power balance");
  EXPECT_EQ(words(NoLoadCurrentHeld{}), "no_load_current is held: its loss depends on speed, which not every log has");
  EXPECT_THAT(words(HeatShareHeld{false}), HasSubstr("scale with it; all of it is assumed to arise at the winding, and iron loss, friction "
                                                     "or a driver's heat at the stator would shift"));
  EXPECT_THAT(words(HeatShareHeld{true}),
              HasSubstr("the part due to no_load_current is assumed to arise at the stator and the rest to arise at the winding, and iron "
                        "loss, friction or a driver's heat at the stator beyond that would shift"));
  EXPECT_EQ(words(EffectHeld{"fan", {"conductance"}}), "effects.fan: conductance is held: the file states no tolerance or range");
  EXPECT_EQ(words(EffectHeld{"fan", {"a", "b"}}), "effects.fan: a, b are held: the file states no tolerance or range");
  EXPECT_EQ(words(SensorHeld{"glued_on", "time_constant", 25.0, "s"}),
            "effects.glued_on.time_constant is held at 25 s: an error of the sensor is not a property of the motor");
  EXPECT_EQ(words(SensorHeld{"amplifier", "factor", 1.1, ""}),
            "effects.amplifier.factor is held at 1.1: an error of the sensor is not a property of the motor");
  EXPECT_EQ(words(SensorUnused{"glued_on", "stator_C"}),
            "no log has the stator_C to which effects.glued_on applies: the effect is not used");
}

TEST(WordsOfCalibration, OpenDirections) {
  using namespace calibration;
  OpenDirection open;
  open.parameters = {"no_load_current"};
  EXPECT_EQ(parameter_words(open), "no_load_current");
  open.together = {{"a", true}, {"b", false}};
  EXPECT_EQ(parameter_words(open), "a raised, b lowered together, no_load_current");
  using enum OpenReason;
  for (const auto& [reason, words] :
       {std::pair(no_heat, "a cool-down determines time constants, but no heat capacity or resistance"),
        std::pair(common_factor, "a common factor on all heat, all heat capacities and all conductances changes no temperature"),
        std::pair(only_stator_measured, "only the stator is measured"), std::pair(only_winding_measured, "only the winding is measured"),
        std::pair(motor_hardly_turns, "the motor hardly turns"),
        std::pair(small_loss_at_speed, "the loss at speed is small against the copper loss"), std::pair(not_excited, "hardly depend on it"),
        std::pair(speed_not_logged, "the runs do not contain the speed"),
        std::pair(stator_not_settled, "the longest lasts 2 min, the stator's time constant is about 20 min"),
        std::pair(stator_beside_unknown_heat, "the uncertainty stays a factor of 1.7"),
        std::pair(winding_not_stepped, "never changes in steps")}) {
    open.reason = reason;
    open.longest_run_s = 120.0;
    open.stator_s = 1150.0;
    open.left_sd = 0.27;
    EXPECT_THAT(reason_words(open), HasSubstr(words));
  }
  for (const auto& [remedy, words] :
       {std::pair(Remedy::heated_run, "constant current at standstill"), std::pair(Remedy::four_wire_resistance, "four wires"),
        std::pair(Remedy::winding_sensor, "a thermocouple at the winding"),
        std::pair(Remedy::stator_sensor, "a thermocouple on the housing"), std::pair(Remedy::no_load_run, "at no load and full speed"),
        std::pair(Remedy::long_run, "up to the steady state"), std::pair(Remedy::logged_speed, "with the speed logged"),
        std::pair(Remedy::current_steps, "several steps of current")}) {
    EXPECT_THAT(words_of(remedy), HasSubstr(words));
  }
}

TEST(WordsOfCalibration, NotesOfForecasts) {
  using namespace calibration;
  EXPECT_THAT(words_of(std::vector<PredictionNote>{BandIncludesLossAtSpeed{"run1", 4.21}, BandIsEstimated{"motor"},
                                                   estimation::RunNote(estimation::SplitIntoRuns{"run2", 3})}),
              ElementsAre("the band of run1 is wider, because its log has a current but no speed: the loss at speed may be anything up to "
                          "4.2 W; if the motor stood still, add speed_rad_per_s = 0",
                          "the band of motor is only an estimate from its declared uncertainties and the usual error of forecasts; "
                          "`heatsoak calibrate`, or `heatsoak diagnose` with two logs or more, determines a band",
                          "run2 is split into 3 runs: heat or ambient temperature is unknown between them"));
}

TEST(WordsOfRuns, NotesAndReasons) {
  using namespace estimation;
  EXPECT_EQ(words_of(RunNote(SensorNeverChanges{"run1", "stator_C"})),
            "run1: stator_C is not used as a sensor, because its value never changes");
  EXPECT_EQ(words_of(RunNote(ColumnsLacking{"run1", {"fan_V", "flap_deg"}})),
            "temperatures of run1 may be too high, because it does not have fan_V, flap_deg: the hottest value of the curve is used");
  EXPECT_EQ(
      words_of(RunNote(ColumnBlank{"run1", "neighbour_C", 90.0, false})),
      "temperatures of run1 may be wrong, because neighbour_C is blank for 90 s, too long to interpolate: the value is treated as unknown");
  EXPECT_EQ(words_of(RunNote(RowsUnused{"run1", 12, 20, {RowsLack{RowsLack::What::signal, thermal::Signal::current, 11, 20}}})),
            "run1: 12 of 20 rows are not used: 11 of 20 rows have no current_A");
  EXPECT_EQ(words_of(std::vector<LossOfRows>{GapsSplitRows{20, 2}, RowsLack{RowsLack::What::surroundings, {}, 1, 20},
                                             RowsLack{RowsLack::What::temperature, {}, 2, 20}}),
            "gaps split its 20 rows into 2 runs ([runs] longest_gap of a mapping sets what counts as a gap), "
            "1 of 20 rows have no ambient temperature within a minute, 2 of 20 rows have no temperature of winding or stator");
  EXPECT_EQ(words_of(std::vector<LossOfRows>{TooFewIntervals{12.0, 9, 2.0}}), "its 12 s make fewer than 9 intervals of 2 s");
  EXPECT_EQ(words_of(std::vector<LossOfRows>{UsablePartsTooShort{}}), "intervals are too short");
}

TEST(Calibration, JsonKeepsTheSeverityOfWarnings) {
  calibration::CalibrationAnswer answer;
  answer.calibration.fit.flux.rms_W = {0.0, 0.0};
  answer.calibration.forecast.emplace();
  answer.calibration.findings = {calibration::FitStoppedEarly{}, calibration::PoorFit{}};
  const Json json = calibration_json({}, answer, {}, "model.toml");
  EXPECT_EQ(json["notes"].size(), 2U);
  ASSERT_EQ(json["warnings"].size(), 1U);
  EXPECT_EQ(json["warnings"][0], words_of(answer.calibration.findings[1]));
  EXPECT_EQ(calibration_document({}, answer, {}, "model.toml").notes.size(), 2U);
}

TEST(Calibration, TheTableHasUnitsAtEveryWidth) {
  calibration::CalibrationAnswer answer;
  answer.calibration.fit.flux.rms_W = {0.0, 0.0};
  answer.calibration.forecast.emplace();
  answer.calibration.parameters = {
      {.name = "effects.a_long_name_of_an_effect.heat_capacity", .unit = "J/K", .before = 400.0, .value = 404.0, .low = 331.0, .high = 492.0}};
  for (const std::size_t width : {60U, 72U, 80U, 120U}) {
    const std::string text = terminal_text(calibration_document({}, answer, {}, "model.toml"), {.width = width});
    EXPECT_THAT(text, HasSubstr("J/K")) << text;
  }
}

TEST(Prediction, JsonKeepsTheSeverityOfWarnings) {
  calibration::PredictionAnswer answer;
  answer.warnings = {calibration::FittedRuns{{"bench.csv"}}};
  const Json json = prediction_json({}, answer, {});
  ASSERT_EQ(json["warnings"].size(), 1U);
  EXPECT_THAT(json["warnings"][0].get<std::string>(), HasSubstr("the error of bench.csv is not a forecast error"));
  EXPECT_EQ(json["notes"], json["warnings"]);
}

TEST(Prediction, OneWarningNamesAllFittedRuns) {
  calibration::PredictionAnswer answer;
  answer.warnings = {calibration::FittedRuns{{"bench@0-10%", "bench@50-60%"}}};
  const std::vector<Note> notes = prediction_notes(answer, {});
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0].words, HasSubstr("the errors of bench@0-10%, bench@50-60% are not forecast errors"));
}

}  // namespace
}  // namespace heatsoak::present
