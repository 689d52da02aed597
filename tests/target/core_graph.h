// Call graph of the drive core's build for the target.
#pragma once

#include <string>

#include "call_graph.h"

namespace heatsoak::target {

/// `files` are the .ci files of the program besides the core's own. `rates` is the mangled name of the thermal law, `planner` that of
/// Config::plan_step; empty without pose targets. Fails the test where a function calls through a pointer that is not known here.
CallGraph core_graph(const std::string& files, const std::string& rates = "", const std::string& planner = "");

/// Of the only function with this part in its mangled name. Fails the test where that is not one, or its stack has no bound.
CallGraph::Depth depth_of_only(const CallGraph& graph, const std::string& part);

}  // namespace heatsoak::target
