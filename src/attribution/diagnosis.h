// The whole question: what does the model lack, what does it do to the error, what remains, what to measure next.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "attribution/found_effects.h"
#include "attribution/open_loop.h"
#include "attribution/residual_tests.h"
#include "calibration/forecast/prediction.h"

namespace heatsoak {

enum class DiagnosisVerdict { effect_found, nothing_missing, unexplained, not_identifiable };
std::string_view to_string(DiagnosisVerdict verdict);

/// Nothing in it is held out: hold-out runs are scored by score_holdout() after everything is decided.
struct DiagnosisInput {
  ExtendedModel model;  ///< as calibrated
  std::vector<MeasuredRun> train;
  bool turns_within_rows = false;  ///< set by settle_turning_rows()
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
  std::vector<ChangedParameter> changed;  ///< figures of the file that do not hold in these runs
  std::vector<Unexplained> unexplained;
  Errors before_train, after_train;
  Errors refitted_train;          ///< the model's own figures fitted to the training runs, nothing added
  Errors file_train;              ///< of the written model alone: without the conditions that only some runs have
  std::vector<MeasuredRun> runs;  ///< of the training
  std::vector<InnovationTests> tests_before, tests_after;
  std::vector<FluxTrace> flux;
  std::map<std::string, double> flux_rms_before_W, flux_rms_after_W;  ///< by node
  std::vector<BalanceRow> balance;
  std::vector<Experiment> experiments;
  std::vector<std::string> notes;
  std::vector<std::string> words;  ///< what to say first, what was found, what it does to the error, what to do next
  std::string description;         ///< the same as one paragraph
  Selection selection;
};

/// Errors of the free-running models on runs that decided nothing.
struct HoldoutScore {
  std::vector<MeasuredRun> runs;
  Errors before, refitted, after;                     ///< as in Diagnosis, of the hold-out runs
  Errors file;                                        ///< of the written model alone
  std::vector<PredictedRun> runs_before, runs_after;  ///< predictions by the motor file and by the extended one: score_files()
  std::vector<std::string> beyond_training;           ///< sentences: where the hold-out runs exceed the range of the training runs
};

/// By a tenth, and by more than matters to anybody.
bool is_plainly_worse(double error_K, double than_K);

/// Takes the runs for ones whose motor turns round within rows of the log where that is more probable than that its speed was held over
/// them; says so in a sentence, or nothing.
std::string settle_turning_rows(DiagnosisInput& input);

Diagnosis diagnose(const DiagnosisInput& input, const SelectionRules& rules);

/// Scores `holdout` (runs as read from their logs) with the models of a finished diagnosis. Nothing of the diagnosis may depend on it.
HoldoutScore score_holdout(const DiagnosisInput& input, const Diagnosis& diagnosis, std::vector<MeasuredRun> holdout);

/// Of everything else in the diagnosis and, where there are hold-out runs, of their score.
std::vector<std::string> describe(const Diagnosis& diagnosis, const HoldoutScore& score);

}  // namespace heatsoak
