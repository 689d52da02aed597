// Compares the block diagram with the code, and checks that the drawing is consistent.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "firmware/core_config.h"
#include "firmware/core_diagram.h"
#include "support/shipped.h"

namespace heatsoak::firmware {
namespace {

using robot_core::Block;
using robot_core::BlockText;
using robot_core::SignalText;
using testing::ElementsAreArray;
using testing::HasSubstr;
using Names = std::set<std::string>;

const std::filesystem::path kCore = kSource / "robot_core";

/// Returns the code of a file without comments.
std::string code_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return std::regex_replace(text, std::regex("//[^\n]*"), "");
}

std::vector<std::string> all_matches(const std::string& text, const std::string& pattern, std::size_t group = 1) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator each(text.begin(), text.end(), regex), end; each != end; ++each) {
    found.push_back((*each)[group]);
  }
  return found;
}

bool has(const std::string& text, const std::string& pattern) { return std::regex_search(text, std::regex(pattern)); }

/// Returns the members of all structs in the headers that the stages share.
std::map<std::string, std::vector<std::string>> structs_of(const std::string& headers) {
  static const std::regex kStruct(R"(struct (?:alignas\(\d+\) )?(\w+) \{\n([^}]*(?:\{[^}\n]*\}[^}]*)*)\n\};)");
  std::map<std::string, std::vector<std::string>> structs;
  for (std::sregex_iterator each(headers.begin(), headers.end(), kStruct), end; each != end; ++each) {
    structs[(*each)[1]] = all_matches((*each)[2], R"((\w+)(?:\[\w+\])?\s*(?:=[^;]*|\{[^;]*\})?;)");
  }
  return structs;
}

/// Returns the concatenated files of each block.
std::map<Block, std::string> code_of_blocks() {
  std::map<Block, std::string> code;
  for (const BlockText& block : robot_core::kBlocks) {
    for (const std::string& file : all_matches(block.files, R"((\w+\.cpp))")) {
      code[block.block] += code_of(kCore / file);
    }
  }
  return code;
}

/// The core's code in the form that the tests analyse.
struct Code {
  std::string stages = code_of(kCore / "drive_stages.h");
  std::string core = code_of(kCore / "drive_core.cpp");
  std::map<std::string, std::vector<std::string>> structs =
      structs_of(code_of(kCore / "drive_core.h") + stages + code_of(kCore / "thermal_guard.h"));
  std::map<Block, std::string> blocks = code_of_blocks();
};

const Code& code() {
  static const Code kCode;
  return kCode;
}

/// Names of the structs that the stages pass on; the second name is one wheel's part.
struct Carrier {
  std::string name;
  std::string variable;
  std::string per_wheel;
};
const std::vector<Carrier> kCarriers{{"Validated", "validated", "ValidatedWheel"},
                                     {"BodyReference", "body", ""},
                                     {"WheelReferences", "wheels", "WheelReference"},
                                     {"WheelVoltages", "voltage", "WheelVoltage"},
                                     {"LimitedVoltages", "limited", "LimitedWheel"}};

/// Returns signal names such as "wheel.speed_rad_per_s", "velocity", "command.pose".
std::vector<std::string> signals_in(const std::string& name, const std::string& part, const std::string& member) {
  std::vector<std::string> names;
  const auto found = code().structs.find(name);
  EXPECT_NE(found, code().structs.end()) << name;
  for (const std::string& each : found->second) {
    if (each != member) {
      names.push_back(each);
    }
  }
  for (const std::string& each : part.empty() ? std::vector<std::string>{} : code().structs.at(part)) {
    names.push_back(fmt::format("{}.{}", member, each));
  }
  return names;
}

/// Returns patterns for the names by which a block accesses the carrier, or one wheel's part of it through an alias.
std::vector<std::string> ways_to(const Carrier& carrier, bool is_per_wheel, const std::string& text) {
  std::vector<std::string> ways{carrier.variable + (is_per_wheel ? R"(\.wheel\[\w+\])" : "")};
  for (const std::string& alias : all_matches(text, fmt::format(R"(\b{}\b[\s&*]+(\w+)\b)", carrier.per_wheel))) {
    if (is_per_wheel && !carrier.per_wheel.empty()) {
      ways.push_back(alias);
    }
  }
  return ways;
}

