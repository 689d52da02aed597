// Output-error fit: finds parameters with which a free-running model follows whole runs, with priors and a tempered likelihood.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "calibration/forecast/forecast_model.h"
#include "estimation/open_loop.h"

namespace heatsoak::calibration {

/// Rows of a run that a fit uses: nonzero if row (sample · sensors + sensor) counts. Empty: all rows.
using RowMask = std::vector<char>;

/// Statistics of the errors that the cost of a fit assumes.
struct ForecastErrorModel {
  double error_K = 0.0;  ///< RMS error, above 0
  double weight = 1.0;   ///< independent samples per sample, 0 to 1
};

struct ForecastRules {
  /// true: since the errors of a run are correlated, N samples count as the number of independent ones (initial positive sequence of Geyer
  /// 1992, about zero). false: ordinary least squares, in which the priors are negligible.
  bool is_tempered = true;
  bool has_heat_factors = true;  ///< fits one heat factor per run if there are two runs or more
  int rounds = 3;                ///< number of fits, each followed by an update of error and weight
  int steps = 25;                ///< steps per round within a trust region
  /// Error and weight if they are fixed, so that costs can be compared; empty: estimated in each round.
  std::optional<ForecastErrorModel> held = {};
  int threads = 0;                           ///< 0: all cores; the result does not depend on it
  std::function<void()> on_simulation = {};  ///< called after each simulation of all runs; may be empty
};

struct ForecastFit {
  Eigen::VectorXd theta;
  Eigen::VectorXd heat_log;                  ///< logarithm of the heat factor, per run
  std::vector<estimation::RunStart> starts;  ///< per run
  // The following values are those of the tempered cost at θ, for ordinary fits too.
  Eigen::MatrixXd covariance;               ///< covariance of θ: inverse curvature of the cost, with heat factors and starts free
  double error_K = 0.0;                     ///< RMS error of the rows that count, at least the sensors' noise
  double weight = 1.0;                      ///< independent samples per sample
  double cost_nats = 0.0;                   ///< with the error and weight of the last round
  std::vector<Eigen::VectorXd> residual_K;  ///< per run, row = sample · sensors + sensor; NaN: not measured
};

/// Fits the model, starting at `theta`. `masks` has one entry per run, or none. The cost is infinite if the simulation fails at `theta`.
ForecastFit fit_forecast(const ForecastModel& model, std::span<const estimation::MeasuredRun> runs, std::span<const RowMask> masks,
                         const Eigen::VectorXd& theta, const ForecastRules& rules);

/// Returns the number of independent samples. The correlation is computed about zero, not about the mean of the errors. NaN are skipped.
double independent_samples(const Eigen::VectorXd& error_K);

}  // namespace heatsoak::calibration
