#include "calibration/contradicting_run.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/parallel.h"
#include "estimation/free_run_errors.h"
#include "estimation/left_out_runs.h"
#include "estimation/thresholds.h"

namespace heatsoak::calibration {
namespace {

/// Smallest error of a run that contradicts the others, and largest error of the others. If the model is wrong by more, runs with
/// different loads contradict each other although nothing was changed.
constexpr double kContradicts_K = estimation::kIncompleteModel_K;
/// Smallest error of a run that contradicts the others without a sign of a moved sensor: a mounting that changes rises of 30 K by 10 %.
/// Smaller errors are usual for a run with another load, such as one on a bench, if an effect is missing.
constexpr double kOtherMounting_K = 3.0;
/// Smallest ratio of the error of a run, predicted with the parameters of the others, to the errors of both fits: 7 to 14 if a sensor was
/// moved, at most 4 otherwise (18 synthetic motors).
constexpr double kContradicts_ratio = 5.0;

/// Largest number of steps of each fit; later steps change the error of a run by less than 1 %.
constexpr int kMostSteps = 10;
/// Number of steps of a first fit. A run whose errors are then below `kFar_share` of the limits agrees with the others. For moved sensors,
/// the ratio after these steps is 4.3 or more (15 synthetic cases).
constexpr int kFewSteps = 3;
constexpr double kFar_share = 0.5;

/// Largest number of effects that explain why one run differs. With more of them, any run can be followed.
constexpr std::ptrdiff_t kMostOwnEffects = 2;

/// Ratio of the error of the run to that of its best explanation.
double ratio(const ContradictingRun& each) {
  const double explained_K = each.moved ? std::min(each.alone_K, each.moved->rmse_K) : each.alone_K;
  return each.by_others_K / std::max(explained_K, each.usual_K);
}

class Comparison {
 public:
  Comparison(const estimation::Posterior& fit, const std::vector<estimation::MeasuredRun>& runs,
             const std::vector<Eigen::VectorXd>& weights)
      : fit_(fit), runs_(runs), options_(estimation::least_squares_options(fit.model, kMostSteps)) {
    options_.weights = weights;
    const auto has_own = [&](const estimation::MeasuredRun& run) { return estimation::own_effect_count(fit.model, runs, run) > 0; };
    if (std::ranges::any_of(runs, has_own)) {
      together_ = estimation::fit_of(estimation::some_of(runs, fit, options_, [](const auto&) { return true; }));
    }
  }

  /// Returns the sensor at which the recording contradicts the others most.
  [[nodiscard]] std::optional<ContradictingRun> of(const std::string& recording) const {
    if (together_ && !std::isfinite(together_->evidence_nats)) {
      return std::nullopt;
    }
    const std::optional<FromOthers> soon = from_others(recording, kFewSteps);
    if (!soon || !soon->contradicts(kFar_share)) {
      return std::nullopt;
    }
    const std::optional<FromOthers> rest = from_others(recording, kMostSteps);
    if (!rest || !rest->contradicts(1.0)) {
      return std::nullopt;
    }
    const estimation::Posterior alone = estimation::fit_of(rest->own);
    if (!std::isfinite(alone.evidence_nats)) {
      return std::nullopt;
    }
    const estimation::Errors alone_K = estimation::open_loop_errors(alone.model, rest->own.runs, {});
    const double usual_K = estimation::rms_K(rest->of_others);
    if (is_explained(rest->own.runs) && !spoils(rest->others, usual_K) &&
        !spoils(rest->own.runs, std::max(usual_K, estimation::rms_K(alone_K)))) {
      return std::nullopt;
    }
    const std::optional<estimation::MovedSensor> moved = estimation::moved_sensor(rest->model, rest->own.runs);
    std::optional<ContradictingRun> worst;
    for (const auto& [signal, error] : rest->by_others) {
      ContradictingRun each{recording,    signal,
                            error.rmse_K, alone_K.at(signal).rmse_K,
                            {},           rest->of_others.contains(signal) ? rest->of_others.at(signal).rmse_K : error.rmse_K};
      if (moved && moved->rmse_K < kContradicts_K && moved->rmse_K < each.alone_K) {
        each.moved = moved;
      }
      if (each.by_others_K > (each.moved ? kContradicts_K : kOtherMounting_K) && ratio(each) > kContradicts_ratio &&
          (!worst || ratio(each) > ratio(*worst))) {
        worst = each;
      }
    }
    return worst;
  }

 private:
  /// Errors of a recording and of the others, with parameters fitted to the others.
  struct FromOthers {
    estimation::SomeRuns own;
    std::vector<estimation::MeasuredRun> others;
    estimation::Model model;  ///< with these parameters
    estimation::Errors by_others, of_others;

    /// Returns whether these errors contradict; `share` < 1 makes the limits less strict.
    [[nodiscard]] bool contradicts(double share) const {
      return estimation::rms_K(of_others) < kContradicts_K / share && std::ranges::any_of(by_others, [&](const auto& each) {
               const auto& [signal, error] = each;
               const double usual_K = of_others.contains(signal) ? of_others.at(signal).rmse_K : 0.0;
               return error.rmse_K > share * kContradicts_K && error.rmse_K > share * kContradicts_ratio * usual_K;
             });
    }
  };

