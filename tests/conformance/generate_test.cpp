// `heatsoak generate core`: the generated folder compiles on its own for host and controller and gives bit-identical results to the
// library.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <random>
#include <regex>
#include <set>

#include "faulty_drive.h"
#include "firmware/core_files.h"
#include "program_run.h"
#include "support/shipped.h"
#include "support/skip_reasons.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using robot_core::Input;
using robot_core::Output;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

const std::string kRobot = "roboteam_twente_v2024";
const std::string kEcx = "maxon_ecx_flat_32l_48v";
constexpr int kSamples = 60;
constexpr const char* kStrict = "-Wall -Wextra -Werror -Wconversion -Wsign-conversion -Wdouble-promotion";

/// Returns lines of a motor file with the effect at its typical size, as `describe` prints them.
std::string typical(const std::string& effect) {
  const ProgramRun done = run({"describe", effect});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  return done.out.substr(done.out.find("\n[effects.") + 1);
}

/// Writes the paper's motor with effects appended to its data sheet.
void write_motor_with(const fs::path& file, const std::vector<std::string>& effects) {
  std::string text = content_of(kSource / "motor_db" / (kEcx + ".toml"));
  for (const std::string& effect : effects) {
    text += "\n" + effect;
  }
  write(file, text);
}

Words generate(const std::string& motor, const fs::path& out) {
  return {"generate", "core", "--robot", kRobot, "--motor", motor, "--out", out.string(), "--samples", std::to_string(kSamples)};
}

bool has_cross_compiler() {
  return run_line(
             "arm-none-eabi-g++ -mcpu=cortex-m7 -mfloat-abi=hard -mfpu=fpv5-sp-d16 -ffreestanding -include limits -include cstdint "
             "-x c++ -fsyntax-only /dev/null")
             .exit_code == 0;
}

/// A generated core and the equivalent configuration in memory. Generated once for all tests of a motor.
struct Generated {
  explicit Generated(const std::vector<std::string>& effects) {
    const fs::path motor_file = folder.path() / (effects.empty() ? kEcx + ".toml" : "with_effects.toml");
    write_motor_with(motor_file, effects);
    RunOptions options;
    options.time_limit_s = 300;
    const ProgramRun done = run(generate(motor_file.string(), core) + Words{"--json", "-"}, options);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    answer = done.exit_code == 0 ? done.json() : nlohmann::json();
    text = done.err;
    const motor::Motor motor = motor::read_motor(motor_file);
    derate::DerateOptions derate_options;
    derate_options.guarantee.samples = kSamples;
    const derate::Derating derating = derate::derate(motor, twente(), derate_options);
    guard.emplace(derating);
    config = firmware::make_core_config(twente(), motor, {}, derating, *guard);
  }

  TemporaryFolder folder;
  fs::path core = folder.path() / "core";
  nlohmann::json answer;
  std::string text;
  std::optional<firmware::HostGuard> guard;
  robot_core::Config config;
};

ProgramRun build(const Generated& core, const std::string& line) {
  RunOptions options;
  options.folder = core.core;
  options.time_limit_s = 600;
  ProgramRun done = run_line(line, options);
  EXPECT_EQ(done.exit_code, 0) << done.out << done.err;
  return done;
}

/// Shared by all tests of this process.
const Generated& plain_core() {
  static const Generated kCore({});
  return kCore;
}

constexpr int kSteps = 100'000;

/// Serialises an Output without its padding bytes, which are undefined, and the digest of the state.
std::string bytes_of(const Output& out, std::uint64_t digest) {
  std::string bytes;
  const auto add = [&bytes](const auto& value) {
    const auto raw = std::bit_cast<std::array<char, sizeof(value)>>(value);
    bytes.append(raw.data(), raw.size());
  };
  add(std::to_array(out.pwm_ratio));
  add(std::to_array(out.voltage_V));
  add(std::to_array(out.is_open));
  add(std::to_array(out.reason));
  add(std::to_array(out.allowed_current_A));
  add(std::to_array(out.winding_C));
  add(out.time_to_guard_limit_s);
  add(out.is_warning);
  add(out.robot_reason);
  add(digest);
  return bytes;
}

