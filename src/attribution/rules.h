// All thresholds and priors of the attribution, with their origin. The benchmark heatsoak_attribution_ablation varies SelectionRules.
#pragma once

#include <cstddef>

namespace heatsoak {

struct SelectionRules {
  // Priors.
  double inclusion_nats = -4.5;              ///< ln prior odds of one effect: one motor in three lacks one of 30
  double size_sd = 2.0;                      ///< prior standard deviation of a size, in typical sizes
  double body_start_K = 5.0;                 ///< prior standard deviation of an added body's start temperature
  double curve_share = 0.3;                  ///< prior standard deviation of a curve's heat, as a fraction of the mean heat
  double curve_nats = -7.0;                  ///< ln prior odds of one curve: one motor in 20 has one of 50
  double curve_level_precision_ratio = 0.1;  ///< prior precision of a curve's values: standard deviation 3.2 typical sizes
  double curve_step_precision_ratio = 2.0;   ///< prior precision of the steps between knots: standard deviation 0.7 typical sizes

  // Decisions.
  double named_probability = 0.95;  ///< smallest probability of a name: at most one in twenty is wrong
  double material_K = 1.8;          ///< temperature rise of the outermost body from which unknown heat matters
  double material_share = 0.1;      ///< fraction of the mean modelled heat from which unknown heat matters
  double as_usual_ratio = 1.5;      ///< largest ratio of unknown heat and error to those of earlier runs of the motor
  double curve_gain_nats = 10.0;    ///< smallest gain of a curve over the best effects, and again of a second signal that multiplies it
  /// A name beside material unknown heat must reduce the error of whole runs below this fraction.
  double beside_unknown_share = 0.5;
  /// A name in a calibrated model must reduce the error of whole runs below this fraction.
  double better_share = 0.97;
  /// The same for a model whose parameters were decided by whole runs.
  double plainly_better_share = 0.85;
  /// A curve is another shape of an effect if its fraction of the two gains is below this, and see `same_shape_ratio`.
  double same_shape_share = 0.2;
  double same_shape_ratio = 0.75;  ///< smallest squared correlation of the responses for the same shape
  double ambiguous_nats = 5.0;     ///< explanations whose ln P differs by less are indistinguishable: odds of 150 to 1
  double seen_nats = 7.0;          ///< smallest expected gain of a typical effect that counts as visible in the runs
  double least_seen_share = 0.5;   ///< smallest fraction of visible effects for the result "nothing missing"

  // First fit: plain least squares without unknown heat.
  double start_error_K = 1.0;       ///< standard deviation of the error of an incomplete model
  double longest_step_ratio = 0.4;  ///< largest change of a coordinate in one Gauss-Newton step

  // Limits of the computation, not meant to influence the result.
  int most_effects = 3;  ///< largest number of effects in a set
  /// Search pool: number of best single effects, of best additions to one effect, and of best additions to a pair. The search extends
  /// `best_pairs` pairs.
  int pool_of_one = 9;
  int pool_of_two = 7;
  int pool_of_three = 5;
  int best_pairs = 25;
  int most_rounds = 5;
  bool scans_drivers = true;
};

// Shapes, sizes and bodies of candidates.
inline constexpr double kUsualCapacity_J_per_K = 120.0;  ///< motors of about 50 W, for which the catalogue gives typical sizes
inline constexpr double kUsual_A = 8.0;                  ///< 98th percentile of the current of such a motor
inline constexpr double kTop_share = 0.98;
inline constexpr double kOrder_ratio =
    2.5;  ///< ratio of currents from which sizes in ampere are scaled: the winding is for another voltage
inline constexpr double kShapeSpread = 0.3;  ///< prior standard deviation of the logarithm of a shape parameter
inline constexpr double kBodySpread = 1.0;   ///< the same for an effect with a body, whose capacity may be almost anything
inline constexpr double kKnotSpread = 0.5;   ///< the same of the first and last knot of a curve over a temperature, in gaps between knots
inline constexpr double kLeast_share = 0.1;  ///< smallest size, in typical sizes, at which a column is linearised; it vanishes at 0
/// Prior standard deviation of a sensor's error, as a fraction of the temperature difference to another body. It is far below the Biot
/// number of 0.1 up to which a body may be lumped (F. P. Incropera et al., Fundamentals of Heat and Mass Transfer, 7th edition, section
/// 5.1).
inline constexpr double kUneven_share = 0.002;

// Signals that a curve may follow.
inline constexpr double kSameCorrelation_ratio = 0.9995;  ///< signals with a larger correlation are copies; the earlier one is kept
inline constexpr double kLeastWithin_share = 0.2;         ///< a signal that varies less within each run only distinguishes runs
inline constexpr std::size_t kFewestSamples = 30;         ///< a few for each of the seven knots

// Reports.
inline constexpr double kOtherMounting = 0.1;    ///< change of a parameter's logarithm from which another mounting is assumed
inline constexpr double kMatters_K = 0.1;        ///< smaller differences between errors are irrelevant
inline constexpr double kWorse_ratio = 1.1;      ///< ratio from which an error counts as larger
inline constexpr double kElsewhere_ratio = 3.0;  ///< the same for hold-out runs that contain another effect than the training runs
inline constexpr double kHarmless_K = 10.0;      ///< temperature rise of an experiment that is harmless even if the runs stayed colder
inline constexpr double kContinues_s = 30.0;     ///< largest gap at which a run continues another one of the same recording
inline constexpr double kTail_share = 0.02;      ///< fraction of the time in each tail that is not part of the range of a signal
inline constexpr double kReach_share = 0.1;      ///< extension of that range, as a fraction of its width or of its upper end
inline constexpr double kMuch_share = 0.25;      ///< fraction of the time outside that range from which a forecast is an extrapolation

// Limits of the computation.
inline constexpr double kConverged_nats = 0.1;    ///< decrease of the misfit at which a fit ends: a tenth of a nat decides nothing
inline constexpr double kSeen_share = 2.0 / 3.0;  ///< part of each run that is fitted to predict its end
inline constexpr int kMostMoves = 3;              ///< moves of the grid to the optimum of the best set, per round
inline constexpr std::size_t kMostFits = 6;       ///< sets with a nonlinear fit, per round
inline constexpr std::size_t kGrownFrom = 3;      ///< best sets of one size to which every candidate is added
inline constexpr std::size_t kClimbed = 12;       ///< curves whose unknown heat is optimised
inline constexpr std::size_t kZoomed = 4;         ///< curves whose knots are concentrated
inline constexpr int kHalvings = 3;               ///< halvings of the range of the knots
inline constexpr int kLess = 2;                   ///< grid steps to less unknown heat at which curves also start

}  // namespace heatsoak
