// Forecasts: the fit to whole runs compared with its known properties, the choice of a network and the band. Also simulates a motor file
// along a log.
#include "calibration/forecast/forecast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "calibration/forecast/prediction.h"
#include "motor/write_motor.h"
#include "study.h"
#include "support/seed_rate.h"

namespace heatsoak::calibration::study {
namespace {

estimation::LogMaking long_enough() {
  estimation::LogMaking making;
  making.duration_s = 1200.0;
  return making;
}

/// Writes logs of one motor to files and reads them.
std::vector<recording::Recording> logs_of(const estimation::TwoNodeTruth& truth, const estimation::LogMaking& making, const Folder& folder,
                                          int first, int count, std::uint64_t seed = 1) {
  std::vector<recording::Recording> all;
  for (int run = first; run < first + count; ++run) {
    const auto file = folder.path() / ("run_" + std::to_string(run) + ".csv");
    all.push_back(read_log(write_log(estimation::generated_log(truth, making, seed, static_cast<std::uint64_t>(run)), file)));
  }
  return all;
}

/// The tests of a rate take the seeds 1 to kSeeds.
constexpr int kSeeds = 4;
/// Seed of tests of properties that every log has.
constexpr std::uint64_t kAnySeed = 1;

std::vector<estimation::MeasuredRun> runs_of(const ForecastSetup& setup, const std::vector<recording::Recording>& logs) {
  std::vector<estimation::RunNote> notes;
  return forecast_runs(setup, logs, std::nullopt, notes);
}

/// White noise has as many independent samples as samples. For x(k+1) = a·x(k) + noise the share is (1 − a)/(1 + a).
TEST(IndependentSamples, AreThoseOfKnownProcesses) {
  constexpr int kSamples = 20'000;
  for (const double kept : {0.0, 0.5, 0.9}) {
    const double expected = kSamples * (1.0 - kept) / (1.0 + kept);
    // The estimate of 20 000 samples scatters by some per cent, most for the process with the longest memory.
    EXPECT_TRUE(holds_for_share(0.95, 30, [&](std::uint64_t seed) {
      base::Random random(seed, 1);
      Eigen::VectorXd error_K(kSamples);
      double now_K = 0.0;
      for (double& each : error_K) {
        now_K = kept * now_K + estimation::standard_normal(random);
        each = now_K;
      }
      return std::abs(independent_samples(error_K) / expected - 1.0) <= 0.15;
    })) << kept;
  }
  // A constant error counts as one independent sample.
  EXPECT_LT(independent_samples(Eigen::VectorXd::Ones(kSamples)), 2.1);
}

/// Columns of θ, of the heat factor and of a free sensor lag, compared with differences of the simulation.
TEST(ForecastModel, SlopesAreDifferences) {
  const Folder folder;
  const Sheet sheet{.truth = {}, .resistance_spread = ", tolerance = \"5 %\""};
  const std::vector<recording::Recording> logs = logs_of(sheet.truth, long_enough(), folder, 0, 1);
  ForecastSetup setup = forecast_setup(sheet.motor(folder), logs);
  const estimation::MeasuredRun run = runs_of(setup, logs).front();
  const ForecastModel base = setup.model();
  for (const Extension& extension : extensions_for(setup, base, base.start(), std::vector{run})) {
    const ForecastModel model = with_extension(setup, extension).model();
    Eigen::VectorXd theta = model.start();
    const std::vector<double> start_C(static_cast<std::size_t>(model.network().state_count()), 27.0);
    const estimation::LinearisedRun here = model.along(run, theta, 0.02, start_C);
    constexpr double kStep = 1e-4;
    for (Eigen::Index i = 0; i <= model.count(); ++i) {
      const auto moved = [&](double by) {
        Eigen::VectorXd other = theta;
        double heat_log = 0.02;
        (i < model.count() ? other[i] : heat_log) += by;
        return model.along(run, other, heat_log, start_C).residual_K;
      };
      const Eigen::VectorXd expected = (moved(-kStep) - moved(kStep)) / (2.0 * kStep);
      const double size = std::max(1e-3, expected.array().isNaN().select(0.0, expected).cwiseAbs().maxCoeff());
      const Eigen::VectorXd off = (here.by_parameter.col(i) - expected).cwiseAbs();
      EXPECT_LT(off.array().isNaN().select(0.0, off).maxCoeff(), 1e-3 * size) << extension.name << ", coordinate " << i;
    }
  }
}

/// A motor with two nodes needs no extended network. Only the unknown heat limits its forecasts.
TEST(Forecast, KeepsANetworkThatIsRight) {
  int kept = 0;
  int predicted = 0;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(kSeeds); ++seed) {
    const Folder folder;
    const Sheet sheet;
    const motor::Motor motor = sheet.motor(folder);
    const estimation::TwoNodeTruth truth = drawn_truth(sheet, motor, seed);
    const std::vector<recording::Recording> logs = logs_of(truth, long_enough(), folder, 0, 4, seed);
    const ForecastSetup setup = forecast_setup(motor, logs);
    const Forecast found = forecast_of(setup, runs_of(setup, logs), {}, 0);
    EXPECT_EQ(found.pieces.size(), 4U);
    kept += found.accepted.empty() && found.source != ForecastSource::file ? 1 : 0;
    const ForecastModel model = found.model();
    bool is_within = true;
    for (const estimation::MeasuredRun& run : runs_of(setup, logs_of(truth, long_enough(), folder, 10, 2, seed))) {
      for (const PredictedSignal& each : predict(model, found.fit.theta, found.fit.covariance, found.band, run).signals) {
        // 0.06 W of unknown heat at each node with a time constant of 180 s changes it by some tenths of a kelvin.
        is_within = is_within && each.rmse_K < 0.6 && each.coverage_share > 0.6;
      }
    }
    predicted += is_within ? 1 : 0;
  }
  EXPECT_GE(kept, kSeeds - 1);
  EXPECT_GE(predicted, kSeeds - 1);
}

/// Logs of a motor whose contact conductance rises by 1 % per K, hot enough to make it visible.
std::vector<recording::Recording> logs_of_better_contact(estimation::TwoNodeTruth truth, const Folder& folder, int first, int count,
                                                         std::uint64_t seed = 1) {
  truth.contact_change_per_K = 0.01;
  estimation::LogMaking making = long_enough();
  making.largest_current_A = 13.0;
  making.flux_rms_W = 0.02;
  return logs_of(truth, making, folder, first, count, seed);
}

/// The contact conductance rises by 1 % per K, by a law that no candidate has. The hold-out runs require a candidate with a similar
/// curvature.
TEST(Forecast, ExtendsANetworkThatIsWrong) {
  int extended = 0;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(kSeeds); ++seed) {
    const Folder folder;
    const Sheet sheet;
    const motor::Motor motor = sheet.motor(folder);
    const std::vector<recording::Recording> logs = logs_of_better_contact(sheet.truth, folder, 0, 4, seed);
    const ForecastSetup setup = forecast_setup(motor, logs);
    const Forecast found = forecast_of(setup, runs_of(setup, logs), {}, 0);
    ASSERT_EQ(found.rivals.size(), 3U);
    const ForecastModel model = found.model();
    const ForecastModel base = setup.model();
    const ForecastRules ordinary{.is_tempered = false, .has_heat_factors = false};
    const ForecastFit plain = fit_forecast(base, runs_of(setup, logs), {}, base.start(), ordinary);
    bool is_better = !found.accepted.empty() && found.source == ForecastSource::tempered;
    for (const estimation::MeasuredRun& run : runs_of(setup, logs_of_better_contact(sheet.truth, folder, 10, 2, seed))) {
      const auto winding_K = [&](const ForecastModel& by, const ForecastFit& fit) {
        return predict(by, fit.theta, fit.covariance, found.band, run).signals.front().rmse_K;
      };
      is_better = is_better && winding_K(model, found.fit) < 0.8 * winding_K(base, plain);
    }
    extended += is_better ? 1 : 0;
  }
  EXPECT_GE(extended, kSeeds - 1);
}

