// The linearised runs as least squares: columns of all free parameters and candidates, and the residual.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimation/evidence.h"
#include "estimation/model_along_run.h"

namespace heatsoak::estimation {

/// One linearised run. Columns: one per coordinate of the model (per unit of θ), then one per candidate (per typical size).
struct DesignRun {
  LinearisedRun run;  ///< averaged run, see estimation/averaged_run.h; by_parameter is empty
  SensorNoise noise;
  StartPrior start;
  Columns columns;
  std::vector<Eigen::Index> active;  ///< indices of the columns that are not zero throughout the run, ascending
  /// For each interval of the log, the index of the interval in `run` that contains it, if there is one.
  std::vector<std::optional<Eigen::Index>> interval_of;
};

/// Gaussian prior of θ. The mean is relative to the present θ.
struct ThetaPrior {
  Eigen::MatrixXd precision;
  Eigen::VectorXd mean;
};

/// Builds the columns of all runs, in parallel. `weights`: per run SensorNoise::weight, or empty. `merged`: per run the number of samples
/// per average, or empty for no averaging. `extra`: per run additional columns after those of the model's coordinates, or empty.
std::vector<DesignRun> design(const thermal::Network& network, const std::vector<LinearisedRun>& fitted,
                              const std::vector<MeasuredRun>& runs, const std::vector<Eigen::VectorXd>& weights,
                              const std::vector<int>& merged, const std::vector<Columns>& extra);

/// Returns the prior of the model's coordinates relative to their present values.
ThetaPrior prior_here(const Model& model);

/// Returns the start temperature of every state node in °C, from the first samples. Rule for a node without a sensor: start_of().
std::vector<double> measured_start_C(const thermal::Network& network, const MeasuredRun& run);

/// Products of the whitened columns, summed over all runs for one assumed unknown heat. The start temperatures are eliminated.
struct Products {
  Eigen::MatrixXd square;        ///< products of [columns, residual], (c + 1) × (c + 1)
  double log_determinant = 0.0;  ///< ln|V| + ln|posterior precision of the starts| − ln|prior precision of the starts|
};

/// Adds the prior of the start temperatures to `square`: products of whitened [start temperatures, columns, residual].
void add_start_prior(const StartPrior& start, Eigen::MatrixXd& square);
/// Eliminates the start temperatures from such products of one run, with their prior, and adds the rest to `sum`.
void add_without_starts(const Eigen::MatrixXd& square, const DesignRun& design, const Whitening& whitening, Products& sum);
/// Computes the products of the columns with these indices, in this order; empty: all columns.
Products products_of(std::span<const DesignRun> runs, const LatentFlux& flux, const std::vector<Eigen::Index>& columns);

/// Normal equations of e candidates after the t parameters θ of the model have been eliminated.
struct Reduced {
  double base_nats = 0.0;         ///< ln evidence of the model without any candidate, up to a constant
  Eigen::MatrixXd products;       ///< e × e: products of the columns
  Eigen::VectorXd right;          ///< e: products with the residual
  Eigen::MatrixXd theta_by_size;  ///< t × e: decrease of θ per unit of each size
  Eigen::VectorXd theta;          ///< step of θ without any candidate
  Eigen::VectorXd whole;          ///< e: squares of the columns before θ was eliminated
};

/// Eliminates θ, the first columns of `products`. A direction of θ without data and without prior stays at its present value.
Reduced reduced(const Products& products, const ThetaPrior& prior);

}  // namespace heatsoak::estimation
