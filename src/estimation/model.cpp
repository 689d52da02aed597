#include "estimation/model.h"

#include <cmath>
#include <limits>

namespace heatsoak::estimation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

void Prior::widen(Eigen::Index coordinate, double sd) {
  // Inverse of (Λ⁻¹ + s²·e·eᵀ) without computing Λ⁻¹ (Sherman and Morrison 1950).
  const Eigen::VectorXd column = precision.col(coordinate);
  precision -= column * column.transpose() * (sd * sd / (1.0 + sd * sd * column[coordinate]));
}

const std::string& Model::name(Eigen::Index parameter) const {
  return network.parameters()[static_cast<std::size_t>(free[static_cast<std::size_t>(parameter)].place)].name;
}

Eigen::VectorXd Model::theta() const {
  Eigen::VectorXd all(free_count());
  for (Eigen::Index i = 0; i < network_count(); ++i) {
    all[i] = theta_of(i, values[static_cast<std::size_t>(free[static_cast<std::size_t>(i)].place)]);
  }
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    all[network_count() + static_cast<Eigen::Index>(i)] = sensors[i].value / sensors[i].type->typical_size;
  }
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    all[first_deviation() + static_cast<Eigen::Index>(i)] = deviations[i].deviation_share / deviations[i].type->usual;
  }
  return all;
}

void Model::set_theta(const Eigen::VectorXd& theta) {
  values = values_at(theta);
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    sensors[i].value = sensors[i].type->typical_size * theta[network_count() + static_cast<Eigen::Index>(i)];
  }
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    deviations[i].deviation_share = deviations[i].type->usual * theta[first_deviation() + static_cast<Eigen::Index>(i)];
  }
}

Prior Model::full_prior() const {
  Prior all{Eigen::VectorXd::Zero(free_count()), Eigen::MatrixXd::Zero(free_count(), free_count())};
  const Eigen::Index inner = network_count();
  all.mean.head(inner) = prior.mean;
  all.precision.topLeftCorner(inner, inner) = prior.precision;
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

double Model::low(Eigen::Index coordinate) const {
  if (coordinate < network_count()) {
    const FreeParameter& which = free[static_cast<std::size_t>(coordinate)];
    return which.by_log && which.low <= 0.0 ? -kInfinity : theta_of(coordinate, which.low);
  }
  if (coordinate >= first_deviation()) {
    const RunDeviationType& type = *deviations[static_cast<std::size_t>(coordinate - first_deviation())].type;
    return type.size.range.low / type.usual;
  }
  const SensorTerm& term = sensors[static_cast<std::size_t>(coordinate - network_count())];
  return term.type->size.range.low / term.type->typical_size;
}

double Model::high(Eigen::Index coordinate) const {
  if (coordinate < network_count()) {
    return theta_of(coordinate, free[static_cast<std::size_t>(coordinate)].high);
  }
  if (coordinate >= first_deviation()) {
    const RunDeviationType& type = *deviations[static_cast<std::size_t>(coordinate - first_deviation())].type;
    return type.size.range.high / type.usual;
  }
  const SensorTerm& term = sensors[static_cast<std::size_t>(coordinate - network_count())];
  return term.type->size.range.high / term.type->typical_size;
}

double Model::theta_of(Eigen::Index parameter, double value) const {
  const FreeParameter& which = free[static_cast<std::size_t>(parameter)];
  return which.by_log ? std::log(value) : value / which.scale;
}

double Model::value_of(Eigen::Index parameter, double theta_value) const {
  const FreeParameter& which = free[static_cast<std::size_t>(parameter)];
  return which.by_log ? std::exp(theta_value) : which.scale * theta_value;
}

double Model::slope_of(Eigen::Index parameter, double theta_value) const {
  const FreeParameter& which = free[static_cast<std::size_t>(parameter)];
  return which.by_log ? std::exp(theta_value) : which.scale;
}

std::vector<double> Model::values_at(const Eigen::VectorXd& theta) const {
  std::vector<double> all = values;
  for (Eigen::Index i = 0; i < network_count(); ++i) {
    const FreeParameter& which = free[static_cast<std::size_t>(i)];
    double& value = all[static_cast<std::size_t>(which.place)];
    value = value_of(i, theta[i]);
    // exp(log(3)) is slightly more than 3: keep the value within its bounds despite rounding.
    if (value > which.high && theta[i] <= theta_of(i, which.high)) {
      value = which.high;
    } else if (value < which.low && theta[i] >= theta_of(i, which.low)) {
      value = which.low;
    }
  }
  return all;
}

std::vector<double> Model::values_in(const MeasuredRun& run) const {
  std::vector<double> all = values;
  for (const ConditionalTerm& term : conditional) {
    if (!run.has(term.condition)) {
      all[static_cast<std::size_t>(term.place)] = term.off_value;
    }
  }
  for (const RunDeviation& each : deviations) {
    if (run.has(each.condition)) {
      for (const int place : each.type->places_in(network)) {
        all[static_cast<std::size_t>(place)] *= 1.0 + each.deviation_share;
      }
    }
  }
  return all;
}

void Model::set_free(const FreeParameter& parameter, double spread) {
  free.push_back(parameter);
  const Eigen::Index count = network_count();
  prior.mean.conservativeResize(count);
  prior.precision.conservativeResizeLike(Eigen::MatrixXd::Zero(count, count));
  prior.precision.row(count - 1).setZero();
  prior.precision.col(count - 1).setZero();
  prior.mean[count - 1] = theta_of(count - 1, values[static_cast<std::size_t>(parameter.place)]);
  prior.precision(count - 1, count - 1) = 1.0 / (spread * spread);
}

}  // namespace heatsoak::estimation
