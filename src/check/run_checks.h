// Every threshold of a check file, evaluated.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "check/check_file.h"

namespace heatsoak::check {

struct Outcome {
  const Check* check = nullptr;
  Limit limit;
  Measured measured;           ///< value NaN where it could not be evaluated
  std::string reason;          ///< why it fails; empty where it passes
  std::string before = {};     ///< the limit's text before --update, where that changed it
  bool failed_before = false;  ///< the value did not keep that limit
  bool is_evaluated = false;
  bool passed = false;

  /// Distance from the value to the limit in the type's unit: positive on the safe side, NaN without a value.
  [[nodiscard]] double margin_value() const;
};

/// In the order of the file. Thresholds that cannot be evaluated fail and say why; the others are evaluated all the same. The results do
/// not depend on `threads`, 0: all cores. `progress` counts checks.
std::vector<Outcome> run_checks(const CheckFile& file, int threads, const base::Progress& progress = {});

/// Compares the value with the limit again, after the limit was changed.
void judge(Outcome& outcome);

}  // namespace heatsoak::check
