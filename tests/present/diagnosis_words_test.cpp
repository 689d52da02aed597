// Wording of the findings of diagnoses, in documents and in the model file.
#include "present/measured/diagnosis_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "calibration/findings.h"
#include "diagnosis/findings.h"
#include "present/measured/diagnosis_output.h"
#include "present/measured/diagnosis_reservations.h"

namespace heatsoak::present {
namespace {

using testing::HasSubstr;

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
      {calibration::ContradictingRun{}, Severity::warning},
      {calibration::SignalsMissing{}, Severity::note},
      {IntervalsOfDataSheet{}, Severity::note},
      {calibration::RowsTurn{}, Severity::note},
  };
  for (const auto& [finding, severity] : severities) {
    EXPECT_EQ(severity_of(finding), severity) << words_of(finding);
  }
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

/// A model that is better than the file, but worse than the same file refitted, is not recommended for that run.
TEST(WordsOfDiagnosis, ErrorsOnHoldoutRunsAreComparedWithBothOtherFiles) {
  const auto words = [](double before_K, double refitted_K, double after_K) {
    diagnosis::HoldoutScore score;
    score.runs_after.resize(1);
    score.runs_after.front().name = "match_4";
    score.errors = {{"match_4", "winding_C", {before_K, before_K}, {refitted_K, refitted_K}, {after_K, after_K}, {after_K, after_K}}};
    diagnosis::Diagnosis diagnosis;
    diagnosis.before_train["winding_C"].rmse_K = before_K;
    diagnosis.after_train["winding_C"].rmse_K = std::min(before_K, after_K);
    return reservations(diagnosis, score);
  };
  EXPECT_EQ(words(2.0, 0.5, 0.4), "");
  EXPECT_THAT(words(2.0, 0.4, 0.9),
              HasSubstr("In match_4, the model with only its own parameters refitted predicts better, 0.4 instead of 0.9 K"));
  EXPECT_THAT(words(0.4, 2.0, 0.9), HasSubstr("Do not use the new model for runs like match_4"));
  EXPECT_THAT(words(0.4, 0.3, 0.9), testing::Not(HasSubstr("refitted")));
}

/// A single signal may grow although the run as a whole is predicted better.
TEST(WordsOfDiagnosis, GrowthOfOneSignalIsReported) {
  diagnosis::HoldoutScore score;
  score.runs_after.resize(1);
  score.runs_after.front().name = "match_4";
  score.errors = {{"match_4", "winding_C", {3.0, 3.0}, {2.0, 2.0}, {0.5, 0.5}, {0.5, 0.5}},
                  {"match_4", "stator_C", {1.0, 1.0}, {0.3, 0.3}, {0.5, 0.5}, {0.5, 0.5}}};
  EXPECT_EQ(reservations({}, score),
            " The error of the stator alone grows in match_4, from 0.3 K with only the model's own parameters refitted to 0.5 K.");
  score.errors.back().before.rmse_K = 0.2;
  EXPECT_EQ(reservations({}, score), " The error of the stator alone grows in match_4, from 0.2 K to 0.5 K.");
}

/// Evidence for an effect does not determine its size, such as that of a body that is tightly coupled.
TEST(WordsOfDiagnosis, IntervalsFromZeroAreNoSizes) {
  diagnosis::DiagnosisAnswer answer;
  diagnosis::FoundEffect effect;
  effect.id = "third_node";
  effect.node = "stator";
  effect.gain_nats = 125.0;
  effect.parameters = {{"conductance", "W/K", 0.138, 0.0, 1.35}};
  answer.diagnosis.effects = {effect};
  const auto words = [&] { return testing::PrintToString(diagnosis_words(answer)); };
  EXPECT_THAT(words(), HasSubstr("0 to 1.35), which these runs hardly determine"));
  answer.diagnosis.effects.front().parameters.front().low = 0.05;
  EXPECT_THAT(words(), testing::Not(HasSubstr("hardly determine")));
}

TEST(WordsOfDiagnosis, OddsAreNumbersWithoutNaturalLogarithms) {
  diagnosis::DiagnosisAnswer answer;
  answer.diagnosis.effects.emplace_back();
  answer.diagnosis.changed.emplace_back();
  const std::vector<std::pair<double, std::string>> words{{1.0, "hardly less probable"},
                                                          {3.0, "20 times less probable"},
                                                          {82.0, "10^36 times less probable"},
                                                          {2788.0, "more than 10^100 times less probable"}};
  for (const auto& [nats, expected] : words) {
    answer.diagnosis.effects.front().gain_nats = nats;
    answer.diagnosis.changed.front().gain_nats = nats;
    const std::string text = testing::PrintToString(diagnosis_words(answer));
    EXPECT_THAT(text, HasSubstr("Without it the model would be " + expected + "."));
    EXPECT_EQ(text.find("with the file's value the runs would be " + expected + ".") != std::string::npos, nats > 2.0) << text;
  }
}

/// A file of guesses with narrow tolerances looks like another mounting. The answer says what to do.
TEST(WordsOfDiagnosis, ContradictedGuessesNeedARange) {
  diagnosis::DiagnosisAnswer answer;
  answer.diagnosis.verdict = diagnosis::DiagnosisVerdict::not_identifiable;
  answer.diagnosis.changed.emplace_back();
  const std::string text = testing::PrintToString(diagnosis_words(answer));
  EXPECT_THAT(text, HasSubstr("values are guesses, give all of them a range"));
  EXPECT_THAT(text, testing::Not(HasSubstr("hardly")));
}

TEST(WordsOfDiagnosis, ASizeWithoutUnitAtItsBoundHasNoBlankBeforeTheComma) {
  diagnosis::DiagnosisAnswer answer;
  answer.diagnosis.verdict = diagnosis::DiagnosisVerdict::effect_found;
  diagnosis::FoundEffect& effect = answer.diagnosis.effects.emplace_back();
  effect.id = "sensor_gain_winding";
  effect.node = "winding";
  effect.parameters = {{"relative_error", "", 0.5, 0.5, 0.5, true}};
  EXPECT_THAT(testing::PrintToString(diagnosis_words(answer)), HasSubstr("relative_error 0.5, at the bound"));
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
      std::vector<std::string>{"heat_share at the winding in run4: deviation -0.305; found in measurements, not a property of the motor"});
}

TEST(Diagnosis, PageAndJsonKeepTheSeverityOfWarnings) {
  diagnosis::DiagnosisAnswer answer;
  answer.findings = {diagnosis::IntervalsOfDataSheet{}, diagnosis::ExtensionsMayImitate{{"contact_law"}}};
  answer.diagnosis.effects.emplace_back().id = "sensor_lag_winding";
  const Json json = diagnosis_json(answer, {});
  EXPECT_EQ(json["effects"][0]["name"], "sensor_lag_winding");
  EXPECT_EQ(json["notes"].size(), 2U);
  ASSERT_EQ(json["warnings"].size(), 1U);
  EXPECT_EQ(json["warnings"][0], words_of(answer.findings[1]));
  const std::string page = diagnosis_page(answer, {}, {});
  EXPECT_THAT(page, HasSubstr("<li><strong>Warning:</strong> an effect similar to contact_law"));
  EXPECT_LT(page.find("an effect similar to contact_law"), page.find(words_of(answer.findings[0]).substr(12)));
}

}  // namespace
}  // namespace heatsoak::present
