// Rates of a network and their derivatives, the result of Network::linearise().
#pragma once

#include <Eigen/Core>

namespace heatsoak::thermal {

/// Rates of the state nodes and their exact derivatives at one moment; n state nodes, p parameters.
struct Linearised {
  Eigen::VectorXd rate_K_per_s;  ///< n
  Eigen::MatrixXd by_state;      ///< n × n, 1/s
  Eigen::MatrixXd by_parameter;  ///< n × p, K/s per unit of the parameter
};

}  // namespace heatsoak::thermal
