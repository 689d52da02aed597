// The C header in a firmware compiler, and its behaviour in case of faults.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <numbers>
#include <regex>
#include <sstream>

#include "derate/exporter.h"
#include "guarded_motor.h"
#include "robot/motor_drive.h"
#include "support/skip_reasons.h"

namespace heatsoak::derate {
namespace {

using testing::HasSubstr;

/// Test program. It reads lines with an input, `current speed ambient`, or a command: "start C", "zero", "break", "iq" before a line whose
/// current is an i_q. It answers each input with the bits of allowed current, winding, stator and nominal winding, and with the reason.
constexpr const char* kProgram = R"(
#include "guard.h"
#include <stdio.h>
#include <string.h>
static unsigned bits(float x) { unsigned u; memcpy(&u, &x, 4); return u; }
int main(void) {
  guarded_state state;
  char word[64];
  memset(&state, 0, sizeof state);
  while (scanf("%60s", word) == 1) {
    double a, b, c;
    if (strcmp(word, "start") == 0) {
      if (scanf("%lf", &a) != 1) return 1;
      guarded_start(&state, (float)a);
    } else if (strcmp(word, "zero") == 0) {
      memset(&state, 0, sizeof state);
    } else if (strcmp(word, "break") == 0) {
      state.state_C[1] = -1e30f;
    } else {
      guarded_input in;
      guarded_output out;
      if (scanf("%lf %lf %lf", &a, &b, &c) != 3) return 1;
      in.current_A = strcmp(word, "iq") == 0 ? guarded_current_from_iq_A((float)a) : (float)a;
      in.speed_rad_per_s = (float)b;
      in.ambient_C = (float)c;
      out = guarded_step(&state, &in);
      printf("%x %x %x %x %d\n", bits(out.allowed_current_A), bits(out.guarded_winding_C), bits(state.state_C[1]),
             bits(out.nominal_winding_C), (int)out.reason);
    }
  }
  return 0;
}
)";

enum Reason { full, derated, no_current, input_unknown, not_started };

struct Answer {
  float allowed_A = 0.0F;
  float winding_C = 0.0F;
  float stator_C = 0.0F;
  float nominal_C = 0.0F;
  int reason = -1;
};

/// Returns a derating for the ECX 32 with `lines` appended to its data sheet.
Derating guarded_ecx_32(const std::string& lines = {}) {
  const GuardedMotor guarded(lines.empty() ? ecx_32() : ecx_32_with(lines), rules_for(ecx_32()), 1.5);
  Derating derating = derating_of(guarded);
  derating.robot_id = "a */ robot";
  derating.effects = {{"copper_loss", "copper_loss", "P = I² R", ""}};
  return derating;
}

std::string header_text(const std::string& lines = {}) {
  for (const ExporterType& each : all_exporters()) {
    if (each.name == "c_header") {
      return each.write(guarded_ecx_32(lines));
    }
  }
  return {};
}

class CHeader : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::system("cc --version > /dev/null 2>&1 && c++ --version > /dev/null 2>&1") != 0) {
      GTEST_SKIP() << HEATSOAK_FAILS_CI "no compiler here";
    }
    folder_ = std::filesystem::path(testing::TempDir()) / ("heatsoak_guard_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "main.c") << kProgram;
    build("");
  }
  /// Builds the header for the motor with effects instead of the bare one.
  void build(const std::string& lines) { build_header(header_text(lines)); }
  /// Builds the header for the bare motor in another robot.
  void build_for(const robot::Robot& robot) {
    Derating derating = guarded_ecx_32();
    const thermal::Network network = motor::datasheet_network(ecx_32(), motor::nominal_sample(ecx_32()));
    derating.observer = Observer(network, ecx_32().nominal, robot, 1.5);
    derating.heating_current_ratio = robot::heating_factor(robot);
    build_header(std::ranges::find(all_exporters(), "c_header", &ExporterType::name)->write(derating));
  }
  void build_header(const std::string& header) {
    std::ofstream(folder_ / "guard.h") << header;
    const std::string warnings =
        " -O2 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion -Wunused -Werror -ffp-contract=off ";
    const std::string command = std::string(GetParam()) + warnings + "-o '" + (folder_ / "guard").string() + "' '" +
                                (folder_ / "main.c").string() + "' -lm 2> '" + (folder_ / "errors").string() + "'";
    std::stringstream errors;
    const int code = std::system(command.c_str());
    errors << std::ifstream(folder_ / "errors").rdbuf();
    ASSERT_EQ(code, 0) << errors.str();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::vector<Answer> ask(const std::string& lines) const {
    std::ofstream(folder_ / "asked") << lines;
    const auto quoted = [this](const char* file) { return fmt::format("'{}'", (folder_ / file).string()); };
    const std::string command = fmt::format("{} < {} > {}", quoted("guard"), quoted("asked"), quoted("answered"));
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::ifstream answered(folder_ / "answered");
    std::vector<Answer> answers;
    std::uint32_t allowed = 0;
    std::uint32_t winding = 0;
    std::uint32_t stator = 0;
    std::uint32_t nominal = 0;
    for (int reason = 0; answered >> std::hex >> allowed >> winding >> stator >> nominal >> std::dec >> reason;) {
      answers.push_back({std::bit_cast<float>(allowed), std::bit_cast<float>(winding), std::bit_cast<float>(stator),
                         std::bit_cast<float>(nominal), reason});
    }
    return answers;
  }

 private:
  std::filesystem::path folder_;
};