/// Two runs: a left-out run is predicted from one run, the file's parameters come from two. Errors f + c/n of unseen and f − c/n of fitted
/// runs give f + c/2 from the errors at n = 1 (left out) and n = 2 (fitted).
TEST(RivalScore, ExpectsTheErrorOfAFitToAllRuns) {
  constexpr double kFloor_K2 = 1.0, kParameters_K2 = 0.5;
  std::vector<estimation::MeasuredRun> runs(2);
  const auto score = [&](double mean_square_K2, double nats) {
    PieceScore all{nats, {}};
    for (std::size_t r = 0; r < runs.size(); ++r) {
      runs[r].sensors = {estimation::Sensor{"winding_C", "winding"}};
      PredictedPiece piece;
      piece.run = r;
      piece.path.sensor_node = {0};
      piece.path.residual_K = Eigen::VectorXd::Constant(10, std::sqrt(mean_square_K2));
      all.pieces.push_back(piece);
    }
    return all;
  };
  const PieceScore left_out = score(kFloor_K2 + kParameters_K2, 1.0);
  const PieceScore fitted = score(kFloor_K2 - 0.5 * kParameters_K2, -0.5);
  const RivalScore rival = rival_score(ForecastSource::ordinary, left_out, fitted, runs);
  EXPECT_NEAR(rival.rmse_K.front().second, std::sqrt(1.5), 1e-12) << "reported as measured";
  EXPECT_NEAR(rival.expected_K.front().second, std::sqrt(kFloor_K2 + 0.5 * kParameters_K2), 1e-12);
  EXPECT_NEAR(rival.score_nats, 0.5, 1e-12);
  constexpr double kFailed = std::numeric_limits<double>::infinity();
  EXPECT_EQ(rival_score(ForecastSource::ordinary, score(1.0, kFailed), fitted, runs).score_nats, kFailed);
  // Blocks of one run share its load: only the left-out error counts.
  runs.resize(1);
  EXPECT_EQ(rival_score(ForecastSource::ordinary, score(1.5, 1.0), score(0.75, -0.5), runs).score_nats, 1.0);
}

