// Fits of third-party recordings from rough initial values. The bounds follow from physics and from the raw recordings. Skipped if the
// recordings are not available.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/measured_data.h"
#include "calibration/calibrate.h"
#include "recording/read_recording.h"
#include "support/source_folder.h"

namespace heatsoak::calibration {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::Field;

const fs::path kReports = kSource / "reports";
const fs::path kMappings = kSource / "tests/data/mappings";

class Recordings : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_MEASURED_DATA(""); }
  static std::vector<recording::Recording> read(const std::string& folder, const std::vector<std::string>& files, const fs::path& map) {
    std::vector<recording::Recording> all;
    for (const std::string& file : files) {
      const fs::path log = *measured_data() / folder / file;
      recording::RecordingReport report;
      all.push_back(recording::read_recording(log, recording::read_mapping(map, log), report));
    }
    return all;
  }
  static const CalibratedParameter& parameter(const Calibration& calibration, std::string_view name) {
    return *std::ranges::find(calibration.parameters, name, &CalibratedParameter::name);
  }
  static const ErrorBeforeAfter& error(const std::vector<ErrorBeforeAfter>& errors, std::string_view signal) {
    return *std::ranges::find(errors, signal, &ErrorBeforeAfter::signal);
  }
  /// Root of the mean square over the signals.
  static double total_K(const std::vector<ErrorBeforeAfter>& errors, estimation::SignalError ErrorBeforeAfter::*when) {
    double squares = 0.0;
    for (const ErrorBeforeAfter& each : errors) {
      squares += (each.*when).rmse_K * (each.*when).rmse_K;
    }
    return std::sqrt(squares / static_cast<double>(errors.size()));
  }
};

TEST_F(Recordings, DroneMotorNearStandstill) {
  const fs::path map = kMappings / "tasrv_uav_motor.map.toml";
  const Calibration found = calibrate(motor::read_motor(kReports / "diagnosis/uav_motor.toml"),
                                      read("tasrv_uav_motor", {"run1.csv", "run3.csv", "run5.csv"}, map),
                                      read("tasrv_uav_motor", {"run2.csv"}, map), {.fit = {}, .written = WrittenFit::innovations});
  // 600 W raise the winding by 1.1 K/s in the first half minute of run 5, before much heat reaches the stator: about 520 J/K.
  const CalibratedParameter& winding = parameter(found, "winding_heat_capacity");
  EXPECT_TRUE(winding.is_identifiable);
  EXPECT_GT(winding.value, 350.0);
  EXPECT_LT(winding.value, 650.0);
  // The stator rises by 0.55 K/s at the end of run 3 and is about 60 K below the winding.
  EXPECT_GT(parameter(found, "thermal_resistance_winding_stator").value, 0.08);
  EXPECT_LT(parameter(found, "thermal_resistance_winding_stator").value, 0.35);
  // These two intervals come from a profile. The same bounds hold for them, less strictly; without the determinant one reached 7.4 K/W.
  EXPECT_GT(parameter(found, "thermal_resistance_winding_stator").low, 0.05);
  EXPECT_LT(parameter(found, "thermal_resistance_winding_stator").high, 0.5);
  EXPECT_GT(parameter(found, "stator_heat_capacity").low, 100.0);
  const std::vector<ErrorBeforeAfter> fitted = errors_over_runs(found.fitted_before, found.fitted_after);
  EXPECT_LT(total_K(fitted, &ErrorBeforeAfter::after), 0.5 * total_K(fitted, &ErrorBeforeAfter::before));
  EXPECT_LT(total_K(found.holdout_error, &ErrorBeforeAfter::after), total_K(found.holdout_error, &ErrorBeforeAfter::before));
  // The runs take minutes and contain no cool-down, so the heat that leaves the stator is not identifiable.
  EXPECT_FALSE(parameter(found, "thermal_resistance_stator_ambient").is_identifiable);
  EXPECT_THAT(found.findings, Contains(testing::VariantWith<HeldValue>(testing::VariantWith<HeatShareHeld>(testing::_))));
}

