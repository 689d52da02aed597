// Reads every exported file with a parser of its format and uses it like its consumer.
#include <expat.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "base/diagnostic.h"
#include "base/version.h"
#include "derate/export_text.h"
#include "exported_motor.h"
#include "support/skip_reasons.h"
#include "thermal/transient.h"
#include "unpacked.h"

namespace heatsoak::derate {
namespace {

using testing::HasSubstr;

std::string refusal(std::string_view name, const Derating& derating) {
  try {
    static_cast<void>(exported(name, derating));
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    return failure.what();
  }
  return "accepted";
}

/// Returns "name value" of every line that is no comment.
std::map<std::string, std::string> lines_of(const std::string& text, const std::string& pattern) {
  std::map<std::string, std::string> values;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    line = line.substr(0, line.find('#'));
    if (!line.empty()) {
      EXPECT_TRUE(std::regex_match(line, found, std::regex(pattern))) << line;
      values[found[1]] = found[2];
    }
  }
  return values;
}

class EveryExporter : public testing::TestWithParam<const char*> {};

TEST_P(EveryExporter, SaysWhereItComesFromAndHowSureItIs) {
  const std::string text = readable(exported(GetParam()));
  EXPECT_EQ(exported(GetParam()), exported(GetParam()));
  EXPECT_THAT(text, HasSubstr(fmt::format("heatsoak {}", base::program_version())));
  EXPECT_THAT(text, HasSubstr(ecx_derating().provenance.input_hash));
  EXPECT_THAT(text, HasSubstr("155"));
  EXPECT_THAT(text, HasSubstr("0.95"));
  EXPECT_EQ(text.find("nan"), std::string::npos);
}

TEST_P(EveryExporter, RefusesWhatIsNoNumber) {
  Derating broken = ecx_derating();
  broken.table.square_A2[7] = std::nan("");
  EXPECT_THAT(refusal(GetParam(), broken), HasSubstr("is not a number"));
}

INSTANTIATE_TEST_SUITE_P(All, EveryExporter,
                         testing::Values("c_header", "c_header_q15", "json", "csv", "moteus", "odrive", "vesc", "simplefoc", "mujoco",
                                         "fmi2_motor", "fmi2_guard", "fmi3_motor", "fmi3_guard"));

TEST(Exporters, ConfidenceIsABoundThatTheDrawsShow) {
  const Guarantee& checked = ecx_derating().guarantee;
  EXPECT_GE(checked.least_kept_share, 0.95);
  // Definition: if the share were lower, so few exceedances would have a probability below 5 %.
  const double p = 1.0 - checked.least_kept_share;
  double chance = 0.0;
  for (int k = 0; k <= checked.over; ++k) {
    chance += std::exp(std::lgamma(checked.samples + 1.0) - std::lgamma(k + 1.0) - std::lgamma(checked.samples - k + 1.0) +
                       k * std::log(p) + (checked.samples - k) * std::log1p(-p));
  }
  EXPECT_NEAR(chance, 1.0 - kCertainty_share, 1e-6);
  const nlohmann::json guarantee = nlohmann::json::parse(exported("json"))["guarantee"];
  EXPECT_EQ(guarantee["certainty"], kCertainty_share);
  EXPECT_EQ(guarantee["least_samples"], 59);
  EXPECT_NEAR(guarantee["least_kept_share"].get<double>(), checked.least_kept_share, 1e-4);
  EXPECT_THAT(exported("csv"), HasSubstr("# Safety factor on heat"));
}

TEST(Exporters, InputHashFollowsTheOptions) {
  DerateOptions other;
  other.hottest_ambient_C = 41.0;
  EXPECT_NE(provenance_of(ecx_32(), twente(), other).input_hash, ecx_derating().provenance.input_hash);
}

TEST(JsonExporter, TableAndObserverAreThoseOfTheDerating) {
  const nlohmann::json file = nlohmann::json::parse(exported("json"));
  EXPECT_EQ(file["schema"], "heatsoak.derating/1");
  const nlohmann::json& table = file["table"];
  const CurrentTable& real = ecx_derating().table;
  ASSERT_EQ(table["current_squared_A2"].size(), real.square_A2.size());
  ASSERT_EQ(table["current_A"].size(), real.square_A2.size());
  for (std::size_t i = 0; i < real.square_A2.size(); ++i) {
    EXPECT_LE(table["current_squared_A2"][i].get<double>(), real.square_A2[i]);
    EXPECT_NEAR(table["current_squared_A2"][i].get<double>(), real.square_A2[i], 1.01e-4);
    EXPECT_LE(table["current_A"][i].get<double>(), real.current_of_A(real.square_A2[i]));
    EXPECT_NEAR(table["current_A"][i].get<double>(), real.current_of_A(real.square_A2[i]), 1.01e-4);
  }
  const nlohmann::json& closed = file["observer"];
  const auto value = [&](const char* key) { return closed[key].get<double>(); };
  const double ratio = value("heat_reserve_ratio_r");
  constexpr double kWinding_C = 110.0;
  constexpr double kCurrent_A = 3.0;
  constexpr double kSpeed_rad_per_s = 200.0;
  ObserverRun<double> run(ecx_derating().observer, 1.0, kWinding_C);
  run.step(std::array<double, observed::kSignalCount>{kCurrent_A, kSpeed_rad_per_s, 40.0, 0.0, 40.0, 0.0, 0.0});
  const double copper_W = value("terminal_resistance_25C_ohm") * (1.0 + value("temperature_coefficient_per_K") * (kWinding_C - 25.0)) *
                          std::pow(value("heating_current_ratio_k") * kCurrent_A, 2.0);
  EXPECT_NEAR(run.state_C()[0], kWinding_C + ratio * copper_W / value("heat_capacity_winding_J_per_K"), 1e-6);
  const double drag_W = value("torque_constant_Nm_per_A") * value("no_load_current_A") * kSpeed_rad_per_s;
  EXPECT_NEAR(run.state_C()[1],
              kWinding_C + (ratio * drag_W - (kWinding_C - 40.0) / value("thermal_resistance_stator_ambient_K_per_W")) /
                               value("heat_capacity_stator_J_per_K"),
              1e-6);
}

constexpr const char* kChassis = R"([effects.chassis]
type = "third_node"
heat_capacity = { value = "60 J/K", origin = "estimated", derivation = "a test" }
conductance = { value = "0.3 W/K", origin = "estimated", derivation = "a test" }
leak_ratio = { value = "0.2", origin = "estimated", derivation = "a test" }
)";
constexpr const char* kAirflow = R"([effects.wind]
type = "vehicle_airflow"
conductance = { value = "0.05 W/K", origin = "estimated", derivation = "a test" }
exponent = { value = "0.8", origin = "estimated", derivation = "a test" }
)";

