#include "present/verdict_topic.h"

#include <fmt/format.h>

#include "base/lanes.h"
#include "select/decision.h"
#include "select/spread.h"

namespace heatsoak::present {

std::vector<VerdictMeaning> verdict_meanings() {
  const double rare_percent = 100.0 * select::kMarginalProbability;
  const double most_percent = 100.0 * select::kMajority;
  const double short_percent = 100.0 * select::kTolerableShortTime;
  return {
      {select::Verdict::pass,
       fmt::format("With nominal values the motor stays within every temperature limit and delivers the demand. At most {:.0f} % of the "
                   "samples exceed a limit, and at most {:.0f} % miss the demand. On a duty that is drawn, such as a match, the samples "
                   "alone decide.",
                   rare_percent, rare_percent)},
      {select::Verdict::marginal,
       fmt::format("As pass, but more than {:.0f} % of the samples exceed a limit or miss the demand.", rare_percent)},
      {select::Verdict::fail,
       fmt::format("With nominal values the winding or the stator exceeds its limit. On a duty that is drawn: more than {:.0f} % of the "
                   "samples do.",
                   most_percent)},
      {select::Verdict::infeasible,
       fmt::format("With a hot winding, voltage or current is too low for the demanded torque for more than {:.0f} % of the time. On a "
                   "duty that is drawn, this is so in more than {:.0f} % of the samples.",
                   short_percent, most_percent)}};
}

std::string undecided_meaning() {
  const int most = select::most_samples(false);
  return fmt::format(
      "The interval of the share of samples over a limit contains the threshold of two verdicts ({rare:.0f} %, and {majority:.0f} % on a "
      "duty that is drawn). Without --samples the program doubles the samples of undecided motors up to {doublings} times: to {most}, or "
      "to {games} games on a duty that is drawn, where it stops earlier if a decision has become improbable (less than {least:.0f} %). The "
      "answer then states with how many samples the verdict is decided with a probability of {even:.0f} % and of {likely:.0f} %; to "
      "continue, give --samples one "
      "of these numbers. The interval allows for the repeated tests: the first may err with a probability of {first:.1f} %, each later one "
      "with {later:.2f} %, so a verdict is wrong with a probability of at most {wrong:.0f} % (Clopper and Pearson 1934; alpha spending, "
      "Jennison and Turnbull 2000). Samples of one game count as one. Until the verdict is decided, JSON states marginal, whatever the "
      "number of samples, and the key decided is false; if one of fail and infeasible is certain and only the other is open, it states the "
      "certain one. The exit code follows the worst verdict that the interval allows. Without any samples (--samples 0) the answer says "
      "within, over or short for the nominal motor; decided is false, and JSON states marginal in place of pass, because nothing is known "
      "about the tolerances.",
      fmt::arg("rare", 100.0 * select::kMarginalProbability), fmt::arg("majority", 100.0 * select::kMajority),
      fmt::arg("doublings", select::kMostDoublings), fmt::arg("most", most), fmt::arg("games", select::most_samples(true) / base::kLanes),
      fmt::arg("even", 100.0 * select::kEvenDecision_share), fmt::arg("likely", 100.0 * select::kLikelyDecision_share),
      fmt::arg("least", 100.0 * select::kLeastDecision_share),
      fmt::arg("first", 100.0 * select::error_share(select::first_samples(false), false)),
      fmt::arg("later", 100.0 * select::error_share(most, false)), fmt::arg("wrong", 100.0 * select::kError_share));
}

}  // namespace heatsoak::present
