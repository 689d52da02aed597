// Exporters for motor controllers: moteus, ODrive and SimpleFOC. VESC has a file of its own.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>

#include "exported_motor.h"
#include "exported_text.h"
#include "support/skip_reasons.h"
#include "thermal/transient.h"

namespace heatsoak::derate {
namespace {

/// Current limit of a controller in A (i_q) as a function of its sensor temperature.
using Limit = std::function<double(double)>;

/// moteus, fw/bldc_servo_control.h: derate_fraction, derate_current_A, effective_max_current_A, and a fault above the fault temperature.
Limit moteus_limit() {
  const auto values = lines_of(exported("moteus"), R"(^(servo\.[a-zA-Z_.]+) ([-0-9.]+)$)");
  const auto value = [values](const char* key) { return std::stod(values.at(key)); };
  EXPECT_EQ(values.at("servo.enable_motor_temperature"), "1");
  return [=](double sensor_C) {
    const double fault_C = value("servo.motor_fault_temperature");
    const double margin_K = value("servo.motor_temperature_margin");
    const double most_A = value("servo.max_current_A");
    const double fraction = std::max((sensor_C - (fault_C - margin_K)) / margin_K, 0.0);
    const double limit_A = std::min(most_A, std::max(0.0, fraction * (value("servo.derate_current_A") - most_A) + most_A));
    return sensor_C > fault_C ? 0.0 : limit_A;
  };
}

/// ODrive, Firmware/MotorControl/thermistor.cpp: get_current_limit(), do_checks().
Limit odrive_limit() {
  std::string text = exported("odrive");
  EXPECT_THAT(text, HasSubstr("\naxis = odrv0.axis0\n"));
  EXPECT_THAT(text, HasSubstr("\nodrv0.save_configuration()\n"));
  // A firmware without the thermistor's settings stops there, with its former current.
  EXPECT_GT(text.find("current_lim"), text.find("enabled = True"));
  text = std::regex_replace(text, std::regex("axis = odrv0.axis0\n|odrv0.save_configuration\\(\\)\n"), "");
  const auto values = lines_of(text, R"(^axis\.motor\.([a-z_.]+) = ([-0-9.A-Za-z]+)$)");
  EXPECT_EQ(values.at("motor_thermistor.config.enabled"), "True");
  const double lower_C = std::stod(values.at("motor_thermistor.config.temp_limit_lower"));
  const double upper_C = std::stod(values.at("motor_thermistor.config.temp_limit_upper"));
  const double most_A = std::stod(values.at("config.current_lim"));
  return [=](double sensor_C) { return std::min(most_A, std::max(0.0, most_A * (upper_C - sensor_C) / (upper_C - lower_C))); };
}

/// Returns the hottest winding temperature in the hottest air: the controller's full current alternates with none, at changing speeds.
double hottest_C(const thermal::Network& network, const Limit& limit, unsigned seed) {
  RandomLoad driver(seed);
  std::vector<double> state_C(2, 40.0);
  double hottest_C = 0.0;
  constexpr double kStep_s = 0.5;
  for (int i = 0; i < 3000; ++i) {
    const RandomLoad::Wish wish = driver.after(kStep_s);
    thermal::OperatingPoint<double> at;
    at.current_rms_A = kDcPerIq_ratio * std::abs(wish.current_share) * limit(state_C[motor::states::stator]);
    at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = wish.speed_share * ecx_derating().rules.most_speed_rad_per_s;
    at.ambient_C = 40.0;
    thermal::TransientOptions options;
    options.start_C = state_C;
    const thermal::TransientResult result =
        thermal::run_transient(network, network.values(), std::vector<thermal::Interval>{{kStep_s, at}}, options);
    state_C = result.end_C;
    hottest_C = std::max(hottest_C, result.peak_C[motor::states::winding]);
  }
  return hottest_C;
}

TEST(RampExporters, ControllerStaysBelowTheTableAndKeepsTheWindingBelowItsLimit) {
  const motor::Motor motor = ecx_32();
  for (const Limit& limit : {moteus_limit(), odrive_limit()}) {
    double sum_A = 0.0;
    for (double sensor_C = 20.0; sensor_C < 170.0; sensor_C += 0.5) {
      EXPECT_LE(kDcPerIq_ratio * limit(sensor_C), ramp_bound_A(ecx_derating(), RampSignal::stator, sensor_C) + 1e-9) << sensor_C;
      sum_A += limit(sensor_C);
    }
    EXPECT_GT(sum_A, 0.0);
    const thermal::Network nominal = motor::datasheet_network(motor, motor::nominal_sample(motor));
    for (unsigned seed = 0; seed < 3; ++seed) {
      EXPECT_LT(hottest_C(nominal, limit, seed), 155.0);
    }
    const motor::Motor spread = motor::with_default_spreads(motor);
    int over = 0;
    for (unsigned i = 0; i < 40; ++i) {
      base::Random random(99, i);
      over += hottest_C(motor::datasheet_network(spread, motor::draw_sample(spread, random)), limit, i) > 155.0 ? 1 : 0;
    }
    // Five in a hundred of 40 are two. Seven or more have a probability of 1/200.
    EXPECT_LE(over, 6);
  }
}

/// Minimal stub of SimpleFOC with the members that the snippet uses.
constexpr const char* kSimpleFoc = R"(#pragma once
#include <math.h>
struct CurrentSense {};
enum class TorqueControlType { voltage, dc_current, foc_current, estimated_current };
struct DQCurrent_s { float d, q; };
struct FOCMotor {
  CurrentSense *current_sense = nullptr;
  TorqueControlType torque_controller = TorqueControlType::foc_current;
  DQCurrent_s current{0.0f, 0.0f};
  float shaft_velocity = 0.0f, current_limit = 0.0f;
  bool is_enabled = true;
  void disable() { is_enabled = false; }
  void updateCurrentLimit(float limit) { current_limit = limit; }
};
)";
constexpr const char* kSketch = R"(#include "limit.h"
#include <stdio.h>
#include <string.h>
int main() {
  FOCMotor motor;
  CurrentSense sense;
  maxon_ecx_flat_32l_48v_state guard;
  memset(&guard, 0, sizeof guard);
  maxon_ecx_flat_32l_48v_start(&guard, 40.0f);
  maxon_ecx_flat_32l_48v_limit(motor, guard, 40.0f);
  printf("%d %.9g\n", (int)motor.is_enabled, motor.current_limit);
  motor.current_sense = &sense;
  const TorqueControlType modes[] = {TorqueControlType::voltage, TorqueControlType::estimated_current, TorqueControlType::dc_current,
                                     TorqueControlType::foc_current};
  for (const TorqueControlType mode : modes) {
    motor.is_enabled = true;
    motor.torque_controller = mode;
    maxon_ecx_flat_32l_48v_limit(motor, guard, 40.0f);
    printf("%d %d\n", (int)motor.is_enabled, (int)(motor.current_limit > 0.0f));
  }
  for (int i = 0; i < 60000; ++i) {
    motor.shaft_velocity = -100.0f;
    motor.current.q = -motor.current_limit;
    const maxon_ecx_flat_32l_48v_output out = maxon_ecx_flat_32l_48v_limit(motor, guard, 40.0f);
    if (out.guarded_winding_C > 155.1f) return 1;
  }
  printf("%d %.9g\n", (int)motor.is_enabled, motor.current_limit);
}
)";

