// Exports against the sources and programs of their consumers, which are not part of the project. Each test reads the place of its consumer
// from a variable; tests/derate/consumers/run fetches the consumers, sets the variables and fails if one of these tests is skipped.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "exported_text.h"
#include "support/skip_reasons.h"

namespace heatsoak::derate {
namespace {

namespace fs = std::filesystem;

/// Returns the place of a consumer; empty if the variable is not set.
fs::path place_of(const char* variable) {
  const char* const place = std::getenv(variable);
  return place == nullptr ? fs::path() : fs::path(place);
}

std::string text_of(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  EXPECT_FALSE(text.str().empty()) << path << " cannot be read";
  return text.str();
}

std::set<std::string> all_matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at) {
    found.insert((*at)[1]);
  }
  return found;
}

/// Files of one test, deleted at its end.
class Consumer : public testing::Test {
 protected:
  Consumer() { fs::create_directories(folder); }
  ~Consumer() override { fs::remove_all(folder); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  [[nodiscard]] int run(const std::string& command) const {
    return std::system(fmt::format("cd '{}' && {}", folder.string(), command).c_str());
  }

  const fs::path folder = fs::path(testing::TempDir()) / fmt::format("heatsoak_consumer_{}", static_cast<int>(getpid()));
};

using ConsumersScript = Consumer;
using VescConsumer = Consumer;
using MoteusConsumer = Consumer;
using OdriveConsumer = Consumer;
using SimpleFocConsumer = Consumer;
using MujocoConsumer = Consumer;

// The script with a program that prints this in place of the tests. With an interpreter that is given, nothing is fetched.
TEST_F(ConsumersScript, FailsIfATestIsSkippedFailsOrDoesNotExist) {
  const std::string script = (kSource / "tests/derate/consumers/run").string();
  const auto exit_code = [&](const std::string& printed, int result, const char* name) {
    write("tests", fmt::format("#!/bin/sh\ncat <<'END'\n{}\nEND\nexit {}\n", printed, result));
    fs::permissions(folder / "tests", fs::perms::owner_all);
    return WEXITSTATUS(run(fmt::format(
        "HEATSOAK_CONSUMERS=fetched HEATSOAK_LISPBM_REPL=given HEATSOAK_TEST_DERATE=./tests '{}' {} > out.txt 2>&1", script, name)));
  };
  EXPECT_EQ(exit_code("[       OK ] One.test (1 ms)", 0, "lispbm"), 0) << text_of(folder / "out.txt");
  EXPECT_EQ(exit_code("[       OK ] One.test (1 ms)\n[  SKIPPED ] Other.test (0 ms)", 0, "lispbm"), 1);
  EXPECT_THAT(text_of(folder / "out.txt"), HasSubstr("failed: lispbm"));
  EXPECT_EQ(exit_code("[==========] Running 0 tests from 0 test suites.", 0, "lispbm"), 1);
  EXPECT_EQ(exit_code("[       OK ] One.test (1 ms)", 1, "lispbm"), 1);
  EXPECT_EQ(exit_code("", 0, "lispbn"), 2);
  EXPECT_THAT(text_of(folder / "out.txt"), HasSubstr("there is no consumer lispbn"));
  EXPECT_EQ(exit_code("", 0, "--help"), 0);
  EXPECT_THAT(text_of(folder / "out.txt"), testing::StartsWith("usage: "));
}

TEST_F(VescConsumer, FirmwareHasEverySettingAndFunctionOfTheScript) {
  const fs::path sources = place_of("HEATSOAK_VESC_SOURCES");
  if (sources.empty()) {
    GTEST_SKIP() << HEATSOAK_LACKS_CONSUMER("vesc") "HEATSOAK_VESC_SOURCES is not set";
  }
  const std::string firmware = text_of(sources / "lispBM/lispif_vesc_extensions.c");
  const std::string script = exported("vesc");
  const std::set<std::string> settings = all_matches(script, R"(\(conf-[gs]et '([a-z0-9-]+))");
  EXPECT_GE(settings.size(), 5U);
  for (const std::string& each : settings) {
    EXPECT_THAT(firmware, HasSubstr(fmt::format("lbm_add_symbol_const(\"{}\"", each)));
  }
  for (const char* function : {"conf-get", "conf-set", "get-current", "get-rpm", "override-temp-motor", "secs-since", "systime"}) {
    EXPECT_THAT(script, HasSubstr(fmt::format("({}", function)));
    EXPECT_THAT(firmware, HasSubstr(fmt::format("lbm_add_extension(\"{}\"", function)));
  }
}

/// Returns the text of a structure of the moteus firmware.
std::string structure(const std::string& sources, const std::string& name) {
  const std::size_t begin = sources.find(fmt::format("\nstruct {} {{", name));
  return begin == std::string::npos ? std::string() : sources.substr(begin, sources.find("\n};", begin) - begin);
}

// The firmware makes its keys from the fields that a structure visits; "servo" is a BldcServoConfig.
TEST_F(MoteusConsumer, FirmwareHasEveryKey) {
  const fs::path sources = place_of("HEATSOAK_MOTEUS_SOURCES");
  if (sources.empty()) {
    GTEST_SKIP() << HEATSOAK_LACKS_CONSUMER("moteus") "HEATSOAK_MOTEUS_SOURCES is not set";
  }
  const std::string structures = text_of(sources / "fw/bldc_servo_structs.h");
  for (const auto& [key, value] : lines_of(exported("moteus"), R"(^servo\.([a-zA-Z_.]+) ([-0-9.]+)$)")) {
    std::string within = "BldcServoConfig";
    std::istringstream parts(key);
    for (std::string part; std::getline(parts, part, '.');) {
      const std::string fields = structure(structures, within);
      EXPECT_THAT(fields, HasSubstr(fmt::format("MJ_NVP({})", part))) << key << " in " << within;
      const std::set<std::string> types = all_matches(fields, fmt::format(R"(\n +(\w+) {}( =[^;]*)?;)", part));
      ASSERT_EQ(types.size(), 1U) << key << " in " << within;
      within = *types.begin();
    }
    EXPECT_TRUE(within == "float" || within == "bool" || within.ends_with("int8_t"))
        << key << " is a " << within << ", the file has " << value;
  }
}

/// Returns the lines of a YAML block that belong to one of its keys: the rest of the key's line and those below it with a larger
/// indentation. Only keys on the level of the block's first line count.
std::string below_key(const std::string& block, const std::string& key) {
  std::istringstream lines(block);
  std::string found;
  std::optional<std::size_t> level;
  bool is_inside = false;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find_first_not_of(' ');
    if (first == std::string::npos || line[first] == '#') {
      continue;
    }
    level = level.value_or(first);
    if (is_inside && first <= *level) {
      break;
    }
    if (is_inside) {
      found += line + "\n";
    } else if (first == *level && line.compare(first, key.size() + 1, key + ":") == 0) {
      is_inside = true;
      found += line.substr(first + key.size() + 1) + "\n";  // {type: float32, …} in the same line
    }
  }
  const std::size_t end = found.find('\n');
  // A block begins on the level of its keys, without an empty rest of the key's line.
  return found.find_first_not_of(' ') == end && end != std::string::npos ? found.substr(end + 1) : found;
}