TEST(Exporters, RefuseByNameWhatTheyCannotExpress) {
  const Derating chassis = derating_of(ecx_32_with(kChassis));
  EXPECT_TRUE(nlohmann::json::parse(exported("json", chassis))["observer"].is_null());
  EXPECT_THAT(refusal("mujoco", chassis), HasSubstr("mujoco cannot express chassis (third_node)"));
  EXPECT_EQ(refusal("moteus", chassis), "accepted") << "the stator's sensor sees what the chassis does";
  EXPECT_EQ(refusal("vesc", chassis), "accepted");
  const Derating wind = derating_of(ecx_32_with(kAirflow));
  for (const char* name : {"vesc", "simplefoc"}) {
    EXPECT_THAT(refusal(name, wind), HasSubstr("wind (vehicle_airflow)")) << name;
    EXPECT_THAT(refusal(name, wind), HasSubstr("vehicle_speed_m_per_s")) << name;
  }
  const Derating soaked = derating_of(ecx_32_with(std::string(kChassis) + "node = \"winding\"\n"));
  for (const char* name : {"moteus", "odrive"}) {
    EXPECT_THAT(refusal(name, soaked), HasSubstr("cannot express chassis")) << name;
  }
  Derating brushed = ecx_derating();
  brushed.is_brushless = false;
  for (const char* name : {"moteus", "odrive", "simplefoc"}) {
    EXPECT_THAT(refusal(name, brushed), HasSubstr("brushed")) << name;
  }
}

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

/// Returns the attributes of an element.
std::map<std::string, std::string> attributes_of(const std::string& xml, const std::string& element) {
  struct Search {
    std::string element;
    std::map<std::string, std::string> found;
  } search{element, {}};
  const XML_Parser parser = XML_ParserCreate(nullptr);
  XML_SetUserData(parser, &search);
  XML_SetStartElementHandler(parser, [](void* user, const XML_Char* name, const XML_Char** attributes) {
    auto& looking = *static_cast<Search*>(user);
    for (int i = 0; looking.element == name && attributes[i] != nullptr; i += 2) {
      looking.found[attributes[i]] = attributes[i + 1];
    }
  });
  EXPECT_EQ(XML_Parse(parser, xml.data(), static_cast<int>(xml.size()), 1), XML_STATUS_OK) << XML_ErrorString(XML_GetErrorCode(parser));
  XML_ParserFree(parser);
  return search.found;
}

/// MuJoCo, src/engine/engine_forward.c: dT/dt = (R·i² − T/R_th)/C with T above ambient; doc/XMLreference.rst: order of the attributes.
TEST(MujocoExporter, HeldCurrentAtStandstillReachesTheObserversTemperature) {
  const auto motor = attributes_of(exported("mujoco"), "dcmotor");
  double resistance_K_per_W = 0.0, capacity_J_per_K = 0.0, constant_s = -1.0, coefficient_per_K = 0.0, reference_C = 0.0, ambient_C = 0.0;
  std::istringstream(motor.at("thermal")) >> resistance_K_per_W >> capacity_J_per_K >> constant_s >> coefficient_per_K >> reference_C >>
      ambient_C;
  EXPECT_EQ(constant_s, 0.0);
  EXPECT_EQ(ambient_C, 40.0);
  EXPECT_NEAR(std::stod(motor.at("motorconst")), ecx_derating().torque_constant_Nm_per_A, 1e-9);
  constexpr double kHeld_A = 2.0;
  double rise_K = 0.0;
  ObserverRun<double> observer(ecx_derating().observer, 0.01, 40.0);
  for (int i = 0; i < 200'000; ++i) {
    const double hot_ohm = std::stod(motor.at("resistance")) * (1.0 + coefficient_per_K * (rise_K + ambient_C - reference_C));
    rise_K += 0.01 * (hot_ohm * kHeld_A * kHeld_A - rise_K / resistance_K_per_W) / capacity_J_per_K;
    observer.step(std::array<double, observed::kSignalCount>{kHeld_A, 0.0, 40.0, 0.0, 40.0, 0.0, 0.0});
    ASSERT_GE(rise_K + 40.0, observer.state_C()[0] - 1e-6) << "while it warms up it is never colder";
  }
  EXPECT_NEAR(rise_K + 40.0, observer.state_C()[0], 0.05);
}

}  // namespace
}  // namespace heatsoak::derate
