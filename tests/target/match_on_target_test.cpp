// A minute of a recorded match on the target, without and with current sensors: results bit for bit against the closed loop on the host;
// instructions, memory and stack against their budgets. See match/record_match.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core_graph.h"
#include "drive_budgets.h"
#include "emulator.h"
#include "image/drive_records.h"

namespace heatsoak::target {
namespace {

using robot_core::Input;

const std::string kMatch = HEATSOAK_MATCH "/";

std::vector<Input> recorded_inputs(const std::string& name) {
  const std::string bytes = content_of(kMatch + name + "_input.bin");
  std::vector<Input> inputs(bytes.size() / sizeof(Input));
  std::memcpy(inputs.data(), bytes.data(), inputs.size() * sizeof(Input));
  return inputs;
}

const Replay& replayed(const std::string& name) {
  static std::map<std::string, Replay> replays;
  if (!replays.contains(name)) {
    replays[name] = replay(HEATSOAK_MATCH_IMAGE, content_of(kMatch + name + "_input.bin"), content_of(kMatch + name + "_start.bin"));
  }
  return replays[name];
}

/// The parameter is the name of the record: "match" or "sensed".
class MatchOnTarget : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Records, MatchOnTarget, testing::Values("match", "sensed"), [](const auto& each) { return each.param; });

TEST_P(MatchOnTarget, RecordIsAMinuteOfPlayWithADuel) {
  SKIP_WITHOUT_COMPILER();
  const std::vector<Input> inputs = recorded_inputs(GetParam());
  ASSERT_EQ(inputs.size(), 60000U);
  const bool is_sensed = std::string(GetParam()) == "sensed";
  int moving = 0;
  int pushing = 0;
  long currents = 0;
  for (const Input& input : inputs) {
    const robot_core::Command& command = input.command;
    moving += command.mode == robot_core::Mode::body_velocity && std::hypot(command.velocity.x, command.velocity.y) > 0.5F ? 1 : 0;
    pushing += std::hypot(command.push.x, command.push.y) > 1.0F ? 1 : 0;
    currents += std::ranges::count_if(input.motor_current_A, [](float current_A) { return std::isfinite(current_A); });
  }
  EXPECT_GT(moving, 20000);
  EXPECT_GT(pushing, 1000);
  EXPECT_EQ(currents, is_sensed ? 4L * 60000L : 0L);
}

TEST_P(MatchOnTarget, OutputsAndStateAgreeBitForBit) {
  SKIP_WITHOUT_EMULATOR();
  const Replay& target = replayed(GetParam());
  const std::string expected = content_of(kMatch + GetParam() + "_output.bin");
  ASSERT_EQ(target.summary.record_size, sizeof(Input));
  ASSERT_EQ(target.summary.result_size, sizeof(DriveResult));
  ASSERT_EQ(target.output.size(), expected.size());
  EXPECT_EQ(first_difference(target.output, expected, sizeof(DriveResult)), target.summary.record_count);
  std::set<std::uint32_t> digests;
  for (std::size_t at = 0; at < expected.size(); at += sizeof(DriveResult)) {
    DriveResult result;
    std::memcpy(&result, expected.data() + at, sizeof(result));
    digests.insert(result.state_digest);
    for (const std::uint8_t reason : result.reason) {
      // No sensor of the recorded match fails.
      EXPECT_TRUE(reason < 110 || reason > 141) << "reason " << int{reason} << " in step " << at / sizeof(DriveResult);
    }
  }
  EXPECT_GT(digests.size(), expected.size() / sizeof(DriveResult) / 2);
}

TEST_P(MatchOnTarget, InstructionsStayWithinTheBudget) {
  SKIP_WITHOUT_EMULATOR();
  const Replay& target = replayed(GetParam());
  ASSERT_EQ(target.summary.known_loop_instructions, kLoopInstructions);
  ASSERT_EQ(target.instructions.size(), 60000U);
  EXPECT_LE(target.mean_instructions(), kMeanInstructions);
  const auto most = std::ranges::max_element(target.instructions);
  EXPECT_LE(*most, kMostInstructions) << "in step " << most - target.instructions.begin();
  RecordProperty("mean_instructions", std::to_string(target.mean_instructions()));
  RecordProperty("most_instructions", std::to_string(*most));
}

TEST_P(MatchOnTarget, ARestartStaysWithinTheBudget) {
  SKIP_WITHOUT_EMULATOR();
  constexpr std::size_t kSteps = 200;
  MatchStart start;
  const std::string recorded = content_of(kMatch + GetParam() + "_start.bin");
  ASSERT_EQ(recorded.size(), sizeof(start));
  std::memcpy(&start, recorded.data(), sizeof(start));
  start.state.wheel[2].integral_V += 1.0F;
  std::vector<Input> inputs = recorded_inputs(GetParam());
  inputs.resize(kSteps);
  const Replay target = replay(HEATSOAK_MATCH_IMAGE, bytes_of(inputs), bytes_of(std::vector<MatchStart>{start}));
  ASSERT_EQ(target.output.size(), kSteps * sizeof(DriveResult));
  DriveResult first;
  std::memcpy(&first, target.output.data(), sizeof(first));
  EXPECT_EQ(first.robot_reason, static_cast<std::uint8_t>(robot_core::Reason::state_corrupted));
  EXPECT_EQ(std::ranges::count(first.is_open, 1), robot_core::kMostWheels);
  EXPECT_LE(target.most_instructions(), kMostInstructions);
  RecordProperty("restart_instructions", std::to_string(target.instructions.front()));
}

TEST_P(MatchOnTarget, MemoryStaysWithinTheBudget) {
  SKIP_WITHOUT_EMULATOR();
  EXPECT_LE(replayed(GetParam()).summary.memory_bytes, kMostMemory_bytes);
  EXPECT_LE(replayed(GetParam()).summary.most_stack_bytes, kMostStack_bytes);
  RecordProperty("memory_bytes", std::to_string(replayed(GetParam()).summary.memory_bytes));
  RecordProperty("stack_bytes", std::to_string(replayed(GetParam()).summary.most_stack_bytes));
}

}  // namespace
}  // namespace heatsoak::target
