// Call graph of the drive core built for the target.
#pragma once

#include <string>

#include "call_graph.h"

namespace heatsoak::target {

/// `files`: .ci files of the program in addition to the core's own. `rates`: mangled name of the thermal law. `planner`: mangled name of
/// Config::plan_step, empty without pose targets; with it Config::predict_pose is called, too. Fails the test if a function calls through
/// an unknown pointer.
CallGraph core_graph(const std::string& files, const std::string& rates = "", const std::string& planner = "");

/// Depth of the only function with `part` in its mangled name. Fails the test if there is not exactly one or its stack is unbounded.
CallGraph::Depth depth_of_only(const CallGraph& graph, const std::string& part);

}  // namespace heatsoak::target