/// Returns the blocks that read or set a member of the carrier.
Names users_of(const Carrier& carrier, const std::string& signal) {
  const bool is_per_wheel = signal.starts_with("wheel.");
  const std::string member = is_per_wheel ? signal.substr(6) : signal;
  Names users;
  for (const auto& [block, text] : code().blocks) {
    for (const std::string& way : ways_to(carrier, is_per_wheel, text)) {
      if (has(text, fmt::format(R"(\b{}\.{}\b)", way, member))) {
        users.insert(text_of(block).number);
      }
    }
  }
  return users;
}

/// True if a block with write access to the carrier also reads one of its members.
bool looks_at(const Carrier& carrier, const std::string& text) {
  for (const std::string& way : ways_to(carrier, true, text)) {
    if (has(text, fmt::format(R"(\b{}\.\w+\b(?!\s*[-+]?=[^=]))", way))) {
      return true;
    }
  }
  return false;
}

Names split(const std::string& numbers) {
  std::istringstream stream(numbers);
  return {std::istream_iterator<std::string>(stream), {}};
}

std::string unit_in_name(const std::string& name) {
  static const std::vector<std::pair<std::string, std::string>> kUnits{{"_A_per_V", "A/V"},
                                                                       {"_V2", "V2"},
                                                                       {"_A2", "A2"},
                                                                       {"_rad_per_s2", "rad/s2"},
                                                                       {"_rad_per_s", "rad/s"},
                                                                       {"_Nm", "N m"},
                                                                       {"_A", "A"},
                                                                       {"_V", "V"},
                                                                       {"_C", "°C"},
                                                                       {"_s", "s"},
                                                                       {"_ratio", "1"}};
  const auto found = std::ranges::find_if(kUnits, [&](const auto& end_and_unit) { return name.ends_with(end_and_unit.first); });
  return found == kUnits.end() ? "" : found->second;
}

const SignalText* row_of(const std::string& carrier, const std::string& name, Block from) {
  const auto row = std::ranges::find_if(
      robot_core::kSignals, [&](const SignalText& each) { return each.carrier == carrier && each.name == name && each.from == from; });
  return row == std::ranges::end(robot_core::kSignals) ? nullptr : &*row;
}

std::string number_of(Block block) { return block == Block::firmware ? "firmware" : text_of(block).number; }

/// Returns the calls of `wanted` functions by `function` of drive_core.cpp in order, including calls through other functions of that file.
std::vector<std::string> calls_of(const std::string& function, const Names& wanted) {
  std::smatch body;
  const std::regex definition(fmt::format(R"(\n[\w:]+(?: [\w:]+)* {}\([^;{{]*\) \{{\n([\s\S]*?)\n\}})", function));
  if (!std::regex_search(code().core, body, definition)) {
    return {};
  }
  std::vector<std::string> calls;
  for (const std::string& call : all_matches(body[1], R"(\b(\w+)\()")) {
    if (wanted.contains(call)) {
      calls.push_back(call);
    } else if (call != function && call != "start") {
      const std::vector<std::string> below = calls_of(call, wanted);
      calls.insert(calls.end(), below.begin(), below.end());
    }
  }
  return calls;
}

TEST(BlockDiagram, StagesAreTheCallsOfStep) {
  const std::vector<std::string> declared = all_matches(code().stages, R"(\n\w+ (\w+)\(const Config& config)");
  // A stage that several branches call counts at its last call.
  std::vector<std::string> expected;
  for (const std::string& call : calls_of("step", {declared.begin(), declared.end()})) {
    std::erase(expected, call);
    expected.push_back(call);
  }
  ASSERT_GE(expected.size(), 8U);
  std::vector<std::string> drawn;
  for (const BlockText& block : robot_core::kBlocks) {
    if (block.block != Block::plan_to_pose) {
      drawn.emplace_back(block.function);
    }
  }
  EXPECT_THAT(drawn, ElementsAreArray(expected));
}

TEST(BlockDiagram, EachFileOfTheCoreBelongsToABlock) {
  Names named{"drive_core.cpp", "drive_config.cpp", "sine_cosine.cpp"};
  for (const BlockText& block : robot_core::kBlocks) {
    const std::vector<std::string> files = all_matches(block.files, R"((\w+\.cpp))");
    ASSERT_FALSE(files.empty());
    EXPECT_TRUE(has(code_of(kCore / files[0]), fmt::format(R"(\b{}\(const Config& config[^;{{]*\) \{{)", block.function)))
        << block.function;
    named.insert(files.begin(), files.end());
  }
  for (const auto& entry : std::filesystem::directory_iterator(kCore)) {
    const std::string file = entry.path().filename().string();
    // The planner names its interface only; its other files start with the same word. The memory over power-off is not part of the step.
    EXPECT_TRUE(!file.ends_with(".cpp") || named.contains(file) || file.starts_with("trajectory_") || file == "guard_memory.cpp")
        << file << " is of no block";
  }
}

