// The meaning of the verdicts, for `describe verdict`: the only place that defines them in words.
#pragma once

#include <string>
#include <vector>

#include "select/evaluate.h"

namespace heatsoak::present {

struct VerdictMeaning {
  Verdict verdict;
  std::string meaning;  ///< with the thresholds of select/evaluate.h
};
/// From the best to the worst.
std::vector<VerdictMeaning> verdict_meanings();

/// When a verdict is called undecided.
std::string undecided_meaning();

}  // namespace heatsoak::present
