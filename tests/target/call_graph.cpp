#include "call_graph.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace heatsoak::target {
namespace {

/// Removes the file from a name. GCC writes file-local and weak functions as "file:name".
std::string without_file(const std::string& title) {
  const std::size_t colon = title.rfind(':');
  return colon == std::string::npos ? title : title.substr(colon + 1);
}

}  // namespace

/// State of one search.
struct CallGraph::Walk {
  std::map<std::string, std::size_t> known;  // bytes of finished functions
  std::map<std::string, std::string> next;   // the deepest callee
  std::set<std::string> open;                // functions on the present path
  std::set<std::string> problems;
};

void CallGraph::add(std::string_view callgraph) {
  static const std::regex kNode(R"re(^node: \{ title: "([^"]*)" label: "([^"]*)")re");
  static const std::regex kEdge(R"re(^edge: \{ sourcename: "([^"]*)" targetname: "([^"]*)")re");
  static const std::regex kFrame(R"((\d+) bytes \((static|dynamic|dynamic,bounded)\))");
  std::istringstream stream{std::string(callgraph)};
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (std::regex_search(line, match, kEdge)) {
      functions_[without_file(match[1])].calls.insert(without_file(match[2]));
    } else if (std::regex_search(line, match, kNode)) {
      Function& function = functions_[without_file(match[1])];
      const std::string label = match[2];
      if (std::smatch frame; std::regex_search(label, frame, kFrame)) {
        function.is_defined = true;
        function.frame_bytes = std::max<std::size_t>(function.frame_bytes, std::stoul(frame[1]));
        function.is_unbounded = function.is_unbounded || frame[2] == "dynamic";
      }
    }
  }
}

void CallGraph::resolve_pointers_of(const std::string& caller, const std::set<std::string>& called) { pointers_[caller] = called; }

void CallGraph::bound_recursion_of(const std::string& function, std::size_t times) { times_[function] = times; }

CallGraph::Depth CallGraph::depth_of(const std::string& root) const {
  Walk walk;
  Depth depth;
  depth.bytes = this->walk(root, walk);
  for (std::string name = root; !name.empty();) {
    depth.path.push_back(name);
    const auto next = walk.next.find(name);
    name = next == walk.next.end() || depth.path.size() > functions_.size() ? "" : next->second;
  }
  depth.problems.assign(walk.problems.begin(), walk.problems.end());
  return depth;
}

std::size_t CallGraph::walk(const std::string& name, Walk& walk) const {
  if (const auto known = walk.known.find(name); known != walk.known.end()) {
    return known->second;
  }
  if (walk.open.contains(name)) {
    walk.problems.insert("recursion: " + name);
    return 0;
  }
  const auto found = functions_.find(name);
  if (found == functions_.end() || !found->second.is_defined) {
    walk.problems.insert("unknown function: " + name);
    return 0;
  }
  const Function& function = found->second;
  if (function.is_unbounded) {
    walk.problems.insert("frame without bound: " + name);
  }
  std::set<std::string> calls = function.calls;
  if (calls.erase(kThroughPointer) > 0) {
    if (const auto pointers = pointers_.find(name); pointers != pointers_.end()) {
      calls.insert(pointers->second.begin(), pointers->second.end());
    } else {
      walk.problems.insert("call through a pointer: " + name);
    }
  }
  std::size_t frame_bytes = function.frame_bytes;
  if (const auto times = times_.find(name); times != times_.end() && calls.erase(name) > 0) {
    frame_bytes *= times->second;
  }
  walk.open.insert(name);
  std::size_t deepest = 0;
  for (const std::string& call : calls) {
    const std::size_t bytes = this->walk(call, walk);
    if (bytes > deepest) {
      deepest = bytes;
      walk.next[name] = call;
    }
  }
  walk.open.erase(name);
  return walk.known[name] = frame_bytes + deepest;
}

std::vector<std::string> CallGraph::callers_through_pointers() const {
  std::vector<std::string> names;
  for (const auto& [name, function] : functions_) {
    if (function.calls.contains(kThroughPointer)) {
      names.push_back(name);
    }
  }
  return names;
}

std::vector<std::string> CallGraph::names_with(const std::string& part) const {
  std::vector<std::string> names;
  for (const auto& [name, function] : functions_) {
    if (name.find(part) != std::string::npos) {
      names.push_back(name);
    }
  }
  return names;
}

CallGraph call_graph_of(const std::string& files) {
  CallGraph graph;
  std::istringstream stream(files);
  for (std::string file; std::getline(stream, file, ':');) {
    std::ifstream text(file, std::ios::binary);
    if (!text) {
      throw std::runtime_error("no call graph " + file);
    }
    graph.add(std::string(std::istreambuf_iterator<char>(text), {}));
  }
  return graph;
}

}  // namespace heatsoak::target