/// With only one run the priors of the data sheet matter: a single steady state cannot separate two resistances.
TEST(ForecastFit, TemperedLikelihoodLeavesThePriorItsSay) {
  const Folder folder;
  const Sheet sheet;
  const std::vector<recording::Recording> logs = logs_of(sheet.truth, long_enough(), folder, 0, 1);
  const ForecastSetup setup = forecast_setup(sheet.motor(folder), logs);
  const ForecastModel model = setup.model();
  const std::vector<estimation::MeasuredRun> runs = runs_of(setup, logs);
  const ForecastFit fit = fit_forecast(model, runs, {}, model.start(), {});
  EXPECT_GT(fit.weight, 0.0);
  EXPECT_LT(fit.weight, 0.5) << "errors of slow unknown heat are correlated";
  // The covariance must be wider by the same factor.
  ForecastRules all_count{.held = ForecastErrorModel{fit.error_K, 1.0}};
  const ForecastFit sure = fit_forecast(model, runs, {}, fit.theta, all_count);
  EXPECT_GT(fit.covariance(0, 0), 1.5 * sure.covariance(0, 0));
}

/// The common factor of all heats, capacities and conductances is nearly undetermined. A descent that is damped in proportion to the
/// curvature creeps along it. The optimum is compared with that of another fit that starts there.
TEST(ForecastFit, FollowsNearlyUndeterminedDirectionsInFewSimulations) {
  const Folder folder;
  const Sheet sheet{.truth = {}, .resistance_spread = ", tolerance = \"20 %\""};
  estimation::TwoNodeTruth truth = sheet.truth;
  truth.resistance_25C_ohm *= 1.1;
  const std::vector<recording::Recording> logs = logs_of(truth, long_enough(), folder, 0, 3);
  const ForecastSetup setup = forecast_setup(sheet.motor(folder), logs);
  const ForecastModel model = setup.model();
  const std::vector<estimation::MeasuredRun> runs = runs_of(setup, logs);
  int simulations = 0;
  ForecastRules rules{.is_tempered = false, .has_heat_factors = false, .on_simulation = [&] { ++simulations; }};
  const ForecastFit fit = fit_forecast(model, runs, {}, model.start(), rules);
  EXPECT_LE(simulations, 12);
  rules.held = ForecastErrorModel{fit.error_K, 1.0};
  const ForecastFit here = fit_forecast(model, runs, {}, fit.theta, rules);
  EXPECT_LT((here.theta - fit.theta).cwiseAbs().maxCoeff(), 0.02);
}