/// Returns the type of a setting of an interface, such as "motor.config.current_lim" of ODrive.Axis; empty if it does not exist there. An
/// attribute either has its attributes below it or names an interface of its own.
std::string odrive_type(const std::string& yaml, const std::string& interface, const std::string& path) {
  const std::string interfaces = below_key(yaml, "interfaces");
  std::string here = below_key(below_key(interfaces, interface), "attributes");
  std::istringstream names(path);
  for (std::string name; std::getline(names, name, '.');) {
    here = below_key(here, name);
    std::smatch other;
    if (const std::string inner = below_key(here, "attributes"); !inner.empty()) {
      here = inner;
    } else if (std::regex_search(here, other, std::regex(R"(^\s*(?:type: )?([A-Z]\w+)\s)"))) {
      here = below_key(below_key(interfaces, "ODrive." + other[1].str()), "attributes");
    }
  }
  std::smatch type;
  return std::regex_search(here, type, std::regex(R"(^\s*(?:\{?type: )?(\w+))")) ? type[1].str() : std::string();
}

TEST_F(OdriveConsumer, InterfaceHasEverySettingWithItsType) {
  const fs::path sources = place_of("HEATSOAK_ODRIVE_SOURCES");
  if (sources.empty()) {
    GTEST_SKIP() << HEATSOAK_LACKS_CONSUMER("odrive") "HEATSOAK_ODRIVE_SOURCES is not set";
  }
  const std::string interface = text_of(sources / "Firmware/odrive-interface.yaml");
  const std::string text = exported("odrive");
  EXPECT_THAT(interface, HasSubstr("\n      save_configuration:"));
  std::size_t settings = 0;
  for (const std::string& line : all_matches(text, R"(\n(axis\.[^\n]+))")) {
    std::smatch parts;
    ASSERT_TRUE(std::regex_match(line, parts, std::regex(R"(axis\.(.+) = (.+))"))) << line;
    const char* const type = parts[2] == "True" || parts[2] == "False" ? "bool" : "float32";
    EXPECT_EQ(odrive_type(interface, "ODrive.Axis", parts[1]), type) << line;
    ++settings;
  }
  EXPECT_EQ(settings, 4U);
}

