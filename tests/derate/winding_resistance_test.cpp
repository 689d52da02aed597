// Winding temperature from voltage and current: accurate within the stated bounds, and absent if it cannot be determined.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "derate/sensed/sensor_plan.h"
#include "sensed_motor.h"

namespace heatsoak::derate {
namespace {

const SensorOptions kResistance{.kind = SensorKind::winding_resistance, .node = motor::states::winding, .accuracy_K = 10.0};

/// Uses the thermistor's plan with resistance readings, because this file tests only how the readings are made.
const CompiledGuard& guard() {
  static const CompiledGuard made(
      [] {
        Derating derating = thermistor_derating();
        derating.sensor->options = kResistance;
        derating.sensor->resistance = resistance_reading(ecx_32(), kResistance, derating.options.period_s);
        return derating;
      }(),
      "resistance");
  return made;
}

constexpr int kCalibrationReadings = 16;  ///< as the header states

/// A motor's terminals with all declared errors at once.
struct Terminals {
  double resistance_25C_ohm = 1.07;
  double torque_constant_Nm_per_A = 0.0328;
  double voltage_error_V = 0.0;
  double current_error_A = 0.0;
  double gain_ratio = 1.0;  ///< gain of the voltage sensor

  [[nodiscard]] double voltage_V(double current_A, double speed_rad_per_s, double winding_C) const {
    const double resistance_ohm = resistance_25C_ohm * (1.0 + 0.0039 * (winding_C - 25.0));
    return gain_ratio * (resistance_ohm * current_A + torque_constant_Nm_per_A * speed_rad_per_s) + voltage_error_V;
  }
};

class ResistanceSensor {
 public:
  ResistanceSensor() : sensor_(static_cast<std::size_t>(guard().function<int()>("resistance_size")())), sensed_(guard()) { start(30.0F); }

  void start(float body_C) {
    sensed_.start(body_C);
    guard().function<void(void*, float)>("resistance_start")(sensor_.data(), body_C);
  }
  /// Reads once more than a calibration takes, because a reading requires that the current has not just changed.
  float reading_C(const Terminals& terminals, double current_A, double speed_rad_per_s, double winding_C) {
    const CompiledGuard::Input in{static_cast<float>(current_A + terminals.current_error_A), static_cast<float>(speed_rad_per_s), 30.0F};
    const auto voltage_V = static_cast<float>(terminals.voltage_V(current_A, speed_rad_per_s, winding_C));
    for (int i = 0; i < kCalibrationReadings; ++i) {
      read(in, voltage_V);
    }
    return read(in, voltage_V);
  }
  float read(const CompiledGuard::Input& in, float voltage_V) {
    return guard().function<float(void*, const void*, const void*, float)>("resistance_reading_C")(sensor_.data(), sensed_.state().data(),
                                                                                                   &in, voltage_V);
  }
  /// Advances the guard's own state under load.
  void work(int steps) {
    for (int i = 0; i < steps; ++i) {
      sensed_.step({5.0F, 0.0F, 30.0F}, std::nanf(""));
    }
  }