/// A torque and speed log must give the same heat as a log with the current for that torque.
TEST(Prediction, TakesATorqueForACurrent) {
  const Folder folder;
  const Sheet sheet{.truth = {}, .resistance_spread = {}, .no_load_current_A = 0.2};
  const motor::Motor motor = sheet.motor(folder);
  recording::Recording with_current = estimation::generated_log(sheet.truth, long_enough(), kAnySeed, 0);
  const std::size_t rows = with_current.rows();
  with_current.channels.push_back({*recording::quantity_named("speed_rad_per_s"), std::vector<double>(rows, 100.0)});
  recording::Recording with_torque = with_current;
  std::vector<double> torque_Nm;
  for (const double current_A : with_current.find("current_A")->values) {
    torque_Nm.push_back(0.034 * (current_A - 0.2));
  }
  std::erase_if(with_torque.channels, [](const recording::Channel& each) { return each.quantity.key == "current_A"; });
  with_torque.channels.push_back({*recording::quantity_named("torque_Nm"), std::move(torque_Nm)});
  const auto predicted = [&](const recording::Recording& log) {
    return predict(motor, std::vector{log}, PredictionOptions{}).runs.front();
  };
  const PredictedRun by_current = predicted(with_current);
  const PredictedRun by_torque = predicted(with_torque);
  ASSERT_EQ(by_current.time_s, by_torque.time_s);
  for (std::size_t k = 0; k < by_current.time_s.size(); ++k) {
    EXPECT_NEAR(by_current.signals[0].predicted_C[k], by_torque.signals[0].predicted_C[k], 1e-6);
  }
}

/// If the input is a constant power that is all heat, the steady state is P·R.
TEST(Prediction, OfAConstantPowerEndsWhereTheResistancesSay) {
  const Folder folder;
  const Sheet sheet;
  const motor::Motor motor = sheet.motor(folder);
  constexpr double kPower_W = 4.0;
  recording::Recording log =
      estimation::generated_log(sheet.truth, {.duration_s = 7200.0, .period_s = 2.0, .ambient_swing_K = 0.0}, kAnySeed, 0);
  std::erase_if(log.channels, [](const recording::Channel& each) { return each.quantity.key == "current_A"; });
  log.channels.push_back({*recording::quantity_named("power_in_W"), std::vector<double>(log.rows(), kPower_W)});
  const PredictedRun run = predict(motor, std::vector{log}, PredictionOptions{}).runs.front();
  const double stator_C = 25.0 + kPower_W * sheet.truth.stator_ambient_K_per_W;
  EXPECT_NEAR(run.signals[1].predicted_C.back(), stator_C, 0.1);
  EXPECT_NEAR(run.signals[0].predicted_C.back(), stator_C + kPower_W * sheet.truth.winding_stator_K_per_W, 0.1);
}

