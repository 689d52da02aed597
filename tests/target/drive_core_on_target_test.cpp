// The drive core under QEMU, compared byte for byte with the host's build of the same source, and its memory and code size.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "core_graph.h"
#include "drive_budgets.h"
#include "drive_stream.h"
#include "emulator.h"

namespace heatsoak::target {
namespace {

using robot_core::Input;
using robot_core::Reason;

/// Returns the results of the host's build for the same inputs.
std::vector<DriveResult> on_host(const std::vector<Input>& inputs) {
  DriveRun run{};
  begin(run);
  std::vector<DriveResult> results(inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    run.output = robot_core::step(run.config, run.state, inputs[i]);
    copy_output(run.output, run.state, results[i]);
  }
  return results;
}

void expect_same(const Replay& target, const std::vector<Input>& inputs, const std::vector<DriveResult>& host) {
  ASSERT_EQ(target.summary.record_count, inputs.size());
  ASSERT_EQ(target.summary.record_size, sizeof(Input));
  ASSERT_EQ(target.summary.result_size, sizeof(DriveResult));
  ASSERT_EQ(target.summary.known_loop_instructions, kLoopInstructions);
  const std::string expected = bytes_of(host);
  ASSERT_EQ(target.output.size(), expected.size());
  EXPECT_EQ(first_difference(target.output, expected, sizeof(DriveResult)), inputs.size());
}

/// Checks mean and worst step, and records both under names with this end.
void expect_within_budget(const Replay& target, double mean_instructions, const std::string& end) {
  EXPECT_LE(target.mean_instructions(), mean_instructions) << end;
  const auto most = std::ranges::max_element(target.instructions);
  ASSERT_NE(most, target.instructions.end());
  EXPECT_LE(*most, kMostInstructions) << end << " in step " << most - target.instructions.begin();
  testing::Test::RecordProperty("mean_instructions" + end, std::to_string(target.mean_instructions()));
  testing::Test::RecordProperty("most_instructions" + end, std::to_string(*most));
}

double mean_before_faults(const Replay& target) {
  const auto faults = target.instructions.begin() + static_cast<std::ptrdiff_t>(target.instructions.size() / 3 * 2);
  return std::accumulate(target.instructions.begin(), faults, 0.0) / static_cast<double>(faults - target.instructions.begin());
}

std::set<Reason> reasons_of(const std::vector<DriveResult>& results) {
  std::set<Reason> reasons;
  for (const DriveResult& result : results) {
    reasons.insert(static_cast<Reason>(result.robot_reason));
    for (const std::uint8_t reason : result.reason) {
      reasons.insert(static_cast<Reason>(reason));
    }
  }
  return reasons;
}

std::string name_of_only(const CallGraph& graph, const std::string& part) {
  const std::vector<std::string> names = graph.names_with(part);
  EXPECT_EQ(names.size(), 1U) << part << ": " << testing::PrintToString(names);
  return names.empty() ? part : names[0];
}

// Mangled name of the overload that writes into the caller's output.
constexpr const char* kStep = "_ZN10robot_core4stepERKNS_6ConfigERNS_5StateERKNS_5InputERNS_6OutputE";
constexpr const char* kStepOfImage = "run_step";
constexpr const char* kRates = "5ratesEPKv";

/// Depth of robot_core::step() or of the image's function that calls it, with or without the functions of a pose target.
CallGraph::Depth depth_of_step(const std::string& function, bool with_planner) {
  const CallGraph names = call_graph_of(HEATSOAK_TARGET_CALL_GRAPHS ":" HEATSOAK_DRIVE_IMAGE_CALL_GRAPHS);
  const std::string rates = name_of_only(names, kRates);
  const std::string planner = with_planner ? name_of_only(names, "plan_to_pose") : "";
  return depth_of_only(core_graph(HEATSOAK_DRIVE_IMAGE_CALL_GRAPHS, rates, planner), function);
}

TEST(DriveCoreOnTarget, MinuteOfPlayAgreesBitForBit) {
  SKIP_WITHOUT_EMULATOR();
  const std::vector<Input> inputs = minute_of_play(1, Play::usual);
  const std::vector<DriveResult> host = on_host(inputs);
  const std::set<Reason> reasons = reasons_of(host);
  for (const Reason reason : {Reason::none, Reason::driver_current, Reason::traction, Reason::guard, Reason::other_wheel, Reason::time_jump,
                              Reason::command_stale, Reason::wheel_speed_missing, Reason::battery_voltage_missing, Reason::yaw_rate_missing,
                              Reason::ambient_missing}) {
    EXPECT_TRUE(reasons.contains(reason)) << "the inputs never lead to " << static_cast<int>(reason);
  }
  const Replay target = replay(HEATSOAK_DRIVE_IMAGE, bytes_of(inputs));
  expect_same(target, inputs, host);
  EXPECT_LE(target.summary.memory_bytes, kMostMemory_bytes);
  const CallGraph::Depth depth = depth_of_step(kStepOfImage, false);
  EXPECT_LE(target.summary.most_stack_bytes, depth.bytes) << testing::PrintToString(depth.path);
  expect_within_budget(target, kMeanInstructionsWithFaults, "");
  EXPECT_LE(mean_before_faults(target), kMeanInstructions);
  RecordProperty("memory_bytes", std::to_string(target.summary.memory_bytes));
  RecordProperty("mean_instructions_before_faults", std::to_string(mean_before_faults(target)));
  RecordProperty("stack_bytes", std::to_string(target.summary.most_stack_bytes));
}

// Minutes with more work than that of seed 1: in the mean before the faults (4), and in the worst step (7).
TEST(DriveCoreOnTarget, OtherMinutesStayWithinTheBudget) {
  SKIP_WITHOUT_EMULATOR();
  for (const unsigned seed : {4U, 7U}) {
    const std::vector<Input> inputs = minute_of_play(seed, Play::usual);
    const Replay target = replay(HEATSOAK_DRIVE_IMAGE, bytes_of(inputs));
    expect_same(target, inputs, on_host(inputs));
    expect_within_budget(target, kMeanInstructionsWithFaults, "_" + std::to_string(seed));
    EXPECT_LE(mean_before_faults(target), kMeanInstructions) << seed;
  }
}

TEST(DriveCoreOnTarget, LostWheelSensorStaysWithinTheBudget) {
  SKIP_WITHOUT_EMULATOR();
  const std::vector<Input> inputs = minute_of_play(1, Play::lost_wheel_sensor);
  const std::vector<DriveResult> host = on_host(inputs);
  EXPECT_EQ(host.back().reason[3], static_cast<std::uint8_t>(Reason::wheel_speed_missing));
  const Replay target = replay(HEATSOAK_DRIVE_IMAGE, bytes_of(inputs));
  expect_same(target, inputs, host);
  expect_within_budget(target, kMeanInstructionsLostSensor, "");
}

TEST(DriveCoreOnTarget, LateStepsStayWithinTheBudget) {
  SKIP_WITHOUT_EMULATOR();
  for (const unsigned seed : {1U, 2U, 3U}) {
    const std::vector<Input> inputs = minute_of_play(seed, Play::late_steps);
    const Replay target = replay(HEATSOAK_DRIVE_IMAGE, bytes_of(inputs));
    expect_same(target, inputs, on_host(inputs));
    expect_within_budget(target, kMeanInstructionsLate, "_" + std::to_string(seed));
  }
}

TEST(DriveCoreOnTarget, PoseTargetsAgreeBitForBit) {
  SKIP_WITHOUT_EMULATOR();
  std::vector<Input> inputs = minute_of_play(1, Play::pose_targets);
  inputs.resize(inputs.size() / 10);  // fewer inputs, because the planner is slow
  const Replay target = replay(HEATSOAK_DRIVE_IMAGE, bytes_of(inputs));
  expect_same(target, inputs, on_host(inputs));
  const CallGraph::Depth depth = depth_of_step(kStepOfImage, true);
  EXPECT_LE(target.summary.most_stack_bytes, depth.bytes) << testing::PrintToString(depth.path);
  RecordProperty("mean_instructions", std::to_string(target.mean_instructions()));
  RecordProperty("most_instructions", std::to_string(target.most_instructions()));
  RecordProperty("stack_bytes", std::to_string(target.summary.most_stack_bytes));
  RecordProperty("stack_bound_bytes", std::to_string(depth.bytes));
}

TEST(DriveCoreOnTarget, StackIsBounded) {
  SKIP_WITHOUT_COMPILER();
  const CallGraph::Depth depth = depth_of_step(kStep, false);
  EXPECT_LE(depth.bytes, kMostStack_bytes) << testing::PrintToString(depth.path);
  RecordProperty("stack_bound_bytes", std::to_string(depth.bytes));
}

TEST(DriveCoreOnTarget, CodeAndConstantsAreSmall) {
  SKIP_WITHOUT_COMPILER();
  const TemporaryFolder folder;
  const CallGraph names = call_graph_of(HEATSOAK_TARGET_CALL_GRAPHS);
  const Words roots{name_of_only(names, kStep), name_of_only(names, "_ZN10robot_core5startE")};
  const std::string object = linked_object(folder, HEATSOAK_TARGET_LIBRARY, roots);
  const std::string defined = output_of_tool("nm", {"-C", "--defined-only", object});
  EXPECT_NE(defined.find("robot_core::step_guard"), std::string::npos);
  EXPECT_EQ(defined.find("plan_plane"), std::string::npos) << "step() needs no planner";
  EXPECT_THAT(undefined_names(object), testing::IsSubsetOf(std::vector<std::string>{"memcpy", "memset"}));
  const std::uint64_t core_bytes = section_bytes(object, {".text", ".rodata", ".data"});
  // Law and tables of the motor, which are generated for each robot.
  const std::uint64_t guard_bytes = section_bytes(HEATSOAK_MOTOR_GUARD_OBJECT, {".text", ".rodata", ".data"});
  EXPECT_GT(guard_bytes, 300U) << "a law and a table";
  EXPECT_LE(core_bytes + guard_bytes, kMostCode_bytes);
  RecordProperty("core_bytes", std::to_string(core_bytes));
  RecordProperty("guard_bytes", std::to_string(guard_bytes));
}

}  // namespace
}  // namespace heatsoak::target
