#include "diagnosis/contradicting_run.h"

#include <algorithm>
#include <cmath>

#include "estimation/free_run_errors.h"
#include "estimation/left_out_runs.h"
#include "estimation/thresholds.h"

namespace heatsoak::diagnosis {
namespace {

/// Smallest error of a run that contradicts the others, and largest error of the others. If the model is wrong by more, runs with
/// different loads contradict each other although nothing was changed.
constexpr double kContradicts_K = estimation::kIncompleteModel_K;
/// Smallest ratio of the error of a run, predicted with the parameters of the others, to the errors of both fits: 7 to 14 if a sensor was
/// moved, at most 4 otherwise (18 synthetic motors).
constexpr double kContradicts_ratio = 5.0;

/// Largest number of effects that explain why one run differs. With more of them, any run can be followed.
constexpr std::ptrdiff_t kMostOwnEffects = 2;

/// Returns whether a fit to all runs follows these runs clearly worse than `usual_K`. An effect that the fit contains then stands for
/// something that its law does not describe, such as a moved sensor.
bool spoils(const estimation::Posterior& together, const std::vector<estimation::MeasuredRun>& runs, double usual_K) {
  return estimation::rms_K(estimation::open_loop_errors(together.model, runs, {})) > estimation::thresholds().clearly_other_ratio * usual_K;
}

}  // namespace

std::optional<ContradictingRun> contradicting_run(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs,
                                                  const std::vector<std::vector<double>>& start_C,
                                                  const estimation::PosteriorOptions& options) {
  // Parts of one recording belong together: nobody moves a sensor during a gap of the log.
  std::vector<std::string> recordings;
  for (const estimation::MeasuredRun& run : runs) {
    const std::string name = estimation::recording_of(run);
    if (std::ranges::find(recordings, name) == recordings.end()) {
      recordings.push_back(name);
    }
  }
  std::vector<ContradictingRun> found;
  if (recordings.size() < 3) {
    return std::nullopt;
  }
  const estimation::Posterior together =
      estimation::fit_of(model, estimation::some_of(runs, start_C, options, [](const estimation::MeasuredRun&) { return true; }));
  if (!std::isfinite(together.evidence_nats)) {
    return std::nullopt;
  }
  for (const std::string& recording : recordings) {
    const estimation::SomeRuns own = estimation::some_of(
        runs, start_C, options, [&](const estimation::MeasuredRun& run) { return estimation::recording_of(run) == recording; });
    const estimation::SomeRuns others = estimation::some_of(
        runs, start_C, options, [&](const estimation::MeasuredRun& run) { return estimation::recording_of(run) != recording; });
    const estimation::Posterior alone = estimation::fit_of(model, own);
    const estimation::Posterior rest = estimation::fit_of(model, others);
    if (!std::isfinite(alone.evidence_nats) || !std::isfinite(rest.evidence_nats)) {
      continue;
    }
    const estimation::Errors alone_K = estimation::open_loop_errors(alone.model, own.runs, {});
    const estimation::Errors rest_K = estimation::open_loop_errors(rest.model, others.runs, {});
    const double usual_K = estimation::rms_K(rest_K);
    if (usual_K > kContradicts_K) {
      continue;
    }
    std::ptrdiff_t effects = 0;
    std::ranges::for_each(own.runs, [&](const auto& run) { effects = std::max(effects, estimation::own_effect_count(model, run)); });
    if (effects > 0 && effects <= kMostOwnEffects && !spoils(together, others.runs, usual_K) &&
        !spoils(together, own.runs, std::max(usual_K, estimation::rms_K(alone_K)))) {
      continue;
    }
    for (const auto& [signal, error] : estimation::open_loop_errors(rest.model, own.runs, others.runs)) {
      const ContradictingRun each{recording, signal, error.rmse_K, alone_K.at(signal).rmse_K,
                                  rest_K.contains(signal) ? rest_K.at(signal).rmse_K : error.rmse_K};
      if (each.by_others_K > kContradicts_K && each.by_others_K > kContradicts_ratio * std::max(each.alone_K, each.usual_K)) {
        found.push_back(each);
      }
    }
  }
  const auto ratio = [](const ContradictingRun& each) { return each.by_others_K / std::max(each.alone_K, each.usual_K); };
  const auto largest = std::ranges::max_element(found, {}, ratio);
  return largest == found.end() ? std::nullopt : std::optional(*largest);
}

}  // namespace heatsoak::diagnosis
