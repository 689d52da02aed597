// Response of the sensors to additional heat, by the linearised equations of a run.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "estimation/linearised_run.h"

namespace heatsoak::estimation {

/// Returns the response of the sensors in K (n·s × heats) to additional heats in W (intervals × heats), constant over each interval. The
/// heat enters the node with index `flux` among the nodes with unknown heat, and leaves the one with index `other`; empty: no node.
template <class Matrix>
Matrix heat_response(const LinearisedRun& run, const Matrix& heat_W, int flux, std::optional<int> other) {
  Matrix shown = Matrix::Zero(run.residual_K.size(), heat_W.cols());
  Matrix state = Matrix::Zero(run.states, heat_W.cols());
  Matrix next = state;
  for (Eigen::Index k = 0; k + 1 < run.samples(); ++k) {
    const double* const transition = run.transition.data() + k * run.states * run.states;
    const double* const injection = run.injection.data() + k * run.states * run.fluxes;
    for (Eigen::Index i = 0; i < run.states; ++i) {
      const double gain_K_per_W = injection[i * run.fluxes + flux] - (other ? injection[i * run.fluxes + *other] : 0.0);
      next.row(i) = gain_K_per_W * heat_W.row(k);
      for (Eigen::Index j = 0; j < run.states; ++j) {
        next.row(i) += transition[i * run.states + j] * state.row(j);
      }
    }
    state.swap(next);
    for (Eigen::Index sensor = 0; sensor < run.sensors(); ++sensor) {
      shown.row((k + 1) * run.sensors() + sensor) = state.row(run.sensor_node[static_cast<std::size_t>(sensor)]);
    }
  }
  return shown;
}

}  // namespace heatsoak::estimation
