// Decision thresholds of the estimation and the attribution: a value is compared with them, and the comparison decides on a name, a
// verdict, a sample, a run or a fit. Priors, scales of physics, tolerances and limits of the search are beside the code that uses them.
// heatsoak_attribution_ablation switches every one off, halves and doubles it, and prints the table in reports/attribution/README.md.
#pragma once

#include <array>
#include <string_view>

namespace heatsoak::estimation {

struct Thresholds {
  // Attribution.
  double wrong_answer_share = 0.05;  ///< allowed share of wrong decisions by evidence
  double material_K = 1.8;           ///< temperature rise of the outermost body from which unknown heat matters
  double clear_nats = 10.0;          ///< gain in ln P from which a curve, or a sensor's drift, is accepted, also in left-out recordings
  /// Difference of ln P below which explanations cannot be distinguished, and gain in left-out recordings that confirms a name.
  double distinct_nats = 5.0;
  double clearly_other_ratio = 1.54;  ///< ratio from which two errors, or two amounts of unknown heat, clearly differ
  double beside_unknown_share = 0.5;  ///< ratio of errors below which a name may stand beside material unknown heat
  double better_share = 0.85;         ///< ratio of errors below which a name, or another fit, is better
  double same_signal_ratio = 0.9995;  ///< correlation above which two signals cannot be distinguished, and the first is used
  double least_seen_share = 0.5;      ///< smallest fraction of visible effects for the result "nothing missing"
  double well_known_ratio = 0.5;      ///< prior of a well-known parameter divided by that of a value on a data sheet
  // Samples.
  double wrong_rejection_share = 1e-6;  ///< probability that a good sample, or a good sequence of equal readings, is rejected
  double least_equal_count = 8.0;       ///< shortest sequence of equal readings that is tested
  double confirms_share = 0.5;       ///< largest change of the residual to the neighbour that confirms an outlier, divided by the outlier
  double most_rejected_share = 0.1;  ///< fraction of rejected samples above which the model is wrong rather than the samples
  // Fit.
  double material_share = 0.1;    ///< fraction of the mean heat from which unknown heat matters
  double seen_share = 2.0 / 3.0;  ///< fraction of every run that a fit sees before it predicts the rest
  double matters_K = 0.1;         ///< smaller differences between errors do not matter
  // Rows.
  double least_rows_count = 10.0;  ///< shortest run
  double longest_pause_s = 10.0;   ///< longest pause within a run
  double jump_K = 5.0;             ///< temperature change during a pause that ends a run
  double slow_s = 60.0;            ///< time in which air, coolant and unheated bodies hardly change
  double most_unused_share = 0.1;  ///< fraction of unused rows above which a remark says so
  double off_step_ratio = 0.125;   ///< mean distance of regular rows from whole numbers of steps, in steps
};

struct ThresholdSpec {
  std::string_view name, unit, origin;
  double Thresholds::*value;
  double off_value;  ///< value that switches the rule off
};

inline constexpr std::array kThresholds{
    ThresholdSpec{"wrong_answer_share", "", "false-alarm rate: at most one name in twenty is wrong", &Thresholds::wrong_answer_share, 0.5},
    ThresholdSpec{"material_K", "K", "physical size: rise that does not matter for a limit (judgement)", &Thresholds::material_K, 0.01},
    ThresholdSpec{"clear_nats", "", "false-alarm rate: odds of 1 to 22 000, far beyond the number of explanations tried",
                  &Thresholds::clear_nats, 0.0},
    ThresholdSpec{"distinct_nats", "", "false-alarm rate: odds of 1 to 150, as many as there are candidates", &Thresholds::distinct_nats,
                  0.0},
    ThresholdSpec{"clearly_other_ratio", "", "judgement: one and a half times", &Thresholds::clearly_other_ratio, 1.0},
    ThresholdSpec{"beside_unknown_share", "", "judgement: a name must explain more than the unknown heat beside it",
                  &Thresholds::beside_unknown_share, 1e9},
    ThresholdSpec{"better_share", "", "judgement", &Thresholds::better_share, 1e9},
    ThresholdSpec{"same_signal_ratio", "", "judgement: 0.1 % of the variance differs, less than sensors resolve",
                  &Thresholds::same_signal_ratio, 1.0},
    ThresholdSpec{"least_seen_share", "", "judgement: \"nothing missing\" needs most effects to be visible", &Thresholds::least_seen_share,
                  0.0},
    ThresholdSpec{"well_known_ratio", "", "judgement: half of the standard deviation of a data sheet", &Thresholds::well_known_ratio, 0.0},
    ThresholdSpec{"wrong_rejection_share", "", "false-alarm rate: some thousand samples and sequences per motor",
                  &Thresholds::wrong_rejection_share, 0.0},
    ThresholdSpec{"least_equal_count", "samples", "fewer have no information at usual noise", &Thresholds::least_equal_count, 1e9},
    ThresholdSpec{"confirms_share", "", "half way between the reading and the prediction", &Thresholds::confirms_share, 0.0},
    ThresholdSpec{"most_rejected_share", "", "judgement: more wrong samples mean a wrong model", &Thresholds::most_rejected_share, 1.0},
    ThresholdSpec{"material_share", "", "judgement: losses are hardly known to a tenth", &Thresholds::material_share, 0.0},
    ThresholdSpec{"seen_share", "", "judgement", &Thresholds::seen_share, 0.9},
    ThresholdSpec{"matters_K", "K", "accuracy of ordinary sensors", &Thresholds::matters_K, 0.0},
    ThresholdSpec{"least_rows_count", "rows", "judgement: shorter runs contain no time constant", &Thresholds::least_rows_count, 2.0},
    ThresholdSpec{"longest_pause_s", "s", "physical size: time constants of small motors (judgement)", &Thresholds::longest_pause_s, 0.0},
    ThresholdSpec{"jump_K", "K", "physical size: heating of a winding within a pause (judgement)", &Thresholds::jump_K, 1e9},
    ThresholdSpec{"slow_s", "s", "physical size: time constant of a room and of a small motor's housing (judgement)", &Thresholds::slow_s,
                  0.0},
    ThresholdSpec{"most_unused_share", "", "judgement: decides only on a remark", &Thresholds::most_unused_share, 0.0},
    ThresholdSpec{"off_step_ratio", "steps", "half of the mean of unrelated times", &Thresholds::off_step_ratio, 1.0},
};
static_assert(sizeof(Thresholds) == kThresholds.size() * sizeof(double));

/// Returns the thresholds in use.
const Thresholds& thresholds();
/// For the ablation study. Nothing else may run at the same time.
void set_thresholds(const Thresholds& changed);

/// Smallest probability of a name.
double named_probability();
/// Difference of two explanations' ln P from which the less probable one is wrong with at most `wrong_answer_share`.
double named_nats();
/// Largest standardised innovation of a good sample, at `wrong_rejection_share`.
double rejected_sd();
/// Returns how many standard deviations the largest of `tries` normal values exceeds with probability `share`.
double largest_sd(double share, int tries);

}  // namespace heatsoak::estimation
