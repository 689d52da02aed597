#include "attribution/extended_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimation/spans.h"

namespace heatsoak {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

Eigen::VectorXd ExtendedModel::theta() const {
  Eigen::VectorXd all(free_count());
  all.head(model.free_count()) = model.theta();
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    all[model.free_count() + static_cast<Eigen::Index>(i)] = sensors[i].value / sensors[i].type->typical_size;
  }
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    all[first_deviation() + static_cast<Eigen::Index>(i)] = deviations[i].deviation_share / deviations[i].type->usual;
  }
  return all;
}

void ExtendedModel::set_theta(const Eigen::VectorXd& theta) {
  model.values = model.values_at(theta.head(model.free_count()));
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    sensors[i].value = sensors[i].type->typical_size * theta[model.free_count() + static_cast<Eigen::Index>(i)];
  }
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    deviations[i].deviation_share = deviations[i].type->usual * theta[first_deviation() + static_cast<Eigen::Index>(i)];
  }
}

Prior ExtendedModel::prior() const {
  Prior all{Eigen::VectorXd::Zero(free_count()), Eigen::MatrixXd::Zero(free_count(), free_count())};
  const Eigen::Index inner = model.free_count();
  all.mean.head(inner) = model.prior.mean;
  all.precision.topLeftCorner(inner, inner) = model.prior.precision;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const double sd_share = sensors[i].spread_sd / sensors[i].type->typical_size;
    all.precision(inner + static_cast<Eigen::Index>(i), inner + static_cast<Eigen::Index>(i)) = 1.0 / (sd_share * sd_share);
  }
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    const Eigen::Index own = first_deviation() + static_cast<Eigen::Index>(i);
    all.precision(own, own) = std::pow(deviations[i].type->usual / deviations[i].spread_sd, 2);
  }
  return all;
}

double ExtendedModel::low(Eigen::Index coordinate) const {
  if (coordinate < model.free_count()) {
    const FreeParameter& free = model.free[static_cast<std::size_t>(coordinate)];
    return free.by_log && free.low <= 0.0 ? -kInfinity : model.theta_of(coordinate, free.low);
  }
  if (coordinate >= first_deviation()) {
    const RunDeviationType& type = *deviations[static_cast<std::size_t>(coordinate - first_deviation())].type;
    return type.size.range.low / type.usual;
  }
  const SensorTerm& term = sensors[static_cast<std::size_t>(coordinate - model.free_count())];
  return term.type->size.range.low / term.type->typical_size;
}

double ExtendedModel::high(Eigen::Index coordinate) const {
  if (coordinate < model.free_count()) {
    return model.theta_of(coordinate, model.free[static_cast<std::size_t>(coordinate)].high);
  }
  if (coordinate >= first_deviation()) {
    const RunDeviationType& type = *deviations[static_cast<std::size_t>(coordinate - first_deviation())].type;
    return type.size.range.high / type.usual;
  }
  const SensorTerm& term = sensors[static_cast<std::size_t>(coordinate - model.free_count())];
  return term.type->size.range.high / term.type->typical_size;
}

std::vector<double> ExtendedModel::values_in(const MeasuredRun& run) const {
  std::vector<double> values = model.values;
  for (const ConditionalTerm& term : conditional) {
    if (!run.has(term.condition)) {
      values[static_cast<std::size_t>(term.place)] = term.off_value;
    }
  }
  for (const RunDeviation& each : deviations) {
    if (run.has(each.condition)) {
      for (const int place : each.type->places_in(model.network)) {
        values[static_cast<std::size_t>(place)] *= 1.0 + each.deviation_share;
      }
    }
  }
  return values;
}

namespace {

/// Returns the factor between the parameter at `place` in a run and in the model.
double factor_in(const ExtendedModel& model, int place, const MeasuredRun& run) {
  double factor = 1.0;
  for (const RunDeviation& each : model.deviations) {
    if (run.has(each.condition)) {
      const std::vector<int> places = each.type->places_in(model.model.network);
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
LinearisedRun linearised(const ExtendedModel& model, const MeasuredRun& run, const Along& along) {
  const Network& network = model.model.network;
  std::vector<int> wanted;
  for (const FreeParameter& free : model.model.free) {
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
  by_theta.rightCols(model.free_count() - model.model.free_count()).setZero();
  for (std::size_t i = 0; i < deviates.size(); ++i) {
    const RunDeviation& each = model.deviations[static_cast<std::size_t>(deviates[i])];
    const auto own = static_cast<std::size_t>(model.model.free_count()) + i;
    by_theta.col(model.first_deviation() + deviates[i]) += each.type->usual * values[static_cast<std::size_t>(wanted[own])] /
                                                           (1.0 + each.deviation_share) *
                                                           out.by_parameter.col(static_cast<Eigen::Index>(own));
  }
  out.by_parameter.conservativeResize(Eigen::NoChange, model.model.free_count());
  by_theta.leftCols(model.model.free_count()) = heatsoak::by_theta(model.model, model.model.theta(), out.by_parameter);
  for (Eigen::Index i = 0; i < model.model.free_count(); ++i) {
    by_theta.col(i) *= factor_in(model, wanted[static_cast<std::size_t>(i)], run);
  }
  out.by_parameter = std::move(by_theta);
  for (std::size_t i = 0; i < model.sensors.size(); ++i) {
    for (Eigen::Index sensor = 0; sensor < out.sensors(); ++sensor) {
      if (run.sensors[static_cast<std::size_t>(sensor)].signal == model.sensors[i].type->signal) {
        const SensorFault fault{model.sensors[i].type, model.sensors[i].value};
        const std::vector<double> by_size = fault.type->law.by_size(run.time_s, fault.size, as_span(out.sensor_C.col(sensor)));
        add_fault(fault, sensor, run, out);
        const auto rows = Eigen::seq(sensor, out.residual_K.size() - 1, out.sensors());
        out.by_parameter(rows, model.model.free_count() + static_cast<Eigen::Index>(i)) = fault.type->typical_size * as_vector(by_size);
      }
    }
  }
  return out;
}

}  // namespace

LinearisedRun linearise(const ExtendedModel& model, std::span<const double> start_C, const MeasuredRun& run) {
  const Network& network = model.model.network;
  std::vector<double> start(start_C.begin(), start_C.end());
  start.resize(static_cast<std::size_t>(network.state_count()), run.at.front().ambient_C);
  return linearised(model, run, [&](const std::vector<double>& values, const std::vector<int>& wanted) {
    return linearise(network, values, wanted, model.model.flux_nodes, start, run);
  });
}

LinearisedRun linearise_along(const ExtendedModel& model, const Eigen::MatrixXd& path_C, const MeasuredRun& run) {
  return linearised(model, run, [&](const std::vector<double>& values, const std::vector<int>& wanted) {
    return linearise_along(model.model.network, values, wanted, model.model.flux_nodes, path_C, run);
  });
}

}  // namespace heatsoak
