// Runs the exported VESC script and the law by which the controller limits its current.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <regex>
#include <sstream>

#include "derate/export_text.h"
#include "exported_motor.h"
#include "small_lisp.h"
#include "support/skip_reasons.h"

namespace heatsoak::derate {
namespace {

using testing::HasSubstr;

/// Current limit of the controller in A (i_q) as a function of its motor temperature.
using VescLimit = std::function<double(double)>;

/// VESC, datatypes.h, mc_motor_type.
constexpr float kVescBldc = 0.0F;
constexpr float kVescDc = 1.0F;
constexpr float kVescFoc = 2.0F;

// Block commutation measures the DC current, which is 10 % larger than the script takes it to be.
TEST(VescExporter, OtherMotorTypesGetNoCurrent) {
  for (const bool is_brushless : {true, false}) {
    Derating derating = ecx_derating();
    derating.is_brushless = is_brushless;
    for (const float type : {kVescBldc, kVescDc, kVescFoc}) {
      SmallLisp script;
      script.settings = {{"'si-motor-poles", 14.0F}, {"'motor-type", type}};
      script.extensions = {{"systime", [](const auto&) { return 0.0F; }}};
      script.load(exported("vesc", derating));
      const bool may_drive = type == (is_brushless ? kVescFoc : kVescDc);
      EXPECT_EQ(script.settings.at("'l-current-max") > 0.0F, may_drive) << is_brushless << " " << type;
      EXPECT_EQ(script.settings.at("'l-current-min"), -script.settings.at("'l-current-max"));
    }
  }
}

TEST(VescExporter, NamesTheQuantitiesOfTheLaw) {
  const std::string text = exported("vesc");
  for (const char* const name : {"hs-copper-loss-W", "hs-winding-to-stator-W", "hs-stator-to-ambient-W", "hs-winding-rate-K-per-s"}) {
    EXPECT_THAT(text, HasSubstr(fmt::format("(var {} ", name)));
  }
  for (const char* const number : {"terminal_resistance 1.07 ohm", "thermal_resistance 3.8 K/W", "winding 3.15789 J/K"}) {
    EXPECT_THAT(text, HasSubstr(number));
  }
}

TEST(VescExporter, StatesTheSettingsOutOfItsReach) {
  EXPECT_THAT(exported("vesc"), testing::AllOf(HasSubstr("motor type FOC"), HasSubstr("the controller never limits below it"),
                                               HasSubstr("default of 0.05 A or less"), HasSubstr("foc_temp_comp: off")));
}

// LispBM's own interpreter is not part of the project. HEATSOAK_LISPBM_REPL names its program `repl`; tests/derate/consumers/run builds it.
TEST(VescExporter, RealInterpreterComputesTheObserver) {
  const char* const repl = std::getenv("HEATSOAK_LISPBM_REPL");
  if (repl == nullptr) {
    GTEST_SKIP() << HEATSOAK_LACKS_CONSUMER("lispbm") "HEATSOAK_LISPBM_REPL is not set";
  }
  constexpr int kCycles = 1000;
  // The controller's functions cannot be redefined, so the script gets its own.
  std::string script = std::regex_replace(
      exported("vesc"), std::regex("\\((conf-get|conf-set|get-current|get-rpm|override-temp-motor|secs-since|sleep)\\b"), "(of-test-$1");
  script = std::regex_replace(script, std::regex("\\(loopwhile t"), fmt::format("(looprange cycle 0 {}", kCycles));
  const std::filesystem::path stem =
      std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_lispbm_{}", static_cast<int>(getpid()));
  std::ofstream(stem.string() + ".lisp") << R"((define of-test-sent 0.0)
(defun of-test-conf-get (name) (if (eq name 'si-motor-poles) 14 2))
(defun of-test-conf-set (name value) t)
(defun of-test-get-current () 2.0)
(defun of-test-get-rpm () 7000.0)
(defun of-test-secs-since (time) 0.01)
(defun of-test-sleep (time) t)
(defun of-test-override-temp-motor (temperature-C) (setq of-test-sent temperature-C))
)" << script << "(print (list 'sent of-test-sent))\n";
  EXPECT_EQ(std::system(fmt::format("'{0}' --terminate --silent -s '{1}.lisp' > '{1}.out'", repl, stem.string()).c_str()), 0);
  std::stringstream out;
  out << std::ifstream(stem.string() + ".out").rdbuf();
  std::smatch sent;
  const std::string text = out.str();
  ASSERT_TRUE(std::regex_search(text, sent, std::regex("\\(sent ([0-9.]+)"))) << text;
  ObserverRun<float> observer(ecx_derating().observer, 0.01F, 155.0F);
  const auto current_A = static_cast<float>(2.0 * kDcPerIq_ratio);
  const auto speed_rad_per_s = static_cast<float>(7000.0 * std::numbers::pi / 30.0 / 7.0);
  for (int i = 0; i < kCycles; ++i) {
    observer.step(std::array<float, observed::kSignalCount>{current_A, speed_rad_per_s, 40.0F, 0.0F, 40.0F, 0.0F, 0.0F});
  }
  EXPECT_NEAR(std::stod(sent[1]), observer.state_C()[0], 0.01);
  std::filesystem::remove(stem.string() + ".lisp");
  std::filesystem::remove(stem.string() + ".out");
}

// The script integrates a pause of its thread in short steps; one Euler step of 24 s would cool the winding to 0 °C.
TEST(VescExporter, ScriptThatWasHeldUpIntegratesThePause) {
  SmallLisp script;
  float override_C = NAN;
  script.settings["'si-motor-poles"] = 14.0F;
  script.settings["'motor-type"] = kVescFoc;
  script.extensions = {
      {"systime", [](const auto&) { return 0.0F; }}, {"secs-since", [](const auto&) { return 24.0F; }},
      {"sleep", [](const auto&) { return 0.0F; }},   {"get-current", [](const auto&) { return 0.0F; }},
      {"get-rpm", [](const auto&) { return 0.0F; }}, {"override-temp-motor", [&](const auto& with) { return override_C = with.at(0); }}};
  script.load(exported("vesc"));
  script.set("hs-winding-C", 120.0F);
  script.set("hs-stator-C", 120.0F);
  ObserverRun<float> observer(ecx_derating().observer, 0.01F, 120.0F);
  for (int i = 0; i < 2400; ++i) {
    observer.step(std::array<float, observed::kSignalCount>{0.0F, 0.0F, 40.0F, 0.0F, 40.0F, 0.0F, 0.0F});
  }
  script.cycle();
  EXPECT_NEAR(override_C, observer.state_C()[0], 1.0);
}

/// MCCONF_CC_MIN_CURRENT: the controller never limits below it.
constexpr double kVescLeastLimit_A = 0.05;

/// Current limit of a driving VESC in A (i_q): motor/mc_interface.c, update_override_limits(), lo_max_mot and lo_motor_temp_accel, with the
/// default of motor/mcconf_default.h for a setting that the script does not set.
VescLimit vesc_limit(const std::map<std::string, float>& settings, double least_A = 0.0) {
  const auto value = [settings](const char* key) { return static_cast<double>(settings.at(key)); };
  const double share = settings.contains("'l-temp-accel-dec") ? value("'l-temp-accel-dec") : 0.15;
  return [=](double sensor_C) {
    const double most_A = value("'l-current-max") * value("'l-current-max-scale");
    double limit_A = most_A;
    for (const double moved : {0.0, share}) {
      const double start_C = value("'l-temp-motor-start") + moved * (25.0 - value("'l-temp-motor-start"));
      const double end_C = value("'l-temp-motor-end") + moved * (25.0 - value("'l-temp-motor-end"));
      const double ramp_A = sensor_C < start_C + 0.1 ? most_A
                            : sensor_C > end_C - 0.1 ? 0.0
                                                     : most_A * (end_C - sensor_C) / (end_C - start_C);
      limit_A = std::min(limit_A, ramp_A);
    }
    // Above the end of the ramp the controller stops with a fault.
    return sensor_C > value("'l-temp-motor-end") - 0.1 ? 0.0 : std::max(limit_A, least_A);
  };
}

/// Mean of a current in A over the temperatures from 40 to 155 degC.
double mean_A(const VescLimit& limit) {
  double sum_A = 0.0;
  for (int i = 0; i < 1150; ++i) {
    sum_A += limit(40.05 + 0.1 * i);
  }
  return sum_A / 1150.0;
}

TEST(VescExporter, LosesWhatTheFileStates) {
  const std::string text = exported("vesc");
  SmallLisp script;
  script.settings["'si-motor-poles"] = 14.0F;
  script.settings["'motor-type"] = kVescFoc;
  script.extensions = {{"systime", [](const auto&) { return 0.0F; }}};
  script.load(text);
  const double bound_A =
      mean_A([](double winding_C) { return ramp_bound_A(ecx_derating(), RampSignal::winding, winding_C); }) / kDcPerIq_ratio;
  const auto stated = [&](const char* pattern) {
    std::smatch found;
    EXPECT_TRUE(std::regex_search(text, found, std::regex(pattern))) << pattern;
    return found.empty() ? NAN : std::stod(found[1]);
  };
  const auto lost_percent = [&](const std::map<std::string, float>& settings) {
    return 100.0 * (1.0 - mean_A(vesc_limit(settings)) / bound_A);
  };
  EXPECT_NEAR(lost_percent(script.settings), stated(R"(Less current than the table: [0-9.]+ A \(([0-9.]+) %\))"), 0.1);
  std::map<std::string, float> changed = script.settings;
  changed["'l-temp-accel-dec"] = 0.15F;
  EXPECT_NEAR(lost_percent(changed), stated(R"(default of 0\.15 [^(]*\(([0-9.]+) %\))"), 0.1);
}

TEST(VescExporter, ScriptFollowsTheObserverAndTheControllersRampKeepsTheLimit) {
  SmallLisp script;
  float override_C = NAN;
  double current_A = 0.0;
  double speed_rad_per_s = 0.0;
  constexpr float kPolePairs = 7.0F;
  script.settings["'si-motor-poles"] = 2.0F * kPolePairs;
  script.settings["'motor-type"] = kVescFoc;
  script.extensions = {{"systime", [](const auto&) { return 0.0F; }},
                       {"secs-since", [](const auto&) { return 0.01F; }},
                       {"sleep", [](const auto&) { return 0.0F; }},
                       {"get-current", [&](const auto&) { return static_cast<float>(current_A); }},
                       {"get-rpm", [&](const auto&) { return static_cast<float>(speed_rad_per_s * 30.0 / std::numbers::pi) * kPolePairs; }},
                       {"override-temp-motor", [&](const auto& with) { return override_C = with.at(0); }}};
  script.load(exported("vesc"));
  const VescLimit limit = vesc_limit(script.settings, kVescLeastLimit_A);
  EXPECT_EQ(script.settings.at("'l-current-min"), -script.settings.at("'l-current-max"));
  for (const char* state : {"hs-winding-C", "hs-stator-C"}) {
    EXPECT_EQ(script.value(state), 155.0F) << "not started: taken as hot as its limit";
    script.set(state, 40.0F);
  }
  ObserverRun<float> observer(ecx_derating().observer, 0.01F, 40.0F);
  double filtered_C = 40.0;
  double hottest = 0.0;
  float last_A = 0.0F;
  RandomLoad driver(5);
  for (int i = 0; i < 60'000; ++i) {
    const RandomLoad::Wish wish = driver.after(0.01);
    // VESC, motor/mc_interface.c, update_override_limits(): a filter of 0.01 at 1 kHz.
    for (int tick = 0; tick < 10 && i > 0; ++tick) {
      filtered_C += 0.01 * (override_C - filtered_C);
    }
    current_A = wish.current_share * limit(filtered_C);
    speed_rad_per_s = wish.speed_share * ecx_derating().rules.most_speed_rad_per_s;
    script.cycle();
    const auto now_A = static_cast<float>(kDcPerIq_ratio) * static_cast<float>(current_A);
    const float more_A = std::abs(now_A) < std::abs(last_A) ? last_A : now_A;
    last_A = now_A;
    observer.step(std::array<float, observed::kSignalCount>{more_A, static_cast<float>(speed_rad_per_s), 40.0F, 0.0F, 40.0F, 0.0F, 0.0F});
    ASSERT_NEAR(override_C, observer.state_C()[0], 0.01) << i;
    hottest = std::max(hottest, static_cast<double>(override_C));
  }
  EXPECT_GT(hottest, 120.0);
  EXPECT_LE(hottest, 155.05);
}

}  // namespace
}  // namespace heatsoak::derate
