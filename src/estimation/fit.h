// Fit of a model to all runs, beside the most probable unknown heat. It is the whole of a calibration, and the start of an attribution,
// which adds effects to the same posterior.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "estimation/flux_grid.h"
#include "estimation/measured_run.h"
#include "estimation/model.h"
#include "estimation/posterior.h"

namespace heatsoak::estimation {

/// Samples and grid of the unknown heat that all fits to the same runs share.
struct FitSetup {
  std::vector<int> merged;               ///< per run, number of samples per average
  std::vector<Eigen::VectorXd> weights;  ///< per run and sample: 0 for samples that the model excludes as wrong; empty: all 1
  double mean_heat_W = 0.0;              ///< heat of the runs that the fit compares unknown heat with, from usual_heat_W()
  double material_W = 0.0;               ///< unknown heat that warms the outermost body by `material_K`; scale of the grid
  FluxGrid grid;

  /// Returns options for a fit with one assumption about the unknown heat.
  [[nodiscard]] PosteriorOptions with(const LatentFlux& flux) const;
  /// Returns options for a fit whose covariance is averaged over the neighbours of `place`.
  [[nodiscard]] PosteriorOptions around(const FluxPlace& place) const;
  /// Returns options for plain least squares of the free runs, without unknown heat.
  [[nodiscard]] PosteriorOptions plain() const;
  /// Repeats the screening of the samples along a fit.
  void screen(const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs);
};

struct FitOptions {
  int starts = 8;             ///< Latin hypercube points in addition to the model's own values; 0: only the latter
  double start_spread = 1.1;  ///< half width of the hypercube in θ; 1.1 = ln 3
  std::uint64_t seed = 1;     ///< seeds the random hypercube points
  int threads = 0;            ///< 0: all cores; the result does not depend on it
  bool with_flux = true;      ///< false: assumes no unknown heat flux (for comparison)
};

/// Plain least squares of the free runs, and the samples that agree with it.
struct FirstFit {
  Posterior fit;
  FitSetup setup;
};
/// Throws Failure (cannot_answer) if the simulation diverges from every starting point.
FirstFit first_fit(const Model& model, const std::vector<MeasuredRun>& runs, const FitOptions& options);

/// Returns the most probable unknown heat of a model without added effects. `designs`: without further columns.
FluxPlace most_probable_heat(const std::vector<DesignRun>& designs, const ThetaPrior& prior, const FluxGrid& grid, FluxPlace start);

struct Fit {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;                ///< covariance of θ, averaged over the neighbours of `flux`
  Eigen::MatrixXd covariance_at_flux;        ///< covariance of θ, given `flux`
  Eigen::MatrixXd information;               ///< inverse covariance of θ by the data alone, given `flux`
  LatentFlux flux;                           ///< most probable value
  bool is_flux_limited = false;              ///< a larger unknown heat may be more probable
  std::vector<std::vector<double>> start_C;  ///< start temperatures per run
  FitSetup setup;
  double log_evidence = 0.0;  ///< in nats, at `flux` and the most probable θ
  bool has_converged = false;
  /// RMS error of the runs, if θ is from plain least squares of free runs, because that predicts left-out runs clearly better.
  std::optional<double> free_run_error_K = {};

  /// Fraction of the measured samples that were excluded.
  [[nodiscard]] double rejected_share(std::span<const MeasuredRun> runs) const;
};

/// Returns the ln evidence of the model at the most probable unknown heat of a search from the model's values. Throws Failure as
/// first_fit() does.
double evidence_nats(const Model& model, const std::vector<MeasuredRun>& runs);

/// Fits the model. Throws Failure as first_fit() does.
Fit fit(const Model& model, const std::vector<MeasuredRun>& runs, const FitOptions& options);

}  // namespace heatsoak::estimation
