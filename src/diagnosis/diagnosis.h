// Diagnosis: which effect the model lacks, how it changes the error, what remains unexplained, and what to measure next.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "attribution/scan_term.h"
#include "base/job_progress.h"
#include "diagnosis/error_in_run.h"
#include "diagnosis/findings.h"
#include "diagnosis/found_effects.h"
#include "estimation/free_run_errors.h"
#include "estimation/residual_tests.h"

namespace heatsoak::diagnosis {

enum class DiagnosisVerdict { effect_found, nothing_missing, unexplained, not_identifiable };
std::string_view to_string(DiagnosisVerdict verdict);

/// Input of a diagnosis. It contains no hold-out run: these are scored after every decision (holdout_score.h).
struct DiagnosisInput {
  estimation::Model model;  ///< calibrated model
  std::vector<estimation::MeasuredRun> train;
  attribution::UsualErrors usual = {};
  base::JobProgress progress = {};
};

/// Heat that no effect of the catalogue explains.
struct Unexplained {
  std::string node;                   ///< node whose sensor shows the heat
  std::vector<std::string> or_nodes;  ///< nodes without a sensor that the heat may enter instead
  std::vector<std::string> signals;   ///< signals that the heat may follow, in order of evidence; empty: none
  std::string unconfirmed_signal;     ///< signal that the heat may follow, though left-out runs do not confirm it; empty: none
  /// Factor that multiplies the curve; `source` without a curve.
  attribution::Multiplier multiplier = attribution::Multiplier::source;
  std::string other_node;  ///< second node of Multiplier::difference; else empty
  double mean_W = 0.0;
  double peak_W = 0.0;
  double rms_W = 0.0;            ///< for a curve: mean magnitude
  double time_scale_s = 0.0;     ///< correlation time
  double gain_nats = 0.0;        ///< evidence gained
  std::vector<double> knots;     ///< values of the signal, ascending, in `signal_unit`
  std::vector<double> curve;     ///< per knot, in the unit of the multiplier (attribution::spec_of)
  std::vector<double> curve_sd;  ///< standard deviation of `curve`
  std::string signal_unit;
  bool is_in_model = false;  ///< the extended model contains the curve
};

/// Estimated unknown heat along a training run, in W.
struct FluxTrace {
  std::string run;
  std::string node;
  std::vector<double> time_s;
  std::vector<double> before_W, after_W;
  std::vector<double> after_sd_W;  ///< posterior standard deviation, given the model
};

/// Mean heat in W that an effect or a run deviation adds to each node, over all training runs.
struct BalanceRow {
  std::string effect;
  std::map<std::string, double> heat_W;
};

/// Run of ten minutes that the advisor can plan.
enum class PlannedRun {
  speeds_without_load,      ///< raised in steps
  pulses_at_standstill,     ///< pulses of current
  spin_after_standstill,    ///< heated at standstill for five minutes, then without load while hot
  rest_after_spin,          ///< without load for five minutes from cold, then without current
  one_current_at_speeds,    ///< four of them
  one_speed_with_currents,  ///< four of them
  rest_after_standstill     ///< heated at standstill for five minutes, then without current
};

struct Experiment {
  std::string effect;                      ///< accepted effect
  std::string rival;                       ///< effect to separate it from
  std::string other;                       ///< experiment of the catalogue that separates the two, Candidate::experiment()
  std::optional<PlannedRun> planned = {};  ///< replaces `other` if it separates them
  /// Largest current and speed at which the motor gets no hotter than in the runs; empty: not part of the experiment.
  std::optional<double> most_A = {};
  std::optional<double> most_rad_per_s = {};
  std::optional<double> expected_nats = {};  ///< expected gain in evidence between them; empty for an experiment of the catalogue
};

/// A parameter of the file that the runs contradict.
struct ChangedParameter {
  std::string name;  ///< name in the network, "stator_ambient.thermal_resistance"
  std::string unit;
  double gain_nats = 0.0;  ///< ln evidence with the prior of a data sheet minus ln evidence with the file's prior
  /// Values of the parameter: of the file, of the final fit, and the fit's 95 % interval; all in `unit`.
  double before = 0.0;
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};

struct Diagnosis {
  DiagnosisVerdict verdict = DiagnosisVerdict::nothing_missing;
  std::vector<FoundEffect> effects;
  std::vector<ChangedParameter> changed;
  std::vector<Unexplained> unexplained;
  std::vector<ErrorInRun> train_errors;                          ///< errors in the training runs, per run and signal
  estimation::Errors before_train, after_train, refitted_train;  ///< errors over all training runs, for remarks
  std::vector<estimation::MeasuredRun> runs;                     ///< training runs
  std::vector<estimation::InnovationTests> tests_before, tests_after;
  std::vector<FluxTrace> flux;
  std::map<std::string, double> flux_rms_before_W, flux_rms_after_W;  ///< RMS of the unknown heat by node
  std::vector<BalanceRow> balance;
  std::vector<Experiment> experiments;
  attribution::Selection selection;
};

/// Returns the mean of the unknown heat that remains, summed over the nodes, divided by the mean of its magnitude: 1 if heat is
/// missing throughout, -1 if the model has too much. 0 without traces.
double net_share(const std::vector<FluxTrace>& flux);

/// True if the error is larger than the other by more than 10 % and by more than the threshold `matters_K`.
bool is_plainly_worse(double error_K, double than_K);

/// Runs the whole diagnosis on the training runs. Throws Failure (numerics_failed) if the model cannot be simulated along them.
Diagnosis diagnose(const DiagnosisInput& input, const attribution::SelectionRules& rules);

}  // namespace heatsoak::diagnosis
