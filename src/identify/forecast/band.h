// How far a forecast may be off: parameters, heat of the run, slow unknown heat, sensor noise.
#pragma once

#include <span>
#include <vector>

#include "identify/forecast/pieces.h"
#include "motor/fit_table.h"

namespace heatsoak {

/// Two-sided 90 % of a normal distribution, in standard deviations.
inline constexpr double kBand_sd = 1.645;

/// Standard deviation of each row (sample · sensors + sensor) of a forecast along `path`, in K; noise of the sensors included.
/// `covariance`: of θ; `start_K2`: of the start temperatures; `heat_W`: rms heat of the run.
Eigen::VectorXd forecast_sd_K(const LinearisedRun& path, const MeasuredRun& run, const Eigen::MatrixXd& covariance,
                              const Eigen::MatrixXd& start_K2, double heat_W, const ForecastBand& band);

/// What is taken where no left-out piece tells; its time scale is a third of `duration_s`.
ForecastBand usual_band(double duration_s);

/// The band under which the errors of the pieces are most probable, widened until it holds 90 % of them and, as so few were left out
/// (`left_out`, at least 1), by Student's distribution.
ForecastBand fit_band(const ForecastModel& model, std::span<const MeasuredRun> runs, std::span<const PredictedPiece> pieces,
                      std::size_t left_out);

}  // namespace heatsoak