INSTANTIATE_TEST_SUITE_P(Compilers, CHeader, testing::Values("cc -std=c99", "c++ -x c++ -std=c++11"),
                         [](const testing::TestParamInfo<const char*>& each) { return each.index == 0 ? "c99" : "cpp11"; });

// The header must be bit-identical to the observer and table that the search has checked.
TEST_P(CHeader, has_the_bits_of_the_observer_and_the_table) {
  const Derating derating = guarded_ecx_32();
  ObserverRun<float> run(derating.observer, 0.01F, 31.0F);
  // Reference observer without a safety factor on heat.
  const thermal::Network network = motor::datasheet_network(ecx_32(), motor::nominal_sample(ecx_32()));
  const Observer nominal_observer(network, ecx_32().nominal, twente(), 1.0);
  ObserverRun<float> nominal(nominal_observer, 0.01F, 31.0F);
  std::ostringstream lines;
  lines << "start 31\n";
  std::vector<Answer> expected;
  std::mt19937_64 engine(2);
  std::uniform_real_distribution<float> uniform;
  for (int i = 0; i < 20'000; ++i) {
    const float current_A = 8.0F * (uniform(engine) - 0.3F);
    const float speed_rad_per_s = 900.0F * (uniform(engine) - 0.5F);
    const float ambient_C = 20.0F + 10.0F * uniform(engine);
    lines << fmt::format("in {:.9g} {:.9g} {:.9g}\n", current_A, speed_rad_per_s, ambient_C);
    const std::array<float, observed::kSignalCount> signals{current_A, speed_rad_per_s, ambient_C, 0.0F, 0.0F, 0.0F, 0.0F};
    run.step(signals);
    nominal.step(signals);
    expected.push_back({derating.table.allowed_A(std::abs(speed_rad_per_s), run.hottest_body_C(), run.state_C()[0]), run.state_C()[0],
                        run.state_C()[1], nominal.state_C()[0], 0});
  }
  const std::vector<Answer> answers = ask(lines.str());
  ASSERT_EQ(answers.size(), expected.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    ASSERT_EQ(answers[i].winding_C, expected[i].winding_C) << "in step " << i;
    ASSERT_EQ(answers[i].stator_C, expected[i].stator_C) << "in step " << i;
    ASSERT_EQ(answers[i].allowed_A, expected[i].allowed_A) << "in step " << i;
    ASSERT_EQ(answers[i].nominal_C, expected[i].nominal_C) << "in step " << i;
  }
}

// The guarded temperature is the pessimistic one. Both temperatures cool to the same air.
TEST_P(CHeader, separates_the_guarded_from_the_nominal_temperature) {
  std::string lines = "start 40\n";
  for (int i = 0; i < 6000; ++i) {
    lines += "in 3 200 40\n";
  }
  for (int i = 0; i < 200'000; ++i) {
    lines += "in 0 0 40\n";
  }
  const std::vector<Answer> answers = ask(lines);
  for (const Answer& each : answers) {
    ASSERT_GE(each.winding_C, each.nominal_C - 1e-3F);
  }
  EXPECT_GT(answers[5999].winding_C, answers[5999].nominal_C + 10.0F);
  EXPECT_NEAR(answers.back().winding_C, 40.0F, 0.2F);
  EXPECT_NEAR(answers.back().nominal_C, 40.0F, 0.2F);
}

