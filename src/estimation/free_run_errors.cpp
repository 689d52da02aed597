#include "estimation/free_run_errors.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "estimation/open_loop.h"
#include "estimation/thresholds.h"

namespace heatsoak::estimation {
namespace {

/// Returns the stated errors of a sensor, followed by those of the model.
std::vector<motor::SensorFault> all_faults(const Model& model, const Sensor& sensor) {
  std::vector<motor::SensorFault> faults = sensor.faults;
  for (const SensorTerm& term : model.sensors) {
    if (term.type->signal == sensor.signal) {
      faults.push_back({term.type, term.value});
    }
  }
  return faults;
}

std::vector<double> start_C(const Model& model, const MeasuredRun& run, const std::vector<MeasuredRun>& before_it) {
  const thermal::Network& network = model.network;
  for (const MeasuredRun& before : before_it) {
    const double gap_s = run.time_s.front() - before.time_s.back();
    if (recording_of(before) == recording_of(run) && gap_s > -1e-9 && gap_s < thresholds().slow_s) {
      const LinearisedRun path = linearise(network, model.values_in(before), {}, {}, start_C(model, before, {}), before);
      const Eigen::VectorXd end_C = path.state_C.rightCols(1);
      return {end_C.begin(), end_C.end()};
    }
  }
  RunStart start = start_of(network, run);
  for (const Sensor& sensor : run.sensors) {
    double& node_C = start.state_C[network.node(sensor.node)];
    node_C = motor::true_at_rest_C(all_faults(model, sensor), motor::sensor_at_rest_C(sensor.faults, node_C));
  }
  start.prior_C = start.state_C;
  const Eigen::VectorXd decided_C = decided_start_C(
      network, start, run, [&](std::span<const double> from_C, const MeasuredRun& part) { return linearise(model, from_C, part); });
  return {decided_C.begin(), decided_C.end()};
}

}  // namespace

Eigen::MatrixXd open_loop_C(const Model& model, const MeasuredRun& run, const std::vector<MeasuredRun>& before_it) {
  // Removing the free parameters saves the sensitivities, which are not needed.
  Model settled = model;
  settled.free.clear();
  settled.flux_nodes.clear();
  return linearise(settled, start_C(model, run, before_it), run).sensor_C;
}

Errors open_loop_errors(const Model& model, const std::vector<MeasuredRun>& runs, const std::vector<MeasuredRun>& before_them) {
  Errors errors;
  std::map<std::string, double> counts;
  std::vector<Eigen::MatrixXd> off_K(runs.size());
  base::in_parallel(runs.size(), 0, [&](std::size_t r) { off_K[r] = runs[r].measured_C - open_loop_C(model, runs[r], before_them); });
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const MeasuredRun& run = runs[r];
    for (std::size_t sensor = 0; sensor < run.sensors.size(); ++sensor) {
      ErrorOfSignal& error = errors[run.sensors[sensor].signal];
      for (const double each_K : off_K[r].col(static_cast<Eigen::Index>(sensor))) {
        if (!std::isnan(each_K)) {
          error.rmse_K += each_K * each_K;
          error.max_abs_K = std::max(error.max_abs_K, std::abs(each_K));
          counts[run.sensors[sensor].signal] += 1.0;
        }
      }
    }
  }
  for (auto& [signal, error] : errors) {
    error.rmse_K = std::sqrt(error.rmse_K / std::max(1.0, counts[signal]));
  }
  return errors;
}

std::optional<Errors> try_open_loop_errors(const Model& model, const std::vector<MeasuredRun>& runs,
                                           const std::vector<MeasuredRun>& before_them) {
  try {
    return open_loop_errors(model, runs, before_them);
  } catch (const base::Failure&) {
    return std::nullopt;
  }
}

double rms_K(const Errors& errors) {
  double squares_K2 = 0.0;
  for (const auto& [signal, error] : errors) {
    squares_K2 += error.rmse_K * error.rmse_K;
  }
  return std::sqrt(squares_K2 / static_cast<double>(std::max<std::size_t>(1, errors.size())));
}

}  // namespace heatsoak::estimation
