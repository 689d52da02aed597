#include "present/verdict_topic.h"

#include <fmt/format.h>

namespace heatsoak::present {

std::vector<VerdictMeaning> verdict_meanings() {
  const double rare_percent = 100.0 * select::kMarginalProbability;
  const double most_percent = 100.0 * select::kMajority;
  const double short_percent = 100.0 * select::kTolerableShortTime;
  return {
      {select::Verdict::pass,
       fmt::format("With nominal values the motor stays within every temperature limit and delivers the demand. At most {:.0f} % of the "
                   "samples exceed a limit, and at most {:.0f} % miss the demand. On a duty that is drawn, such as a match, most samples "
                   "stay within, and the upper end of the 95 % interval of the share over a limit is at most {:.0f} %.",
                   rare_percent, rare_percent, rare_percent)},
      {select::Verdict::marginal,
       fmt::format("As pass, but more samples exceed a limit or miss the demand than the {:.0f} % allowed there.", rare_percent)},
      {select::Verdict::fail,
       fmt::format("With nominal values the winding or the stator exceeds its limit. On a duty that is drawn: more than "
                   "{:.0f} % of the samples do.",
                   most_percent)},
      {select::Verdict::infeasible,
       fmt::format("Voltage or current do not suffice for the demanded torque for more than {:.0f} % of the time, the winding being hot. "
                   "On a duty that is drawn: in more than {:.0f} % of the samples.",
                   short_percent, most_percent)}};
}

std::string undecided_meaning() {
  return fmt::format(
      "The interval of the share of samples over a limit covers the threshold between two verdicts ({:.0f} %, and {:.0f} % on a duty that "
      "is drawn). Without --samples the program doubles the samples up to five times, on a duty that is drawn once, and only if that can "
      "decide the verdict. --samples continues with the number that the answer gives. Looking several times is part of the interval: the "
      "first may err with a probability of 2.5 %, each later one with 0.36 %, so a verdict is wrong with a "
      "probability of 5 % at most (Clopper and Pearson 1934; alpha spending, Jennison and Turnbull 2000). Samples of one game count as "
      "one. Exit code and JSON then use the verdict of the samples so far.",
      100.0 * select::kMarginalProbability, 100.0 * select::kMajority);
}

}  // namespace heatsoak::present
