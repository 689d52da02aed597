// Priors of the selection, with their origin, and limits of its computation. The benchmark heatsoak_attribution_ablation varies the priors.
// Decision thresholds are in estimation/thresholds.h.
#pragma once

#include "estimation/thresholds.h"

namespace heatsoak::attribution {

struct SelectionRules {
  // Priors.
  double inclusion_nats = -4.5;              ///< ln prior odds of one effect: one motor in three lacks one of 30
  double conditional_nats = -7.0;            ///< ln prior odds of one effect in some runs: one motor in 20 has one of 50
  double size_sd = 2.0;                      ///< prior standard deviation of a size, in typical sizes
  double body_start_K = 5.0;                 ///< prior standard deviation of an added body's start temperature
  double curve_nats = -7.0;                  ///< ln prior odds of a curve over one signal: one motor in 20 has one of 50
  double curve_level_precision_ratio = 0.1;  ///< prior precision of a curve's values: standard deviation 3.2 typical sizes
  double curve_step_precision_ratio = 2.0;   ///< prior precision of the steps between knots: standard deviation 0.7 typical sizes

  /// Smallest expected gain of a typical effect that counts as visible in the runs: it outweighs the prior odds and suffices for a name.
  [[nodiscard]] double seen_nats() const { return estimation::named_nats() - inclusion_nats; }

  // Limits of the computation, not meant to influence the result.
  /// Largest number of effects in a set. Lags of both sensors and a wrong current sensor in one run often take three places.
  int most_effects = 5;
  /// Search pool: number of best single effects, of best additions to one effect, and of best additions to a larger set. The
  /// search extends the `best_grown` best sets of each size by every member of the pool.
  int pool_of_one = 9;
  int pool_of_two = 7;
  int pool_of_three = 5;
  int best_grown = 25;
  int most_rounds = 5;           ///< largest number of rounds
  bool scans_regressors = true;  ///< true: the search also tries curves over signals
};

}  // namespace heatsoak::attribution