/// The network that predicts the left-out runs best must also predict a run that was not used for its choice.
TEST_F(Recordings, DroneMotorIsForecastTo2K) {
  const fs::path map = kMappings / "tasrv_uav_motor.map.toml";
  const Calibration found =
      calibrate(motor::read_motor(kReports / "diagnosis/uav_motor.toml"),
                read("tasrv_uav_motor", {"run1.csv", "run3.csv", "run5.csv"}, map), read("tasrv_uav_motor", {"run2.csv"}, map), {});
  ASSERT_TRUE(found.is_forecast_written);
  double contact_W_per_K = 1.0 / parameter(found, "thermal_resistance_winding_stator").value;
  for (const CalibratedParameter& each : found.parameters) {
    contact_W_per_K += each.name == "effects.contact_law.conductance" ? each.value : 0.0;
  }
  EXPECT_GT(1.0 / contact_W_per_K, 0.08);
  EXPECT_LT(1.0 / contact_W_per_K, 0.35);
  EXPECT_LE(error(found.holdout_error, "winding_C").after.rmse_K, 2.0);
  EXPECT_LE(error(found.holdout_error, "stator_C").after.rmse_K, 1.7);
}

TEST_F(Recordings, StallStaircase) {
  const fs::path map = kMappings / "umich_ri50.map.toml";
  CalibrationOptions options;
  options.ambient_C = 22.0;
  const Calibration found =
      calibrate(motor::read_motor(kReports / "calibration/ri50.toml"), read("umich_ri50", {"stall_staircase.csv"}, map), {}, options);
  // 8 A through 0.52 ohm raise the winding by 5.3 K/s: 6.3 J/K, or at most about 8 J/K including the heat that reaches the stator.
  const CalibratedParameter& winding = parameter(found, "winding_heat_capacity");
  EXPECT_LT(winding.low, 6.6);
  EXPECT_GT(winding.high, 6.0);
  EXPECT_LT(error(found.fit_error, "winding_C").after.rmse_K, 0.25 * error(found.fit_error, "winding_C").before.rmse_K);
  // A run of 72 s does not determine the path from housing to air, and a locked rotor has no loss at speed.
  EXPECT_FALSE(parameter(found, "thermal_resistance_stator_ambient").is_identifiable);
  EXPECT_FALSE(parameter(found, "no_load_current").is_identifiable);
  EXPECT_THAT(found.open, Contains(Field(&OpenDirection::reason, OpenReason::common_factor)));
}

TEST_F(Recordings, CoolDowns) {
  const fs::path map = kReports / "calibration/ksu_cool_down.map.toml";
  const Calibration found =
      calibrate(motor::read_motor(kReports / "calibration/p80.toml"),
                read("ksu_propeller_bench",
                     {"cooling_slopes__Spike-P80-1700_2020-02-11_162559.csv", "cooling_slopes__Spike-P80-1700_2020-03-09_185035.csv"}, map),
                {}, {});
  EXPECT_LT(error(found.fit_error, "winding_C").after.rmse_K, 1.0);
  EXPECT_THAT(found.open, Contains(Field(&OpenDirection::reason, OpenReason::no_heat)));
  for (const char* watts :
       {"thermal_resistance_winding_stator", "thermal_resistance_stator_ambient", "winding_heat_capacity", "stator_heat_capacity"}) {
    EXPECT_FALSE(parameter(found, watts).is_identifiable) << watts;
  }
  // From 44.1 °C, 170 s after the stop, to 38.1 °C, 520 s after it, in air of 24.5 °C: 990 s if only the slowest decay remained.
  const CalibratedParameter& stator = parameter(found, "thermal_time_constant_stator");
  EXPECT_TRUE(stator.is_identifiable);
  EXPECT_LT(stator.low, 990.0);
  EXPECT_GT(stator.high, 500.0);
}

TEST_F(Recordings, TractionMotorHourByHour) {
  const fs::path folder = kReports / "calibration";
  const Calibration found = calibrate(motor::read_motor(folder / "lea_pmsm_52kw.toml"),
                                      read("paderborn_pmsm", {"profile24_2.5s.csv"}, folder / "paderborn_first_hour.map.toml"),
                                      read("paderborn_pmsm", {"profile24_2.5s.csv"}, folder / "paderborn_second_hour.map.toml"), {});
  EXPECT_LT(total_K(found.fit_error, &ErrorBeforeAfter::after), 2.0);
  EXPECT_LT(total_K(found.holdout_error, &ErrorBeforeAfter::after), total_K(found.holdout_error, &ErrorBeforeAfter::before));
  // The limits correspond to 3 to 8 kg of copper.
  EXPECT_GT(parameter(found, "winding_heat_capacity").value, 1000.0);
  EXPECT_LT(parameter(found, "winding_heat_capacity").value, 3500.0);
  // The model lacks iron loss. The result must show that an effect is missing.
  EXPECT_GT(found.findings.size(), 1U);
}

}  // namespace
}  // namespace heatsoak::calibration