/// Feeds recorded inputs to a compiled self_test.
std::vector<std::string> replayed(const fs::path& self_test, const fs::path& inputs, const fs::path& outputs) {
  const ProgramRun done = run_line(fmt::format("'{}' replay '{}' '{}'", self_test.string(), inputs.string(), outputs.string()));
  EXPECT_EQ(done.exit_code, 0) << done.out << done.err;
  std::ifstream stream(outputs, std::ios::binary);
  std::vector<std::string> records;
  std::array<char, sizeof(Output)> out{};
  std::uint64_t digest = 0;
  while (stream.read(out.data(), out.size()) && stream.read(reinterpret_cast<char*>(&digest), sizeof digest)) {
    records.push_back(bytes_of(std::bit_cast<Output>(out), digest));
  }
  return records;
}

/// Describes the first differing byte for the failure message.
std::string difference(const std::vector<std::string>& found, const std::vector<std::string>& expected) {
  const auto [differs, here] = std::ranges::mismatch(found, expected);
  if (differs == found.end()) {
    return "";
  }
  const auto byte = std::ranges::mismatch(*differs, *here).in1 - differs->begin();
  return fmt::format("step {} differs from byte {} of {} on", differs - found.begin(), byte, here->size());
}

void expect_host_builds_with_the_bits_of_the_core_here(const Generated& core) {
  EXPECT_THAT(build(core, fmt::format("make host WARNINGS='{}'", kStrict)).out, HasSubstr("passes its self-test"));
  build(core, fmt::format("cmake -S . -B build/cmake_host -DCMAKE_CXX_FLAGS='{}' && cmake --build build/cmake_host && ctest --test-dir "
                          "build/cmake_host",
                          kStrict));
  FaultyDrive drive(core.config);
  const fs::path inputs = core.folder.path() / "inputs";
  std::ofstream stream(inputs, std::ios::binary);
  std::vector<std::string> expected;
  std::set<int> reasons;
  for (int i = 0; i < kSteps; ++i) {
    const Input input = drive.next();
    stream.write(reinterpret_cast<const char*>(&input), sizeof input);
    const Output out = drive.take_step();
    expected.push_back(bytes_of(out, drive.digest()));
    reasons.insert(static_cast<int>(out.robot_reason));
    for (int wheel = 0; wheel < core.config.wheel_count; ++wheel) {
      reasons.insert(static_cast<int>(out.reason[wheel]));
    }
  }
  stream.close();
  EXPECT_GE(reasons.size(), 12U) << testing::PrintToString(reasons);
  for (const char* const self_test : {"build/host/self_test", "build/cmake_host/self_test"}) {
    const std::vector<std::string> found = replayed(core.core / self_test, inputs, core.folder.path() / "outputs");
    ASSERT_EQ(found.size(), expected.size());
    EXPECT_EQ(difference(found, expected), "") << self_test;
  }
}

void expect_firmware_builds(const Generated& core) {
  if (!has_cross_compiler()) {
    GTEST_SKIP() << HEATSOAK_FAILS_CI "no arm-none-eabi-g++ with its headers";
  }
  build(core, fmt::format("make firmware WARNINGS='{}'", kStrict));
  build(core,
        fmt::format("cmake -S . -B build/cmake_firmware --toolchain arm-none-eabi.cmake -DCMAKE_C_FLAGS='{0}' -DCMAKE_CXX_FLAGS='{0}' "
                    "&& cmake --build build/cmake_firmware",
                    kStrict));
  for (const char* const image : {"build/firmware/firmware.elf", "build/cmake_firmware/firmware.elf"}) {
    EXPECT_THAT(build(core, fmt::format("arm-none-eabi-nm -u {}", image)).out, IsEmpty());
    const std::string names = build(core, fmt::format("arm-none-eabi-nm -C {}", image)).out;
    EXPECT_THAT(names, AllOf(HasSubstr("heatsoak_core_step"), HasSubstr("kMotorGuard"), HasSubstr("08000000 r vectors")));
    // main.c uses no pose targets, so the linker must omit the planner.
    EXPECT_THAT(names, Not(AnyOf(HasSubstr("plan_to_pose"), HasSubstr("plan_plane"))));
    // Double precision would appear as calls of the compiler's library.
    EXPECT_THAT(names, Not(HasSubstr("__aeabi_d")));
    // An interrupt between the test and wfi must not be missed.
    const std::string wait = build(core, fmt::format("arm-none-eabi-objdump -d --disassemble=board_wait_for_period {}", image)).out;
    EXPECT_LT(wait.find("cpsid"), wait.find("wfi"));
    EXPECT_THAT(wait, HasSubstr("cpsie"));
    const std::string sections = build(core, fmt::format("arm-none-eabi-size -A -d {}", image)).out;
    EXPECT_THAT(sections, AllOf(HasSubstr(".vectors"), HasSubstr("134217728"), HasSubstr(".noinit")));
  }
}