TEST(BlockDiagram, UnitsAreThoseOfTheNames) {
  for (const SignalText& signal : robot_core::kSignals) {
    const std::string unit = unit_in_name(signal.name);
    if (!unit.empty()) {
      EXPECT_EQ(unit, signal.unit) << signal.name;
    } else {
      EXPECT_THAT(signal.unit, testing::MatchesRegex("flag|code|count|m/s, rad/s|m/s2, rad/s2|N, N m|m, rad")) << signal.name;
    }
  }
}

// The other tests look for these names, so another name or a copy of the same object would hide a reader.
TEST(BlockDiagram, EachObjectHasOneName) {
  std::vector<Carrier> objects = kCarriers;
  objects.push_back({"Input", "input", ""});
  objects.push_back({"State", "state", ""});
  for (const auto& [block, text] : code().blocks) {
    for (const Carrier& object : objects) {
      // References and parameters of its type, copies, and names that the compiler gives a type.
      Names names;
      for (const char* const pattern : {R"(\b{0}\s*[&*]+\s*(\w+)\b)", R"(\b{0}\s+(\w+)\s*(?:=|\{{)\s*{1}\b)", R"(\b{0}\s+(\w+)\s*[,)])",
                                        R"(\bauto[\s&*]+(\w+)\s*=\s*&?{1}\b\s*(?:;|\.(?:wheel|guard|comparison|command)\b[^.;]*;))"}) {
        const std::vector<std::string> found = all_matches(text, fmt::format(fmt::runtime(pattern), object.name, object.variable));
        names.insert(found.begin(), found.end());
      }
      names.erase(object.variable);
      EXPECT_THAT(names, testing::IsEmpty()) << object.name << " in " << text_of(block).number;
    }
  }
}

// Checks both directions: the table must contain all signals between stages with their readers, and no others.
TEST(BlockDiagram, SignalsBetweenStagesAreThoseOfTheCode) {
  std::size_t rows = 0;
  for (const Carrier& carrier : kCarriers) {
    for (const std::string& name : signals_in(carrier.name, carrier.per_wheel, "wheel")) {
      const Names used = users_of(carrier, name);
      Names drawn;
      for (const SignalText& each : robot_core::kSignals) {
        if (each.carrier == carrier.name && each.name == name) {
          const Names readers = split(numbers_of(each.to));
          drawn.insert(readers.begin(), readers.end());
          drawn.insert(number_of(each.from));
          ++rows;
        }
      }
      // A member that only its own block uses is no signal.
      EXPECT_EQ(drawn, used.size() > 1 ? used : Names{}) << carrier.name << " " << name;
    }
  }
  const auto is_of_stage = [](const SignalText& each) {
    return std::ranges::any_of(kCarriers, [&](const Carrier& carrier) { return carrier.name == each.carrier; });
  };
  EXPECT_EQ(rows, static_cast<std::size_t>(std::ranges::count_if(robot_core::kSignals, is_of_stage)));
}

TEST(BlockDiagram, SignalsBetweenStagesComeFromWhereTheyAreReturned) {
  for (const Carrier& carrier : kCarriers) {
    Names writers;
    Names readers;
    for (const BlockText& block : robot_core::kBlocks) {
      const std::string declaration = block.function + std::string(R"(\([^;{]*)");
      const bool returns = has(code().stages, fmt::format(R"(\n{} {})", carrier.name, declaration));
      const bool reads = has(code().stages, fmt::format(R"(\b{}\bconst {}& {})", declaration, carrier.name, carrier.variable));
      const bool changes = has(code().stages, fmt::format(R"(\b{}[,(]\s*{}& {})", declaration, carrier.name, carrier.variable));
      const bool changes_and_reads = changes && looks_at(carrier, code().blocks.at(block.block));
      if (returns || changes) {
        writers.insert(block.number);
      }
      if (reads || changes_and_reads) {
        readers.insert(block.number);
      }
    }
    Names drawn_writers;
    Names drawn_readers;
    for (const SignalGroup& group : signal_groups()) {
      if (group.carrier == carrier.name) {
        drawn_writers.insert(number_of(group.from));
        const Names numbers = split(numbers_of(group.readers()));
        drawn_readers.insert(numbers.begin(), numbers.end());
      }
    }
    EXPECT_EQ(drawn_writers, writers) << carrier.name;
    EXPECT_EQ(drawn_readers, readers) << carrier.name;
  }
}