// Reference for i_q: copper loss of three sinusoidal phase currents, averaged over a turn, compared with the heat in one step of the
// header's observer. The step starts at 25 °C, where the resistance equals the data sheet's. The torque follows from the same average,
// relative to block commutation with the same back-EMF.
TEST_P(CHeader, converts_the_current_of_field_oriented_control_by_torque_and_never_below_its_heat) {
  constexpr double kIq_A = 5.0;
  constexpr int kTurn = 3600;
  const motor::MotorValues motor = ecx_32().nominal;
  double copper_W = 0.0;
  double torque_per_emf = 0.0;
  for (int i = 0; i < kTurn; ++i) {
    for (int phase = 0; phase < 3; ++phase) {
      const double angle_rad = 2.0 * std::numbers::pi * (static_cast<double>(i) / kTurn + phase / 3.0);
      const double phase_A = kIq_A * std::cos(angle_rad);
      copper_W += phase_A * phase_A * 0.5 * motor.terminal_resistance_ohm / kTurn;
      torque_per_emf += std::cos(angle_rad) * phase_A / kTurn;
    }
  }
  double block_per_emf = 0.0;  // one ampere through the two phases with the largest difference of back-EMF
  for (int i = 0; i < kTurn; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kTurn;
    const auto emf = [&](int phase) { return std::cos(angle_rad + 2.0 * std::numbers::pi * phase / 3.0); };
    block_per_emf += (std::max({emf(0), emf(1), emf(2)}) - std::min({emf(0), emf(1), emf(2)})) / kTurn;
  }
  const double equivalent_A = torque_per_emf / block_per_emf;
  for (const std::string robot : {"roboteam_twente_v2024", "tigers_v2020"}) {
    build_for(shipped_robot(robot));
    const auto heating_K = [&](const std::string& line) { return ask("start 25\n" + line)[0].nominal_C - 25.0F; };
    const double by_iq_K = heating_K(fmt::format("iq {} 0 25\n", kIq_A));
    EXPECT_NEAR(by_iq_K, heating_K(fmt::format("in {:.9g} 0 25\n", equivalent_A)), 1e-5) << robot;
    const double capacity_J_per_K = motor.thermal_time_constant_winding_s / motor.thermal_resistance_winding_stator_K_per_W;
    const double counted_W = by_iq_K * capacity_J_per_K / 0.01;
    EXPECT_GE(counted_W, 0.999 * copper_W) << robot;
    EXPECT_LE(counted_W, 1.1 * copper_W) << robot;
    if (shipped_robot(robot).drive.commutation == robot::Commutation::sinusoidal) {
      EXPECT_NEAR(counted_W, copper_W, 1e-3 * copper_W) << robot;
    }
  }
}

// The header brings its own exponential and power, so that a controller's C library cannot change a bit.
TEST_P(CHeader, brings_its_own_exponential_and_power) {
  const std::string laws = kPowerAndExponential;
  const std::string text = header_text(laws);
  EXPECT_THAT(text, testing::AllOf(testing::ContainsRegex("saturation_share = .*heatsoak_exp\\("),
                                   testing::ContainsRegex("natural_convection_conductance_W_per_K = .*heatsoak_pow\\("),
                                   HasSubstr("static inline float heatsoak_exp(")));
  EXPECT_THAT(text, testing::Not(testing::AnyOf(HasSubstr("expf("), HasSubstr("powf("))));
  EXPECT_THAT(header_text(), testing::Not(HasSubstr("heatsoak_exp")));
  build(laws);
  const Derating derating = guarded_ecx_32(laws);
  ObserverRun<float> run(derating.observer, 0.01F, 31.0F);
  std::string lines = "start 31\n";
  std::vector<float> expected_C;
  for (int i = 0; i < 2000; ++i) {
    const float current_A = 4.0F + 3.0F * static_cast<float>(std::sin(0.01 * i));
    lines += fmt::format("in {:.9g} 100 25\n", current_A);
    run.step(std::array<float, observed::kSignalCount>{current_A, 100.0F, 25.0F, 0.0F, 0.0F, 0.0F, 0.0F});
    expected_C.push_back(run.state_C()[0]);
  }
  const std::vector<Answer> answers = ask(lines);
  ASSERT_EQ(answers.size(), expected_C.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    ASSERT_EQ(answers[i].winding_C, expected_C[i]) << "in step " << i;
  }
}

