// Fits to some of the runs, and predictions of the runs that such a fit did not use.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "estimation/design.h"
#include "estimation/posterior.h"

namespace heatsoak::estimation {

/// Returns the sum over all runs but one.
Products sum_of(const std::vector<Products>& parts, std::optional<std::size_t> left_out = std::nullopt);

/// Adds up the products of the parts of each recording. `parts`: one per run, its start temperatures eliminated.
std::vector<Products> by_recording(const std::vector<Products>& parts, const std::vector<MeasuredRun>& runs);

/// Returns ln p of every recording, given all others. `parts` as from by_recording(); `evidence_nats(reduced)`: ln evidence of a set of
/// effects.
template <class Evidence>
Eigen::VectorXd left_out_nats(const std::vector<Products>& parts, const ThetaPrior& prior, Evidence evidence_nats) {
  Eigen::VectorXd nats = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(parts.size()), evidence_nats(reduced(sum_of(parts), prior)));
  for (std::size_t r = 0; r < parts.size(); ++r) {
    nats[static_cast<Eigen::Index>(r)] -= evidence_nats(reduced(sum_of(parts, r), prior));
  }
  return nats;
}

/// True if the left-out recordings, without the one that gains most, together gain more than `least_nats`: an explanation must not depend
/// on one recording. `gain_nats`: gain of each recording as the difference of two results of left_out_nats(). False for a single recording.
bool is_confirmed(const Eigen::VectorXd& gain_nats, double least_nats);

/// Some of the runs, with their part of a fit to all, their weights and averaging.
struct SomeRuns {
  std::vector<MeasuredRun> runs;
  Posterior start;
  PosteriorOptions options;
};

/// Returns the runs for which `belongs(run)` is true. `fit` is the fit to all runs.
template <class Predicate>
SomeRuns some_of(const std::vector<MeasuredRun>& runs, const Posterior& fit, const PosteriorOptions& options, Predicate belongs) {
  SomeRuns part{{}, {}, options};
  part.start.model = fit.model;
  part.options.weights.clear();
  part.options.merged.clear();
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (belongs(runs[r])) {
      part.runs.push_back(runs[r]);
      part.start.start_C.push_back(fit.start_C[r]);
      part.start.fitted.push_back(fit.fitted[r]);
      if (!options.weights.empty()) {
        part.options.weights.push_back(options.weights[r]);
      }
      if (!options.merged.empty()) {
        part.options.merged.push_back(options.merged[r]);
      }
    }
  }
  return part;
}

/// Fits the model to these runs; the evidence is −∞ if the fit fails.
Posterior fit_of(const SomeRuns& some);

/// Returns the run with NaN for the samples whose weight is 0. `weight` per sample; empty: all stay.
MeasuredRun without_rejected(MeasuredRun run, const Eigen::VectorXd& weight);

/// Returns the number of effects and deviations of the conditions of this run; 1 if it has none but all other recordings of `runs` have
/// some. Without the run, nothing may determine their sizes.
std::ptrdiff_t own_effect_count(const Model& model, const std::vector<MeasuredRun>& runs, const MeasuredRun& run);

/// True if at least three recordings have no effect of their own: fewer have too few different loads to show what predicts another one.
bool can_leave_out(const Model& model, const std::vector<MeasuredRun>& runs);

/// Predicts every recording with a fit to the others that starts from `fit`. Returns the RMS error in K over these recordings and all
/// signals, with equal weights; ∞ if a fit fails. Recordings with an effect of their own are fitted, but not predicted: in the model
/// `usual_in`, or in that of `fit` if it is null. Samples with the weight 0 do not count. Call it only if can_leave_out(). If the error is
/// above `largest_K`, the result is the error or ∞, because not all recordings need a fit then.
double left_out_error_K(const Posterior& fit, const std::vector<MeasuredRun>& runs, const PosteriorOptions& options,
                        double largest_K = std::numeric_limits<double>::infinity(), const Model* usual_in = nullptr);

/// Returns `fit`, or a fit with the options `plain` that starts from it if that predicts better: left-out recordings with
/// less than Thresholds::better_share of the error, or, with too few recordings, the last third of every run after a fit to the first two
/// thirds. The difference of the two is added to the covariance. `own`: the options of `fit`. Weights and averaging are per run.
Posterior more_predictive(Posterior fit, const std::vector<MeasuredRun>& runs, const PosteriorOptions& own, const PosteriorOptions& plain);

}  // namespace heatsoak::estimation