/// Not all logs have a current, so the input power is the heat of all. It contains the copper loss of the logged current.
TEST(Prediction, ACurrentBesideTheInputPowerIsNotCountedTwice) {
  const Folder folder;
  const Sheet sheet;
  recording::Recording both = estimation::generated_log(sheet.truth, long_enough(), kAnySeed, 0);
  both.channels.push_back({*recording::quantity_named("power_in_W"), std::vector<double>(both.rows(), 4.0)});
  recording::Recording power_only = both;
  std::erase_if(power_only.channels, [](const recording::Channel& each) { return each.quantity.key == "current_A"; });
  const std::vector mixed{both, power_only};
  const ForecastSetup setup = forecast_setup(sheet.motor(folder), mixed);
  ASSERT_EQ(setup.heat, HeatInput::input_power);
  const std::vector<estimation::MeasuredRun> runs = runs_of(setup, mixed);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_FALSE(runs[0].has(thermal::Signal::current));
  const ForecastModel model = setup.model();
  const std::vector<double> start_C(static_cast<std::size_t>(model.network().state_count()), 25.0);
  const Eigen::MatrixXd of_both = model.along(runs[0], model.start(), 0.0, start_C).state_C;
  const Eigen::MatrixXd of_power = model.along(runs[1], model.start(), 0.0, start_C).state_C;
  EXPECT_EQ(of_both, of_power);
}

/// Wind of constant speed cools the stator. A blank cell is a gap between two equal cells, not standstill; a log without the column is
/// reported.
TEST(Prediction, BlankCellsOfTheSignalOfAnEffectAreGaps) {
  const auto known = [](double value) {
    base::ParameterValue parameter;
    parameter.value = value;
    return parameter;
  };
  const Folder folder;
  const Sheet sheet;
  motor::Motor motor = sheet.motor(folder);
  motor.effects.push_back({.name = "wind",
                           .type = thermal::find_effect("vehicle_airflow"),
                           .nodes = {"stator", "ambient"},
                           .parameters = {known(0.3), known(0.7)},
                           .condition = {},
                           .column = {}});
  recording::Recording windy = estimation::generated_log(sheet.truth, long_enough(), kAnySeed, 0);
  windy.channels.push_back({*recording::quantity_named("vehicle_speed_m_per_s"), std::vector<double>(windy.rows(), 3.0)});
  recording::Recording blank = windy;
  for (std::size_t row = 1; row + 1 < blank.rows(); row += 2) {
    blank.channels.back().values[row] = std::numeric_limits<double>::quiet_NaN();
  }
  recording::Recording without = windy;
  without.channels.pop_back();
  const auto predicted = [&](const recording::Recording& log) { return predict(motor, std::vector{log}, PredictionOptions{}); };
  const Prediction all = predicted(windy);
  const Prediction half = predicted(blank);
  const Prediction none = predicted(without);
  const auto last_C = [](const Prediction& each) { return each.runs.front().signals[1].predicted_C.back(); };
  EXPECT_GT(last_C(none), last_C(all) + 1.0) << "the wind of this test hardly cools";
  EXPECT_NEAR(last_C(half), last_C(all), 1e-6);
  EXPECT_TRUE(all.missing.empty());
  EXPECT_TRUE(half.missing.empty());
  ASSERT_EQ(none.missing.size(), 1U);
  EXPECT_EQ(none.missing.front().effect, "wind");
  EXPECT_EQ(none.missing.front().recording, without.name);
}

/// The band of a data sheet covers the tolerances of its parameters. It must grow with them.
TEST(Prediction, BandWidensWithTheToleranceOfTheFile) {
  const Folder folder;
  const std::vector<recording::Recording> logs = logs_of({}, long_enough(), folder, 0, 1);
  double width_K = 0.0;
  for (const char* spread : {", tolerance = \"10 %\"", ", tolerance = \"40 %\""}) {
    const motor::Motor motor = Sheet{.truth = {}, .resistance_spread = {}, .thermal_spread = spread}.motor(folder);
    const PredictedSignal winding = predict(motor, logs, PredictionOptions{}).runs.front().signals.front();
    const double here_K = winding.high_C.back() - winding.low_C.back();
    EXPECT_GT(here_K, 1.5 * width_K);
    width_K = here_K;
  }
}

