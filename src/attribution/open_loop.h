// How far an extended model is off when it runs freely, each run from its first measured temperatures.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "attribution/extended_model.h"

namespace heatsoak {

struct ErrorOfSignal {
  double rmse_K = 0.0;
  double max_abs_K = 0.0;
};
inline constexpr double kMatters_K = 0.1;  ///< errors that differ by less differ to nobody

/// By signal, "winding_C".
using Errors = std::map<std::string, ErrorOfSignal>;

/// The model run freely from the first measured temperatures. A run that goes on where one of `before_them` ends begins where the model's
/// free run of that one has arrived: nothing but the beginning of the log is looked at.
Errors open_loop_errors(const ExtendedModel& model, const std::vector<MeasuredRun>& runs, const std::vector<MeasuredRun>& before_them);
/// Predictions of one run, n × sensors.
Eigen::MatrixXd open_loop_C(const ExtendedModel& model, const MeasuredRun& run, const std::vector<MeasuredRun>& before_it);
/// Over all signals, each counting alike.
double rms_K(const Errors& errors);

}  // namespace heatsoak
