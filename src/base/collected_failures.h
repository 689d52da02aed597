// Continues after a failure, so that one run reports the problems of all files.
#pragma once

#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak::base {

/// Failures of independent steps, such as reading one log each.
class CollectedFailures {
 public:
  /// Returns the result of `step`, or nothing if it throws a Failure because of its input (bad_input or cannot_answer), which is kept.
  /// Other exceptions are thrown on.
  template <class Step>
  auto attempt(const Step& step) -> std::optional<decltype(step())> {
    try {
      return step();
    } catch (const Failure& failure) {
      if (!keep(failure)) {
        throw;
      }
      return std::nullopt;
    }
  }
  [[nodiscard]] bool empty() const { return failures_.empty(); }
  /// Throws the kept failures: a single one as it was, several as one Failure with every diagnostic once, in order of the steps. Its exit
  /// code is bad_input if any of them has it. Does nothing if there are none.
  void throw_if_any() const;

 private:
  /// Keeps the exception that is being handled. Returns false if its exit code is another one.
  bool keep(const Failure& failure);

  std::vector<std::pair<Failure, std::exception_ptr>> failures_;
};

}  // namespace heatsoak::base
