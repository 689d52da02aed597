// The whole question: what does the model lack, what does it do to the error, what remains, what to measure next.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "identify/attribution/residual_tests.h"
#include "identify/attribution/selection.h"

namespace heatsoak {

enum class DiagnosisVerdict { effect_found, nothing_missing, unexplained, not_identifiable };
std::string_view to_string(DiagnosisVerdict verdict);

struct DiagnosisInput {
  ExtendedModel model;  ///< as calibrated
  std::vector<MeasuredRun> train;
  std::vector<FreeSignals> free;  ///< of the training runs
  std::vector<MeasuredRun> holdout;
};

struct ErrorOfSignal {
  double rmse_K = 0.0;
  double max_abs_K = 0.0;
};
/// By signal, "winding_C".
using Errors = std::map<std::string, ErrorOfSignal>;

/// The model run freely from the first measured temperatures. A run that goes on where one of `before_them` ends begins where the model's
/// free run of that one has arrived: nothing but the beginning of the log is looked at.
Errors open_loop_errors(const ExtendedModel& model, const std::vector<MeasuredRun>& runs, const std::vector<MeasuredRun>& before_them);
/// Predictions of one run, n × sensors.
Eigen::MatrixXd open_loop_C(const ExtendedModel& model, const MeasuredRun& run, const std::vector<MeasuredRun>& before_it);

struct FittedParameter {
  std::string name;
  std::string unit;
  double value = 0.0;
  double low = 0.0;  ///< of the 95 % interval; both the value where there is none
  double high = 0.0;
  bool is_at_bound = false;  ///< of what is looked for: the search ended there, not the runs
};

struct FoundEffect {
  std::string id;    ///< of the catalogue; "tabulated" and the like for curves
  std::string name;  ///< of the instance in the model file; empty for faults of sensors
  std::string node;
  std::string description;  ///< one line in words
  std::vector<FittedParameter> parameters;
  std::map<std::string, std::string> condition;  ///< where it acts; empty: everywhere
  std::vector<std::string> drivers;              ///< of a curve
  double mean_W = 0.0;                           ///< of the magnitude over the time of the runs in which it acts
  double peak_W = 0.0;                           ///< 99 % of the magnitude
  bool has_heat = true;                          ///< false: a fault of a sensor
  double gain_nats = 0.0;                        ///< that the final model would lose without it
  double delta_bic = 0.0;                        ///< −2 · gain
  double p_value = 1.0;                          ///< of the size being 0, one parameter
  double visibility_ratio = 0.0;
  std::vector<std::string> confusable_with;  ///< on these runs
  std::string look_alike;                    ///< in general, and what tells them apart: the catalogue's own words
  bool is_from_catalogue = true;
};

struct Unexplained {
  std::string node;
  std::vector<std::string> drivers;  ///< empty: no measured signal explains it
  double mean_W = 0.0;
  double peak_W = 0.0;
  double rms_W = 0.0;
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

/// Mean heat in W that an effect brings into a node over the training runs.
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
  std::vector<Unexplained> unexplained;
  Errors before_train, before_holdout, after_train, after_holdout;
  Errors refitted_train, refitted_holdout;  ///< the model's own figures fitted to the training runs, nothing added
  std::vector<MeasuredRun> runs;            ///< of the training
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

Diagnosis diagnose(const DiagnosisInput& input, const SelectionRules& rules);

/// Of everything else in the diagnosis, for Diagnosis::words.
std::vector<std::string> describe(const Diagnosis& diagnosis);

}  // namespace heatsoak
