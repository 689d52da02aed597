#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/binomial_bound.h"
#include "check/computations.h"

namespace heatsoak::check::thresholds {
namespace {

/// Returns the limit of the check, as a share.
double limit_of(const Check& check) {
  return std::ranges::find(check.limits, "probability_over_limit", [](const Limit& limit) { return limit.type->name; })->value;
}

Measured measure_probability_over_limit(const Check& check, Computations& computations) {
  const select::MotorEvaluation& result = computations.feasible_evaluation(check);
  const int draws = Computations::independent_draws(check);
  const bool is_drawn = draws != check.samples;
  const double share = result.probability_over_limit.value();
  ShareBasis basis{.over = std::lround(share * check.samples),
                   .samples = check.samples,
                   .games = is_drawn ? std::optional(draws) : std::nullopt,
                   .limit_share = limit_of(check),
                   .samples_needed = base::draws_needed(share, limit_of(check), kBoundConfidence_share)};
  if (is_drawn && basis.samples_needed) {
    *basis.samples_needed *= (check.samples + draws - 1) / draws;
  }
  // Samples of one game share its load, so they count as one draw. This errs on the safe side.
  return {base::upper_bound_share(share * draws, draws, kBoundConfidence_share), 0.0, basis};
}

std::string meaning() {
  return fmt::format(
      "probability that winding or stator exceeds its limit: the exact upper confidence bound (Clopper and Pearson, {:.3g} %, one-sided) "
      "of "
      "the share of samples over a limit. A tight limit therefore needs many samples. On a duty that is drawn at random, such as a match, "
      "its draws count instead of the samples",
      100.0 * kBoundConfidence_share);
}

}  // namespace

ThresholdType probability_over_limit() {
  static const std::string kMeaning = meaning();
  return {.name = {},
          .unit = "",
          .is_share = true,
          .range = base::Range::between(0.0, 1.0),
          .meaning = kMeaning,
          .example = "at most 5 %",
          .needs = {Setting::robot, Setting::duty, Setting::motor},
          .takes = {Setting::samples, Setting::seed, Setting::conditions},
          .loosest = [](const Check&) -> std::optional<LoosestLimit> { return largest_share_limit(); },
          .measure = measure_probability_over_limit};
}

}  // namespace heatsoak::check::thresholds
