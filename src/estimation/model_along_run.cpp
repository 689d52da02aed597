#include "estimation/model_along_run.h"

#include <algorithm>

#include "estimation/spans.h"

namespace heatsoak::estimation {
namespace {

/// Returns the factor between the parameter at `place` in a run and in the model.
double factor_in(const Model& model, int place, const MeasuredRun& run) {
  double factor = 1.0;
  for (const RunDeviation& each : model.deviations) {
    if (run.has(each.condition)) {
      const std::vector<int> places = each.type->places_in(model.network);
      factor *= std::ranges::find(places, place) != places.end() ? 1.0 + each.deviation_share : 1.0;
    }
  }
  for (const ConditionalTerm& term : model.conditional) {
    factor *= term.place == place && !run.has(term.condition) ? 0.0 : 1.0;
  }
  return factor;
}

/// `along` linearises the network for given values and requested parameters.
template <class Along>
LinearisedRun linearised(const Model& model, const MeasuredRun& run, const Along& along) {
  const thermal::Network& network = model.network;
  std::vector<int> wanted;
  for (const FreeParameter& free : model.free) {
    wanted.push_back(free.place);
  }
  std::vector<Eigen::Index> deviates;  // deviation of each requested parameter after the model's own
  for (std::size_t i = 0; i < model.deviations.size(); ++i) {
    if (run.has(model.deviations[i].condition)) {
      const std::vector<int> places = model.deviations[i].type->places_in(network);
      wanted.insert(wanted.end(), places.begin(), places.end());
      deviates.resize(deviates.size() + places.size(), static_cast<Eigen::Index>(i));
    }
  }
  const std::vector<double> values = model.values_in(run);
  LinearisedRun out = along(values, wanted);
  Columns by_theta(out.by_parameter.rows(), model.free_count());
  by_theta.rightCols(model.free_count() - model.network_count()).setZero();
  for (std::size_t i = 0; i < deviates.size(); ++i) {
    const RunDeviation& each = model.deviations[static_cast<std::size_t>(deviates[i])];
    const auto own = static_cast<std::size_t>(model.network_count()) + i;
    by_theta.col(model.first_deviation() + deviates[i]) += each.type->usual * values[static_cast<std::size_t>(wanted[own])] /
                                                           (1.0 + each.deviation_share) *
                                                           out.by_parameter.col(static_cast<Eigen::Index>(own));
  }
  out.by_parameter.conservativeResize(Eigen::NoChange, model.network_count());
  by_theta.leftCols(model.network_count()) = estimation::by_theta(model, model.theta(), out.by_parameter);
  for (Eigen::Index i = 0; i < model.network_count(); ++i) {
    by_theta.col(i) *= factor_in(model, wanted[static_cast<std::size_t>(i)], run);
  }
  out.by_parameter = std::move(by_theta);
  for (std::size_t i = 0; i < model.sensors.size(); ++i) {
    for (Eigen::Index sensor = 0; sensor < out.sensors(); ++sensor) {
      if (run.sensors[static_cast<std::size_t>(sensor)].signal == model.sensors[i].type->signal) {
        const motor::SensorFault fault{model.sensors[i].type, model.sensors[i].value};
        const std::vector<double> by_size = fault.type->law.by_size(run.time_s, fault.size, as_span(out.sensor_C.col(sensor)));
        add_fault(fault, sensor, run, out);
        const auto rows = Eigen::seq(sensor, out.residual_K.size() - 1, out.sensors());
        out.by_parameter(rows, model.network_count() + static_cast<Eigen::Index>(i)) = fault.type->typical_size * as_vector(by_size);
      }
    }
  }
  return out;
}

}  // namespace

LinearisedRun linearise(const Model& model, std::span<const double> start_C, const MeasuredRun& run) {
  const thermal::Network& network = model.network;
  std::vector<double> start(start_C.begin(), start_C.end());
  start.resize(static_cast<std::size_t>(network.state_count()), run.at.front().ambient_C);
  return linearised(model, run, [&](const std::vector<double>& values, const std::vector<int>& wanted) {
    return linearise(network, values, wanted, model.flux_nodes, start, run);
  });
}

LinearisedRun linearise_along(const Model& model, const Eigen::MatrixXd& path_C, const MeasuredRun& run) {
  return linearised(model, run, [&](const std::vector<double>& values, const std::vector<int>& wanted) {
    return linearise_along(model.network, values, wanted, model.flux_nodes, path_C, run);
  });
}

}  // namespace heatsoak::estimation
