// The runs at the present fit as linear algebra takes them: columns of everything free, of every candidate, and the residual.
#pragma once

#include <vector>

#include "attribution/extended_model.h"
#include "estimation/evidence.h"

namespace heatsoak {

/// One run. The columns are: one per coordinate of the model (per unit of θ), then those of candidates (per typical size).
struct DesignRun {
  LinearisedRun run;  ///< averaged, see estimation/averaged_run.h; without by_parameter
  SensorNoise noise;
  StartPrior start;
  Columns columns;
  std::vector<Eigen::Index> interval_of;  ///< per interval of the log that of `run`; -1: none
};

/// Gaussian knowledge of θ; the mean is relative to the present θ.
struct ThetaPrior {
  Eigen::MatrixXd precision;
  Eigen::VectorXd mean;
};

/// `weights` per run and sample as SensorNoise has them, or empty. `merged` per run how many samples are averaged, or empty: none.
/// `extra` columns per run beside those of the model's coordinates, or empty.
std::vector<DesignRun> design(const Network& network, const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs,
                              const std::vector<Eigen::VectorXd>& weights, const std::vector<int>& merged,
                              const std::vector<Columns>& extra);

/// The prior of the model's coordinates relative to where they are.
ThetaPrior prior_here(const ExtendedModel& model);

/// First measured temperatures; nodes without a sensor begin between the measured ones.
std::vector<double> measured_start_C(const Network& network, const MeasuredRun& run);

/// Products of whitened columns over all runs under one supposition, the start temperatures eliminated.
struct Products {
  Eigen::MatrixXd square;        ///< of [columns, residual], (c + 1) × (c + 1)
  double log_determinant = 0.0;  ///< ln|V| + ln|posterior precision of the starts| − ln|prior precision of the starts|
};

/// Uses the columns with these indices, in this order; empty: all columns.
Products products_of(const std::vector<DesignRun>& runs, const LatentFlux& flux, const std::vector<Eigen::Index>& columns);

/// Least squares of the candidates after θ, the model's own parameters, has been eliminated.
struct Reduced {
  double base_nats = 0.0;         ///< ln evidence of the model without any candidate, up to a constant
  Eigen::MatrixXd products;       ///< e × e
  Eigen::VectorXd right;          ///< e: products with the residual
  Eigen::MatrixXd theta_by_size;  ///< t × e: how θ moves per unit of each size, with the opposite sign
  Eigen::VectorXd theta;          ///< step without any candidate
  Eigen::VectorXd whole;          ///< e: squares of the columns before θ absorbed anything
};

Reduced reduced(const Products& products, const ThetaPrior& prior);

}  // namespace heatsoak
