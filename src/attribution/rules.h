// Every tunable number of an attribution, with its origin. README.md shows what each of them does when it is halved or doubled.
#pragma once

namespace heatsoak {

struct SelectionRules {
  // Before anything is measured.
  double inclusion_nats = -4.5;              ///< ln prior odds of one effect: one motor in three lacks one of some 30
  double conditional_nats = -7.0;            ///< the same of what only some runs have: one motor in 20 has one of some 50
  double size_sd = 2.0;                      ///< of an effect's size, in typical sizes
  double body_start_K = 5.0;                 ///< of a body that comes with an effect, above ambient when a run begins
  double curve_nats = -7.0;                  ///< ln prior odds of one curve over a signal: one motor in 20 has one of some 50
  double curve_level_precision_ratio = 0.1;  ///< of a curve's values, in its usual size: within some three of it
  double curve_step_precision_ratio = 2.0;   ///< of the steps between its knots: neighbours are alike within 0.7 of it

  // What gets a name.
  double named_probability = 0.95;     ///< one name in twenty may be wrong
  double material_K = 1.8;             ///< unknown heat matters where it would warm the outermost body by this
  double material_share = 0.1;         ///< of the mean heat that the model knows: less than this every model leaves
  double as_usual_ratio = 1.5;         ///< more than this of the unknown heat of earlier runs of the motor is not as usual
  double curve_gain_nats = 10.0;       ///< that a curve must explain beyond the best effects
  double narrow_nats = 5.0;            ///< that knots over half the range must explain more
  double second_signal_nats = 10.0;    ///< that heat over one signal times another must be ahead of heat over one
  double beside_unknown_share = 0.5;   ///< of the error of whole runs, with which a name stays although unknown heat remains that matters
  double better_share = 0.97;          ///< of the error of whole runs, that a calibrated model may have with a name
  double plainly_better_share = 0.85;  ///< the same where whole runs decided its figures
  double same_shape_share = 0.2;   ///< of the evidence of an effect and a curve: with more of it a curve is no other shape of the effect
  double same_shape_ratio = 0.75;  ///< squared correlation from which a curve is another shape of a named effect
  double seen_nats = 7.0;          ///< that an effect of typical size would add, to count as one that these runs can show
  double least_seen_share = 0.5;   ///< of the catalogue: with less nobody can say that nothing is missing

  // The start: plain least squares, before any unknown heat is supposed.
  double start_error_K = 1.0;       ///< of a model that lacks something
  double longest_step_ratio = 0.4;  ///< of a figure's logarithm in one Gauss-Newton step

  // Limits of the computation; they decide nothing.
  int most_effects = 3;  ///< in a set
  int pool_of_one = 9;
  int pool_of_two = 7;
  int pool_of_three = 5;
  int best_pairs = 25;
  int most_rounds = 5;
  bool scans_drivers = true;
};

}  // namespace heatsoak
