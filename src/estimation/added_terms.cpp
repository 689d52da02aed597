#include "estimation/added_terms.h"

#include <algorithm>
#include <cmath>

#include "estimation/spans.h"
#include "thermal/linearised.h"

namespace heatsoak::estimation {
namespace {

/// Computes the response of a linear system over a step to its state, e^(A·h), and to a constant rate, ∫e^(A·s)ds. Both are of fourth
/// order, like the steps of the fit.
void set_step(const Eigen::MatrixXd& slope_per_s, double step_s, Eigen::MatrixXd& power, Eigen::MatrixXd& forward,
              Eigen::MatrixXd& held_s) {
  const Eigen::Index size = slope_per_s.rows();
  power.setIdentity(size, size);
  forward.setIdentity(size, size);
  held_s.setIdentity(size, size);
  for (int order = 1; order <= 4; ++order) {
    power = (slope_per_s * power.eval()) * (step_s / order);
    forward += power;
    held_s += order < 4 ? Eigen::MatrixXd(power / (order + 1.0)) : Eigen::MatrixXd::Zero(size, size);
  }
  held_s *= step_s;
}

/// Converts sensitivities of the nodes to those of the readings, with the stated sensor errors of the run.
void show(const MeasuredRun& run, Columns& columns) {
  const auto sensors = static_cast<Eigen::Index>(run.sensors.size());
  for (Eigen::Index sensor = 0; sensor < sensors; ++sensor) {
    const auto rows = Eigen::seq(sensor, columns.rows() - 1, sensors);
    const std::vector<motor::SensorFault>& faults = run.sensors[static_cast<std::size_t>(sensor)].faults;
    for (Eigen::Index column = 0; column < (faults.empty() ? 0 : columns.cols()); ++column) {
      Eigen::VectorXd change = columns(rows, column);
      motor::apply(faults, run.time_s, true, as_span(change));
      columns(rows, column) = change;
    }
  }
}

}  // namespace

Columns added_sensitivities(const thermal::Network& network, std::span<const double> parameters, const std::vector<int>& wanted,
                            const LinearisedRun& fitted, const MeasuredRun& run) {
  const Eigen::Index own = fitted.states;
  const Eigen::Index states = network.state_count();
  const auto count = static_cast<Eigen::Index>(wanted.size());
  const Eigen::Index bodies = states - own;
  std::vector<double> values = network.values();
  std::ranges::copy(parameters, values.begin());
  std::vector<double> state_C(static_cast<std::size_t>(states), run.at.front().ambient_C);
  thermal::Linearised slope;
  // Sensitivities to the parameters and to the start temperatures of added nodes; the last column is the state's step.
  Eigen::MatrixXd rate = Eigen::MatrixXd::Zero(states, count + bodies + 1), moved = rate, next = rate;
  moved.block(own, count, bodies, bodies).setIdentity();
  Eigen::MatrixXd power, forward, held_s;
  Columns columns = Columns::Zero(fitted.residual_K.size(), count + bodies);
  for (Eigen::Index k = 0; k + 1 < fitted.samples(); ++k) {
    for (Eigen::Index node = 0; node < own; ++node) {
      state_C[static_cast<std::size_t>(node)] = 0.5 * (fitted.state_C(node, k) + fitted.state_C(node, k + 1));
    }
    network.linearise(run.at[static_cast<std::size_t>(k)], values, state_C, slope);
    rate.leftCols(count) = slope.by_parameter(Eigen::all, wanted);
    rate.rightCols<1>() = slope.rate_K_per_s;
    const double duration_s = fitted.duration_s[static_cast<std::size_t>(k)];
    const double fastest_per_s = slope.by_state.cwiseAbs().rowwise().sum().maxCoeff();
    const int parts = std::max(1, static_cast<int>(std::ceil(2.0 * duration_s * fastest_per_s)));
    set_step(slope.by_state, duration_s / parts, power, forward, held_s);
    moved.rightCols<1>().setZero();
    for (int part = 0; part < parts; ++part) {
      next.noalias() = forward * moved;
      next.noalias() += held_s * rate;
      moved.swap(next);
    }
    for (Eigen::Index node = own; node < states; ++node) {
      state_C[static_cast<std::size_t>(node)] += moved(node, count + bodies);
    }
    for (Eigen::Index sensor = 0; sensor < fitted.sensors(); ++sensor) {
      columns.row((k + 1) * fitted.sensors() + sensor) =
          moved.row(fitted.sensor_node[static_cast<std::size_t>(sensor)]).head(count + bodies);
    }
  }
  show(run, columns);
  return columns;
}

}  // namespace heatsoak::estimation
