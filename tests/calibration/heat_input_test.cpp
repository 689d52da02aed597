// The heat input is a property of a model: its parameters hold for the heat input that they were fitted with. The motor files of these
// tests have a wrong resistance or torque constant, so that heat from another input is wrong by a known factor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/diagnostic.h"
#include "calibration/calibration_job.h"
#include "calibration/forecast/prediction.h"
#include "motor/write_motor.h"
#include "study.h"

namespace heatsoak::calibration::study {
namespace {

using testing::ElementsAre;

constexpr double kWrong_ratio = 0.6;        ///< parameter of the motor file divided by its true value
constexpr double kTorque_Nm_per_A = 0.034;  ///< true torque constant

/// Returns logs of the simulator with all heat inputs: current, torque, the electrical input power of a motor whose only loss is the
/// copper loss, and a standing shaft.
std::vector<recording::Recording> logs_with_all(const estimation::TwoNodeTruth& truth, int count) {
  const estimation::LogMaking making{.duration_s = 1500.0, .flux_rms_W = 0.0, .outlier_share = 0.0, .dropout_share = 0.0};
  std::vector<recording::Recording> logs;
  for (int run = 0; run < count; ++run) {
    recording::Recording log = estimation::generated_log(truth, making, 7, static_cast<std::uint64_t>(run));
    log.name = "run_" + std::to_string(run + 1);
    const std::vector<double>& current_A = log.find("current_A")->values;
    const std::vector<double>& winding_C = log.find("winding_C")->values;
    std::vector<double> power_W, torque_Nm;
    for (std::size_t row = 0; row < log.rows(); ++row) {
      const double ohm = truth.resistance_25C_ohm * (1.0 + truth.temperature_coefficient_per_K * (winding_C[row] - 25.0));
      power_W.push_back(ohm * current_A[row] * current_A[row]);
      torque_Nm.push_back(kTorque_Nm_per_A * current_A[row]);
      log.line.push_back(static_cast<int>(row) + 2);
    }
    log.channels.push_back({*recording::quantity_named("speed_rad_per_s"), std::vector<double>(log.rows(), 0.0)});
    log.channels.push_back({*recording::quantity_named("power_in_W"), std::move(power_W)});
    log.channels.push_back({*recording::quantity_named("torque_Nm"), std::move(torque_Nm)});
    logs.push_back(std::move(log));
  }
  return logs;
}

recording::Recording without(recording::Recording log, const std::vector<std::string>& columns) {
  std::erase_if(log.channels,
                [&](const recording::Channel& each) { return std::ranges::find(columns, each.quantity.key) != columns.end(); });
  return log;
}

std::vector<recording::Recording> without(std::vector<recording::Recording> logs, const std::vector<std::string>& columns) {
  std::ranges::transform(logs, logs.begin(), [&](const recording::Recording& log) { return without(log, columns); });
  return logs;
}

motor::Motor with_wrong(motor::Motor motor, std::string_view key) {
  motor::find_parameter(motor, key)->value *= kWrong_ratio;
  motor::find_parameter(motor, key)->printed.clear();
  motor::refresh_values(motor);
  return motor;
}

double worst_rms_K(const PredictedRun& run) {
  double worst_K = 0.0;
  for (const PredictedSignal& signal : run.signals) {
    worst_K = std::max(worst_K, signal.rmse_K);
  }
  return worst_K;
}

double worst_rms_K(const motor::Motor& motor, const recording::Recording& log) {
  return worst_rms_K(predict(motor, std::vector{log}, {}).runs.at(0));
}

/// Writes the motor's file and reads it.
motor::Motor from_file(const motor::Motor& motor, const Folder& folder) {
  const auto file = folder.path() / "written.toml";
  std::ofstream(file) << motor::to_toml(motor);
  return motor::read_motor(file);
}

constexpr double kRight_K = 1.0;
constexpr double kWrong_K = 5.0;

/// The motor file's resistance is 0.6 times the true one, so a current gives 0.6 times the heat of the logged power.
TEST(HeatInput, OfTheFitIsThatOfItsForecasts) {
  const Folder folder;
  const Sheet sheet;
  const motor::Motor motor = with_wrong(sheet.motor(folder), "terminal_resistance");
  const std::vector<recording::Recording> all = logs_with_all(sheet.truth, 4);
  const recording::Recording both = without(all.back(), {"torque_Nm", "speed_rad_per_s"});
  const std::vector<recording::Recording> power = without({all.begin(), all.begin() + 3}, {"current_A", "torque_Nm", "speed_rad_per_s"});
  const Calibration calibration = calibrate(motor, power, std::vector{both}, {});
  const motor::Motor fitted = from_file(calibrated_motor(motor, calibration), folder);
  EXPECT_EQ(fitted.fit->heat_input, HeatInput::input_power);
  EXPECT_LT(worst_rms_K(fitted, both), kRight_K);
  EXPECT_LT(worst_rms_K(calibration.holdout_after.at(0)), kRight_K);
  EXPECT_FALSE(has_finding<HeatInputLacking>(calibration.findings));
  motor::Motor unstated = fitted;
  unstated.fit->heat_input.reset();
  EXPECT_GT(worst_rms_K(unstated, both), kWrong_K) << "the wrong resistance of this test hardly matters";
}

/// The file's torque constant is 0.6 times the true one, so the torque gives a current of 1/0.6 times the logged one.
TEST(HeatInput, OfAFitToTorquesIgnoresACurrent) {
  const Folder folder;
  const Sheet sheet;
  const motor::Motor motor = with_wrong(sheet.motor(folder), "torque_constant");
  const std::vector<recording::Recording> all = logs_with_all(sheet.truth, 4);
  const recording::Recording both = without(all.back(), {"power_in_W"});
  const std::vector<recording::Recording> torque = without({all.begin(), all.begin() + 3}, {"current_A", "power_in_W"});
  const Calibration calibration = calibrate(motor, torque, {}, {});
  motor::Motor fitted = from_file(calibrated_motor(motor, calibration), folder);
  EXPECT_EQ(fitted.fit->heat_input, HeatInput::torque);
  EXPECT_LT(worst_rms_K(fitted, both), kRight_K);
  fitted.fit->heat_input.reset();
  EXPECT_GT(worst_rms_K(fitted, both), kWrong_K) << "the wrong torque constant of this test hardly matters";
}

/// A log without the model's heat input is predicted from another one, with a warning that names the log; without any it is refused.
TEST(HeatInput, ThatALogLacksIsReplacedWithAWarning) {
  const Folder folder;
  const Sheet sheet;
  const motor::Motor motor = sheet.motor(folder);
  const std::vector<recording::Recording> all = without(logs_with_all(sheet.truth, 4), {"torque_Nm", "speed_rad_per_s"});
  const std::vector<recording::Recording> train = without({all.begin(), all.begin() + 3}, {"current_A"});
  const recording::Recording no_power = without(all.back(), {"power_in_W"});
  const Calibration calibration = calibrate(motor, train, std::vector{no_power}, {});
  const motor::Motor fitted = calibrated_motor(motor, calibration);
  const auto lacking_in = [](const auto& notes) {
    std::vector<HeatInputLacking> found;
    for (const auto& note : notes) {
      if (const auto* const lacking = std::get_if<HeatInputLacking>(&note)) {
        found.push_back(*lacking);
      }
    }
    return found;
  };
  const Prediction prediction = predict(fitted, std::vector{no_power}, {});
  for (const std::vector<HeatInputLacking>& found : {lacking_in(prediction.notes), lacking_in(calibration.findings)}) {
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].of_model, HeatInput::input_power);
    EXPECT_EQ(found[0].used, HeatInput::current);
    EXPECT_THAT(found[0].recordings, ElementsAre("run_4"));
  }
  EXPECT_LT(worst_rms_K(prediction.runs.at(0)), kRight_K) << "the resistance of this file is the true one";
  EXPECT_THROW(predict(fitted, std::vector{without(no_power, {"current_A"})}, {}), base::Failure);
  const Calibration again = calibrate(fitted, std::vector{no_power}, {}, {});
  EXPECT_EQ(lacking_in(again.findings).size(), 1U) << "the file's parameters hold for the input power";
  EXPECT_EQ(calibrated_motor(fitted, again).fit->heat_input, HeatInput::current);
}

