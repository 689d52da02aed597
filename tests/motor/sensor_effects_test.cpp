// Sensor faults: the values given beside each equation, and the derivatives that fits use.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "motor/sensor_effect.h"

namespace heatsoak::motor {
namespace {

Eigen::VectorXd vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::span<double> as_span(Eigen::VectorXd& values) { return {values.data(), static_cast<std::size_t>(values.size())}; }

class SensorEffects : public testing::TestWithParam<std::string_view> {};

TEST_P(SensorEffects, WorkedExampleComesOut) {
  const SensorEffectType& type = *find_sensor_effect(GetParam());
  Eigen::VectorXd shown = vector(type.example.true_C);
  type.law.apply(type.example.time_s, type.example.size, false, as_span(shown));
  for (Eigen::Index i = 0; i < shown.size(); ++i) {
    EXPECT_NEAR(shown[i], type.example.sensor_C[static_cast<std::size_t>(i)], 1e-9);
  }
  EXPECT_TRUE(type.size.range.contains(type.example.size));
  EXPECT_TRUE(type.size.range.contains(0.0)) << "a size of 0 is a faultless sensor";
}

std::vector<double> seconds() {
  std::vector<double> time_s;
  for (int k = 0; k < 200; ++k) {
    time_s.push_back(k + 0.3 * std::sin(k));
  }
  return time_s;
}

TEST_P(SensorEffects, NothingChangesAtSizeZero) {
  const SensorEffectType& type = *find_sensor_effect(GetParam());
  const std::vector<double> time_s = seconds();
  const Eigen::VectorXd true_C = vector(time_s).array().unaryExpr([](double t) { return 40.0 + 10.0 * std::sin(0.05 * t); });
  Eigen::VectorXd shown = true_C;
  type.law.apply(time_s, 0.0, false, as_span(shown));
  EXPECT_LT((shown - true_C).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_P(SensorEffects, DerivativeBySizeIsTheReadingsOwn) {
  const SensorEffectType& type = *find_sensor_effect(GetParam());
  const std::vector<double> time_s = seconds();
  Eigen::VectorXd true_C = vector(time_s).array().unaryExpr([](double t) { return 40.0 + 10.0 * std::sin(0.05 * t) + 0.02 * t; });
  const double size = type.typical_size;
  const double h = 1e-5 * size;
  Eigen::VectorXd above = true_C, below = true_C;
  type.law.apply(time_s, size + h, false, as_span(above));
  type.law.apply(time_s, size - h, false, as_span(below));
  const Eigen::VectorXd expected = (above - below) / (2.0 * h);
  EXPECT_LT((vector(type.law.by_size(time_s, size, as_span(true_C))) - expected).cwiseAbs().maxCoeff(),
            1e-6 * (1.0 + expected.cwiseAbs().maxCoeff()));
}

TEST_P(SensorEffects, ReadingIsLinearInTheTemperature) {
  const SensorEffectType& type = *find_sensor_effect(GetParam());
  const std::vector<double> time_s = seconds();
  const Eigen::VectorXd one_C = vector(time_s).array().unaryExpr([](double t) { return 40.0 + 10.0 * std::sin(0.05 * t); });
  const Eigen::VectorXd change_K = vector(time_s).array().unaryExpr([](double t) { return std::cos(0.2 * t); });
  Eigen::VectorXd shown = one_C, moved = one_C + change_K, shown_change = change_K;
  type.law.apply(time_s, type.typical_size, false, as_span(shown));
  type.law.apply(time_s, type.typical_size, false, as_span(moved));
  type.law.apply(time_s, type.typical_size, true, as_span(shown_change));
  EXPECT_LT((moved - shown - shown_change).cwiseAbs().maxCoeff(), 1e-9);
}

std::vector<std::string_view> all_names() {
  std::vector<std::string_view> names;
  for (const SensorEffectType& type : all_sensor_effects()) {
    names.push_back(type.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, SensorEffects, testing::ValuesIn(all_names()),
                         [](const auto& instance) { return std::string(instance.param); });

/// Several faults of one sensor act one after the other. Evaluation of a series and stepwise evaluation must agree.
TEST(SensorReading, GoesAsTheWholeSeriesDoes) {
  const std::vector<SensorFault> faults{{find_sensor_effect("sensor_lag_winding"), 6.0},
                                        {find_sensor_effect("sensor_gain_winding"), 0.04},
                                        {find_sensor_effect("sensor_offset_winding"), -2.0}};
  const std::vector<double> time_s = seconds();
  const Eigen::VectorXd true_C = vector(time_s).array().unaryExpr([](double t) { return 40.0 + 10.0 * std::sin(0.05 * t); });
  Eigen::VectorXd sensor_C = true_C;
  apply(faults, time_s, false, as_span(sensor_C));
  Reading reading(faults, true_C[0]);
  EXPECT_DOUBLE_EQ(reading.sensor_C(), true_C[0] + 0.04 * (true_C[0] - 25.0) - 2.0);
  for (Eigen::Index k = 1; k < true_C.size(); ++k) {
    const auto place = static_cast<std::size_t>(k);
    reading.advance(time_s[place] - time_s[place - 1], true_C[k]);
    EXPECT_NEAR(reading.sensor_C(), sensor_C[k], 1e-12);
  }
  EXPECT_GT((sensor_C - true_C).cwiseAbs().maxCoeff(), 3.0);
  // After zero elapsed time the sensor must not yet show a step of the temperature.
  const double before_C = reading.sensor_C();
  reading.advance(0.0, true_C[true_C.size() - 1]);
  EXPECT_DOUBLE_EQ(reading.sensor_C(), before_C);
}

TEST(SensorReading, AtSteadyStateInvertsTheFaults) {
  const std::vector<SensorFault> faults{{find_sensor_effect("sensor_gain_winding"), 0.1},
                                        {find_sensor_effect("sensor_offset_winding"), 3.0},
                                        {find_sensor_effect("sensor_lag_winding"), 40.0}};
  // By hand: 25 + 1.1·50 + 3 = 83 °C
  EXPECT_NEAR(sensor_at_rest_C(faults, 75.0), 83.0, 1e-12);
  EXPECT_NEAR(true_at_rest_C(faults, 83.0), 75.0, 1e-12);
  EXPECT_EQ(true_at_rest_C({}, 83.0), 83.0);
}

/// Reading of a sensor with lag, compared with a fine Euler integration of its differential equation.
TEST(SensorLag, FollowsItsDifferentialEquation) {
  const SensorEffectType& type = *find_sensor_effect("sensor_lag_winding");
  std::vector<double> time_s, true_C;
  for (int k = 0; k <= 60; ++k) {
    time_s.push_back(k);
    true_C.push_back(20.0 + (k > 10 ? 0.8 * (k - 10) : 0.0));
  }
  Eigen::VectorXd shown = vector(true_C);
  type.law.apply(time_s, 7.0, false, as_span(shown));
  double reading_C = 20.0;
  constexpr int kSteps = 20000;
  for (int k = 0; k < 60; ++k) {
    for (int i = 0; i < kSteps; ++i) {
      const double now_C = true_C[static_cast<std::size_t>(k)] +
                           (true_C[static_cast<std::size_t>(k) + 1] - true_C[static_cast<std::size_t>(k)]) * (i + 0.5) / kSteps;
      reading_C += (now_C - reading_C) / 7.0 / kSteps;
    }
    EXPECT_NEAR(shown[k + 1], reading_C, 1e-4);
  }
}

}  // namespace
}  // namespace heatsoak::motor