TEST_P(CHeader, counts_as_hot_what_was_never_started) {
  for (const char* const state : {"zero\n", "start nan\n", "start 5000\n", "start 30\nbreak\n"}) {
    const std::vector<Answer> answers = ask(std::string(state) + "in 0 0 25\n");
    ASSERT_EQ(answers.size(), 1U);
    EXPECT_GT(answers[0].winding_C, 154.0F) << state;
    EXPECT_LT(answers[0].allowed_A, 3.0F) << state;
  }
  EXPECT_EQ(ask("zero\nin 0 0 25\n")[0].reason, not_started);
  EXPECT_EQ(ask("start 30\nbreak\nin 0 0 25\n")[0].reason, not_started);
  EXPECT_NE(ask("start 30\nin 0 0 25\n")[0].reason, not_started);
}

// A winding hotter than any number of the observer counts as that hot: to start again at the limit would forget the heat.
TEST_P(CHeader, forgets_no_heat_of_an_impossible_overcurrent) {
  for (const char* const in : {"in 60 0 40\n", "in nan 100 40\n"}) {
    std::string lines = "start 40\n";
    constexpr std::size_t kSteps = 3000;
    for (std::size_t i = 0; i < kSteps; ++i) {
      lines += in;
    }
    const std::vector<Answer> answers = ask(lines + "in 0 0 40\n");
    ASSERT_EQ(answers.size(), kSteps + 1);
    for (std::size_t i = 1; i < kSteps; ++i) {
      ASSERT_GE(answers[i].winding_C, answers[i - 1].winding_C) << in << i;
      ASSERT_NE(answers[i].reason, not_started) << in << i;
    }
    EXPECT_EQ(answers[kSteps - 1].winding_C, 1000.0F) << in;
    EXPECT_LT(answers[kSteps].winding_C, 1000.0F) << in;
    EXPECT_EQ(answers[kSteps].reason, no_current) << in;
  }
}

// One wrong sample must not disable the motor for seconds, whatever its size. What may have flowed counts as measured.
TEST_P(CHeader, one_impossible_current_costs_a_few_kelvins_and_is_named) {
  const double most_A = guarded_ecx_32().rules.most_current_A;
  const auto after = [&](double current_A) { return ask(fmt::format("start 30\nin {:.4f} 0 25\nin 0 0 25\n", current_A)); };
  const std::vector<Answer> driver = after(most_A);
  EXPECT_NE(driver[0].reason, input_unknown);
  const std::vector<Answer> twice = after(1.99 * most_A);
  EXPECT_NE(twice[0].reason, input_unknown);
  EXPECT_NEAR(twice[0].winding_C - 30.0, 1.99 * 1.99 * (driver[0].winding_C - 30.0), 0.05);
  for (const double ratio : {2.01, 10.0, -10.0, 1e6}) {
    const std::vector<Answer> impossible = after(ratio * most_A);
    EXPECT_EQ(impossible[0].reason, input_unknown) << ratio;
    EXPECT_GE(impossible[0].winding_C, driver[0].winding_C) << ratio;
    EXPECT_LE(impossible[0].winding_C, driver[0].winding_C + 0.05) << ratio;
    EXPECT_GT(impossible[1].allowed_A, 0.9F * driver[0].allowed_A) << ratio;
  }
  // Such readings that last leave no current.
  std::string lines = "start 30\n";
  for (int i = 0; i < 300; ++i) {
    lines += fmt::format("in {:.4f} 0 25\n", 10.0 * most_A);
  }
  EXPECT_EQ(ask(lines).back().allowed_A, 0.0F);
  EXPECT_EQ(ask(lines).back().reason, input_unknown);
}

TEST_P(CHeader, takes_the_hottest_case_for_what_is_no_number) {
  const std::vector<Answer> known = ask("start 80\nin 0 0 25\nin 0 0 25\n");
  for (const char* const in : {"in nan 0 25\n", "in inf 0 25\n", "in -inf 0 25\n", "in 0 nan 25\n", "in 0 0 nan\n", "in 0 0 -273\n",
                               "in 0 0 1e30\n", "in 0 0 0\n", "in 0 0 1e-30\n"}) {
    const std::vector<Answer> answers = ask(fmt::format("start 80\n{}in 0 0 25\n", in));
    ASSERT_EQ(answers.size(), 2U);
    EXPECT_EQ(answers[0].reason, input_unknown) << in;
    EXPECT_GE(answers[1].winding_C + answers[1].stator_C, known[1].winding_C + known[1].stator_C) << in;
    EXPECT_LT(answers[1].winding_C, 200.0F) << in;
    EXPECT_NE(answers[1].reason, input_unknown) << in;
  }
  EXPECT_GT(ask("start 80\nin nan 0 25\n")[0].winding_C, known[0].winding_C + 0.5F);
}