TEST(BlockDiagram, InputsAreReadWhereTheTableSays) {
  std::size_t rows = 0;
  for (const std::string& name : signals_in("Input", "Command", "command")) {
    Names used;
    for (const auto& [block, text] : code().blocks) {
      static const std::regex kPlan(R"(plan_step\([^;{]*\))");
      std::smatch plan;
      const bool is_planned = std::regex_search(text, plan, kPlan) && has(plan.str(), fmt::format(R"(\binput\.{}\b)", name));
      const std::string own = std::regex_replace(text, kPlan, "");
      bool is_read = has(own, fmt::format(R"(\binput\.{}\b)", name));
      for (const std::string& alias : all_matches(own, R"(\bCommand\b[\s&*]+(\w+)\b)")) {
        is_read = is_read || (name.starts_with("command.") && has(own, fmt::format(R"(\b{}\.{}\b)", alias, name.substr(8))));
      }
      if (is_read) {
        used.insert(text_of(block).number);
      }
      if (is_planned) {
        used.insert(text_of(Block::plan_to_pose).number);
      }
    }
    const SignalText* const row = row_of("Input", name, Block::firmware);
    ASSERT_NE(row, nullptr) << name;
    EXPECT_EQ(split(numbers_of(row->to)), used) << name;
    ++rows;
  }
  EXPECT_EQ(rows, static_cast<std::size_t>(std::ranges::count(robot_core::kSignals, std::string_view("Input"), &SignalText::carrier)));
}

TEST(BlockDiagram, OutputsAreThoseOfTheCode) {
  Names drawn;
  for (const SignalText& signal : robot_core::kSignals) {
    if (signal.carrier == std::string_view("Output")) {
      EXPECT_EQ(signal.from, Block::make_output);
      EXPECT_EQ(numbers_of(signal.to), "firmware");
      EXPECT_TRUE(has(code().blocks.at(Block::make_output), fmt::format(R"(\bout\.{}\b)", signal.name))) << signal.name;
      drawn.insert(signal.name);
    }
  }
  const std::vector<std::string>& members = code().structs.at("Output");
  EXPECT_EQ(drawn, Names(members.begin(), members.end()));
}

/// An object in State: prefix of its members in the table, its struct, and a pattern of the expression that reaches it.
struct KeptObject {
  std::string prefix;
  std::string name;
  std::string expression;
};
const std::vector<KeptObject> kKept{{"", "State", R"(\bstate)"},
                                    {"wheel.", "WheelState", R"(\bstate\.wheel\[\w+\])"},
                                    {"comparison.", "ComparisonState", R"(\bstate\.comparison)"},
                                    {"guard.", "GuardState", R"(\bstate\.guard\[\w+\])"}};

/// Returns the blocks that use a member of an object in State, by the object's expression or through a reference of its type.
Names blocks_with(const KeptObject& object, const std::string& member) {
  Names users;
  for (const auto& [block, text] : code().blocks) {
    std::vector<std::string> ways{object.expression};
    for (const std::string& alias : all_matches(text, fmt::format(R"(\b{}\b[\s&*]+(\w+)\b)", object.name))) {
      ways.push_back(R"(\b)" + alias);
    }
    if (std::ranges::any_of(ways, [&](const std::string& way) { return has(text, fmt::format(R"({}\.{}\b)", way, member)); })) {
      users.insert(text_of(block).number);
    }
  }
  return users;
}

TEST(BlockDiagram, WhatBlocksKeepForEachOtherIsInTheTable) {
  for (const SignalText& signal : robot_core::kSignals) {
    if (signal.carrier != std::string_view("State")) {
      continue;
    }
    const std::string name = signal.name;
    const std::string member = name.substr(name.rfind('.') + 1);
    const std::string from =
        signal.from == Block::plan_to_pose ? code().blocks.at(Block::control_body_velocity) : code().blocks.at(signal.from);
    const std::string planned = fmt::format(R"(plan_step\([^;{{]*\.{}\b)", member);
    const std::string assigned = fmt::format(R"(\.{}(\[\w+\])?\s*(=[^=]|[-+*]=))", member);
    EXPECT_TRUE(has(from, member.starts_with("plan_") ? planned : assigned)) << signal.name;
  }
  std::size_t shared = 0;
  for (const KeptObject& object : kKept) {
    for (const std::string& member : code().structs.at(object.name)) {
      const std::string name = object.prefix + member;
      const bool is_struct = std::ranges::any_of(
          robot_core::kSignals, [&](const SignalText& each) { return std::string_view(each.name).starts_with(name + "."); });
      if (is_struct || name == "steps") {
        continue;  // drawn by its members; step() itself counts the steps
      }
      const Names used = blocks_with(object, member);
      Names drawn;
      for (const SignalText& each : robot_core::kSignals) {
        if (each.carrier == std::string_view("State") && each.name == name && each.from != Block::plan_to_pose) {
          const Names readers = split(numbers_of(each.to));
          drawn.insert(readers.begin(), readers.end());
          drawn.insert(number_of(each.from));
        }
      }
      EXPECT_EQ(drawn, used.size() > 1 ? used : Names{}) << name;
      shared += used.size() > 1 ? 1 : 0;
    }
  }
  EXPECT_GE(shared, 15U);
}