TEST(GeneratedCore, CompilesForTheHostWithBothBuildsAndHasTheBitsOfTheCoreHere) {
  expect_host_builds_with_the_bits_of_the_core_here(plain_core());
}

TEST(GeneratedCore, CompilesForTheControllerWithBothBuilds) { expect_firmware_builds(plain_core()); }

// The oscillator of the independent watchdog has 17 to 47 kHz (data sheet DS11532 of the STM32F767).
TEST(GeneratedCore, WatchdogEndsWithinTheGapThatTheCoreCounts) {
  const std::string board = content_of(plain_core().core / "firmware/board_default.c");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(board, found, std::regex("WATCHDOG_RELOAD (\\d+)u")));
  constexpr double kPrescaler = 4.0;
  const double cycles = kPrescaler * (std::stod(found[1]) + 1.0);
  EXPECT_LE(cycles / 17e3, static_cast<double>(robot_core::kWatchdog_s));
  EXPECT_GT(cycles / 47e3, 5.0 * static_cast<double>(plain_core().config.period_s));
}

// These effects need a power, an exponential, a third node, and a signal that the core lacks.
TEST(GeneratedCore, HasTheLawsOfAddedEffects) {
  const Generated core({typical("natural_convection"), typical("third_node"), typical("contact_ageing")});
  EXPECT_THAT(content_of(core.core / "motor_guard.cpp"),
              AllOf(HasSubstr("heatsoak_pow("), HasSubstr("heatsoak_exp("), Not(HasSubstr("sqrtf"))));
  EXPECT_THAT(core.answer["derating"]["nodes"], SizeIs(3));
  EXPECT_THAT(core.answer["notes"][0].get<std::string>(), AllOf(HasSubstr("my_contact_ageing"), HasSubstr("operating hours")));
  EXPECT_THAT(content_of(core.core / "README.md"), HasSubstr("my_contact_ageing"));
  expect_host_builds_with_the_bits_of_the_core_here(core);
  expect_firmware_builds(core);
}

TEST(GeneratedCore, HeaderIsC99) {
  write(plain_core().folder.path() / "c99.c", "#include \"heatsoak_core.h\"\nint main(void) { return HEATSOAK_CORE_GUARD_UNKNOWN; }\n");
  build(plain_core(), fmt::format("cc -std=c99 -Wpedantic {} -I. -fsyntax-only ../c99.c", kStrict));
  build(plain_core(), fmt::format("c++ -std=c++11 -Wpedantic {} -I. -fsyntax-only -x c++ ../c99.c", kStrict));
}

TEST(GeneratedCore, ConfigurationMayBeIncludedAfterAUsingDirective) {
  write(plain_core().folder.path() / "using.cpp",
        "#include \"robot_core/drive_core.h\"\nusing namespace robot_core;\n#include \"core_config.h\"\n"
        "int main() { return kCoreConfigWithPlanner.wheel_count; }\n");
  build(plain_core(), fmt::format("c++ -std=c++20 -Wpedantic {} -I. -fsyntax-only ../using.cpp", kStrict));
}

TEST(GeneratedCore, NamesTheReasonsOfTheCore) {
  const std::string header = content_of(plain_core().core / "heatsoak_core.h");
  EXPECT_THAT(header, AllOf(HasSubstr("HEATSOAK_CORE_NONE = 0,"), HasSubstr("HEATSOAK_CORE_GUARD = 14,"),
                            HasSubstr("HEATSOAK_CORE_WHEEL_SPEED_SWAPPED = 113,")));
  const std::string reasons = content_of(kSource / "robot_core/reason.h");
  const auto numbers = [](const std::string& text, const std::string& begin) {
    std::size_t count = 0;
    for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
      ++count;
    }
    return count;
  };
  EXPECT_EQ(numbers(content_of(plain_core().core / "heatsoak_core.cpp"), "static_assert(HEATSOAK_CORE_") - 3,
            numbers(reasons.substr(reasons.find("enum class Reason")), " = 1") + 1);
}