// Air flow at speed cools the motor. If the speed is unknown, the guard must not rely on this cooling.
TEST_P(CHeader, relies_on_no_cooling_by_a_speed_that_it_does_not_know) {
  build(R"([effects.flow]
type = "winding_through_flow"
conductance = { value = "0.1 W/K", origin = "estimated", derivation = "a test" }
)");
  for (const char* const speed : {"nan", "inf", "3e6", "-1e5"}) {
    std::string lines = "start 150\n";
    for (int i = 0; i < 200; ++i) {
      lines += fmt::format("in 3 {} 40\n", speed);
    }
    const std::vector<Answer> unknown = ask(lines);
    std::string standing = "start 150\n";
    for (int i = 0; i < 200; ++i) {
      standing += "in 3 0 40\n";
    }
    ASSERT_EQ(unknown.size(), 200U);
    EXPECT_EQ(unknown.back().reason, input_unknown) << speed;
    EXPECT_EQ(unknown.back().allowed_A, 0.0F) << speed;
    EXPECT_GE(unknown.back().winding_C, ask(standing).back().winding_C) << speed;
  }
}

TEST_P(CHeader, takes_the_hottest_accepted_speed_for_an_impossible_one) {
  const auto after = [&](double speed_rad_per_s) {
    std::string lines = "start 40\n";
    for (int i = 0; i < 20'000; ++i) {
      lines += fmt::format("in 0 {} 40\n", speed_rad_per_s);
    }
    return ask(lines).back();
  };
  const double last_rad_per_s = rules_for(ecx_32()).no_current_speed_rad_per_s.value();
  const Answer fastest = after(0.999 * last_rad_per_s);
  EXPECT_NE(fastest.reason, input_unknown);
  for (const double speed_rad_per_s : {std::nan(""), 1.001 * last_rad_per_s, -1e5}) {
    const Answer unknown = after(speed_rad_per_s);
    EXPECT_EQ(unknown.reason, input_unknown) << speed_rad_per_s;
    EXPECT_GE(unknown.stator_C, fastest.stator_C) << speed_rad_per_s;
  }
}

// Telemetry distinguishes a cold motor from a warm one.
TEST_P(CHeader, calls_the_current_of_a_cold_motor_full) {
  for (const double speed_rad_per_s : {0.0, 200.0, 1.2 * rules_for(ecx_32()).most_speed_rad_per_s}) {
    EXPECT_EQ(ask(fmt::format("start 20\nin 0 {} 20\n", speed_rad_per_s))[0].reason, full) << speed_rad_per_s;
    const Answer warm = ask(fmt::format("start 90\nin 0 {} 20\n", speed_rad_per_s))[0];
    EXPECT_EQ(warm.reason, derated) << speed_rad_per_s;
    EXPECT_LT(warm.allowed_A, ask(fmt::format("start 20\nin 0 {} 20\n", speed_rad_per_s))[0].allowed_A);
  }
}

// An open thermistor reads far below 0 °C.
TEST_P(CHeader, does_not_accept_air_colder_than_declared) {
  std::string lines = "start 40\n";
  std::string hottest = lines;
  for (int i = 0; i < 1000; ++i) {
    lines += "in 2 0 -55\n";
    hottest += "in 2 0 40\n";
  }
  const std::vector<Answer> answers = ask(lines);
  EXPECT_EQ(answers.back().reason, input_unknown);
  EXPECT_EQ(answers.back().stator_C, ask(hottest).back().stator_C);
  EXPECT_EQ(ask("start -55\nin 0 0 25\n")[0].winding_C, ask("start nan\nin 0 0 25\n")[0].winding_C);
}

TEST_P(CHeader, gives_no_current_beyond_its_table) {
  const double most_rad_per_s = rules_for(ecx_32()).most_speed_rad_per_s;
  const double last_rad_per_s = rules_for(ecx_32()).no_current_speed_rad_per_s.value();
  EXPECT_EQ(ask(fmt::format("start 30\nin 0 {} 25\n", last_rad_per_s))[0].reason, no_current);
  EXPECT_EQ(ask(fmt::format("start 30\nin 0 {} 25\n", -1.1 * last_rad_per_s))[0].allowed_A, 0.0F);
  // A motor pushed beyond the table's last full row can still brake.
  EXPECT_GT(ask(fmt::format("start 30\nin -3 {} 25\n", 1.05 * most_rad_per_s))[0].allowed_A, 3.0F);
  EXPECT_EQ(ask("start 170\nin 0 0 25\n")[0].allowed_A, 0.0F);
  EXPECT_GT(ask("start 30\nin 0 -300 25\n")[0].allowed_A, 5.0F);
}

