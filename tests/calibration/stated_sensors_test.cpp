// The motor's file states a sensor fault. With this statement the fit must find the true parameters, and without it other values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "calibration/admission.h"
#include "estimation/linearised_run.h"
#include "estimation/open_loop.h"
#include "study.h"
#include "synthetic_log.h"

namespace heatsoak::calibration::study {
namespace {

constexpr double kLag_s = 25.0;
constexpr double kOffset_K = 4.0;

/// Adds a probe in glue (lag) and a converter offset, in ten small steps per row.
void spoil(recording::Recording& log) {
  for (recording::Channel& channel : log.channels) {
    if (channel.quantity.key != "stator_C") {
      continue;
    }
    double sensor_C = std::nan("");
    double before_C = std::nan("");
    for (double& value_C : channel.values) {
      const double now_C = std::isnan(value_C) ? before_C : value_C;
      constexpr int kParts = 10;
      for (int part = 1; part <= kParts && !std::isnan(sensor_C); ++part) {
        const double at_C = before_C + (now_C - before_C) * (part - 0.5) / kParts;
        sensor_C += (at_C - sensor_C) / (kParts * kLag_s);
      }
      sensor_C = std::isnan(sensor_C) ? now_C : sensor_C;
      before_C = now_C;
      value_C = std::isnan(value_C) ? value_C : sensor_C + kOffset_K;
    }
  }
}

std::vector<motor::MotorSensor> stated() {
  base::ParameterValue lag, offset;
  lag.value = kLag_s;
  offset.value = kOffset_K;
  return {{"glued_on", motor::find_sensor_effect("sensor_lag_stator"), lag},
          {"sensor_offset_stator", motor::find_sensor_effect("sensor_offset_stator"), offset}};
}

class StatedSensors : public testing::Test {
 protected:
  StatedSensors() {
    estimation::LogMaking making;
    making.duration_s = 1800.0;
    making.noise_K = 0.02;
    making.resolution_K = 0.0;
    making.flux_rms_W = 0.0;
    making.outlier_share = 0.0;
    for (int run = 0; run < 3; ++run) {
      logs_.push_back(estimation::generated_log(truth_, making, 7, static_cast<std::uint64_t>(run)));
      logs_.back().name += std::to_string(run);
      spoil(logs_.back());
    }
  }
  [[nodiscard]] double off(const Calibration& calibration, std::string_view name, double truth) const {
    const auto found = std::ranges::find(calibration.parameters, name, &CalibratedParameter::name);
    return std::abs(found->value / truth - 1.0);
  }
  [[nodiscard]] double stator_off(const Calibration& calibration) const {
    return off(calibration, "thermal_time_constant_stator", truth_.stator_J_per_K * truth_.stator_ambient_K_per_W);
  }
  [[nodiscard]] double out_off(const Calibration& calibration) const {
    return off(calibration, "thermal_resistance_stator_ambient", truth_.stator_ambient_K_per_W);
  }

