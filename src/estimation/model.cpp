#include "estimation/model.h"

#include <cmath>

namespace heatsoak {

const std::string& Model::name(Eigen::Index parameter) const {
  return network.parameters()[static_cast<std::size_t>(free[static_cast<std::size_t>(parameter)].place)].name;
}

Eigen::VectorXd Model::theta() const {
  Eigen::VectorXd all(free_count());
  for (Eigen::Index i = 0; i < free_count(); ++i) {
    all[i] = theta_of(i, values[static_cast<std::size_t>(free[static_cast<std::size_t>(i)].place)]);
  }
  return all;
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
  for (Eigen::Index i = 0; i < free_count(); ++i) {
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

void Model::set_free(const FreeParameter& parameter, double spread) {
  free.push_back(parameter);
  const Eigen::Index count = free_count();
  prior.mean.conservativeResize(count);
  prior.precision.conservativeResizeLike(Eigen::MatrixXd::Zero(count, count));
  prior.precision.row(count - 1).setZero();
  prior.precision.col(count - 1).setZero();
  prior.mean[count - 1] = theta_of(count - 1, values[static_cast<std::size_t>(parameter.place)]);
  prior.precision(count - 1, count - 1) = 1.0 / (spread * spread);
}

}  // namespace heatsoak
