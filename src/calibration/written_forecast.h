// Selects the parameters that a calibration writes: those of the innovations fit or those of the forecast fit.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/calibrate.h"

namespace heatsoak::calibration {

/// Adds the innovations fit to the rivals of the forecast, scored on the same left-out pieces. Does nothing without pieces.
void score_innovations(const ForecastModel& model, estimation::FitOptions options, Calibration& calibration,
                       const base::Progress& progress = {});

/// Returns whether the forecast's parameters are written. With WrittenFit::best they must come from a fit, not from the file. They must
/// also predict the left-out pieces better than the innovations fit, by kLeastGain_nats and by 0.1 K rms in at least one signal. Without
/// two pieces to compare, `follows_fitted_runs_better` decides: whether the forecast's free-run error in the fitted runs is the smaller
/// one.
bool writes_forecast(WrittenFit wanted, const Forecast& forecast, bool follows_fitted_runs_better);

/// Returns the fitted values outside the ranges (`spread`) that the motor file declares for them. Verbs that need a sound motor may refuse
/// such a file.
std::vector<OutsideDeclaredRange> outside_declared_ranges(const motor::Motor& motor, std::span<const CalibratedParameter> parameters);

/// Marks a value as not identifiable if it was not identifiable in `before`, the innovations fit. If the forecast has
/// the same network, that fit alone decides, as long as the written interval is less than twice as wide as its own.
void carry_identifiability(const Forecast& forecast, std::span<const CalibratedParameter> before,
                           std::vector<CalibratedParameter>& parameters);

/// Replaces model, parameters and covariance of the innovations fit by those of the forecast fit. If both have the same network, the
/// intervals also contain the innovations fit and its intervals. Needs calibration.forecast.
void write_forecast(Calibration& calibration);

/// Returns the findings about the compared fits and the chosen one.
std::vector<CalibrationFinding> forecast_findings(const Calibration& calibration);

/// Adds the effects and sensor errors of the calibration that the motor file does not have. Returns the names of those that were added for
/// better forecasts.
std::vector<std::string> add_extensions(const Calibration& calibration, const std::string& source, motor::Motor& motor);

/// Returns the physically possible values of a motor parameter by its key (for example "effects.fan.conductance"), in the parameter's unit:
/// the range of its ParameterSpec. Positive numbers if the key is unknown.
base::Range possible_range(const motor::Motor& motor, std::string_view key);

}  // namespace heatsoak::calibration
