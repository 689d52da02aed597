#pragma once
// Score of a suite: tables in Markdown and a list of the answers that are wrong.
#include <string>
#include <utility>
#include <vector>

#include "answer.h"

namespace heatsoak::suite {

/// Wilson's 95 % interval of a share.
std::pair<double, double> wilson_interval(int hits, int count);

/// Counts of all groups. Cases that are not visible count only where the name says so.
struct Score {
  int nulls = 0, nulls_false_alarm = 0, nulls_unexplained = 0;
  int singles = 0, singles_named = 0, singles_right = 0, singles_exact = 0, singles_by_class = 0, singles_by_curve = 0;
  int single_terms = 0, single_wrong_terms = 0;
  int hidden_singles = 0, hidden_single_terms = 0, hidden_single_wrong_terms = 0;
  int pairs = 0, pairs_one_right = 0, pairs_both_right = 0, pair_terms = 0, pair_wrong_terms = 0, hidden_pairs = 0;
  int outsides = 0, outside_unexplained = 0, outside_node = 0, outside_signal = 0, outside_all = 0, outside_named = 0, hidden_outsides = 0;
  int eights = 0, eight_first_absent = 0, eight_name_absent = 0, eight_term_absent = 0;
  int eights_with_effect = 0, eight_effect_named = 0;
  int classes = 0;                        ///< terms that are a class, of all motors
  int failures = 0;                       ///< no documented exit code
  int refusals = 0;                       ///< documented exit code, but no diagnosis
  std::vector<std::string> failed_cases;  ///< one line of Markdown each
};

Score score_of(const std::vector<Answer>& answers);

/// The whole report in Markdown.
std::string report_of(const std::vector<Answer>& answers);

}  // namespace heatsoak::suite