  /// Empty if the fit or a simulation fails.
  [[nodiscard]] std::optional<FromOthers> from_others(const std::string& recording, int most_steps) const {
    estimation::PosteriorOptions options = options_;
    options.most_steps = most_steps;
    const auto is_own = [&](const estimation::MeasuredRun& run) { return estimation::recording_of(run) == recording; };
    estimation::SomeRuns others = estimation::some_of(runs_, fit_, options, std::not_fn(is_own));
    const estimation::Posterior fit = estimation::fit_of(others);
    if (!std::isfinite(fit.evidence_nats)) {
      return std::nullopt;
    }
    estimation::SomeRuns own = estimation::some_of(runs_, fit_, options, is_own);
    std::optional<estimation::Errors> by_others = estimation::try_open_loop_errors(fit.model, own.runs, others.runs);
    if (!by_others) {
      return std::nullopt;
    }
    estimation::Errors of_others = estimation::open_loop_errors(fit.model, others.runs, {});
    return FromOthers{std::move(own), std::move(others.runs), fit.model, std::move(*by_others), std::move(of_others)};
  }

  /// True if the model contains a few effects of this recording alone. If most recordings have effects that no log states, none of them
  /// shows what is usual.
  [[nodiscard]] bool is_explained(const std::vector<estimation::MeasuredRun>& own) const {
    const auto is_unstated = [&](const estimation::MeasuredRun& run) {
      const auto is_of_run = [&](const auto& term) { return term.condition.contains("run") && run.has(term.condition); };
      return std::ranges::any_of(fit_.model.conditional, is_of_run) || std::ranges::any_of(fit_.model.deviations, is_of_run);
    };
    if (2 * std::ranges::count_if(runs_, is_unstated) > std::ssize(runs_)) {
      return false;
    }
    std::ptrdiff_t effects = 0;
    std::ranges::for_each(own, [&](const auto& run) { effects = std::max(effects, estimation::own_effect_count(fit_.model, runs_, run)); });
    return effects > 0 && effects <= kMostOwnEffects;
  }

  /// Returns whether a fit to all runs follows these runs clearly worse than `usual_K`. An effect that the fit contains then stands for
  /// something that its law does not describe, such as a moved sensor.
  [[nodiscard]] bool spoils(const std::vector<estimation::MeasuredRun>& runs, double usual_K) const {
    return estimation::rms_K(estimation::open_loop_errors(together_->model, runs, {})) >
           estimation::thresholds().clearly_other_ratio * usual_K;
  }

  const estimation::Posterior& fit_;
  const std::vector<estimation::MeasuredRun>& runs_;
  estimation::PosteriorOptions options_;
  std::optional<estimation::Posterior> together_;  ///< fit to all runs; only if an effect belongs to some of them
};

}  // namespace

std::optional<ContradictingRun> contradicting_run(const estimation::Posterior& fit, const std::vector<estimation::MeasuredRun>& runs,
                                                  const std::vector<Eigen::VectorXd>& weights) {
  // Parts of one recording belong together: nobody moves a sensor during a gap of the log.
  std::vector<std::string> recordings;
  for (const estimation::MeasuredRun& run : runs) {
    const std::string name = estimation::recording_of(run);
    if (std::ranges::find(recordings, name) == recordings.end()) {
      recordings.push_back(name);
    }
  }
  if (recordings.size() < 3) {
    return std::nullopt;
  }
  const Comparison comparison(fit, runs, weights);
  std::vector<std::optional<ContradictingRun>> found(recordings.size());
  base::in_parallel(recordings.size(), 0, [&](std::size_t i) { found[i] = comparison.of(recordings[i]); });
  std::erase(found, std::nullopt);
  const auto largest = std::ranges::max_element(found, {}, [](const auto& each) { return ratio(*each); });
  return largest == found.end() ? std::nullopt : *largest;
}

std::optional<ContradictingRun> contradicting_run(const estimation::Model& model, const estimation::Fit& fit,
                                                  const std::vector<estimation::MeasuredRun>& runs) {
  estimation::PosteriorOptions options = estimation::least_squares_options(model, kFewSteps);
  options.weights = fit.setup.weights;
  estimation::Model fitted = model;
  fitted.set_theta(fit.theta);
  const estimation::Posterior near = estimation::try_posterior_of(std::move(fitted), runs, fit.start_C, options);
  return std::isfinite(near.evidence_nats) ? contradicting_run(near, runs, options.weights) : std::nullopt;
}

std::optional<ContradictingRun> run_with_moved_sensor(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs) {
  const estimation::FirstFit first = estimation::first_fit(model, runs, {.starts = 0});
  std::optional<ContradictingRun> found = contradicting_run(first.fit, runs, first.setup.weights);
  return found && found->moved ? found : std::nullopt;
}

}  // namespace heatsoak::calibration
