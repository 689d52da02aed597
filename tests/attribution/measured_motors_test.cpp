// Measured motors with effects that the recordings do not describe. The recordings are not part of the repository; without them the tests
// are skipped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "../support/measured_data.h"
#include "calibration/calibrate.h"
#include "diagnosis/coverage.h"
#include "measured_cases.h"
#include "support/source_folder.h"

namespace heatsoak::attribution {
namespace {

using namespace measured;
using truth::account;

/// RMS error of a free-running simulation over all samples of one signal.
double rms_K(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs, const char* signal) {
  return estimation::open_loop_errors(model, runs, {}).at(signal).rmse_K;
}

/// Checks the fitted first part of run 4 and the unseen second part.
void expect_follows_the_fan(Drone& all, const Diagnosed& found) {
  const estimation::Model& after = found.diagnosis.selection.after.model;
  const std::vector<estimation::MeasuredRun> run4 = runs_of(found.model, {all.run["run4"]});
  const std::vector<estimation::MeasuredRun> fitted = runs_of(found.model, {recording::part_of(all.run["run4"], 0.0, 0.6)});
  for (const char* const signal : {"winding_C", "stator_C"}) {
    EXPECT_LE(rms_K(after, fitted, signal), 3.0) << signal << account(found.diagnosis);
    EXPECT_GT(rms_K(found.input.model, run4, signal), 25.0) << signal;
    EXPECT_LE(rms_K(after, run4, signal), 0.15 * rms_K(found.input.model, run4, signal)) << signal << account(found.diagnosis);
  }
}

TEST(MeasuredMotors, an_undocumented_fan_is_found_in_the_run_that_had_it) {
  SKIP_WITHOUT_MEASURED_DATA("tasrv_uav_motor");
  const std::optional<std::filesystem::path> folder = measured_data("tasrv_uav_motor");
  Drone all = drone(*folder, false);
  for (const auto& [name, run] : all.run) {
    EXPECT_THAT(run.conditions, testing::IsEmpty()) << name;
  }
  const Diagnosed found = diagnosed(all, 0.6);
  expect_follows_the_fan(all, found);
  const std::vector<estimation::MeasuredRun> run2 = runs_of(found.model, {all.run["run2"]});
  for (const char* const signal : {"winding_C", "stator_C"}) {
    EXPECT_LE(rms_K(found.diagnosis.selection.after.model, run2, signal), rms_K(found.input.model, run2, signal)) << signal;
  }
}

/// The condition has two values, so a heat share with the fan and one without it are the same statement.
TEST(MeasuredMotors, a_fan_that_the_logs_state_is_found) {
  SKIP_WITHOUT_MEASURED_DATA("tasrv_uav_motor");
  const std::optional<std::filesystem::path> folder = measured_data("tasrv_uav_motor");
  for (const bool is_for_forecasts : {true, false}) {
    Drone all = drone(*folder, is_for_forecasts);
    for (auto& [name, run] : all.run) {
      run.conditions = {{"fan", name == "run4" ? "on" : "off"}};
    }
    const Diagnosed found = diagnosed(all, 0.6);
    EXPECT_TRUE(effect_of(found.diagnosis, "airflow")) << account(found.diagnosis);
    EXPECT_TRUE(effect_of(found.diagnosis, "heat_share")) << account(found.diagnosis);
    const std::vector<estimation::MeasuredRun> run4 = runs_of(found.model, {all.run["run4"]});
    EXPECT_LT(rms_K(found.diagnosis.selection.after.model, run4, "stator_C"),
              0.25 * rms_K(found.diagnosis.selection.own.model, run4, "stator_C"))
        << account(found.diagnosis);
  }
}

TEST(MeasuredMotors, a_fan_is_found_from_another_start_too) {
  SKIP_WITHOUT_MEASURED_DATA("tasrv_uav_motor");
  const std::optional<std::filesystem::path> folder = measured_data("tasrv_uav_motor");
  Drone all = drone(*folder, true,
                    {{"thermal_resistance_winding_stator", 1.7},
                     {"thermal_resistance_stator_ambient", 1.5},
                     {"thermal_time_constant_winding", 1.6},
                     {"thermal_time_constant_stator", 0.7}});
  expect_follows_the_fan(all, diagnosed(all, 0.6));
}

/// Diagnoses from files that no calibration has fitted, with start values that differ by a factor of four.
TEST(MeasuredMotors, a_fan_is_found_from_any_uncalibrated_file) {
  SKIP_WITHOUT_MEASURED_DATA("tasrv_uav_motor");
  const std::optional<std::filesystem::path> folder = measured_data("tasrv_uav_motor");
  Drone all = drone(*folder, true);
  for (const double factor : {0.5, 1.0, 2.0}) {
    all.motor = guessed_otherwise(motor::read_motor(reports() / "uav_motor.toml"), {{"thermal_resistance_winding_stator", factor},
                                                                                    {"thermal_resistance_stator_ambient", factor},
                                                                                    {"thermal_time_constant_winding", factor},
                                                                                    {"thermal_time_constant_stator", factor}});
    for (const double cut : {0.5, 0.6, 0.65}) {
      const Diagnosed found = diagnosed(all, cut);
      const diagnosis::FoundEffect* const fan = effect_of(found.diagnosis, "airflow");
      ASSERT_TRUE(fan) << factor << ", " << cut << account(found.diagnosis);
      EXPECT_THAT(fan->condition, testing::ElementsAre(testing::Pair("run", "run4")));
    }
  }
}

/// The law that the whole set needs is hardly visible in this part. Without it the error on whole runs is six times as large.
TEST(MeasuredMotors, a_hardly_visible_law_is_kept_if_no_parameter_could_replace_it) {
  SKIP_WITHOUT_MEASURED_DATA("tasrv_uav_motor");
  const std::optional<std::filesystem::path> folder = measured_data("tasrv_uav_motor");
  Drone all = drone(*folder);
  const Diagnosed found = diagnosed(all, 0.65);
  for (const char* const signal : {"winding_C", "stator_C"}) {
    EXPECT_GT(found.score.before.at(signal).rmse_K, 40.0) << signal;
    EXPECT_LE(found.score.after.at(signal).rmse_K, 6.0) << signal << account(found.diagnosis);
  }
}

class DroneWithFan : public testing::TestWithParam<int> {};

TEST_P(DroneWithFan, is_named_wherever_its_run_is_cut) {
  SKIP_WITHOUT_MEASURED_DATA("tasrv_uav_motor");
  const std::optional<std::filesystem::path> folder = measured_data("tasrv_uav_motor");
  Drone all = drone(*folder);
  const Diagnosed found = diagnosed(all, GetParam() / 100.0);
  EXPECT_EQ(found.diagnosis.verdict, diagnosis::DiagnosisVerdict::effect_found) << account(found.diagnosis);
  const diagnosis::FoundEffect* const fan = effect_of(found.diagnosis, "airflow");
  ASSERT_TRUE(fan) << account(found.diagnosis);
  EXPECT_EQ(fan->node, "stator");
  EXPECT_THAT(fan->condition, testing::ElementsAre(testing::Pair("run", "run4")));
  EXPECT_GT(fan->parameters.front().low, 0.0);
}
INSTANTIATE_TEST_SUITE_P(MeasuredMotors, DroneWithFan, testing::Values(50, 60, 70),
                         [](const auto& each) { return "first_" + std::to_string(each.param) + "_percent"; });

/// The probe at the coils is in the propeller's air flow. The copper behind it is hotter, so the probe's temperature rises after
/// switch-off.
TEST(MeasuredMotors, a_propeller_cools_while_it_turns_and_what_is_hot_inside_comes_out_after_switch_off) {
  SKIP_WITHOUT_MEASURED_DATA("ksu_propeller_bench");
  const std::optional<std::filesystem::path> folder = measured_data("ksu_propeller_bench");
  const auto [january, march, start] = propeller_bench(*folder);
  const auto [model, input, diagnosis, score] = diagnosed(start, {january}, {march});
  EXPECT_EQ(diagnosis.verdict, diagnosis::DiagnosisVerdict::effect_found) << account(diagnosis);
  const diagnosis::FoundEffect* const propeller = effect_of(diagnosis, "speed_dependent_convection");
  ASSERT_TRUE(propeller) << account(diagnosis);
  EXPECT_EQ(propeller->node, "stator");
  EXPECT_GT(propeller->parameters.front().low, 0.0);
  EXPECT_LE(score.after.at("stator_C").rmse_K, 1.0);
  const estimation::MeasuredRun& run = score.runs.front();
  const auto turns = [](const thermal::OperatingPoint<double>& at) { return at.speed_mean_rad_per_s > 10.0; };
  const Eigen::MatrixXd predicted_C = estimation::open_loop_C(diagnosis.selection.after.model, run, {});
  const Eigen::Index stopped = std::ranges::find_if(run.at.rbegin(), run.at.rend(), turns).base() - run.at.begin();
  const double measured_rise_K = run.measured_C.col(0).tail(run.samples() - stopped).maxCoeff() - run.measured_C(stopped, 0);
  EXPECT_GT(measured_rise_K, 4.0);
  EXPECT_NEAR(predicted_C.col(0).tail(run.samples() - stopped).maxCoeff() - predicted_C(stopped, 0), measured_rise_K, 1.0);
}

/// A calibration without the propeller's air flow absorbs part of it in the parameters. The run must still reveal the effect.
TEST(MeasuredMotors, a_calibrated_motor_gets_the_air_of_its_propeller_from_the_one_run_that_it_was_fitted_to) {
  SKIP_WITHOUT_MEASURED_DATA("ksu_propeller_bench");
  const std::optional<std::filesystem::path> folder = measured_data("ksu_propeller_bench");
  const auto [january, march, start] = propeller_bench(*folder);
  const motor::Motor motor = calibration::calibrated_motor(
      start, calibration::calibrate(start, std::vector{january}, {}, {.fit = {}, .written = calibration::WrittenFit::innovations}));
  const auto [model, input, diagnosis, score] = diagnosed(motor, {january}, {march});
  EXPECT_EQ(diagnosis.verdict, diagnosis::DiagnosisVerdict::effect_found) << account(diagnosis);
  EXPECT_TRUE(effect_of(diagnosis, "speed_dependent_convection")) << account(diagnosis);
  EXPECT_LE(score.after.at("stator_C").rmse_K, 1.05 * score.before.at("stator_C").rmse_K);
}

/// From this initial guess no step along the whitened errors improves the fit. The fit must first match the simulated runs directly.
TEST(MeasuredMotors, two_recordings_far_from_the_guess_are_followed_before_anything_is_looked_for) {
  SKIP_WITHOUT_MEASURED_DATA("ksu_propeller_bench");
  const std::optional<std::filesystem::path> folder = measured_data("ksu_propeller_bench");
  const auto [january, march, start] = propeller_bench(*folder);
  const std::vector<recording::Recording> both{january, march};
  const diagnosis::Diagnosis diagnosis = diagnosed(start, both, {}).diagnosis;
  EXPECT_GT(diagnosis.before_train.at("stator_C").rmse_K, 40.0);
  EXPECT_LT(diagnosis.refitted_train.at("stator_C").rmse_K, 3.0);
  EXPECT_LT(diagnosis.after_train.at("stator_C").rmse_K, diagnosis.refitted_train.at("stator_C").rmse_K);
  EXPECT_TRUE(effect_of(diagnosis, "speed_dependent_convection")) << account(diagnosis);
}

/// If no effect is accepted, the result must be the base model with refitted parameters. Rejected laws must not influence it.
TEST(MeasuredMotors, rejected_laws_do_not_change_the_refitted_parameters) {
  SKIP_WITHOUT_MEASURED_DATA("ksu_propeller_bench");
  const std::optional<std::filesystem::path> folder = measured_data("ksu_propeller_bench");
  const auto [january, march, start] = propeller_bench(*folder);
  const motor::Motor guess = guessed_otherwise(start, {{"thermal_resistance_winding_stator", 1.31},
                                                       {"thermal_resistance_stator_ambient", 1.70},
                                                       {"thermal_time_constant_winding", 1.91},
                                                       {"thermal_time_constant_stator", 2.64}});
  const auto [model, input, diagnosis, score] =
      diagnosed(guess, {january, recording::part_of(march, 0.0, 0.6)}, {recording::part_of(march, 0.6, 1.0)});
  EXPECT_THAT(diagnosis.selection.refused, testing::Not(testing::IsEmpty()));
  if (diagnosis.effects.empty()) {
    EXPECT_NEAR(diagnosis.after_train.at("stator_C").rmse_K, diagnosis.refitted_train.at("stator_C").rmse_K, 0.01);
  } else {
    EXPECT_LT(score.after.at("stator_C").rmse_K, score.refitted.at("stator_C").rmse_K);
  }
}

/// A second motor of the bench, not used during development of the tool. Its speed was recorded once only.
TEST(MeasuredMotors, another_outrunner_of_the_bench_gets_the_air_of_its_propeller) {
  SKIP_WITHOUT_MEASURED_DATA("ksu_propeller_bench");
  const std::optional<std::filesystem::path> folder = measured_data("ksu_propeller_bench");
  const recording::Recording all = of_bench(*folder, "P80-1700_2020-02-11_162559");
  const motor::Motor start = motor::read_motor(reports() / "propeller_bench/start.toml");
  const auto [model, input, diagnosis, score] = diagnosed(start, {recording::part_of(all, 0.0, 0.7)}, {recording::part_of(all, 0.7, 1.0)});
  ASSERT_TRUE(effect_of(diagnosis, "speed_dependent_convection")) << account(diagnosis);
  EXPECT_LE(diagnosis.after_train.at("stator_C").rmse_K, 0.5 * diagnosis.refitted_train.at("stator_C").rmse_K);
  EXPECT_LE(score.after.at("stator_C").rmse_K, 0.5);
}

TEST(MeasuredMotors, locked_and_free_runs_of_a_frameless_motor_come_under_one_model) {
  SKIP_WITHOUT_MEASURED_DATA("umich_ri50");
  const std::optional<std::filesystem::path> folder = measured_data("umich_ri50");
  const std::filesystem::path map = kSource / "tests/data/mappings/umich_ri50.map.toml";
  const recording::Recording stall = read(*folder / "stall_staircase.csv", map);
  const recording::Recording no_load = read(*folder / "no_load_staircase.csv", map);
  const motor::Motor start = motor::read_motor(reports() / "../calibration/ri50.toml");
  constexpr double kAmbient_C = 22.0;
  const motor::Motor motor = calibration::calibrated_motor(
      start, calibration::calibrate(start, std::vector{stall}, {}, {{}, kAmbient_C, calibration::WrittenFit::innovations}));
  const auto [model, input, diagnosis, score] =
      diagnosed(motor, {stall, recording::part_of(no_load, 0.0, 0.6)}, {recording::part_of(no_load, 0.6, 1.0)}, kAmbient_C);
  EXPECT_LE(score.after.at("winding_C").rmse_K, 0.4) << account(diagnosis);
  EXPECT_LE(score.after.at("stator_C").rmse_K, 0.2) << account(diagnosis);
  EXPECT_LT(diagnosis.after_train.at("winding_C").rmse_K, 0.7 * diagnosis.before_train.at("winding_C").rmse_K);
  // The data are 37 samples with a resolution of 1 K, so a tiny p-value would be wrong.
  EXPECT_THAT(diagnosis.effects, testing::Each(testing::Field(&diagnosis::FoundEffect::p_value, testing::Gt(1e-60))));
}

TEST(MeasuredMotors, a_traction_motor_said_to_have_copper_loss_only_is_predicted_after_two_loads) {
  SKIP_WITHOUT_MEASURED_DATA("paderborn_pmsm");
  const std::optional<std::filesystem::path> folder = measured_data("paderborn_pmsm");
  const auto [model, input, diagnosis, score] = of_traction_motor(*folder, 0.65);
  for (const char* const signal : {"winding_C", "stator_C"}) {
    EXPECT_GT(score.before.at(signal).rmse_K, 10.0) << signal;
    EXPECT_LE(score.after.at(signal).rmse_K, 3.0) << signal << account(diagnosis);
  }
  EXPECT_NE(diagnosis.verdict, diagnosis::DiagnosisVerdict::nothing_missing);
}

TEST(MeasuredMotors, a_traction_motor_said_to_have_copper_loss_only_gets_names_once_two_loads_were_seen_for_a_while) {
  SKIP_WITHOUT_MEASURED_DATA("paderborn_pmsm");
  const std::optional<std::filesystem::path> folder = measured_data("paderborn_pmsm");
  for (const double cut : {0.7, 0.75}) {
    const auto [model, input, diagnosis, score] = of_traction_motor(*folder, cut);
    EXPECT_THAT(diagnosis.effects, testing::Not(testing::IsEmpty())) << account(diagnosis);
    for (const char* const signal : {"winding_C", "stator_C"}) {
      EXPECT_LE(score.after.at(signal).rmse_K, 3.0) << signal << account(diagnosis);
    }
  }
}

TEST(MeasuredMotors, half_a_log_at_one_load_does_not_claim_to_know_another_load) {
  SKIP_WITHOUT_MEASURED_DATA("paderborn_pmsm");
  const std::optional<std::filesystem::path> folder = measured_data("paderborn_pmsm");
  const auto [model, input, diagnosis, score] = of_traction_motor(*folder, 0.5);
  for (const char* const signal : {"winding_C", "stator_C"}) {
    EXPECT_LT(score.after.at(signal).rmse_K, score.before.at(signal).rmse_K) << signal;
  }
  EXPECT_THAT(diagnosis::beyond_fitted(diagnosis.runs, score.runs),
              testing::ElementsAre(testing::Field(&diagnosis::BeyondTraining::signal, thermal::Signal::current)));
}

/// One recording of four minutes, to which whitened and plain fits give very different sizes.
TEST(MeasuredMotors, an_effect_without_a_size_gets_no_name) {
  SKIP_WITHOUT_MEASURED_DATA("ksu_propeller_bench");
  const std::optional<std::filesystem::path> folder = measured_data("ksu_propeller_bench");
  const recording::Recording all =
      read(*folder / "custom_head_testing__HeadBaseline-KDE-2000_2020-02-13_160050.csv", reports() / "propeller_bench/recordings.map.toml");
  const Diagnosed found =
      diagnosed(propeller_bench(*folder).start, {recording::part_of(all, 0.0, 0.7)}, {recording::part_of(all, 0.7, 1.0)});
  for (const diagnosis::FoundEffect& each : found.diagnosis.effects) {
    EXPECT_GT(each.parameters.front().value, 0.0) << each.id << account(found.diagnosis);
    EXPECT_FALSE(each.id.starts_with("sensor_") && each.parameters.front().low <= 0.0) << each.id << account(found.diagnosis);
  }
}

}  // namespace
}  // namespace heatsoak::attribution