class SimpleFocExporter : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("c++ --version > /dev/null 2>&1") != 0) {
      GTEST_SKIP() << HEATSOAK_FAILS_CI "no compiler here";
    }
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "limit.h") << exported("simplefoc");
    std::ofstream(folder / "maxon_ecx_flat_32l_48v_guard.h") << exported("c_header");
    std::ofstream(folder / "sketch.cpp") << kSketch;
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  /// Compiles the sketch for this version of the library and runs it. Returns the exit code.
  [[nodiscard]] int run(const std::string& library) const {
    std::ofstream(folder / "SimpleFOC.h") << library;
    return std::system(
        fmt::format("cd {} && c++ -std=c++11 -Wall -Wextra -Werror -O1 -I. sketch.cpp -o sketch 2> errors.txt && ./sketch > out.txt",
                    folder.string())
            .c_str());
  }
  [[nodiscard]] std::string errors() const {
    std::stringstream text;
    text << std::ifstream(folder / "errors.txt").rdbuf();
    return text.str();
  }

  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_simplefoc_{}", getpid());
};

// v2.3.5 has neither updateCurrentLimit nor estimated_current.
TEST_F(SimpleFocExporter, SaysWhichVersionItNeedsWhereTheLibraryIsOlder) {
  std::string old = std::regex_replace(std::string(kSimpleFoc), std::regex(", estimated_current"), "");
  old = std::regex_replace(old, std::regex("  void updateCurrentLimit[^\n]*\n"), "");
  EXPECT_NE(run(old), 0);
  EXPECT_THAT(errors().substr(0, errors().find("has no member")), HasSubstr("needs SimpleFOC 2.4.0 or later"));
  EXPECT_THAT(exported("simplefoc"), HasSubstr("Needs SimpleFOC 2.4.0 or later"));
}

TEST_F(SimpleFocExporter, CompilesBesideTheHeaderAndLimitsTheMotor) {
  ASSERT_EQ(run(kSimpleFoc), 0) << errors();
  std::ifstream out(folder / "out.txt");
  int is_enabled = -1;
  double limit_A = NAN;
  out >> is_enabled >> limit_A;
  EXPECT_EQ(is_enabled, 0) << "without a current sense";
  EXPECT_EQ(limit_A, 0.0);
  for (const int measures : {0, 0, 1, 1}) {
    int is_limited = -1;
    out >> is_enabled >> is_limited;
    EXPECT_EQ(is_enabled, measures) << "voltage, estimated_current, dc_current, foc_current";
    EXPECT_EQ(is_limited, measures);
  }
  out >> is_enabled >> limit_A;
  EXPECT_EQ(is_enabled, 1);
  // After ten minutes at the limit the current is near the permanent one.
  EXPECT_NEAR(limit_A, 2.46 / kDcPerIq_ratio, 0.1);
}

}  // namespace
}  // namespace heatsoak::derate
