// Definitions of the verdicts for `describe verdict`; no other place defines them in words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "select/evaluate.h"

namespace heatsoak::present {

struct VerdictMeaning {
  select::Verdict verdict;
  std::string meaning;  ///< includes the thresholds of select/evaluate.h
};
/// Returns the verdicts from best to worst.
std::vector<VerdictMeaning> verdict_meanings();

/// States when a verdict is reported as undecided.
std::string undecided_meaning();

/// One fact about undecided verdicts, such as how many samples are drawn.
struct UndecidedDetail {
  std::string_view label;
  std::string words;
};
std::vector<UndecidedDetail> undecided_details();

}  // namespace heatsoak::present