TEST(GeneratedCore, EachValueOfTheConfigurationHasItsOrigin) {
  const std::string header = content_of(plain_core().core / "core_config.h");
  EXPECT_THAT(
      header,
      AllOf(HasSubstr(fmt::format(".check_sum = 0x{:08X}U", plain_core().config.check_sum)), HasSubstr("robot file: body.yaw_inertia"),
            HasSubstr("CRC-64/XZ " + plain_core().answer["input_hash"]["value"].get<std::string>()), HasSubstr("heatsoak 0."),
            HasSubstr(
                fmt::format(".limp_current_A = {},  // smallest current", firmware::float_literal(plain_core().config.limp_current_A)))));
  std::istringstream lines(header);
  bool is_first_wheel = true;
  for (std::string line; std::getline(lines, line);) {
    is_first_wheel = is_first_wheel && line.find("},") == std::string::npos;
    const bool is_of_other_wheel = line.starts_with("                .") && !is_first_wheel;
    if (line.find("F,") != std::string::npos && !is_of_other_wheel) {
      EXPECT_THAT(line, HasSubstr("  // "));
    }
  }
}

TEST(GeneratedCore, AnswerListsTheFiles) {
  const nlohmann::json& answer = plain_core().answer;
  EXPECT_EQ(answer["schema"], "heatsoak.core/1");
  EXPECT_EQ(answer["derating"]["guard_period_s"], 0.01);
  EXPECT_EQ(answer["derating"]["samples"], kSamples);
  std::size_t files = 0;
  for (const nlohmann::json& file : answer["files"]) {
    EXPECT_EQ(fs::file_size(plain_core().core / file["path"].get<std::string>()), file["bytes"].get<std::size_t>());
    ++files;
  }
  EXPECT_GE(files, 40U);
  EXPECT_TRUE(content_of(plain_core().core / "robot_core/limits.cpp") == content_of(kSource / "robot_core/limits.cpp"));
  EXPECT_FALSE(fs::exists(plain_core().core / "robot_core/block_diagram.h"));
}

std::string all_bytes(const fs::path& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files.insert(entry.path().lexically_relative(folder).string() + "\n" + content_of(entry.path()));
    }
  }
  return fmt::format("{}", fmt::join(files, "\n"));
}

TEST(GenerateCore, WritesTheSameBytesTwice) {
  const TemporaryFolder folder;
  ASSERT_EQ(run(generate(kEcx, folder.path() / "one")).exit_code, 0);
  ASSERT_EQ(run(generate(kEcx, folder.path() / "two") + Words{"--threads", "1"}).exit_code, 0);
  const std::string first = all_bytes(folder.path() / "one");
  EXPECT_TRUE(first == all_bytes(folder.path() / "two"));
  EXPECT_THAT(first, Not(HasSubstr(folder.path().string())));
  ASSERT_EQ(run(generate(kEcx, folder.path() / "other") + Words{"--seed", "2"}).exit_code, 0);
  EXPECT_FALSE(first == all_bytes(folder.path() / "other"));
}

TEST(GenerateCore, TellsWhatTheCoreDoesNotKnow) {
  const TemporaryFolder folder;
  write_motor_with(folder.path() / "windy.toml", {typical("vehicle_airflow"), typical("neighbour_coupling")});
  const ProgramRun done = run(generate((folder.path() / "windy.toml").string(), folder.path() / "core") + Words{"--json", "-"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.json()["notes"], SizeIs(3));
  EXPECT_THAT(done.json()["notes"][2].get<std::string>(), HasSubstr("effects.my_vehicle_airflow.conductance -33 to +50 % (estimated)"));
  EXPECT_THAT(done.err, AllOf(HasSubstr("- my_vehicle_airflow depends on"), HasSubstr("still air"),
                              HasSubstr("- my_neighbour_coupling depends on"), HasSubstr("other wheels' guards")));
  EXPECT_THAT(content_of(folder.path() / "core/README.md"), HasSubstr("my_vehicle_airflow"));
}

TEST(GenerateCore, RefusesAWindingThatIsCoupledToItsNeighbours) {
  const TemporaryFolder folder;
  std::string coupled = typical("neighbour_coupling");
  coupled.replace(coupled.find("\"stator\""), 8, "\"winding\"");
  write_motor_with(folder.path() / "coupled.toml", {coupled});
  const ProgramRun done = run(generate((folder.path() / "coupled.toml").string(), folder.path() / "core"));
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_THAT(done.err, AllOf(HasSubstr("effects.my_neighbour_coupling"), HasSubstr("expected node = \"stator\"")));
  EXPECT_FALSE(fs::exists(folder.path() / "core"));
}

TEST(GenerateCore, CurveOverAColumnCountsAtItsHottest) {
  const TemporaryFolder folder;
  std::string curve = typical("tabulated");
  curve.replace(curve.find("driver = \"speed\""), 16, "driver = \"column\"\ncolumn = \"gripper_ratio\"");
  for (std::size_t at = curve.find(" rad/s"); at != std::string::npos; at = curve.find(" rad/s")) {
    curve.erase(at, 6);
  }
  write_motor_with(folder.path() / "gripper.toml", {curve});
  const ProgramRun done = run(generate((folder.path() / "gripper.toml").string(), folder.path() / "core"));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("- my_tabulated depends on gripper_ratio of the logs"));
  EXPECT_THAT(content_of(folder.path() / "core/motor_guard.cpp"),
              HasSubstr("depends on gripper_ratio of the logs, evaluated at its hottest value"));
}

