// The planner under QEMU, compared byte for byte with the host's build of the same source.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "core_graph.h"
#include "emulator.h"
#include "image/planner_records.h"
#include "robot_core/port/instruction_counter.h"

namespace heatsoak::target {
namespace {

using robot_core::PlanResult;

/// Returns a random state on the field: mostly moving, sometimes beyond its limits, at rest or with an unreachable target.
PlannerRecord random_record(std::mt19937_64& random) {
  const auto uniform = [&random](double low, double high) {
    return static_cast<float>(std::uniform_real_distribution<double>(low, high)(random));
  };
  PlannerRecord record{};
  record.plane = {uniform(1, 3.5), uniform(1, 5), uniform(5, 60)};
  record.yaw = robot_core::AxisLimits<float>::symmetric(uniform(5, 20), uniform(20, 60), uniform(100, 600));
  const float hurry = uniform(0, 1.1);
  for (int axis = 0; axis < 3; ++axis) {
    const float speed = hurry * (axis == 2 ? record.yaw.velocity_max : record.plane.speed_max);
    const float acceleration = hurry * (axis == 2 ? record.yaw.acceleration_max : record.plane.acceleration_max);
    record.start[axis] = {uniform(-6, 6), speed * uniform(-1, 1), acceleration * uniform(-1, 1)};
    record.target[axis] = {uniform(-6, 6), uniform(0, 1) < 0.5F ? 0.0F : speed * uniform(-1, 1), 0.0F};
  }
  record.how = uniform(0, 1) < 0.3F ? 1 : 0;
  return record;
}

std::vector<PlannerRecord> random_records(int count) {
  std::mt19937_64 random(31);
  std::vector<PlannerRecord> records;
  for (int i = 0; i < count; ++i) {
    records.push_back(random_record(random));
  }
  return records;
}

class PlannerOnTarget : public testing::Test {
 protected:
  static constexpr int kRecords = 3000;
  const std::vector<PlannerRecord> records_ = random_records(kRecords);
};

TEST_F(PlannerOnTarget, AgreesWithTheHostBitForBit) {
  SKIP_WITHOUT_EMULATOR();
  const Replay target = replay(HEATSOAK_PLANNER_IMAGE, bytes_of(records_));
  ASSERT_EQ(target.summary.record_count, records_.size());
  ASSERT_EQ(target.summary.record_size, sizeof(PlannerRecord));
  ASSERT_EQ(target.summary.result_size, sizeof(PlannerResult));
  std::vector<PlannerResult> host(records_.size());
  int planned = 0;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    run_planner(records_[i], host[i]);
    clear_unused(host[i]);
    planned += host[i].result == static_cast<int>(PlanResult::ok) ? 1 : 0;
  }
  EXPECT_GT(planned, kRecords / 2);
  EXPECT_LT(planned, kRecords);
  const std::string expected = bytes_of(host);
  ASSERT_EQ(target.output.size(), expected.size());
  EXPECT_EQ(first_difference(target.output, expected, sizeof(PlannerResult)), records_.size());
  RecordProperty("mean_instructions", std::to_string(target.mean_instructions()));
  RecordProperty("most_instructions", std::to_string(target.most_instructions()));
}

TEST_F(PlannerOnTarget, InstructionsAreCounted) {
  SKIP_WITHOUT_EMULATOR();
  const Replay first = replay(HEATSOAK_PLANNER_IMAGE, bytes_of(records_));
  EXPECT_EQ(first.summary.known_loop_instructions, kLoopInstructions);
  ASSERT_EQ(first.instructions.size(), records_.size());
  // The count must be repeatable and independent of earlier records.
  const std::vector<PlannerRecord> reversed(records_.rbegin(), records_.rend());
  std::vector<std::uint32_t> again = replay(HEATSOAK_PLANNER_IMAGE, bytes_of(reversed)).instructions;
  std::ranges::reverse(again);
  EXPECT_EQ(first.instructions, again);
  EXPECT_LT(first.most_instructions(), robot_core::port::kTooManyInstructions);
}

TEST_F(PlannerOnTarget, StackStaysBelowTheSumAlongTheDeepestCalls) {
  SKIP_WITHOUT_EMULATOR();
  const CallGraph::Depth depth = depth_of_only(core_graph(HEATSOAK_PLANNER_IMAGE_CALL_GRAPHS), "run_planner");
  const std::size_t measured = replay(HEATSOAK_PLANNER_IMAGE, bytes_of(records_)).summary.most_stack_bytes;
  EXPECT_LE(measured, depth.bytes);
  // Common problems use the deep paths too: a sum far above the measured stack would count functions that are never called.
  EXPECT_GE(2 * measured, depth.bytes) << testing::PrintToString(depth.path);
  RecordProperty("stack_bytes", std::to_string(measured));
  RecordProperty("stack_bound_bytes", std::to_string(depth.bytes));
}

}  // namespace
}  // namespace heatsoak::target