 private:
  std::vector<unsigned char> sensor_;
  SensedGuard sensed_;
};

TEST(WindingResistance, ExactTerminalsShowTheTemperature) {
  ResistanceSensor sensor;
  const Terminals exact;
  EXPECT_NEAR(sensor.reading_C(exact, 6.0, 0.0, 30.0), 30.0, 0.1);
  for (const double winding_C : {40.0, 90.0, 150.0}) {
    EXPECT_NEAR(sensor.reading_C(exact, 6.0, 0.0, winding_C), winding_C, 0.1);
    EXPECT_NEAR(sensor.reading_C(exact, -6.0, 0.0, winding_C), winding_C, 0.1);
    EXPECT_NEAR(sensor.reading_C(exact, 6.0, 5.0, winding_C), winding_C, 0.2);
  }
}

// Random motors with random errors within the declared ranges: every given temperature is within the stated accuracy.
TEST(WindingResistance, StaysWithinItsAccuracyForDrawnMotorsAndErrors) {
  std::mt19937_64 engine(12);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int shown = 0;
  for (int i = 0; i < 100'000; ++i) {
    base::Random random(7, static_cast<std::uint64_t>(i % 500));
    const motor::MotorSample sample = motor::draw_sample(ecx_32(), random);
    const Terminals terminals{.resistance_25C_ohm = sample.values.terminal_resistance_ohm,
                              .torque_constant_Nm_per_A = sample.values.torque_constant_Nm_per_A * (0.95 + 0.05 * uniform(engine)),
                              .voltage_error_V = 0.02 * uniform(engine),
                              .current_error_A = 0.01 * uniform(engine),
                              .gain_ratio = 1.0 + 0.05 * uniform(engine)};
    ResistanceSensor sensor;
    if (std::isnan(sensor.reading_C(terminals, 3.0 + 2.0 * uniform(engine), 0.0, 30.0))) {
      continue;
    }
    const double winding_C = 90.0 + 60.0 * uniform(engine);
    const float reading_C = sensor.reading_C(terminals, 8.0 * uniform(engine), 10.0 * uniform(engine), winding_C);
    if (!std::isnan(reading_C)) {
      ++shown;
      ASSERT_NEAR(reading_C, winding_C, kResistance.accuracy_K) << i;
    }
  }
  EXPECT_GT(shown, 10'000);
}

TEST(WindingResistance, ShowsNothingWhereItCannotBeRead) {
  ResistanceSensor sensor;
  const Terminals exact;
  EXPECT_FALSE(std::isnan(sensor.reading_C(exact, 6.0, 0.0, 30.0)));
  EXPECT_TRUE(std::isnan(sensor.reading_C(exact, 0.5, 0.0, 80.0))) << "too little current";
  EXPECT_TRUE(std::isnan(sensor.reading_C(exact, 0.0, 0.0, 80.0)));
  EXPECT_TRUE(std::isnan(sensor.reading_C(exact, 6.0, 300.0, 80.0))) << "too fast";
  EXPECT_TRUE(std::isnan(sensor.reading_C(exact, std::nan(""), 0.0, 80.0)));
}

TEST(WindingResistance, AMotorThatHasWorkedDoesNotCalibrate) {
  ResistanceSensor sensor;
  sensor.work(500);
  EXPECT_TRUE(std::isnan(sensor.reading_C(Terminals{}, 6.0, 0.0, 60.0)));
}

// A reading that cannot be used must not spoil the mean, and fewer readings than stated give no temperature.
TEST(WindingResistance, CalibratesWithTheStatedNumberOfUsableReadings) {
  ResistanceSensor sensor;
  const CompiledGuard::Input in{6.0F, 0.0F, 30.0F};
  const auto voltage_V = static_cast<float>(Terminals{}.voltage_V(6.0, 0.0, 30.0));
  sensor.read(in, voltage_V);  // the current has just changed
  for (int i = 1; i < kCalibrationReadings; ++i) {
    EXPECT_TRUE(std::isnan(sensor.read(in, voltage_V))) << i;
    for (const float broken_V : {std::nanf(""), -voltage_V, std::numeric_limits<float>::infinity()}) {
      EXPECT_TRUE(std::isnan(sensor.read(in, broken_V))) << i;
    }
  }
  EXPECT_NEAR(sensor.read(in, voltage_V), 30.0, 0.1);
}

TEST(WindingResistance, NoiseOfTheVoltageCountsWithAQuarterOfItsRms) {
  constexpr double kNoise_V = 0.1;
  constexpr int kStarts = 400;
  std::mt19937_64 engine(3);
  std::normal_distribution<double> noise_V(0.0, kNoise_V);
  const Terminals exact;
  const double rest_V = exact.voltage_V(6.0, 0.0, 30.0);
  double squares_K2 = 0.0;
  for (int start = 0; start < kStarts; ++start) {
    ResistanceSensor sensor;
    const CompiledGuard::Input in{6.0F, 0.0F, 30.0F};
    for (int i = 0; i <= kCalibrationReadings; ++i) {
      sensor.read(in, static_cast<float>(rest_V + noise_V(engine)));
    }
    const double error_K = sensor.read(in, static_cast<float>(rest_V)) - 30.0;
    squares_K2 += error_K * error_K;
  }
  const double one_reading_K = kNoise_V / rest_V * (1.0 + 0.0039 * 5.0) / 0.0039;
  EXPECT_NEAR(std::sqrt(squares_K2 / kStarts), 0.25 * one_reading_K, 0.15 * 0.25 * one_reading_K);
  EXPECT_LT(0.25 * one_reading_K, 1.05) << "docs/sensors.md states 1.0 K";
}

TEST(WindingResistance, HelpsAtRestAndIsTheGuardWithoutASensorAtSpeed) {
  const Derating& derating = resistance_derating();
  const SensorPlan& plan = *derating.sensor;
  EXPECT_LT(plan.observer.heat_safety_factor(), derating.observer.heat_safety_factor());
  EXPECT_GT(plan.lasting.front().with_A, 1.05 * plan.lasting.front().without_A);
  EXPECT_NEAR(plan.lasting.back().with_A, plan.lasting.back().without_A, 0.05 * plan.lasting.back().without_A);
  EXPECT_LE(plan.guarantee.over, most_over(derating.options.guarantee));
}

}  // namespace
}  // namespace heatsoak::derate
