#include "core_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace heatsoak::target {
namespace {

/// Recursion depth of most_square() in trajectory_circle.h, which halves a segment up to kHalvings times.
constexpr std::size_t kHalvings = 10;

/// Returns a set of one name; empty for an empty name.
std::set<std::string> named(const std::string& name) { return name.empty() ? std::set<std::string>{} : std::set<std::string>{name}; }

}  // namespace

CallGraph core_graph(const std::string& files, const std::string& rates, const std::string& planner) {
  CallGraph graph = call_graph_of(files.empty() ? HEATSOAK_TARGET_CALL_GRAPHS : HEATSOAK_TARGET_CALL_GRAPHS ":" + files);
  for (const std::string& caller : graph.names_with("most_square")) {
    graph.bound_recursion_of(caller, kHalvings + 1);
  }
  const std::vector<std::string> predictor = graph.names_with("predict_pose");
  EXPECT_EQ(predictor.size(), 1U);
  for (const std::string& caller : graph.callers_through_pointers()) {
    if (caller.find("replay") != std::string::npos) {
      continue;  // belongs to the test program, which calls the core
    }
    const bool is_planner = caller.find("control_body_velocity") != std::string::npos || caller.find("follow_command") != std::string::npos;
    const bool is_guard = caller.find("guard") != std::string::npos || caller.find("hottest") != std::string::npos ||
                          caller.find("rates_of_any_age") != std::string::npos;
    EXPECT_TRUE(is_planner != is_guard) << caller << " calls through a pointer that this test does not know";
    std::set<std::string> targets = named(is_planner ? planner : rates);
    if (is_planner && !planner.empty()) {
      targets.insert(predictor.begin(), predictor.end());
    }
    graph.resolve_pointers_of(caller, targets);
  }
  return graph;
}

CallGraph::Depth depth_of_only(const CallGraph& graph, const std::string& part) {
  const std::vector<std::string> names = graph.names_with(part);
  EXPECT_EQ(names.size(), 1U) << part << ": " << testing::PrintToString(names);
  const CallGraph::Depth depth = graph.depth_of(names.empty() ? part : names[0]);
  EXPECT_THAT(depth.problems, testing::IsEmpty());
  return depth;
}

}  // namespace heatsoak::target
