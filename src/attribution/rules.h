// Tunable constants of the selection, with their origin. The benchmark heatsoak_attribution_ablation varies them.
#pragma once

#include <cmath>

#include "estimation/evidence.h"
#include "estimation/flux_grid.h"

namespace heatsoak::attribution {

struct SelectionRules {
  // Priors.
  double inclusion_nats = -4.5;              ///< ln prior odds of one effect: one motor in three lacks one of 30
  double conditional_nats = -7.0;            ///< ln prior odds of one effect in some runs: one motor in 20 has one of 50
  double size_sd = 2.0;                      ///< prior standard deviation of a size, in typical sizes
  double body_start_K = 5.0;                 ///< prior standard deviation of an added body's start temperature
  double curve_nats = -7.0;                  ///< ln prior odds of one curve: one motor in 20 has one of 50
  double curve_level_precision_ratio = 0.1;  ///< prior precision of a curve's values: standard deviation 3.2 typical sizes
  double curve_step_precision_ratio = 2.0;   ///< prior precision of the steps between knots: standard deviation 0.7 typical sizes

  // Decisions.
  double named_probability = 0.95;                   ///< smallest probability of a name: at most one in twenty is wrong
  double material_K = estimation::kMaterial_K;       ///< temperature rise of the outermost body from which unknown heat matters
  double material_share = 0.1;                       ///< fraction of the mean modelled heat from which unknown heat matters
  double as_usual_ratio = 1.5;                       ///< largest ratio of unknown heat and error to those of earlier runs of the motor
  double distinct_nats = 5.0;                        ///< explanations whose ln P differs by less cannot be distinguished: odds of 1 to 150
  double curve_gain_nats = estimation::kClear_nats;  ///< smallest gain of a curve over the best effects
  /// A curve must reduce the error of left-out training runs below this fraction: 0.55 for heat that exists, 0.8 without such heat (the
  /// extremes of 30 synthetic motors each).
  double curve_left_out_share = 0.65;
  double second_signal_nats = 10.0;  ///< penalty of a curve over one signal multiplied by a second one
  /// A name beside material unknown heat must reduce the error of whole runs below this fraction.
  double beside_unknown_share = 0.5;
  /// A name in a calibrated model must reduce the error of whole runs below this fraction.
  double better_share = 0.97;
  /// The same for a model whose parameters were decided by whole runs.
  double plainly_better_share = 0.85;
  double same_shape_ratio = 0.75;  ///< smallest squared correlation of the responses for which a curve is another shape of an effect
  double least_seen_share = 0.5;   ///< smallest fraction of visible effects for the result "nothing missing"

  /// Smallest expected gain of a typical effect that counts as visible in the runs: it outweighs the prior odds and suffices for a name.
  [[nodiscard]] double seen_nats() const { return std::log(named_probability / (1.0 - named_probability)) - inclusion_nats; }

  // Limits of the computation, not meant to influence the result.
  /// Largest number of effects in a set. Lags of both sensors and a wrong current sensor in one run often take three places.
  int most_effects = 5;
  /// Search pool: number of best single effects, of best additions to one effect, and of best additions to a larger set. The
  /// search extends the `best_grown` best sets of each size by every member of the pool.
  int pool_of_one = 9;
  int pool_of_two = 7;
  int pool_of_three = 5;
  int best_grown = 25;
  int most_rounds = 5;        ///< largest number of rounds
  bool scans_drivers = true;  ///< searches curves over signals, too
};

}  // namespace heatsoak::attribution
