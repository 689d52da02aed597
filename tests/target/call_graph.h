// Stack that a function and all its callees need, from the files that GCC writes for -fcallgraph-info=su.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::target {

/// Functions by their mangled names. A function in several objects counts with its largest frame and all its calls, because the linker
/// keeps any of them. For the same reason file-local functions of one name count as one.
class CallGraph {
 public:
  /// Name under which calls through pointers appear.
  static constexpr const char* kThroughPointer = "__indirect_call";

  /// Adds the text of one .ci file. A frame of unknown size at compile time counts as unbounded.
  void add(std::string_view callgraph);

  /// Declares the functions that the pointer calls of `caller` reach. Without this its depth is unknown.
  void resolve_pointers_of(const std::string& caller, const std::set<std::string>& called);

  /// Declares that a recursive function is entered at most `times` times.
  void bound_recursion_of(const std::string& function, std::size_t times);

  struct Depth {
    std::size_t bytes = 0;
    std::vector<std::string> path;      ///< deepest path, starting at the root
    std::vector<std::string> problems;  ///< recursion, unknown functions or pointers, unbounded frames: if any, `bytes` is too small
  };
  /// Returns the deepest path from `root`, its own frame included.
  [[nodiscard]] Depth depth_of(const std::string& root) const;

  /// Returns the mangled names that contain `part`.
  [[nodiscard]] std::vector<std::string> names_with(const std::string& part) const;

  /// Returns the mangled names of the functions that call through pointers.
  [[nodiscard]] std::vector<std::string> callers_through_pointers() const;

 private:
  struct Function {
    std::size_t frame_bytes = 0;
    bool is_defined = false;
    bool is_unbounded = false;
    std::set<std::string> calls;
  };
  struct Walk;
  [[nodiscard]] std::size_t walk(const std::string& name, Walk& walk) const;

  std::map<std::string, Function> functions_;
  std::map<std::string, std::set<std::string>> pointers_;
  std::map<std::string, std::size_t> times_;
};

/// Reads .ci files, whose paths are separated by ':'.
CallGraph call_graph_of(const std::string& files);

}  // namespace heatsoak::target
