// Stack that a function needs with everything that it calls, from the files that GCC writes for -fcallgraph-info=su.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::target {

/// Functions by their mangled names. A function that several objects contain counts with its largest frame and all its calls, because
/// the linker keeps any of them; for the same reason, file-local functions of one name count as one.
class CallGraph {
 public:
  /// Calls through pointers appear under this name.
  static constexpr const char* kThroughPointer = "__indirect_call";

  /// Adds the text of one .ci file. A frame whose size is not known at compile time is remembered as unbounded.
  void add(std::string_view callgraph);

  /// Declares what the pointer calls of a function reach. Without that, they make its depth unknown.
  void resolve_pointers_of(const std::string& caller, const std::set<std::string>& called);

  /// Declares that a function that calls itself does so until it is entered `times` times.
  void bound_recursion_of(const std::string& function, std::size_t times);

  struct Depth {
    std::size_t bytes = 0;
    std::vector<std::string> path;      ///< the deepest, from the root on
    std::vector<std::string> problems;  ///< recursion, unknown functions, pointers, frames without bound: if any, `bytes` is too small
  };
  /// Deepest path from `root` on, its own frame included.
  [[nodiscard]] Depth depth_of(const std::string& root) const;

  /// Mangled names that contain `part`.
  [[nodiscard]] std::vector<std::string> names_with(const std::string& part) const;

  /// Mangled names of the functions that call through pointers.
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

/// Of .ci files, whose paths are separated by ':'.
CallGraph call_graph_of(const std::string& files);

}  // namespace heatsoak::target
