// Uncertainty band of a forecast: from parameters, heat factor of the run, slow unknown heat and sensor noise.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calibration/forecast/pieces.h"
#include "motor/fit_table.h"

namespace heatsoak::calibration {

/// Half width of the interval of a normal distribution that contains base::kBand_share of it, in standard deviations.
inline constexpr double kBand_sd = 1.645;

/// Returns the standard deviation in K of each row (sample · sensors + sensor) of a forecast along `path`, sensor noise included.
/// `covariance` is that of θ, `start_K2` that of the start temperatures; `heat_W` is the RMS heat of the run.
Eigen::VectorXd forecast_sd_K(const estimation::LinearisedRun& path, const estimation::MeasuredRun& run, const Eigen::MatrixXd& covariance,
                              const Eigen::MatrixXd& start_K2, double heat_W, const motor::ForecastBand& band);

/// Returns the default band, for use without left-out pieces. Its time scale is a third of `duration_s`.
motor::ForecastBand usual_band(double duration_s);

/// Fits the band to the errors of the left-out pieces: the most probable parameters of the band, then a factor so that it contains the
/// share base::kBand_share of the errors. Student's distribution accounts for the small number of errors. Its degrees of freedom are the
/// number of independent errors if each piece is a whole recording; parts of the same recordings share errors, so `dependent_pieces` (at
/// least 1) then gives the degrees.
motor::ForecastBand fit_band(std::span<const estimation::MeasuredRun> runs, std::span<const PredictedPiece> pieces,
                             std::optional<std::size_t> dependent_pieces = {});

}  // namespace heatsoak::calibration
