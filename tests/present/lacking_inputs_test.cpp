// Wording and severity of inputs that a log lacks.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "present/measured/calibration_words.h"
#include "present/measured/diagnosis_words.h"
#include "present/measured/prediction.h"

namespace heatsoak::present {
namespace {

/// Whatever makes temperatures wrong is a warning in every verb that reads logs.
TEST(Prediction, WarnsOfInputsThatALogLacks) {
  using namespace estimation;
  const calibration::HeatInputLacking heat{motor::HeatInput::input_power, motor::HeatInput::current, {"run1"}};
  calibration::PredictionAnswer answer;
  answer.prediction.notes = {heat, RunNote(ColumnsLacking{"run1", {"fan_V"}}), RunNote(ColumnBlank{"run1", "fan_V", 90.0, true}),
                             RunNote(SplitIntoRuns{"run1", 2})};
  const Json json = prediction_json({}, answer, {});
  EXPECT_EQ(json["warnings"].size(), 3U) << json["warnings"];
  EXPECT_EQ(json["notes"].size(), 4U);
  EXPECT_EQ(
      json["warnings"][0],
      "temperatures may be wrong by several kelvin: the model was fitted with heat from power_in_W, which run1 does not have, so that "
      "the heat comes from current_A");
  for (const RunNote& note : {RunNote(ColumnsLacking{"run1", {"fan_V"}}), RunNote(ColumnBlank{"run1", "fan_V", 90.0, true})}) {
    EXPECT_EQ(severity_of(calibration::CalibrationFinding(note)), Severity::warning);
    EXPECT_EQ(severity_of(diagnosis::DiagnosisFinding(note)), Severity::warning);
  }
  EXPECT_EQ(severity_of(diagnosis::DiagnosisFinding(heat)), Severity::warning);
}

TEST(WordsOfCalibration, SignalsThatAnEffectIsWithout) {
  using thermal::Signal;
  const auto words = [](const calibration::SignalsMissing& of) { return words_of(calibration::CalibrationFinding(of)); };
  EXPECT_EQ(words({.signals = {Signal::current}, .effect = "rest", .recording = "run1", .is_unused = true}),
            "run1 does not have current_A, on which rest depends; the effect is not used");
  EXPECT_EQ(words({.signals = {Signal::current}, .effect = "driver", .recording = "run1", .is_unread = true}),
            "run1 is read without current_A, on which driver depends; the value 0 is used");
}

}  // namespace
}  // namespace heatsoak::present
