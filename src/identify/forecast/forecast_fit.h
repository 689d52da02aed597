// Output-error fit: parameters with which a model that runs free follows whole runs, with priors and a tempered likelihood.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "identify/forecast/forecast_model.h"
#include "identify/open_loop.h"

namespace heatsoak {

/// What a fit looks at in a run: whether each row counts (sample · sensors + sensor). Empty: all.
using RowMask = std::vector<char>;

struct ForecastRules {
  /// The errors of a run are correlated: N samples count as the number of independent ones (initial positive sequence of Geyer 1992,
  /// about zero). false: ordinary least squares, beside which priors do not count.
  bool is_tempered = true;
  bool has_heat_factors = true;  ///< one per run; only with two runs or more
  int rounds = 3;                ///< of the fit and the update of error and weight
  int steps = 25;                ///< of Levenberg and Marquardt per round
  double held_error_K = 0.0;     ///< above 0: error and weight are these and not updated, so that costs can be compared
  double held_weight = 1.0;
  int threads = 0;  ///< 0: all cores; the result does not depend on it
};

struct ForecastFit {
  Eigen::VectorXd theta;
  Eigen::VectorXd heat_log;      ///< per run
  std::vector<RunStart> starts;  ///< per run
  // Of any fit, tempered or not, the following are those of the tempered cost there.
  Eigen::MatrixXd covariance;               ///< of θ: inverse curvature of the cost, heat factors and starts included
  double error_K = 0.0;                     ///< rms of the rows that count, at least the sensors' noise
  double weight = 1.0;                      ///< independent samples per sample
  double cost_nats = 0.0;                   ///< at the error and weight of the last round
  std::vector<Eigen::VectorXd> residual_K;  ///< per run: sample · sensors + sensor; NaN: nothing measured
};

/// From `theta`. `masks`: one per run, or none. The cost is infinite where the model cannot be run there.
ForecastFit fit_forecast(const ForecastModel& model, std::span<const MeasuredRun> runs, std::span<const RowMask> masks,
                         const Eigen::VectorXd& theta, const ForecastRules& rules);

/// Cost in nats of other parameters at the error and weight of a fit, with the heat factors and starts that suit them best.
double cost_at(const ForecastModel& model, std::span<const MeasuredRun> runs, std::span<const RowMask> masks, const ForecastFit& fit,
               const Eigen::VectorXd& theta, int threads);

/// Independent samples of errors whose correlation is about zero, not about their mean. NaN: no sample.
double independent_samples(const Eigen::VectorXd& error_K);

}  // namespace heatsoak
