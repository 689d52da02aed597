// Evaluates every threshold of a check file.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/job_progress.h"
#include "check/check_file.h"
#include "check/limit.h"
#include "check/not_evaluated.h"

namespace heatsoak::check {

class CommandAnswers;

enum class Status { kept, broken, not_evaluated };

/// The event never happens, so no limit on its time from above can hold.
struct NoTimeSuffices {};
/// Why --update leaves a limit as it is.
using NotRewritten = std::variant<NoTimeSuffices, Looseness, LimitInvalid>;

struct Outcome {
  const Check* check = nullptr;
  Limit limit;
  std::optional<Measured> measured = {};           ///< empty if it could not be evaluated
  std::optional<Reason> reason = {};               ///< why it could not be evaluated
  std::optional<NotRewritten> not_rewritten = {};  ///< only with --update
  std::string before = {};                         ///< text of the limit before --update; empty if unchanged
  bool failed_before = false;                      ///< the value did not keep the limit before --update

  [[nodiscard]] Status status() const;
  [[nodiscard]] bool passed() const { return status() == Status::kept; }
  /// Returns the distance from the value to the limit in the type's unit: positive on the safe side; nothing without a value.
  [[nodiscard]] std::optional<double> margin_value() const;
};

struct OutcomeCounts {
  std::size_t all = 0;
  std::size_t broken = 0;
  std::size_t not_evaluated = 0;
};
OutcomeCounts count(std::span<const Outcome> outcomes);

/// Returns one outcome per limit, in the order of the file. If some thresholds cannot be evaluated, the others still
/// are. The results do not depend on `threads`; 0 means all cores. `progress` reports the phases that check_phases() returns.
/// `answers` are those of the file's commands.
std::vector<Outcome> run_checks(const CheckFile& file, int threads, const CommandAnswers& answers, const base::JobProgress& progress = {});

/// Returns the phases of run_checks().
std::vector<base::JobPhase> check_phases(const CheckFile& file);

}  // namespace heatsoak::check