/// A file without a stated heat input, as older versions wrote it, uses what each log has.
TEST(HeatInput, OfADataSheetIsThatOfEachLog) {
  const Folder folder;
  const Sheet sheet;
  const motor::Motor motor = sheet.motor(folder);
  const std::vector<recording::Recording> all = without(logs_with_all(sheet.truth, 1), {"torque_Nm", "speed_rad_per_s"});
  EXPECT_EQ(forecast_setup(motor, all).heat, HeatInput::current);
  EXPECT_EQ(forecast_setup(motor, without(all, {"current_A"})).heat, HeatInput::input_power);
  EXPECT_FALSE(lacking_heat_input(motor, all, {}, HeatInput::current));
}

TEST(HeatInput, OfAFileMustBeKnown) {
  const Folder folder;
  const Sheet sheet;
  motor::Motor motor = sheet.motor(folder);
  motor.fit.emplace().motor = motor.id;
  motor.fit->latent_flux_time_scale_s = 1.0;
  motor.fit->parameters = {"thermal_resistance_winding_stator"};
  motor.fit->correlation = motor::Correlation(std::size_t{1});
  motor.fit->heat_input = HeatInput::power_balance;
  std::string text = motor::to_toml(motor);
  EXPECT_EQ(from_file(motor, folder).fit->heat_input, HeatInput::power_balance);
  const std::string_view stated = "\"power_balance\"";
  const auto file = folder.path() / "unknown.toml";
  std::ofstream(file) << text.replace(text.find(stated), stated.size(), "\"curent\"");
  try {
    motor::read_motor(file);
    FAIL() << "an unknown heat input was accepted";
  } catch (const base::Failure& failure) {
    EXPECT_THAT(failure.what(), testing::AllOf(testing::HasSubstr("heat_input"), testing::HasSubstr("did you mean 'current'")));
  }
}

