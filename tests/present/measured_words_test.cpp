// Wording of the findings about logs, friction tests and fits: one sentence for every kind of finding.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "calibration/admission.h"
#include "calibration/calibrate.h"
#include "calibration/calibration_job.h"
#include "calibration/prediction_job.h"
#include "diagnosis/findings.h"
#include "estimation/findings.h"
#include "friction/friction_job.h"
#include "friction/robot_file.h"
#include "present/failure_words.h"
#include "present/measured/calibration.h"
#include "present/measured/calibration_words.h"
#include "present/measured/diagnosis_output.h"
#include "present/measured/diagnosis_words.h"
#include "present/measured/friction_words.h"
#include "present/measured/log_words.h"
#include "present/measured/prediction.h"
#include "present/measured/run_words.h"
#include "recording/quality.h"

namespace heatsoak::present {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

template <class Finding>
using Sentences = std::vector<std::pair<Finding, const char*>>;

/// Expects the sentence of each finding, and that the list has every kind of finding.
template <class Finding>
void expect_words(const Sentences<Finding>& sentences) {
  std::set<std::size_t> kinds;
  for (const auto& [finding, words] : sentences) {
    EXPECT_EQ(words_of(finding), words);
    kinds.insert(finding.index());
  }
  EXPECT_EQ(kinds.size(), std::variant_size_v<Finding>);
}

TEST(WordsOfLogs, Suspicions) {
  using namespace recording;
  expect_words<Suspicion>({
      {CurrentTooLarge{"current_A", 8004.0}, "current_A reaches 8000 A: is it in milliamperes?"},
      {PowerDiffersFromBus{0.001}, "power_in_W is 0.001 times bus_V × bus_A: is one of them in another unit?"},
      {PowerOppositeToBus{}, "power_in_W and bus_V × bus_A have opposite signs"},
      {TorqueOppositeToCurrent{}, "torque_Nm and current_A have opposite signs: is the sign of one of them wrong?"},
      {SpeedTooLarge{"speed_rad_per_s", 5000.0},
       "speed_rad_per_s reaches 5000 rad/s: is it in rpm (524 rad/s) or degrees per second (87.3 rad/s)?"},
      {ShaftPowerExceedsInput{7.64},
       "torque_Nm × speed_rad_per_s is 7.64 times power_in_W, more than the input: is the speed in rpm (÷ 9.55) or degrees per second (÷ "
       "57.3)?"},
      {AngleSpansDegrees{"yaw_rad", 359.0}, "yaw_rad spans 359 rad: is it in degrees?"},
      {WheelRowsFarApart{20.0}, "the speeds of wheels are 20 s apart: is the time in milliseconds?"},
      {ModulationAboveOne{"wheel_modulation_ratio_1", 97.0},
       "wheel_modulation_ratio_1 reaches 97: is it in percent or in counts of a timer? 1 is the whole battery voltage"},
      {VoltageTooLarge{"battery_V", 24000.0}, "battery_V reaches 24000 V: is it in millivolts?"},
      {LastsForDays{8.64e5, 1000.0, TimeUnit::milliseconds}, "the log lasts 10 days at 1000 s per row: is the time in milliseconds?"},
      {LastsForDays{8.64e8, 1e6, TimeUnit::microseconds}, "the log lasts 10000 days at 1000000 s per row: is the time in microseconds?"},
      {FallsTooFast{"stator_C", 1.0 / 60.0, 10.0, 2.5, TimeUnit::minutes},
       "the rows are 0.0167 s apart and stator_C falls by 10 K in 2.5 s: is the time in minutes?"},
      {RespondsEarly{"winding_C", "current_A", -1.0, 0.2, true},
       "winding_C responds 1 s ± 0.2 s before current_A changes, so one of their clocks is off; in a mapping give current_A and all "
       "columns "
       "logged with it clock_offset = \"-1 s\", or inputs = \"previous_interval\" if a row's inputs describe the interval before it"},
      {RespondsEarly{"winding_C", "current_A", -4.0, 0.2, false},
       "winding_C responds 4 s ± 0.2 s before current_A changes, so one of their clocks is off; in a mapping give current_A and all "
       "columns "
       "logged with it clock_offset = \"-4 s\""},
      {ConstantSensor{"winding_C", 25.0, "stator_C", 31.2},
       "winding_C is constant, 25 °C, while stator_C changes by 31.2 K: is its sensor connected?"},
      {StaysAtLimit{"current_A", "A", 3.0, 250, 1000},
       "current_A stays at exactly 3 A in 25 % of its rows: a limit, or a saturated sensor?"},
      {AmbientAboveMotor{"stator_C", 12.0}, "ambient_C is hotter than stator_C most of the time (by 12 K): are the channels swapped?"},
      {FallsWhileHeated{"winding_C", "current_A"},
       "winding_C falls while current_A heats and rises while it rests: is the sign of the sensor wrong?"},
      {StatorRespondsFaster{"current_A", 90.0, 30.0},
       "stator_C responds to current_A faster than winding_C and varies more (90 K against 30 K): are the two swapped?"},
      {StatorHotterAtRest{8.0}, "without heat, stator_C is hotter than winding_C (by 8 K) and falls by more: are the two swapped?"},
      {StatorWarmsFirst{"current_A", 30.0, 20.0},
       "at standstill current_A heats stator_C by 30 K while winding_C is 20 K cooler: are the two swapped, or is a sensor elsewhere?"},
      {StartsInOtherScale{"stator_C", 220.0, 22.0, TemperatureScale::tenths_of_degrees},
       "stator_C starts at 220 °C: is it in tenths of degrees (22 °C)?"},
      {StartsInOtherScale{"stator_C", 295.2, 22.06, TemperatureScale::kelvin}, "stator_C starts at 295.2 °C: is it in kelvin (22.1 °C)?"},
      {StartsInOtherScale{"ambient_C", 71.6, 22.0, TemperatureScale::fahrenheit},
       "ambient_C starts at 71.6 °C: is it in degrees Fahrenheit (22 °C)?"},
      {MotorStartsInFahrenheit{"winding_C", 71.6, 22.0, 21.0},
       "winding_C and the motor's other temperatures start at 71.6 °C in air of 21 °C: are they in degrees Fahrenheit (22 °C)?"},
      {MotorCoolsInFahrenheit{"winding_C", 71.6, 22.0, 21.0},
       "winding_C reaches a steady state of 71.6 °C without heat, in air of 21 °C: are the motor's temperatures in degrees Fahrenheit (22 "
       "°C)?"},
  });
  EXPECT_EQ(words_of(SuspicionOfLog{"run1", PowerOppositeToBus{}}), "run1: power_in_W and bus_V × bus_A have opposite signs");
}

TEST(WordsOfLogs, LacksDelaysAndNotes) {
  using namespace recording;
  expect_words<Lack>({
      {TooFewRows{1, 20}, "it has 1 row; at least 20 are needed"},
      {NoTemperature{}, "it has no temperature of the motor (winding_C, stator_C, …)"},
      {NoHeatInput{}, "it has no heat input (current_A, power_in_W, torque_Nm, speed_rad_per_s, …)"},
      {TemperatureIsConstant{"winding_C", 25.0}, "winding_C is constant, 25 °C"},
      {TemperatureWithinNoise{"winding_C", 24.1, 25.3, 0.31},
       "no temperature changes by more than its noise: winding_C from 24.1 °C to 25.3 °C, noise 0.31 K"},
      {HeatInputIsZero{"current_A"}, "there is no heat input: current_A is 0 throughout"},
      {NoWheelSpeed{}, "it has no speeds of wheels (wheel_speed_rad_per_s_1, …)"},
      {WheelsKeepSpeed{}, "no wheel changes its speed beyond the noise"},
      {NoWheelEffort{}, "it has no effort of wheels (wheel_modulation_ratio_1, wheel_voltage_V_1 or wheel_current_A_1, …)"},
  });
  expect_words<NoDelayReason>({
      {IntervalsTooShort{}, "the intervals without a gap are too short"},
      {NoBestDelay{10.0}, "no delay within ± 10 s gives a best fit"},
      {PartsDisagree{3.21}, "parts of the log disagree by 3.2 s"},
  });
  expect_words<ReadingNote>({
      {ColumnWithoutUnit{5, "comment"}, "column 5 'comment' is not used: its name does not end in a unit"},
      {AdditionalSignal{"stator_F"},
       "stator_F is used as an additional signal; did you mean 'stator_C'? A column in another unit is read with a mapping: stator_C = { "
       "column = \"stator_F\", unit = … }"},
      {AdditionalSignal{"windin_C"}, "windin_C is used as an additional signal; did you mean 'winding_C'?"},
      {NotRecorded{"coolant_C", "T_cool"}, "coolant_C is not recorded: no column 'T_cool'"},
      {ChannelWithoutNumbers{"stator_C", 1800}, "stator_C is left out: not one number in 1800 rows"},
      {BlanksFilled{"power_in_W", 1}, "power_in_W: 1 blank samples are filled as the mapping states"},
  });
}

TEST(WordsOfLogs, Admission) {
  using namespace calibration;
  expect_words<LogProblem>({
      {recording::PowerOppositeToBus{}, "power_in_W and bus_V × bus_A have opposite signs"},
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
              ElementsAre("run1 states that it is of the motor a, not of b", "run1: power_in_W and bus_V × bus_A have opposite signs",
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

/// The factor of the curve is part of the sentence, also if the curve is over the time.
TEST(WordsOfDiagnosis, FactorsOfCurves) {
  using attribution::Multiplier;
  const auto sentence = [](const std::string& driver, Multiplier multiplier, double at_knots) {
    diagnosis::Diagnosis diagnosis;
    diagnosis::Unexplained heat;
    heat.node = "winding";
    heat.other_node = "stator";
    heat.signals = {driver};
    heat.multiplier = multiplier;
    heat.mean_W = 2.0;
    heat.peak_W = 5.0;
    heat.curve = {0.0, at_knots};
    heat.is_in_model = driver != "time";
    diagnosis.unexplained = {heat};
    return unexplained_words(diagnosis).front();
  };
  EXPECT_EQ(sentence("fan_V", Multiplier::source, 5.0),
            "Unnamed: heat into the winding that follows fan_V, 2 W on average, up to 5 W. The extended model contains it as a curve.");
  EXPECT_THAT(sentence("fan_V", Multiplier::excess, 5.0),
              testing::StartsWith("Unnamed: heat out of the winding that follows the temperature rise of the winding above ambient times a "
                                  "curve over fan_V, "));
  EXPECT_THAT(sentence("time", Multiplier::copper, 0.2),
              testing::StartsWith("Unexplained: heat into the winding that no measured signal explains; it is the copper loss times a "
                                  "curve over the time since the start of the recording, "));
  EXPECT_THAT(sentence("time", Multiplier::source, -3.0),
              testing::StartsWith("Unexplained: heat out of the winding that no measured signal explains; it is a curve over the time "));
  EXPECT_THAT(sentence("speed", Multiplier::difference, -0.1),
              HasSubstr("the temperature difference from winding to stator times a curve over speed, "));
}

TEST(WordsOfDiagnosis, Findings) {
  using namespace diagnosis;
  const std::vector<std::pair<DiagnosisFinding, Severity>> severities{
      {ExtensionsMayImitate{{"contact_law"}}, Severity::warning},
      {ContradictingRun{}, Severity::warning},
      {calibration::SignalsMissing{}, Severity::note},
      {IntervalsOfDataSheet{}, Severity::note},
      {calibration::RowsTurn{}, Severity::note},
  };
  for (const auto& [finding, severity] : severities) {
    EXPECT_EQ(severity_of(finding), severity) << words_of(finding);
  }
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

TEST(Prediction, JsonKeepsTheSeverityOfWarnings) {
  calibration::PredictionAnswer answer;
  answer.warnings = {calibration::FittedRun{"bench.csv"}};
  const Json json = prediction_json({}, answer, {});
  ASSERT_EQ(json["warnings"].size(), 1U);
  EXPECT_THAT(json["warnings"][0].get<std::string>(), HasSubstr("the error of bench.csv is not a forecast error"));
  EXPECT_EQ(json["notes"], json["warnings"]);
}

TEST(Diagnosis, PageAndJsonKeepTheSeverityOfWarnings) {
  diagnosis::DiagnosisAnswer answer;
  answer.findings = {diagnosis::IntervalsOfDataSheet{}, diagnosis::ExtensionsMayImitate{{"contact_law"}}};
  const Json json = diagnosis_json(answer, {});
  EXPECT_EQ(json["notes"].size(), 2U);
  ASSERT_EQ(json["warnings"].size(), 1U);
  EXPECT_EQ(json["warnings"][0], words_of(answer.findings[1]));
  const std::string page = diagnosis_page(answer, {}, {});
  EXPECT_THAT(page, HasSubstr("<li><strong>Warning:</strong> an effect similar to contact_law"));
  EXPECT_LT(page.find("an effect similar to contact_law"), page.find(words_of(answer.findings[0]).substr(12)));
}

/// A missing signal has the default of its row; no default is safe for the temperature of a neighbour.
TEST(WordsOfDiagnosis, MissingSignalsHaveTheAssumptionOfTheirRow) {
  using thermal::Signal;
  const auto words = [](std::vector<Signal> signals) {
    return words_of(diagnosis::DiagnosisFinding(calibration::SignalsMissing{std::move(signals), "loss"}));
  };
  EXPECT_EQ(words({Signal::current, Signal::speed}),
            "no log has current_A and speed_rad_per_s, on which loss depends; the value 0 is used");
  EXPECT_EQ(words({Signal::neighbour_temperature}),
            "no log has neighbour_C, on which loss depends; the temperature of the neighbour is treated as unknown");
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

TEST(WordsOfFailures, OfRunsAndDiagnoses) {
  EXPECT_EQ(in_words(estimation::NoUsableInterval("run1", "logs/run1.csv", 10, {estimation::UsablePartsTooShort{}})).message(),
            "run1: no interval of 10 rows or more has temperatures and all heat inputs: intervals are too short; see `heatsoak log inspect "
            "logs/run1.csv`");
  const base::Failure heat = in_words(diagnosis::NothingHeatsModel("ecx"));
  EXPECT_EQ(heat.code(), base::ExitCode::bad_input);
  EXPECT_EQ(heat.message(),
            "no log has a heat input for ecx; expected current_A, or power_in_W with an effect input_power_loss; add one to the logs");
  EXPECT_THAT(in_words(diagnosis::NoEffectFollows({"stator_C", 31.26, 8.04})).message(),
              HasSubstr("no effect makes the model follow these logs: stator_C has an error of 31 K rms, more than its variation (standard "
                        "deviation 8 K)\n  check for another motor"));
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

TEST(WordsOfDiagnosis, Experiments) {
  diagnosis::Experiment experiment{.effect = "windage", .rival = "iron_loss_eddy", .other = "close the housing"};
  EXPECT_EQ(experiment_words(experiment), "close the housing");
  std::set<std::string> words;
  for (int run = 0; run <= static_cast<int>(diagnosis::PlannedRun::rest_after_standstill); ++run) {
    experiment.planned = static_cast<diagnosis::PlannedRun>(run);
    words.insert(experiment_words(experiment));
  }
  EXPECT_EQ(words.size(), 7U);
  EXPECT_FALSE(words.contains(""));
  experiment.planned = diagnosis::PlannedRun::one_speed_with_currents;
  experiment.most_A = 2.04;
  experiment.most_rad_per_s = 150.0;
  EXPECT_EQ(experiment_words(experiment),
            "one speed at four currents; with at most 2 A and 150 rad/s the motor gets no hotter than in these runs");
}

TEST(WordsOfDiagnosis, RunDeviationsAreNotesOfTheModelFile) {
  diagnosis::Diagnosis found;
  diagnosis::FoundEffect deviation;
  deviation.id = "heat_share";
  deviation.node = "winding";
  deviation.parameters = {{"deviation", "", -0.3052}};
  deviation.condition = {{"run", "run4"}};
  diagnosis::FoundEffect named = deviation;
  named.name = "fan";
  diagnosis::FoundEffect sensor = deviation;
  sensor.id = "sensor_offset_winding";
  found.effects = {named, deviation, sensor};
  EXPECT_EQ(
      notes_of_model_file(found),
      std::vector<std::string>{"heat_share at the winding in run4: deviation -0.305 ; found in measurements, not a property of the motor"});
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
        std::pair(winding_not_stepped, "never changes in steps")}) {
    open.reason = reason;
    open.longest_run_s = 120.0;
    open.stator_s = 1150.0;
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

TEST(WordsOfFriction, Suspicions) {
  using namespace friction;
  expect_words<FrictionSuspicion>({
      {recording::AngleSpansDegrees{"yaw_rad", 359.0}, "yaw_rad spans 359 rad: is it in degrees?"},
      {DirectionDiffers{90.2},
       "the direction of travel is 90° off the direction that follows from the wheels' speeds: are the wheels in another order than in the "
       "robot's file, or is an angle in degrees or in another frame?"},
      {SpeedsContradict{0.31},
       "31 % of the wheels' speeds fit no motion of the robot: do their order or signs differ from the robot's file?"},
      {VoltageFallsWithSpeed{}, "voltage falls as the wheels turn faster: does one of them have the wrong sign?"},
      {DampingDiffersFromBackEmf{9.5},
       "d is 9.5 times the motor's back-EMF, expected 1 to 2 times: is a speed in rpm or that of the wheel instead of its motor, a "
       "modulation in percent, a voltage in millivolts or too high, or is it another motor?"},
      {MoreWheelsThanRobot{4, 3}, "the log has values of wheel 4, but the robot's file has 3 wheels: is it the log of another robot?"},
      {WheelWithoutVoltage{2}, "wheel 2 turns with hardly any voltage: is its modulation missing from the log?"},
      {WheelVoltageFallsWithSpeed{2}, "voltage of wheel 2 falls as it turns faster: does its speed or its modulation have the wrong sign?"},
      {FrictionDrivesWheel{2, -0.5, -1.25},
       "friction of wheel 2 would drive it (a = -0.5 V, b = -1.2 V): is its modulation that of another wheel, or of the wrong sign?"},
      {WheelVoltageUnexplained{2, 0.456},
       "voltage of wheel 2 hardly follows its speed and direction (R² 0.46): is its modulation that of another wheel?"},
      {WheelDampingDiffers{2, 4.0},
       "d of wheel 2 is 4 times the motor's back-EMF, expected 1 to 2 times: is its speed or modulation in another unit?"},
  });
  EXPECT_THAT(words_of(std::vector<SuspicionOfTest>{{"run1", recording::PowerOppositeToBus{}}, {"", VoltageFallsWithSpeed{}}}),
              ElementsAre("run1: power_in_W and bus_V × bus_A have opposite signs",
                          "voltage falls as the wheels turn faster: does one of them have the wrong sign?"));
}

TEST(WordsOfFriction, ProblemsOfWheels) {
  using enum friction::WheelProblem;
  EXPECT_EQ(words_of(hardly_turns), "it hardly turns in any steady leg");
  EXPECT_EQ(words_of(constant_voltage), "its voltage is the same in all legs");
  EXPECT_THAT(words_of(one_speed), HasSubstr("drive at two speeds or more"));
  EXPECT_THAT(words_of(too_few_headings), HasSubstr("drive at least six directions all around"));
  EXPECT_EQ(words_of(too_few_legs), "it has too few steady legs");
  EXPECT_EQ(words_of(friction::Repeats::legs_on_one_heading), "legs on one heading");
  EXPECT_EQ(words_of(friction::Repeats::speeds_of_one_leg), "speeds of one leg");
  EXPECT_EQ(words_of(friction::Repeats::neighbouring_headings), "neighbouring headings");
  EXPECT_EQ(words_of(friction::ExpectedFrom::robot_file), "the robot's file");
  EXPECT_EQ(words_of(friction::ExpectedFrom::motor_data_sheet), "the motor's data sheet");
}

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
  EXPECT_EQ(to_string(wrong.diagnostics()[0]), "run1.csv: error: current_A reaches 8000 A: is it in milliamperes?");
  const base::Failure plain(base::ExitCode::numerics_failed, "did not converge");
  EXPECT_STREQ(told(plain).what(), plain.what());
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
  EXPECT_EQ(
      told(calibration::NothingFollows({{"winding_C", 30.0, 20.0}, {"stator_C", 30.0, 40.0}}, false)).message(),
      "no parameter values make the model follow these logs\n  winding_C has an error of 30 K rms, more than its variation (standard "
      "deviation 20 K)\n  stator_C has an error of 30 K rms, close to its variation (standard deviation 40 K)\n  no log has the speed "
      "(speed_rad_per_s), so the loss at speed is unknown\n  check for another motor, a wrong unit (degrees Fahrenheit, minutes, "
      "milliamperes), a misplaced sensor, or heat that no column contains; `heatsoak log inspect` shows each channel");
  EXPECT_THAT(told(calibration::NothingFollows({{"winding_C", 30.0, 20.0}}, true)).message(),
              testing::Not(HasSubstr("no log has the speed")));
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
            "suspicious: run1: power_in_W and bus_V × bus_A have opposite signs");
  EXPECT_EQ(told(friction::NothingIdentifiable({})).message(),
            "nothing is identifiable: in no interval do the wheels turn steadily; legs of one speed and direction must last a second or "
            "more");
  EXPECT_THAT(told(friction::WheelNotIdentifiable(2, friction::WheelProblem::hardly_turns)).message(),
              EndsWith("friction of wheel 2 over the directions is not identifiable: it hardly turns in any steady leg"));
  EXPECT_THAT(told(friction::WheelNotIdentifiable(2, std::nullopt)).message(), EndsWith("its logs only turn on the spot"));
}

}  // namespace
}  // namespace heatsoak::present