// The heat has its maximum at a medium speed, so neither standstill nor the highest speed is the worst case.
TEST_P(CHeader, takes_the_hottest_of_all_that_an_unknown_signal_may_be) {
  build(hump(R"(driver = "speed"
hot = "stator"
first_knot = { value = "0 rad/s", origin = "estimated", derivation = "a test" }
last_knot = { value = "360 rad/s", origin = "estimated", derivation = "a test" }
)",
             9.0));
  const auto after = [&](const char* speed_rad_per_s) {
    std::string lines = "start 60\n";
    for (int i = 0; i < 2000; ++i) {
      lines += fmt::format("in 1 {} 30\n", speed_rad_per_s);
    }
    return ask(lines).back();
  };
  const Answer unknown = after("nan");
  EXPECT_EQ(unknown.reason, input_unknown);
  EXPECT_EQ(unknown.allowed_A, 0.0F);
  for (const char* const known : {"0", "100", "-150", "180", "300", "400"}) {
    EXPECT_GE(unknown.stator_C, after(known).stator_C - 0.2F) << known;
  }
  EXPECT_GT(after("180").stator_C, std::max(after("0").stator_C, after("400").stator_C) + 2.0F);
}

TEST(CHeaderText, SaysWhatWasAssumed) {
  Derating derating = guarded_ecx_32();
  const auto text = [&] { return std::ranges::find(all_exporters(), "c_header", &ExporterType::name)->write(derating); };
  EXPECT_THAT(text(), testing::Not(HasSubstr("VALID ONLY IF")));
  derating.assumed = {{"cooling", "fan"}};
  derating.effects.push_back({"gripper", "tabulated", "P = curve", "gripper_ratio"});
  EXPECT_THAT(text(), HasSubstr("VALID ONLY IF cooling is fan"));
  EXPECT_THAT(text(), HasSubstr("depends on gripper_ratio of the logs, evaluated at its hottest value"));
}

TEST(CHeaderText, SaysInItsFirstLinesWhichSpreadsItAssumed) {
  Derating derating = guarded_ecx_32();
  const auto text = [&] { return std::ranges::find(all_exporters(), "c_header", &ExporterType::name)->write(derating); };
  EXPECT_THAT(text(), testing::Not(HasSubstr("DEFAULT TOLERANCES")));
  derating.default_spreads = {{"effects.a */ b.loss", base::Origin::estimated, 2.0, {base::Spread::Kind::range, 1.0, 3.0, true}}};
  EXPECT_LT(text().find("DEFAULT TOLERANCES"), 300U);
  EXPECT_THAT(text(), HasSubstr("effects.a * / b.loss -50 to +50 % (estimated)"));
}

TEST(CHeaderText, ConvertsNoCurrentOfABrushedMotor) {
  Derating derating = guarded_ecx_32();
  derating.is_brushless = false;
  EXPECT_THAT(std::ranges::find(all_exporters(), "c_header", &ExporterType::name)->write(derating), testing::Not(HasSubstr("_iq_")));
}

TEST(CHeaderText, NamesHeatAfterItsLawAndNodes) {
  const std::string text = header_text("[effects.chassis]\ntype = \"third_node\"\n" + estimated("heat_capacity", "60 J/K") +
                                       estimated("conductance", "0.3 W/K") + estimated("leak_ratio", "0.2"));
  for (const char* name : {"copper_loss_W", "no_load_loss_W", "winding_to_stator_W", "stator_to_ambient_W", "stator_to_chassis_W"}) {
    EXPECT_THAT(text, HasSubstr(fmt::format("const float {} = ", name)));
  }
  EXPECT_FALSE(std::regex_search(text, std::regex("\\bt[0-9]+\\b"))) << "names of steps of the formula";
}

TEST(CHeaderText, ACommentEndsWhereItShould) {
  EXPECT_THAT(header_text(), HasSubstr("a * / robot"));
  EXPECT_THAT(header_text(), HasSubstr("10 of the 400 drawn motors, which determined the safety factor, exceeded a limit"));
}

}  // namespace
}  // namespace heatsoak::derate
