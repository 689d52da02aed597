// Continues after a failure, so that one run reports the problems of all files.
#pragma once

#include <exception>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak::base {

/// Returns one Failure with every diagnostic of `failures` once, in order; a message becomes a diagnostic without a place. The exit code is
/// bad_input if any of them has it, else cannot_answer.
Failure joined(std::span<const Failure> failures);

/// Several failures as one, joined(). The parts keep their types, so that they can be put into words one by one.
class SeveralFailures : public Failure {
 public:
  /// A failure and the exception of its own type.
  using Part = std::pair<Failure, std::exception_ptr>;
  explicit SeveralFailures(std::vector<Part> parts);
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }

 private:
  std::vector<Part> parts_;
};

/// Failures of independent steps, such as reading one log each.
class CollectedFailures {
 public:
  /// Returns the result of `step`, or nothing if it throws a Failure because of its input (bad_input or cannot_answer), which is kept. A
  /// step without a result gives true or false. Other exceptions are thrown on.
  template <class Step>
  auto attempt(const Step& step) {
    using Result = decltype(step());
    if constexpr (std::is_void_v<Result>) {
      return attempt([&step] { return step(), true; }).has_value();
    } else {
      try {
        return std::optional<Result>(step());
      } catch (const Failure& failure) {
        if (!keep(failure)) {
          throw;
        }
        return std::optional<Result>();
      }
    }
  }
  [[nodiscard]] bool empty() const { return failures_.empty(); }
  /// Throws the kept failures: a single one as it was, several as SeveralFailures in order of the steps. Does nothing if there are none.
  void throw_if_any() const;

 private:
  /// Keeps the exception that is being handled. Returns false if its exit code is another one.
  bool keep(const Failure& failure);

  std::vector<SeveralFailures::Part> failures_;
};

}  // namespace heatsoak::base
