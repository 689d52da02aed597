// Errors of an extended model in free-running simulation, each run from its first measured temperatures.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "estimation/model_along_run.h"
#include "estimation/open_loop.h"

namespace heatsoak::estimation {

struct ErrorOfSignal {
  double rmse_K = 0.0;
  double max_abs_K = 0.0;
};

/// Errors by signal, such as "winding_C".
using Errors = std::map<std::string, ErrorOfSignal>;

/// Simulates each run freely from its first measured temperatures and returns the errors by signal. A run that continues one of
/// `before_them` within Thresholds::slow_s starts from the simulated end of that run; later samples are not used.
Errors open_loop_errors(const Model& model, const std::vector<MeasuredRun>& runs, const std::vector<MeasuredRun>& before_them);
/// Returns the result of open_loop_errors(), or nothing if a simulation fails. With parameters that were fitted to other runs, the copper
/// loss may run away.
std::optional<Errors> try_open_loop_errors(const Model& model, const std::vector<MeasuredRun>& runs,
                                           const std::vector<MeasuredRun>& before_them);
/// Returns the predicted readings of one run in °C, n × sensors.
Eigen::MatrixXd open_loop_C(const Model& model, const MeasuredRun& run, const std::vector<MeasuredRun>& before_it);
/// Returns the RMS over all signals, with equal weights.
double rms_K(const Errors& errors);

}  // namespace heatsoak::estimation