TEST(Prediction, OfAWrittenFileIsThatOfTheCalibration) {
  const Folder folder;
  const Sheet sheet;
  const motor::Motor motor = sheet.motor(folder);
  const std::vector<recording::Recording> logs = logs_of_better_contact(sheet.truth, folder, 0, 4);
  const std::vector<recording::Recording> others = logs_of_better_contact(sheet.truth, folder, 10, 1);
  const Calibration found = calibrate(motor, logs, others, {.fit = {}, .written = WrittenFit::forecast});
  ASSERT_TRUE(found.is_forecast_written);
  const auto file = folder.path() / "written.toml";
  std::ofstream(file) << motor::to_toml(calibrated_motor(motor, found));
  const motor::Motor read = motor::read_motor(file);
  ASSERT_TRUE(read.fit && read.fit->band);
  EXPECT_EQ(motor::data_quality(read), "measured");
  const PredictedRun of_file = predict(read, others, PredictionOptions{}).runs.front();
  const PredictedRun& at_once = found.holdout_after.front();
  for (std::size_t s = 0; s < of_file.signals.size(); ++s) {
    EXPECT_NEAR(of_file.signals[s].rmse_K, at_once.signals[s].rmse_K, 0.01);
    const std::size_t last = of_file.time_s.size() - 1;
    EXPECT_NEAR(of_file.signals[s].high_C[last] - of_file.signals[s].low_C[last],
                at_once.signals[s].high_C[last] - at_once.signals[s].low_C[last], 0.05);
  }
  // The written file must give the same result as the library.
  const ForecastModel model = found.forecast->model();
  const estimation::MeasuredRun run = runs_of(found.forecast->setup, others).front();
  const PredictedRun direct = predict(model, found.forecast->fit.theta, found.forecast->fit.covariance, found.forecast->band, run);
  EXPECT_NEAR(direct.signals.front().rmse_K, of_file.signals.front().rmse_K, 0.05);
}

/// Forecast errors beyond the parameter uncertainty also widen the result of a duty: the heat gets the band's factor.
TEST(ForecastBand, WidensTheDrawsOfACalibratedMotor) {
  const Folder folder;
  const Sheet sheet;
  motor::Motor motor = sheet.motor(folder);
  motor.fit.emplace();
  motor.fit->parameters = {"thermal_resistance_winding_stator"};
  motor.fit->correlation = motor::Correlation(std::size_t{1});
  motor::Motor banded = motor;
  banded.fit->band = motor::ForecastBand{{0.03, 0.0}, 100.0, 0.04, 2.0};
  constexpr int kDraws = 4000;
  double squares = 0.0;
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    base::Random random(seed, 0);
    base::Random again(seed, 0);
    const motor::MotorValues without = motor::draw_sample(motor, random).values;
    const motor::MotorValues with = motor::draw_sample(banded, again).values;
    const double heat_ratio = with.thermal_resistance_stator_ambient_K_per_W / without.thermal_resistance_stator_ambient_K_per_W;
    EXPECT_NEAR(with.thermal_resistance_winding_stator_K_per_W, heat_ratio * without.thermal_resistance_winding_stator_K_per_W, 1e-12);
    EXPECT_EQ(with.terminal_resistance_ohm, without.terminal_resistance_ohm);
    squares += std::pow(std::log(heat_ratio), 2);
  }
  EXPECT_NEAR(std::sqrt(squares / kDraws), 2.0 * 0.05, 0.005);
}

}  // namespace
}  // namespace heatsoak::calibration::study
