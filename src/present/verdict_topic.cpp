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
  return fmt::format(
      "More samples are needed. The interval of the share of samples that exceed a limit or miss the demand contains the threshold of two "
      "verdicts: {:.0f} %, or {:.0f} % on a duty that is drawn.",
      100.0 * select::kMarginalProbability, 100.0 * select::kMajority);
}

std::vector<UndecidedDetail> undecided_details() {
  const int most = select::most_samples(false);
  return {
      {"samples",
       fmt::format(
           "Without --samples the program doubles the samples of undecided motors up to {} times: to {}, or to {} games on a duty "
           "that is drawn. On such a duty it stops earlier if a decision has become improbable (less than {:.0f} %). Samples of one "
           "game count as one.",
           select::kMostDoublings, most, select::most_samples(true) / base::kLanes, 100.0 * select::kLeastDecision_share)},
      {"to continue",
       fmt::format("The answer states the numbers of samples that decide the verdict with a probability of {:.0f} % and of {:.0f} %. Give "
                   "--samples one of them.",
                   100.0 * select::kEvenDecision_share, 100.0 * select::kLikelyDecision_share)},
      {"errors",
       fmt::format(
           "A verdict is wrong with a probability of at most {:.0f} %. The intervals allow for the repeated tests: the first may err "
           "with {:.1f} %, each later one with {:.2f} % (Clopper and Pearson 1934; alpha spending, Jennison and Turnbull 2000).",
           100.0 * select::kError_share, 100.0 * select::error_share(select::first_samples(false), false),
           100.0 * select::error_share(most, false))},
      {"JSON",
       "The key verdict is marginal and the key decided is false. If one of fail and infeasible is certain and only the other is open, "
       "verdict is the certain one."},
      {"exit code", "It follows the worst verdict that the interval allows."},
      {"--samples 0",
       "There is no verdict, because nothing is known about the tolerances. The answer states within, over or short for the nominal motor. "
       "In JSON, decided is false, and verdict is marginal in place of pass."}};
}

}  // namespace heatsoak::present
