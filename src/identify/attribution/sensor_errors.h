// What sensors do besides showing temperatures: samples that count as outliers, and slow errors of their own.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "identify/measured_run.h"

namespace heatsoak {

struct RefitResult;
struct FluxGrid;

struct SensorErrors {
  std::vector<Eigen::VectorXd> weights;  ///< per run: of each sample, 0 for an outlier; empty: all count
  /// By signal: standard deviation of an error that comes and goes within seconds and heats nothing, as where a probe sits at one phase of
  /// a motor that creeps. Empty: none.
  std::map<std::string, double> wander_K;
  double wander_time_scale_s = 10.0;

  [[nodiscard]] bool is_same_wander(const SensorErrors& other) const {
    return wander_K == other.wander_K && wander_time_scale_s == other.wander_time_scale_s;
  }
};

/// Samples that no smooth heat explains.
std::vector<Eigen::VectorXd> outlier_weights(const RefitResult& fit, const std::vector<MeasuredRun>& runs, const FluxGrid& grid,
                                             const SensorErrors& known);

/// `known` with slow errors that make the model at the fit most probable, where the evidence for them is clear.
SensorErrors with_wander(const RefitResult& fit, const std::vector<MeasuredRun>& runs, const FluxGrid& grid, const std::vector<int>& merged,
                         SensorErrors known);

/// The slow errors of `known` as they are most probable at the fit; none begin to be.
SensorErrors wander_at(const RefitResult& fit, const std::vector<MeasuredRun>& runs, const FluxGrid& grid, const std::vector<int>& merged,
                       SensorErrors known);

}  // namespace heatsoak
