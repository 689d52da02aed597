// Evaluates every threshold of a check file.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/job_progress.h"
#include "check/check_file.h"

namespace heatsoak::check {

class CommandAnswers;

struct Outcome {
  const Check* check = nullptr;
  Limit limit;
  std::optional<Measured> measured = {};  ///< empty if it could not be evaluated
  std::string reason;                     ///< why it fails; empty if it passes
  std::string before = {};                ///< text of the limit before --update; empty if unchanged
  bool failed_before = false;             ///< the value did not keep the limit before --update
  bool passed = false;

  /// Returns the distance from the value to the limit in the type's unit: positive on the safe side; nothing without a value.
  [[nodiscard]] std::optional<double> margin_value() const;
};

/// Returns one outcome per limit, in the order of the file. Thresholds that cannot be evaluated fail with a reason; all others are still
/// evaluated. The results do not depend on `threads`; 0 means all cores. `progress` reports the phases that check_phases() returns.
/// `answers` are those of the file's commands.
std::vector<Outcome> run_checks(const CheckFile& file, int threads, const CommandAnswers& answers, const base::JobProgress& progress = {});

/// Returns the phases of run_checks().
std::vector<base::JobPhase> check_phases(const CheckFile& file);

/// Compares the value with the limit again, after the limit was changed.
void judge(Outcome& outcome);

}  // namespace heatsoak::check