/// Without a current, the input power is the whole heat. A remaining_loss of the file is a part of it, not an addition.
TEST(HeatInput, OfPowerContainsTheRemainingLoss) {
  const Folder folder;
  const Sheet sheet;
  const motor::Motor plain = sheet.motor(folder);
  motor::Motor motor = plain;
  base::ParameterValue one, half;
  one.value = 1.0;
  half.value = 0.5;
  motor.effects.push_back({.name = "rest",
                           .type = thermal::find_effect("remaining_loss"),
                           .nodes = {"winding", "stator"},
                           .parameters = {one, half},
                           .condition = {},
                           .column = {}});
  const recording::Recording all = logs_with_all(sheet.truth, 1).front();
  const Prediction of_power = predict(motor, std::vector{without(all, {"current_A"})}, {});
  EXPECT_LT(worst_rms_K(of_power.runs.at(0)), kRight_K);
  ASSERT_EQ(of_power.missing.size(), 1U);
  EXPECT_TRUE(of_power.missing[0].is_unused && !of_power.missing[0].is_unread);
  EXPECT_LT(worst_rms_K(motor, all), kRight_K) << "the balance";
  recording::Recording working = without(all, {"torque_Nm", "speed_rad_per_s"});
  std::ranges::for_each(working.channels.back().values, [](double& power_W) { power_W *= 3.0; });
  EXPECT_LT(worst_rms_K(motor, working), kRight_K) << "without a torque, the power is no balance: two thirds of it may leave the shaft";
}

/// A forecast from the input power does not depend on the current, so the file states no range of it.
TEST(HeatInput, ThatIsUnusedHasNoRange) {
  const Folder folder;
  const Sheet sheet;
  const std::vector<recording::Recording> all = logs_with_all(sheet.truth, 1);
  motor::TrainingRange range;
  widen(range, all, HeatInput::current);
  EXPECT_TRUE(range.inputs.contains("current_A"));
  widen(range, all, HeatInput::input_power);
  EXPECT_FALSE(range.inputs.contains("current_A"));
  EXPECT_TRUE(range.inputs.contains("speed_rad_per_s"));
  recording::Recording tenfold = all.front();
  std::ranges::for_each(tenfold.channels, [](recording::Channel& each) {
    if (each.quantity.key == "current_A") {
      std::ranges::for_each(each.values, [](double& value) { value *= 10.0; });
    }
  });
  EXPECT_TRUE(outside(range, tenfold).empty());
}

}  // namespace
}  // namespace heatsoak::calibration::study
