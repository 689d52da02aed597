#include "diagnosis/diagnosis_job.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/collected_failures.h"
#include "base/diagnostic.h"
#include "calibration/followed_signals.h"
#include "calibration/forecast/forecast.h"
#include "calibration/unlogged_speed.h"
#include "diagnosis/coverage.h"
#include "diagnosis/left_out_band.h"
#include "estimation/log_columns.h"
#include "estimation/log_rows.h"
#include "estimation/turning_rows.h"

namespace heatsoak::diagnosis {
namespace {

const std::string kReading = "checking the runs";
const std::string kContradiction = "comparing the runs with each other";
const std::string kBand = "predicting left-out runs";
const std::string kScoring = "predicting the runs";

struct RunsOfLogs {
  std::vector<estimation::MeasuredRun> runs;
  std::vector<DiagnosisFinding> findings;
};

/// Reads the runs of the recordings; the caller throws `failures`. A log without a speed is accepted, as if no log had one: its loss at
/// speed is unknown heat.
RunsOfLogs runs_of(const std::vector<recording::Recording>& recordings, const estimation::MeasuredRunOptions& options,
                   base::CollectedFailures& failures) {
  RunsOfLogs all;
  for (const recording::Recording& recording : recordings) {
    estimation::MeasuredRunOptions here = options;
    if (!estimation::has_signal(recording, thermal::Signal::speed)) {
      std::erase(here.needed, thermal::Signal::speed);
    }
    if (std::optional<estimation::MeasuredRuns> runs = failures.attempt([&] { return estimation::measured_runs(recording, here); })) {
      std::ranges::move(runs->notes, std::back_inserter(all.findings));
      std::ranges::move(runs->runs, std::back_inserter(all.runs));
    }
  }
  return all;
}

/// Throws if not even the extended model follows the runs.
void refuse_where_nothing_follows(const Diagnosis& diagnosis, const DiagnosisInput& input) {
  std::map<std::string, double> rmse_K;
  std::ranges::for_each(diagnosis.after_train, [&](const auto& each) { rmse_K[each.first] = each.second.rmse_K; });
  if (std::vector<calibration::PoorFit> signals = calibration::not_followed(rmse_K, input.train); !signals.empty()) {
    throw calibration::NothingFollows(calibration::NothingFollows::Tried::effects, std::move(signals),
                                      std::ranges::none_of(input.train, calibration::turns_unseen));
  }
}

/// Scatter of the duration of a phase, from 12 diagnoses: standard deviation of its natural logarithm.
constexpr double kSpread_sd = 0.4;

/// Returns the phases of select_effects(). Usually the second round repeats the set of the first, and the search ends. The durations are
/// averages of runs of 0.5 to 6 hours, spreads and probabilities those of 12 diagnoses. `unit_s`: usual duration of one fit to the runs.
std::vector<base::JobPhase> selection_work(double unit_s) {
  using namespace attribution::selection_phases;
  constexpr double kThirdRound = 0.25;
  constexpr double kSomethingMissing = 0.5;
  constexpr double kSpread_last = 1.5;  // the last fit may start at its optimum
  return {{kFirstFit, 0.1 * unit_s, 1.0, {}, kSpread_sd},
          {kSearching, 0.4 * unit_s, 1.0, {}, kSpread_sd},
          {kFollowing, 0.1 * unit_s, 1.0, {}, kSpread_sd},
          {kSearching, 0.4 * unit_s, 1.0, {}, kSpread_sd},
          {kFollowing, 0.1 * unit_s, kThirdRound, {}, kSpread_sd},
          {kSearching, 0.4 * unit_s, kThirdRound, {}, kSpread_sd},
          {kCurves, 0.3 * unit_s, kSomethingMissing, {}, kSpread_sd},
          {kLastFit, 0.1 * unit_s, 1.0, {}, kSpread_last}};
}

void add_fitted_holdouts(const motor::Motor& motor, const std::vector<recording::Recording>& held_out,
                         std::vector<DiagnosisFinding>& findings) {
  for (const recording::Recording& each : held_out) {
    if (motor.fit && calibration::was_fitted_to(*motor.fit, each)) {
      findings.emplace_back(HoldoutWasFitted{each.name});
    }
  }
}

BandSize size_of_band(const motor::Motor& motor, const std::vector<recording::Recording>& fitted,
                      const calibration::PredictionOptions& options) {
  BandSize size{fitted.size(), {}};
  std::map<std::string, double> samples;
  for (const calibration::PredictedRun& run : calibration::predict(motor, fitted, options).runs) {
    for (const calibration::PredictedSignal& signal : run.signals) {
      for (std::size_t k = 0; k < signal.high_C.size(); ++k) {
        size.half_width_K[signal.signal] += 0.5 * (signal.high_C[k] - signal.low_C[k]);
      }
      samples[signal.signal] += static_cast<double>(signal.high_C.size());
    }
  }
  for (auto& [signal, sum_K] : size.half_width_K) {
    sum_K /= std::max(1.0, samples[signal]);
  }
  return size;
}

/// Diagnoses the motor from the recordings `fitted`. Stops and returns the recording that contradicts the others, if there is one.
std::optional<calibration::ContradictingRun> diagnose_recordings(const DiagnosisJob& job, const std::vector<recording::Recording>& fitted,
                                                                 const base::JobProgress& progress, DiagnosisAnswer& answer) {
  const std::vector<recording::Recording>& held_out = job.logs.held_out;
  const recording::LogChoice& choice = job.logs.choice;
  std::vector<DiagnosisFinding>& findings = answer.findings;
  ModelOfLogs model = model_of_logs(job.motor, fitted);
  std::ranges::move(model.findings, std::back_inserter(findings));
  estimation::MeasuredRunOptions how = model.how;
  how.ambient_C = choice.ambient_C;
  DiagnosisInput& input = answer.input;
  input.model = model.model;
  input.usual = model.usual;
  // The hold-out logs are read here only to refuse what cannot be read before the fit.
  base::CollectedFailures unreadable;
  RunsOfLogs training = runs_of(fitted, how, unreadable);
  RunsOfLogs holdout = runs_of(held_out, how, unreadable);
  unreadable.throw_if_any();
  std::ranges::move(training.findings, std::back_inserter(findings));
  input.train = std::move(training.runs);
  input.progress = progress;
  const double unit_s = calibration::usual_s(input.train);
  const std::vector<base::JobPhase> last{
      {kContradiction, 0.4 * unit_s, 1.0, {}, 2.0 * kSpread_sd}, {kBand, 0.2 * unit_s, 1.0, {}, kSpread_sd}, {kScoring, 0.01 * unit_s}};
  std::vector<base::JobPhase> phases = selection_work(unit_s);
  phases.insert(phases.begin(), {kReading, 0.4 * unit_s});
  phases.insert(phases.end(), last.begin(), last.end());
  progress.expect(std::move(phases));
  progress.begin(kReading);
  const std::optional<bool> is_speed_linear = estimation::settle_turning_rows(input.model, input.train);
  model.is_speed_linear = is_speed_linear.value_or(job.motor.fit && job.motor.fit->is_speed_linear);
  if (is_speed_linear.value_or(false)) {
    findings.emplace_back(calibration::RowsTurn{});
  }
  if (std::vector<std::string> rare = estimation::keep_common_columns(input.train, input.model.columns); !rare.empty()) {
    findings.emplace_back(ColumnsNotSearched{std::move(rare)});
  }
  if (std::optional<calibration::ContradictingRun> found = calibration::run_with_moved_sensor(input.model, input.train)) {
    return found;
  }
  answer.diagnosis = diagnose(input, {});
  const std::vector<std::string>& columns = answer.diagnosis.selection.after.model.columns;
  estimation::set_columns(input.train, columns);
  progress.expect(last);
  progress.begin(kContradiction);
  const attribution::Selection& selection = answer.diagnosis.selection;
  if (std::optional<calibration::ContradictingRun> found =
          calibration::contradicting_run(selection.after, input.train, selection.weights)) {
    if (found->moved) {
      return found;
    }
    // A missing effect that acts in one run only looks alike.
    findings.emplace_back(*std::move(found));
  }
  refuse_where_nothing_follows(answer.diagnosis, input);
  answer.motor = extended_motor(job.motor, model, answer.diagnosis);
  std::ranges::move(outside_declared_ranges(job.motor, model, answer.motor), std::back_inserter(findings));
  const calibration::PredictionOptions predicting{choice.ambient_C, model.heat};
  progress.begin(kBand);
  answer.motor.fit->band = left_out_band(job.motor, model, answer.diagnosis, fitted);
  if (answer.motor.fit->band) {
    answer.motor.fit->band = motor::rounded_as_in_file(*answer.motor.fit->band);
    answer.band = size_of_band(answer.motor, fitted, predicting);
  }
  progress.begin(kScoring);
  const std::array motors{job.motor, refitted_motor(job.motor, model, answer.diagnosis), answer.motor};
  std::vector<calibration::HoldoutDiverges> diverging;
  const std::vector<recording::Recording> scored = calibration::predictable(motors, held_out, predicting, diverging);
  answer.score = score_holdout({motors[0], motors[1], motors[2]}, scored, predicting);
  answer.score.runs = std::move(holdout.runs);
  for (calibration::HoldoutDiverges& each : diverging) {
    std::erase_if(answer.score.runs, [&](const estimation::MeasuredRun& run) { return estimation::recording_of(run) == each.recording; });
    findings.emplace_back(std::move(each));
  }
  std::ranges::move(holdout.findings, std::back_inserter(findings));
  if (model.is_speed_linear) {
    answer.score.runs = estimation::turning_within_rows(std::move(answer.score.runs));
  }
  estimation::set_columns(answer.score.runs, columns);
  answer.score.beyond_training = beyond_fitted(answer.diagnosis.runs, answer.score.runs);
  std::ranges::move(estimation::columns_lacking(columns, held_out), std::back_inserter(findings));
  add_fitted_holdouts(job.motor, held_out, findings);
  return std::nullopt;
}

}  // namespace

DiagnosisAnswer run_diagnosis(const DiagnosisJob& job, const base::JobProgress& progress) {
  const calibration::Admission admission = calibration::admit(job.motor, job.logs);
  std::vector<recording::Recording> fitted = job.logs.fitted;
  std::vector<DiagnosisFinding> first;
  if (job.motor.fit && !job.motor.fit->extensions.empty()) {
    first.emplace_back(ExtensionsMayImitate{job.motor.fit->extensions});
  }
  DiagnosisAnswer answer;
  // Parameters between those of two mountings would hold for neither.
  while (const std::optional<calibration::ContradictingRun> odd = diagnose_recordings(job, fitted, progress, answer)) {
    first.emplace_back(*odd);
    std::get<calibration::ContradictingRun>(first.back()).is_left_out = true;
    if (std::erase_if(fitted, [&](const recording::Recording& each) { return each.name == odd->run; }) == 0) {
      throw std::logic_error("there is no recording " + odd->run);
    }
    answer = {};
  }
  answer.admission = admission;
  answer.findings.insert(answer.findings.begin(), first.begin(), first.end());
  return answer;
}

}  // namespace heatsoak::diagnosis