  Folder folder_;
  const estimation::TwoNodeTruth truth_;
  motor::Motor motor_ = Sheet().motor(folder_);
  std::vector<recording::Recording> logs_;
};

testing::Matcher<CalibrationFinding> sensor_held(const char* sensor, const char* parameter, double value, const char* unit) {
  return testing::VariantWith<HeldValue>(testing::VariantWith<SensorHeld>(
      testing::AllOf(testing::Field(&SensorHeld::sensor, sensor), testing::Field(&SensorHeld::parameter, parameter),
                     testing::Field(&SensorHeld::value, value), testing::Field(&SensorHeld::unit, unit))));
}

TEST_F(StatedSensors, FitFindsTheMotorBehindThem) {
  const Calibration blind = calibrate(motor_, logs_, {}, {});
  motor_.sensors = stated();
  const Calibration seeing = calibrate(motor_, logs_, {}, {});
  EXPECT_LT(out_off(seeing), 0.01);
  EXPECT_LT(stator_off(seeing), 0.01);
  EXPECT_GT(out_off(blind) + stator_off(blind), 0.1);
  for (const ErrorBeforeAfter& each : seeing.fit_error) {
    EXPECT_LT(each.after.rmse_K, 0.05) << each.signal;
  }
  EXPECT_THAT(seeing.findings, testing::Contains(sensor_held("glued_on", "time_constant", 25.0, "s")));
  EXPECT_THAT(seeing.findings, testing::Contains(sensor_held("sensor_offset_stator", "offset", 4.0, "K")));
  const motor::Motor written = calibrated_motor(motor_, seeing);
  ASSERT_EQ(written.sensors.size(), 2U);
  EXPECT_EQ(written.sensors.front().size.value, kLag_s);
}

TEST_F(StatedSensors, OfWhichNoLogSpeaksAreSaidToCountForNothing) {
  for (recording::Recording& log : logs_) {
    std::erase_if(log.channels, [](const recording::Channel& channel) { return channel.quantity.key == "stator_C"; });
  }
  const Calibration before = calibrate(motor_, logs_, {}, {});
  motor_.sensors = stated();
  const Calibration after = calibrate(motor_, logs_, {}, {});
  EXPECT_THAT(after.findings, testing::Contains(testing::VariantWith<HeldValue>(testing::VariantWith<SensorUnused>(testing::AllOf(
                                  testing::Field(&SensorUnused::sensor, "glued_on"), testing::Field(&SensorUnused::signal, "stator_C"))))));
  EXPECT_EQ(after.fit.theta, before.fit.theta);
}

/// Derivatives of displayed temperatures with respect to start temperatures and parameters, compared with differences.
TEST_F(StatedSensors, SlopesAreThoseOfWhatIsShown) {
  motor_.sensors = stated();
  estimation::MeasuredRunOptions how = how_to_read(motor_, HeatInput::current);
  how.needed = {thermal::Signal::current};
  const estimation::MeasuredRun run = estimation::measured_runs(logs_.front(), how).runs.front();
  const estimation::Model model = estimation::two_node_model(truth_, 1.0);
  std::vector<int> wanted;
  for (const estimation::FreeParameter& parameter : model.free) {
    wanted.push_back(parameter.place);
  }
  const auto at = [&](const std::vector<double>& values, const std::vector<double>& start_C) {
    return estimation::linearise(model.network, values, wanted, model.flux_nodes, start_C, run);
  };
  const std::vector<double> start_C{31.0, 27.0};
  const estimation::LinearisedRun here = at(model.values, start_C);
  const Eigen::Index stator = run.sensor_at("stator").value();
  EXPECT_NEAR(here.sensor_C(0, stator), 27.0 + kOffset_K, 1e-12);
  EXPECT_GT((here.sensor_C.col(stator).transpose() - here.state_C.row(1)).array().abs().maxCoeff(), kOffset_K + 0.3);
  const auto expect_slopes = [&](const estimation::Columns& columns, Eigen::Index column, const estimation::LinearisedRun& up,
                                 const estimation::LinearisedRun& down, double apart) {
    const Eigen::MatrixXd expected = (up.sensor_C - down.sensor_C) / apart;
    double worst = 0.0;
    for (Eigen::Index row = 0; row < columns.rows(); ++row) {
      worst = std::max(worst, std::abs(columns(row, column) - expected(row / here.sensors(), row % here.sensors())));
    }
    EXPECT_LT(worst, 1e-5 * columns.col(column).cwiseAbs().maxCoeff()) << column;
  };
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    std::vector<double> up = model.values, down = model.values;
    const auto place = static_cast<std::size_t>(wanted[i]);
    up[place] *= 1.0 + 1e-5;
    down[place] *= 1.0 - 1e-5;
    expect_slopes(here.by_parameter, static_cast<Eigen::Index>(i), at(up, start_C), at(down, start_C), up[place] - down[place]);
  }
  for (const Eigen::Index node : {0, 1}) {
    std::vector<double> up = start_C, down = start_C;
    up[static_cast<std::size_t>(node)] += 1e-3;
    down[static_cast<std::size_t>(node)] -= 1e-3;
    expect_slopes(here.by_start, node, at(model.values, up), at(model.values, down), 2e-3);
  }
  // The simulation starts at the stator temperature that the sensor's first sample implies, and displays the faulty sensor's value.
  EXPECT_NEAR(estimation::start_of(model.network, run).state_C[1], run.measured_C(0, stator) - kOffset_K, 1e-12);
  const Eigen::MatrixXd off_K = run.measured_C - estimation::open_loop_C(model.network, model.values, run);
  for (const double each_K : off_K.col(stator)) {
    EXPECT_FALSE(std::abs(each_K) > 0.3) << each_K;
  }
}

// A lag looks like a clock offset. A fault that the file states needs no note.
TEST_F(StatedSensors, LateAnswerThatIsStatedIsNoNews) {
  const recording::SyntheticLog late{.delay_s = 6.0};
  const auto file = folder_.path() / "late.csv";
  std::ofstream(file) << late.csv();
  const std::vector<recording::Recording> logs{read_log(file)};
  const auto is_late = testing::Contains(testing::VariantWith<SensorLags>(testing::_));
  EXPECT_THAT(admit(motor_, logs, {}, true, 22.0).notes, is_late);
  base::ParameterValue lag;
  lag.value = 6.0;
  motor_.sensors = {{"glued_on", motor::find_sensor_effect("sensor_lag_winding"), lag}};
  EXPECT_THAT(admit(motor_, logs, {}, true, 22.0).notes, testing::Not(is_late));
}

}  // namespace
}  // namespace heatsoak::calibration::study
