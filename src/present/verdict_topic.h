// Definitions of the verdicts for `describe verdict`; no other place defines them in words.
#pragma once

#include <string>
#include <vector>

#include "select/evaluate.h"

namespace heatsoak::present {

struct VerdictMeaning {
  select::Verdict verdict;
  std::string meaning;  ///< includes the thresholds of select/evaluate.h
};
/// Returns the verdicts from best to worst.
std::vector<VerdictMeaning> verdict_meanings();

/// Explains when a verdict is reported as undecided.
std::string undecided_meaning();

}  // namespace heatsoak::present
