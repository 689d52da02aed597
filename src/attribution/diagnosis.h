// The whole question: what does the model lack, what does it do to the error, what remains, what to measure next.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "attribution/found_effects.h"
#include "attribution/open_loop.h"
#include "attribution/residual_tests.h"

namespace heatsoak {

enum class DiagnosisVerdict { effect_found, nothing_missing, unexplained, not_identifiable };
std::string_view to_string(DiagnosisVerdict verdict);

struct DiagnosisInput {
  ExtendedModel model;  ///< as calibrated
  std::vector<MeasuredRun> train;
  std::vector<MeasuredRun> holdout;
};

struct Unexplained {
  std::string node;                   ///< whose sensor shows it
  std::vector<std::string> or_nodes;  ///< that it may enter as well: they have no sensor
  std::vector<std::string> drivers;   ///< empty: no measured signal explains it
  std::string times;                  ///< signal that multiplies what goes with the driver; empty: none
  double mean_W = 0.0;
  double peak_W = 0.0;
  double rms_W = 0.0;  ///< of a curve the mean magnitude
  double time_scale_s = 0.0;
  double gain_nats = 0.0;
  std::vector<double> knots;
  std::vector<double> curve;
  std::vector<double> curve_sd;
  std::string curve_unit;
  std::string driver_unit;
  bool is_in_model = false;  ///< the extended model follows it
};

/// Unknown heat along a training run, in W.
struct FluxTrace {
  std::string run;
  std::string node;
  std::vector<double> time_s;
  std::vector<double> before_W, after_W;
  std::vector<double> after_sd_W;  ///< posterior, given the model
};

/// Mean heat in W that an effect, or what some runs have more or less of, brings into a node over the training runs.
struct BalanceRow {
  std::string effect;
  std::map<std::string, double> heat_W;
};

struct Experiment {
  std::string rivals;  ///< "iron_loss_eddy or windage"
  std::string what;
  double expected_nats = 0.0;  ///< that it adds to their difference; 0: not computed
};

struct Diagnosis {
  DiagnosisVerdict verdict = DiagnosisVerdict::nothing_missing;
  std::vector<FoundEffect> effects;
  std::vector<ChangedFigure> changed;  ///< figures of the file that do not hold in these runs
  std::vector<Unexplained> unexplained;
  Errors before_train, before_holdout, after_train, after_holdout;
  Errors refitted_train, refitted_holdout;  ///< the model's own figures fitted to the training runs, nothing added
  /// Of the written model alone: without what some runs have more or less of, which is no property of the motor.
  Errors file_train, file_holdout;
  std::vector<MeasuredRun> runs;  ///< of the training
  std::vector<InnovationTests> tests_before, tests_after;
  std::vector<FluxTrace> flux;
  std::map<std::string, double> flux_rms_before_W, flux_rms_after_W;  ///< by node
  std::vector<BalanceRow> balance;
  std::vector<Experiment> experiments;
  std::vector<std::string> notes;
  std::vector<std::string> beyond_training;  ///< sentences: where the runs held out go and those of the training do not
  std::vector<std::string> words;            ///< what to say first, what was found, what it does to the error, what to do next
  std::string description;                   ///< the same as one paragraph
  Selection selection;
};

/// By a tenth, and by more than matters to anybody.
bool is_plainly_worse(double error_K, double than_K);

/// Takes the runs for ones whose motor turns round within rows of the log where that is more probable than that its speed was held over
/// them; says so in a sentence, or nothing.
std::string settle_turning_rows(DiagnosisInput& input);

/// The model as it was, or its own figures refitted without anything that was added, follows the runs held out plainly better; those
/// figures by more than a quarter of what the training runs gain by it.
bool fails_on_holdout(const Diagnosis& diagnosis);

/// Whoever runs the model that was found on the runs needs the column in them that one of its curves is drawn over.
void set_column(DiagnosisInput& input, const Selection& found);

Diagnosis diagnose(const DiagnosisInput& input, const SelectionRules& rules);

/// Of everything else in the diagnosis, for Diagnosis::words.
std::vector<std::string> describe(const Diagnosis& diagnosis);

}  // namespace heatsoak
