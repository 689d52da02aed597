// The title of a picture states the verdict or the main result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <tuple>

#include "present/jerk_sweep_chart.h"
#include "present/measured/calibration_chart.h"
#include "present/measured/diagnosis_output.h"
#include "present/measured/diagnosis_words.h"
#include "present/measured/prediction_chart.h"
#include "support/shipped.h"

namespace heatsoak::present {
namespace {

using testing::EndsWith;
using testing::StartsWith;

TEST(Titles, ACalibrationStatesItsIdentifiableValuesAndItsLargestError) {
  motor::Motor motor;
  motor.name = "M";
  calibration::Calibration calibration;
  calibration.parameters.resize(3);
  calibration.parameters[1].is_identifiable = true;
  const auto error_of = [](const char* signal, double rmse_K) {
    calibration::ErrorBeforeAfter error;
    error.signal = signal;
    error.after.rmse_K = rmse_K;
    return error;
  };
  calibration.fit_error = {error_of("winding_C", 0.4), error_of("stator_C", 1.26)};
  EXPECT_EQ(calibration_chart(motor, calibration).title, "M: 1 of 3 values identifiable, largest error 1.3 K rms");
  calibration.holdout_error = {error_of("winding_C", 2.0)};
  EXPECT_THAT(calibration_chart(motor, calibration).title, EndsWith("largest hold-out error 2 K rms"));
}

TEST(Titles, APredictionStatesItsLargestError) {
  motor::Motor motor;
  motor.id = "m";
  calibration::Prediction prediction;
  for (const auto& [name, error_K] : {std::pair("a", 0.5), {"b", 3.0}}) {
    calibration::PredictedRun run;
    run.name = name;
    run.time_s = {0.0};
    calibration::PredictedSignal signal;
    signal.signal = "winding_C";
    signal.rmse_K = error_K;
    run.signals = {signal};
    prediction.runs.push_back(run);
  }
  EXPECT_EQ(prediction_chart(motor, prediction).title, "m: the largest error is 3 K rms, of the winding in b");
}

TEST(Titles, ADiagnosisStatesItsVerdict) {
  diagnosis::DiagnosisAnswer answer;
  diagnosis::FoundEffect effect;
  effect.id = "windage";
  effect.node = "stator";
  effect.is_from_catalogue = true;
  answer.diagnosis.effects = {effect};
  answer.diagnosis.verdict = diagnosis::DiagnosisVerdict::effect_found;
  const std::vector<DiagnosisPicture> pictures = diagnosis_pictures(answer);
  ASSERT_EQ(pictures.size(), 2U);
  EXPECT_EQ(pictures[0].chart.title, "Residual in K: the model lacks windage");
  EXPECT_EQ(pictures[1].chart.title, "Unknown heat in W: the model lacks windage");
  answer.diagnosis.effects[0].confusable_with = {"iron_loss_eddy"};
  EXPECT_EQ(verdict_words(answer.diagnosis), "the model lacks windage or iron_loss_eddy (these runs do not distinguish them)");
  effect.id = "third_node";
  diagnosis::FoundEffect elsewhere = effect;
  elsewhere.node = "winding";
  answer.diagnosis.effects = {effect, elsewhere};
  EXPECT_EQ(verdict_words(answer.diagnosis), "the model lacks third_node at the stator and third_node at the winding");
  answer.diagnosis.verdict = diagnosis::DiagnosisVerdict::unexplained;
  EXPECT_THAT(verdict_words(answer.diagnosis), EndsWith(", and further heat that no effect of the catalogue explains"));
  answer.diagnosis.effects.clear();
  const auto with_heat = [&](std::vector<double> winding_W, std::vector<double> stator_W) {
    answer.diagnosis.flux.assign(2, {});
    answer.diagnosis.flux[0].after_W = std::move(winding_W);
    answer.diagnosis.flux[1].after_W = std::move(stator_W);
    return verdict_words(answer.diagnosis);
  };
  EXPECT_THAT(with_heat({2.0, 3.0}, {-1.0, 0.0}), StartsWith("heat is missing that no effect"));
  EXPECT_THAT(with_heat({-2.0, -3.0}, {1.0, 1.0}), StartsWith("the model has too much heat, a difference that no effect"));
  EXPECT_THAT(with_heat({-2.0, 3.0}, {0.0, 0.0}), StartsWith("the runs have unmodelled heat of both signs that no effect"));
  diagnosis::Unexplained& curve = answer.diagnosis.unexplained.emplace_back();
  curve.mean_W = 2.0;
  curve.curve = {0.0, 3.0};
  EXPECT_THAT(verdict_words(answer.diagnosis), StartsWith("heat is missing"));
  curve.curve = {0.0, -3.0};
  EXPECT_THAT(verdict_words(answer.diagnosis), StartsWith("the model has too much heat"));
  answer.diagnosis.verdict = diagnosis::DiagnosisVerdict::nothing_missing;
  EXPECT_EQ(verdict_words(answer.diagnosis), "no effect is missing");
}

/// The errors of the text are those of the motor files, so the picture must not simulate the runs again with another model.
TEST(DiagnosisPictures, ShowThePredictionsThatWereScored) {
  diagnosis::DiagnosisAnswer answer;
  answer.diagnosis.before_train["winding_C"] = {};
  const auto predicted = [](std::vector<double> predicted_C) {
    calibration::PredictedSignal signal;
    signal.signal = "winding_C";
    signal.measured_C = {30.0, 32.0};
    signal.predicted_C = std::move(predicted_C);
    return calibration::PredictedRun{"run2", {100.0, 160.0}, {signal}};
  };
  answer.score.runs_before = {predicted({30.0, 27.0})};
  answer.score.runs_after = {predicted({30.0, 31.5})};
  const report::ChartPanel panel = diagnosis_pictures(answer).at(0).chart.panels.at(0);
  EXPECT_EQ(panel.title, "winding; hold-out run2");
  ASSERT_EQ(panel.curves.size(), 2U);
  EXPECT_THAT(panel.curves[0].y, testing::ElementsAre(0.0, 5.0, testing::IsNan()));
  EXPECT_THAT(panel.curves[1].y, testing::ElementsAre(0.0, 0.5, testing::IsNan()));
  EXPECT_THAT(panel.curves[1].x, testing::ElementsAre(0.0, 1.0, 1.0));
}

TEST(DiagnosisPictures, ShowASignalThatOnlyHoldOutRunsHave) {
  diagnosis::DiagnosisAnswer answer;
  answer.diagnosis.before_train["stator_C"] = {};
  calibration::PredictedSignal signal;
  signal.signal = "winding_C";
  signal.measured_C = {30.0, 32.0};
  signal.predicted_C = {30.0, 31.0};
  answer.score.runs_before = answer.score.runs_after = {{"run2", {100.0, 160.0}, {signal}}};
  answer.score.errors.emplace_back().signal = "winding_C";
  const std::vector<report::ChartPanel> panels = diagnosis_pictures(answer).at(0).chart.panels;
  ASSERT_EQ(panels.size(), 2U);
  EXPECT_EQ(panels[0].title, "stator");
  EXPECT_EQ(panels[1].title, "winding; hold-out run2");
}

TEST(Titles, AJerkSweepStatesTheLimitThatSettlesFirst) {
  simulate::JerkSweep sweep{.robot = twente(), .motor = ecx_32(), .results = {}};
  for (const auto& [acceleration_m_per_s2, jerk_m_per_s3, settled_s] : {std::tuple(3.0, 5.0, 1.4),
                                                                        {3.0, 20.0, 1.2},
                                                                        {3.0, std::numeric_limits<double>::infinity(), 1.3},
                                                                        {6.0, 60.0, 0.9},
                                                                        {6.0, std::numeric_limits<double>::infinity(), 0.8}}) {
    simulate::StudyResult result;
    result.limits = {acceleration_m_per_s2, jerk_m_per_s3};
    result.settled_s = settled_s;
    sweep.results.push_back(result);
  }
  EXPECT_EQ(jerk_sweep_chart(sweep).title, sweep.robot.name +
                                               ": at its own acceleration of 3.0 m/s² it settles earliest, after 1.20 s, with a jerk limit "
                                               "of 20.0 m/s³");
}

}  // namespace
}  // namespace heatsoak::present
