// Checks the exported headers with tools of firmware teams: strict warnings, MISRA C, and every Cortex-M from M0 to M7.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "derate/c_header/c_text.h"
#include "derate/export_text.h"
#include "exported_motor.h"
#include "sensed_motor.h"
#include "support/skip_reasons.h"

namespace heatsoak::derate {
namespace {

constexpr const char* kUse = R"(
#include "guard.h"
int32_t use(void);
int32_t use(void) {
  static PREFIX_state state;
  static PREFIX_input input;
  PREFIX_start(&state, 30);
  return (int32_t)PREFIX_step(&state, &input).reason;
}
)";

constexpr const char* kStrict =
    "-Wall -Wextra -Wpedantic -pedantic -Wconversion -Wsign-conversion -Wdouble-promotion -Wshadow -Wundef -Wcast-qual -Werror";

/// Advisory rules that the headers do not follow; src/derate/README.md has the reasons.
const std::set<std::string> kNotKept{"2.5", "8.9", "12.1", "15.5"};

struct Form {
  const char* name;
  const char* exporter;
  const Derating& (*derating)() = ecx_derating;
};

/// Derating of the motor with effects.
const Derating& derating_with_effects() {
  static const Derating derating = derating_of(ecx_32_with(kPowerAndExponential));
  return derating;
}

class CleanHeader : public testing::TestWithParam<Form> {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "guard.h") << exported(GetParam().exporter, GetParam().derating());
    const std::string prefix = identifier(GetParam().derating().motor_id) + (std::string_view(GetParam().exporter) == "c_header" ? "" : "_q15");
    std::ofstream(folder_ / "use.c") << std::regex_replace(kUse, std::regex("PREFIX"), prefix);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static bool has(const std::string& program) { return std::system((program + " --version > /dev/null 2>&1").c_str()) == 0; }

  struct Answer {
    int code = 0;
    std::string text;
  };
  [[nodiscard]] Answer run(const std::string& command) const {
    Answer answer;
    answer.code = std::system(fmt::format("cd '{}' && {{ {}; }} > out 2>&1", folder_.string(), command).c_str());
    std::stringstream text;
    text << std::ifstream(folder_ / "out").rdbuf();
    answer.text = text.str();
    return answer;
  }

  std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_clean_{}", static_cast<int>(getpid()));
};

INSTANTIATE_TEST_SUITE_P(
    Headers, CleanHeader,
    testing::Values(Form{"c_header", "c_header"}, Form{"c_header_q15", "c_header_q15"},
                    Form{"c_header_with_power_and_exponential", "c_header", derating_with_effects},
                    Form{"c_header_with_stator_thermistor", "c_header", thermistor_derating},
                    Form{"c_header_with_winding_resistance", "c_header", resistance_derating}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(CleanHeader, HasNoWarningsAsC99AndAsCpp11) {
  for (const char* const compiler : {"cc -std=c99", "c++ -x c++ -std=c++11"}) {
    if (has(std::string(compiler).substr(0, std::string_view(compiler).find(' ')))) {
      const Answer answer = run(fmt::format("{} {} -O2 -c -o use.o use.c", compiler, kStrict));
      EXPECT_EQ(answer.code, 0) << compiler << "\n" << answer.text;
    }
  }
}

// A number that has a name appears once, where the name is defined.
TEST_P(CleanHeader, IsReadable) {
  std::string code = exported(GetParam().exporter, GetParam().derating());
  std::istringstream lines(code);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 140U) << line;
  }
  EXPECT_EQ(code.find("/ 2]"), std::string::npos) << "an index that only counts passes";
  if (std::string_view(GetParam().exporter) == "c_header") {
    code = std::regex_replace(code, std::regex(R"(#define [^\n]*|/\*[\s\S]*?\*/|static const float [\s\S]*?\};)"), "");
    const std::size_t step = code.find("_step(maxon");
    ASSERT_NE(step, std::string::npos);
    std::smatch found;
    const std::string body = code.substr(step, code.find("\n}\n", step) - step);
    EXPECT_FALSE(std::regex_search(body, found, std::regex(R"(\b\d+\.\d{2,}f|\d{2,}\.\d+f)"))) << found[0];
  }
}

TEST_P(CleanHeader, CompilesForEveryCortexM) {
  if (!has("arm-none-eabi-gcc")) {
    GTEST_SKIP() << HEATSOAK_FAILS_CI "no compiler for ARM here";
  }
  for (const char* const controller : {"cortex-m0", "cortex-m0plus", "cortex-m3", "cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard",
                                       "cortex-m7 -mfpu=fpv5-sp-d16 -mfloat-abi=hard"}) {
    const Answer answer = run(fmt::format(
        "arm-none-eabi-gcc -std=c99 {} -Os -mthumb -mcpu={} -c -o use.o use.c && arm-none-eabi-nm -u use.o", kStrict, controller));
    EXPECT_EQ(answer.code, 0) << controller << "\n" << answer.text;
    // A double would call __aeabi_d… in the compiler's library.
    EXPECT_EQ(answer.text.find("__aeabi_d"), std::string::npos) << controller << "\n" << answer.text;
  }
}

TEST_P(CleanHeader, KeepsMisraRulesButTheNamedAdvisoryOnes) {
  if (!has("cppcheck")) {
    GTEST_SKIP() << HEATSOAK_FAILS_CI "no cppcheck here";
  }
  const Answer answer =
      run("cppcheck --std=c99 --addon=misra --enable=style --inline-suppr --template='{file}:{line}: {id}: {message}' use.c");
  EXPECT_EQ(answer.code, 0) << answer.text;
  std::istringstream lines(answer.text);
  const std::regex rule("misra-c2012-([0-9.]+)");
  for (std::string line; std::getline(lines, line);) {
    if (std::smatch found; std::regex_search(line, found, rule)) {
      EXPECT_TRUE(kNotKept.contains(found[1])) << line;
    } else {
      EXPECT_EQ(line.find(": warning"), std::string::npos) << line;
      EXPECT_EQ(line.find(": error"), std::string::npos) << line;
      EXPECT_FALSE(line.starts_with("guard.h")) << line;  // findings of style
    }
  }
}

TEST(HeaderText, KeepsANumberWithItsUnit) {
  for (std::size_t before = 120; before < 140; ++before) {
    const std::string text = "/*\n * " + std::string(before - 3, 'x') + " 20 K and more of it\n */\n";
    EXPECT_THAT(c_header::wrapped(text), testing::HasSubstr("20 K")) << before;
  }
}

}  // namespace
}  // namespace heatsoak::derate