TEST(GenerateCore, WorksWithoutFrictionAndSaysSo) {
  const TemporaryFolder folder;
  std::string robot = content_of(kSource / "robot_core/robots" / (kRobot + ".toml"));
  const std::size_t begin = robot.find("[friction]");
  robot.erase(begin, robot.find("[traction]") - begin);
  write(folder.path() / "bare.toml", robot);
  Words words = generate(kEcx, folder.path() / "core");
  *std::ranges::find(words, kRobot) = (folder.path() / "bare.toml").string();
  const ProgramRun done = run(words + Words{"--json", "-"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.json()["notes"][0].get<std::string>(), AllOf(HasSubstr("friction"), HasSubstr("feed-forward")));
  EXPECT_THAT(content_of(folder.path() / "core/core_config.h"), HasSubstr(".has_friction = false"));
  EXPECT_THAT(content_of(folder.path() / "core/README.md"), HasSubstr("feed-forward"));
}

TEST(GenerateCore, KeepsWhatAUserAdded) {
  const TemporaryFolder folder;
  const fs::path core = folder.path() / "core";
  fs::create_directories(core / "firmware");
  fs::create_directories(core / "robot_core");
  write(core / "firmware/board.c", "of my board");
  write(core / "robot_core/mine.h", "of my project");
  write(core / "robot_core/gone.cpp", "of an older version");
  write(core / "core_config.h", "of an older version");
  write(core / "generated_files.txt", "core_config.h\ngenerated_files.txt\nrobot_core/gone.cpp\n");
  EXPECT_EQ(run(generate(kEcx, core)).exit_code, 2);
  ASSERT_EQ(run(generate(kEcx, core) + Words{"--force"}).exit_code, 0);
  EXPECT_EQ(content_of(core / "firmware/board.c"), "of my board");
  EXPECT_EQ(content_of(core / "robot_core/mine.h"), "of my project");
  EXPECT_FALSE(fs::exists(core / "robot_core/gone.cpp"));
  EXPECT_THAT(content_of(core / "core_config.h"), HasSubstr("kCoreConfig"));
  EXPECT_THAT(content_of(core / "generated_files.txt"), AllOf(HasSubstr("robot_core/limits.cpp\n"), Not(HasSubstr("gone"))));
  EXPECT_THAT(folder.names(), testing::ElementsAre("core"));
}

/// --force must fail with this message and change nothing.
void expect_refused(const TemporaryFolder& folder, const std::string& message) {
  const std::string before = all_bytes(folder.path() / "core");
  const ProgramRun done = run(generate(kEcx, folder.path() / "core") + Words{"--force"});
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_THAT(done.err, HasSubstr(message));
  EXPECT_EQ(all_bytes(folder.path() / "core"), before);
  EXPECT_THAT(folder.names(), testing::ElementsAre("core"));
}

TEST(GenerateCore, ReplacesNoFileThatItHasNotGenerated) {
  const TemporaryFolder folder;
  const fs::path core = folder.path() / "core";
  fs::create_directories(core);
  write(core / "Makefile", "of my project");
  expect_refused(folder, "Makefile exists and generated_files.txt does not list it");
  write(core / "generated_files.txt", "README.md\ngenerated_files.txt\n");
  expect_refused(folder, "Makefile exists and generated_files.txt does not list it");
  fs::remove(core / "Makefile");
  write(core / "robot_core", "of my project");
  expect_refused(folder, "robot_core is not a folder");
}

TEST(GenerateCore, LeavesAFolderWithoutWritePermission) {
  const TemporaryFolder folder;
  const fs::path core = folder.path() / "core";
  fs::create_directories(core / "robot_core");
  constexpr auto kReadOnly = fs::perms::owner_read | fs::perms::owner_exec;
  fs::permissions(core, kReadOnly);
  expect_refused(folder, "cannot be written");
  EXPECT_EQ(fs::status(core).permissions(), kReadOnly);
  fs::permissions(core, fs::perms::owner_all);
  fs::permissions(core / "robot_core", kReadOnly);
  expect_refused(folder, "robot_core cannot be written");
  fs::permissions(core / "robot_core", fs::perms::owner_all);
  ASSERT_EQ(run(generate(kEcx, core) + Words{"--force"}).exit_code, 0);
  EXPECT_EQ(fs::status(core).permissions(), fs::perms::owner_all);
}

struct WrongCoreLine {
  Words words;
  int exit_code;
  std::string message;
};

TEST(GenerateCore, SaysWhatIsWrongAndLeavesNothing) {
  const Words with_motor{"--motor", kEcx};
  const std::vector<WrongCoreLine> wrong{
      {{"--out", "x"}, 2, "the motor is missing"},
      {with_motor, 2, "--out"},
      {with_motor + Words{"--out", "x", "--period", "50ms"}, 2, "period"},
      {with_motor + Words{"--out", "x", "--period", "0.01ms"}, 2, "--period: 0.01ms is out of range"},
      {with_motor + Words{"--out", "taken"}, 2, "--force"},
      {with_motor + Words{"--out", "file"}, 2, "is a file"},
      {with_motor + Words{"--out", "file/x"}, 2, "file is a file; expected a folder"},
      {with_motor + Words{"--out", "missing/x"}, 2, "make it first"},
      {with_motor + Words{"--out", "/proc/heatsoak_core"}, 2, "cannot be written"},
      {with_motor + Words{"--out", "x", "--coldest", "50degC"}, 2, "is not above the coldest air"},
      {with_motor + Words{"--out", "x", "--json", "missing/y.json"}, 2, "missing"},
      {with_motor + Words{"--out", "x", "--samples", "3"}, 2, "--samples"},
      {{"--motor", "maxon_dcx19s_24v", "--out", "x", "--ambient", "110degC"}, 2, "is not above the hottest air"},
      {{"--motor", "maxon_dcx19s_24v", "--out", "x"}, 2, "one full stop from"},
  };
  for (const WrongCoreLine& each : wrong) {
    const TemporaryFolder folder;
    fs::create_directories(folder.path() / "taken");
    write(folder.path() / "taken/mine", "mine");
    write(folder.path() / "file", "mine");
    RunOptions options;
    options.folder = folder.path();
    const ProgramRun done = run(Words{"generate", "core", "--robot", kRobot} + each.words, options);
    EXPECT_EQ(done.exit_code, each.exit_code) << fmt::format("{}: ", fmt::join(each.words, " ")) << done.err;
    EXPECT_THAT(done.err, HasSubstr(each.message));
    EXPECT_THAT(folder.names(), testing::ElementsAre("file", "taken"));
    EXPECT_EQ(all_bytes(folder.path() / "taken"), "mine\nmine");
  }
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  const ProgramRun here = run(Words{"generate", "core", "--robot", kRobot} + with_motor + Words{"--out", ".", "--force"}, inside);
  EXPECT_EQ(here.exit_code, 2);
  EXPECT_THAT(here.err, HasSubstr("change to another folder first"));
  EXPECT_TRUE(folder.names().empty());
  const ProgramRun other = run({"generate", "house", "--robot", kRobot, "--motor", kEcx, "--out", "x"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("expected core"));
}

TEST(GenerateCore, InputHashIsThePublishedOne) { EXPECT_EQ(derate::input_hash("123456789"), "995dc9bbdf1939fa"); }

TEST(GenerateCore, LiteralsReadBackAsTheSameNumber) {
  EXPECT_EQ(firmware::float_literal(0.01F), "0.01F");
  EXPECT_EQ(firmware::float_literal(-3.0F), "-3.0F");
  std::mt19937 engine(3);
  for (int i = 0; i < 100'000; ++i) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(engine()));
    if (std::isfinite(value)) {
      EXPECT_EQ(std::strtof(firmware::float_literal(value).c_str(), nullptr), value);
    }
  }
}

}  // namespace
}  // namespace heatsoak