/// Declarations of the Arduino core that the headers of SimpleFOC need; nothing is linked.
constexpr const char* kArduino = R"(#pragma once
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
typedef uint8_t byte;
typedef uint16_t word;
class String {};
class StringSumHelper : public String {};
class __FlashStringHelper;
class Print {};
class Stream : public Print {};
extern Stream Serial;
enum { MSBFIRST, RISING, CHANGE, SPI_MODE0, SPI_MODE1 };
class SPISettings {
 public:
  SPISettings(int, int, int);
};
class SPIClass {};
extern SPIClass SPI;
class TwoWire {};
extern TwoWire Wire;
)";

TEST_F(SimpleFocConsumer, SnippetFitsTheHeaders) {
  const fs::path sources = place_of("HEATSOAK_SIMPLEFOC_SOURCES");
  if (sources.empty()) {
    GTEST_SKIP() << HEATSOAK_LACKS_CONSUMER("simplefoc") "HEATSOAK_SIMPLEFOC_SOURCES is not set";
  }
  write("Arduino.h", kArduino);
  write("SPI.h", "#include \"Arduino.h\"\n");
  write("Wire.h", "#include \"Arduino.h\"\n");
  write("limit.h", exported("simplefoc"));
  write("maxon_ecx_flat_32l_48v_guard.h", exported("c_header"));
  write("sketch.cpp",
        "#include \"limit.h\"\n"
        "float allowed_A(BLDCMotor &motor, maxon_ecx_flat_32l_48v_state &guard) {\n"
        "  return maxon_ecx_flat_32l_48v_limit(motor, guard, 40.0f).allowed_current_A;\n}\n");
  EXPECT_EQ(run(fmt::format("c++ -std=c++17 -fsyntax-only -I. -isystem '{}' sketch.cpp", (sources / "src").string())), 0);
}

// Steady state of P = U²/(R·(1 + α·(T − T₂₅))) and T − air = P·R_th, with the numbers of the file.
constexpr const char* kBlockedMotor = R"py(import mujoco, re
text = open('motor.xml').read()
name = re.search(r'default class="(\w+)"', text).group(1)
text = text.replace('</mujoco>', f'''<option timestep="0.02"/><worldbody><body><joint name="shaft" type="hinge" axis="0 0 1" damping="1e6"/>
<geom size="0.01"/></body></worldbody><actuator><dcmotor class="{name}" joint="shaft"/></actuator></mujoco>''')
model = mujoco.MjModel.from_xml_string(text)
data = mujoco.MjData(model)
data.ctrl[:] = 3.0
while data.time < 600.0:
    mujoco.mj_step(model, data)
cold_ohm = float(re.search(r'resistance="([^"]+)"', text).group(1))
thermal = [float(each) for each in re.search(r'thermal="([^"]+)"', text).group(1).split()]
rise_K = 0.0
for _ in range(200):
    rise_K = thermal[0] * 9.0 / (cold_ohm * (1.0 + thermal[3] * (rise_K + thermal[5] - thermal[4])))
assert abs(data.act[-1] - rise_K) < 0.1, (data.act, rise_K)
)py";

TEST_F(MujocoConsumer, LoadsItAndABlockedMotorWarmsAsComputed) {
  if (std::system("python3 -c 'import mujoco' > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << HEATSOAK_LACKS_CONSUMER("mujoco") "python3 has no mujoco";
  }
  write("motor.xml", exported("mujoco"));
  write("blocked.py", kBlockedMotor);
  EXPECT_EQ(run("python3 blocked.py"), 0);
}

}  // namespace
}  // namespace heatsoak::derate
