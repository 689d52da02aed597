#include <fmt/format.h>

#include <cmath>

#include "base/binomial_bound.h"
#include "base/quantity.h"
#include "check/computations.h"

namespace heatsoak::check::thresholds {
namespace {

constexpr double kConfidence = 0.95;

/// Returns a phrase with the number of samples that could show the limit to be kept.
std::string what_would_do(const Check& check, double over_share, double limit_share, int draws) {
  const std::optional<long> needed = base::draws_needed(over_share, limit_share, kConfidence);
  if (!needed) {
    return "no number of samples can meet the limit with this share";
  }
  const bool is_drawn = draws != check.samples;
  const long per_draw = is_drawn ? (check.samples + draws - 1) / draws : 1;
  return fmt::format("{} samples or more could meet {} % with this share", *needed * per_draw, base::significant(100.0 * limit_share, 3));
}

Measured measure_probability_over_limit(const Check& check, Computations& computations) {
  const select::MotorEvaluation& result = computations.feasible_evaluation(check);
  const int draws = Computations::independent_draws(check);
  const bool is_drawn = draws != check.samples;
  const double share = result.probability_over_limit.value();
  double bound = base::upper_bound_share(share * draws, draws, kConfidence);
  std::string detail = fmt::format("{} of {} samples over, bound of {:.0f} % confidence", std::lround(share * check.samples), check.samples,
                                   100.0 * kConfidence);
  if (is_drawn) {
    // Samples of one game share its load, so they count as one draw. This errs on the safe side.
    detail += fmt::format(" by {} games", draws);
  }
  for (const Limit& limit : check.limits) {
    if (limit.type->name != "probability_over_limit" || bound <= limit.value) {
      continue;
    }
    detail += "; " + what_would_do(check, share, limit.value, draws);
  }
  return {bound, 0.0, detail};
}

}  // namespace

ThresholdType probability_over_limit() {
  return {.name = {},
          .unit = "",
          .is_share = true,
          .range = base::Range::between(0.0, 1.0),
          .meaning =
              "probability that winding or stator exceeds its limit: the exact upper confidence bound (Clopper and Pearson, 95 %, "
              "one-sided) of the share of samples over a limit. A tight limit therefore needs many samples. On a duty that is drawn at "
              "random, such as a match, its draws count instead of the samples",
          .example = "at most 5 %",
          .needs = {Setting::robot, Setting::duty, Setting::motor},
          .takes = {Setting::samples, Setting::seed, Setting::conditions},
          .loosest = [](const Check&) -> std::optional<LoosestLimit> { return largest_share_limit(); },
          .measure = measure_probability_over_limit};
}

}  // namespace heatsoak::check::thresholds