int guard_runs = 0;
int plan_runs = 0;

// Counts calls to check the rates stated in the blocks.
TEST(BlockDiagram, RatesAreThoseOfTheCore) {
  const float axis[] = {0.0F, 100.0F};
  const float hot_C[] = {0.0F, 155.0F};
  const float most_A2[] = {81.0F, 81.0F, 81.0F, 81.0F, 81.0F, 81.0F, 81.0F, 81.0F};
  robot_core::GuardModel guard;
  guard.node_count = 2;
  guard.period_s = 0.01F;
  guard.winding_limit_C = 155.0F;
  guard.hottest_ambient_C = 40.0F;
  guard.resting_C[0] = guard.resting_C[1] = 40.0F;
  guard.most_current_A = 9.0F;
  guard.cold_current_A = 9.0F;
  guard.table = {.speed_rad_per_s = {axis, 2},
                 .stator_C = {hot_C, 2},
                 .winding_C = {hot_C, 2},
                 .heat_per_ohm_A2 = most_A2,
                 .resistance_at_0C_ratio = 1.0F,
                 .resistance_ratio_per_K = 0.0F,
                 .most_current_A = 9.0F,
                 .straight_below_A = 0.1F,
                 .most_speed_rad_per_s = 100.0F,
                 .no_current_speed_rad_per_s = 110.0F,
                 .winding_per_stator_K = 1.0F};
  guard.rates = [](const void*, const float*, const float*, float* rate_K_per_s) {
    ++guard_runs;
    rate_K_per_s[0] = rate_K_per_s[1] = 0.0F;
  };
  robot_core::Config config = make_core_config(twente(), ecx_32().nominal, {});
  config.guard = &guard;
  config.plan_step = [](const robot_core::Config&, const robot_core::Vector3&, const robot_core::Vector3&, robot_core::Vector3&,
                        robot_core::Vector3&) {
    ++plan_runs;
    return true;
  };
  robot_core::complete(config);
  robot_core::State state{};
  ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
  robot_core::Input input;
  input.elapsed_s = config.period_s;
  input.battery_V = 22.0F;
  input.pose = {0.0F, 0.0F, 0.0F};
  const auto run = [&](robot_core::Mode mode) {
    guard_runs = plan_runs = 0;
    input.command.mode = mode;
    for (int i = 0; i < 1000; ++i) {
      robot_core::step(config, state, input);
    }
  };
  run(robot_core::Mode::body_velocity);
  EXPECT_EQ(guard_runs, 4 * 1000 / 10);
  EXPECT_EQ(plan_runs, 0);
  run(robot_core::Mode::pose_target);
  EXPECT_EQ(plan_runs, 1000);
  // The motion limits are reached only after many steps, so that each new reference differs from the last one.
  int references = 0;
  robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F});
  input.command.mode = robot_core::Mode::body_velocity;
  input.command.velocity.x = 1.0F;
  for (int i = 0; i < 40; ++i) {
    const float before_m_per_s = state.velocity_reference.x;
    robot_core::step(config, state, input);
    references += state.velocity_reference.x != before_m_per_s ? 1 : 0;
  }
  EXPECT_EQ(references, 20);
  for (const Block block : {Block::control_body_velocity, Block::find_wheel_speeds, Block::feed_forward}) {
    EXPECT_EQ(text_of(block).rate, robot_core::BlockRate::every_second_period);
  }
  EXPECT_EQ(text_of(Block::run_guards).rate, robot_core::BlockRate::every_guard_period);
  EXPECT_EQ(text_of(Block::plan_to_pose).rate, robot_core::BlockRate::every_period_of_command);
}

}  // namespace
}  // namespace heatsoak::firmware
