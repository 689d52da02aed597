// The heat input of a diagnosis: decided over the training logs, written into the file, and used by every prediction.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/diagnostic.h"
#include "diagnosis/diagnosis_job.h"
#include "runs_for_tests.h"
#include "support/source_folder.h"

namespace heatsoak::diagnosis {
namespace {

using calibration::HeatInput;

/// Returns the motor of the simulator, with a terminal resistance that is 0.6 times the true one.
motor::Motor motor_with_wrong_resistance() {
  const estimation::TwoNodeTruth truth;
  motor::Motor motor = motor::read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml");
  motor.parameters.erase("mass");
  const std::vector<std::pair<std::string_view, double>> values{
      {"terminal_resistance", 0.6 * truth.resistance_25C_ohm},
      {"no_load_current", 0.0},
      {"thermal_resistance_winding_stator", truth.winding_stator_K_per_W},
      {"thermal_resistance_stator_ambient", truth.stator_ambient_K_per_W},
      {"thermal_time_constant_winding", truth.winding_J_per_K * truth.winding_stator_K_per_W},
      {"thermal_time_constant_stator", truth.stator_J_per_K * truth.stator_ambient_K_per_W}};
  for (const auto& [key, value] : values) {
    base::ParameterValue& parameter = *motor::find_parameter(motor, key);
    parameter.value = value;
    parameter.printed.clear();
    parameter.spread.reset();
  }
  motor::refresh_values(motor);
  return motor;
}

/// Returns a log with current and input power of a motor whose only loss is the copper loss.
recording::Recording log_with_both(std::uint64_t stream) {
  const estimation::TwoNodeTruth truth;
  recording::Recording log =
      estimation::generated_log(truth, {.duration_s = 1500.0, .flux_rms_W = 0.0, .outlier_share = 0.0, .dropout_share = 0.0}, 11, stream);
  log.name = "run_" + std::to_string(stream);
  log.file = log.name + ".csv";
  std::vector<double> power_W;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const double current_A = log.find("current_A")->values[row];
    const double hot_ratio = 1.0 + truth.temperature_coefficient_per_K * (log.find("winding_C")->values[row] - 25.0);
    power_W.push_back(truth.resistance_25C_ohm * hot_ratio * current_A * current_A);
    log.line.push_back(static_cast<int>(row) + 2);
  }
  log.channels.push_back({*recording::quantity_named("power_in_W"), std::move(power_W)});
  return log;
}

recording::Recording without(recording::Recording log, std::string_view column) {
  std::erase_if(log.channels, [&](const recording::Channel& each) { return each.quantity.key == column; });
  return log;
}

DiagnosisAnswer answer_for(const motor::Motor& motor, std::vector<recording::Recording> fitted,
                           std::vector<recording::Recording> held_out) {
  recording::NamedLogs logs;
  logs.fitted = std::move(fitted);
  logs.held_out = std::move(held_out);
  return run_diagnosis({motor, logs});
}

double worst_rms_K(const std::vector<calibration::PredictedRun>& runs) {
  double worst_K = 0.0;
  for (const calibration::PredictedRun& run : runs) {
    for (const calibration::PredictedSignal& signal : run.signals) {
      worst_K = std::max(worst_K, signal.rmse_K);
    }
  }
  return worst_K;
}

/// The hold-out log has a current, which would give 0.6 times the heat. Neither its errors nor the band depend on it.
TEST(HeatInputOfDiagnosis, IsThatOfItsForecasts) {
  const motor::Motor motor = motor_with_wrong_resistance();
  const std::vector<recording::Recording> fitted{without(log_with_both(1), "current_A"), without(log_with_both(2), "current_A"),
                                                 without(log_with_both(3), "current_A")};
  const DiagnosisAnswer of_both = answer_for(motor, fitted, {log_with_both(4)});
  const DiagnosisAnswer of_power = answer_for(motor, fitted, {without(log_with_both(4), "current_A")});
  EXPECT_EQ(of_both.motor.fit->heat_input, HeatInput::input_power);
  EXPECT_TRUE(std::ranges::any_of(of_both.findings, [](const DiagnosisFinding& each) {
    return std::holds_alternative<calibration::ShaftPowerUnknown>(each);
  })) << "the logs have no torque";
  EXPECT_LT(worst_rms_K(of_both.score.runs_after), 1.0);
  EXPECT_EQ(worst_rms_K(of_both.score.runs_after), worst_rms_K(of_power.score.runs_after));
  EXPECT_EQ(worst_rms_K(of_both.score.runs_before), worst_rms_K(of_power.score.runs_before));
  motor::Motor unstated = of_both.motor;
  unstated.fit->heat_input.reset();
  const std::vector<recording::Recording> held_out{log_with_both(4)};
  EXPECT_GT(worst_rms_K(calibration::predict(unstated, held_out, {}).runs), 5.0) << "the wrong resistance of this test hardly matters";
}

/// The file was fitted to input powers, so the currents of these training logs are not used, and logs without one may be among them.
TEST(HeatInputOfDiagnosis, IsThatOfTheFile) {
  motor::Motor motor = motor_with_wrong_resistance();
  motor.fit.emplace().motor = motor.id;
  motor.fit->heat_input = HeatInput::input_power;
  const DiagnosisAnswer answer = answer_for(motor, {log_with_both(1), without(log_with_both(2), "current_A"), log_with_both(3)}, {});
  EXPECT_EQ(answer.motor.fit->heat_input, HeatInput::input_power);
  ASSERT_TRUE(answer.motor.fit->band);
  EXPECT_LT(answer.band->half_width_K.at("winding_C"), 3.0) << "the band is that of correct heat";
  EXPECT_EQ(answer.diagnosis.verdict, DiagnosisVerdict::nothing_missing);
}

TEST(HeatInputOfDiagnosis, LogsWithAndWithoutACurrentDoNotMix) {
  const motor::Motor motor = motor_with_wrong_resistance();
  try {
    answer_for(motor, {log_with_both(1), without(log_with_both(2), "current_A")}, {});
    FAIL() << "one of two logs has no current";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_THAT(failure.what(),
                testing::AllOf(testing::HasSubstr("run_2.csv: error: current_A"), testing::Not(testing::HasSubstr("run_1.csv"))));
  }
}

}  // namespace
}  // namespace heatsoak::diagnosis
