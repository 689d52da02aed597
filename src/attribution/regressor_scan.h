// What is it, if it is not in the catalogue? Heat = g(driver) × multiplier at a node, with a curve g that nobody declared: hat functions
// with a prior that likes smooth curves. Each curve competes beside every subset of the best set of effects.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "attribution/design.h"
#include "attribution/flux_grid.h"
#include "attribution/regressors.h"
#include "attribution/rules.h"
#include "attribution/scan_term.h"

namespace heatsoak {

struct ScanResult {
  ScanTerm term;
  double usual = 1.0;          ///< size of curves that the prior takes for usual, in the curve's unit
  double gain_nats = 0.0;      ///< of ln P, best subset with the curve above best subset without one, each beside its own unknown heat
  std::vector<double> knots;   ///< of the driver, in its unit
  Eigen::VectorXd curve;       ///< g at the knots, in unit_of(multiplier)
  Eigen::MatrixXd covariance;  ///< of the curve
  double mean_W = 0.0;         ///< of the heat's magnitude over the time it acts
  double peak_W = 0.0;         ///< 99 % of its magnitude
  std::vector<int> beside;     ///< places of the members that stay beside it
  /// Per member: squared correlation of what the sensors show of it and of the curve, θ having absorbed what it can.
  std::vector<double> shape_ratio;
};

/// The effects that curves compete with, as columns of the design behind those of θ.
struct ScanMembers {
  std::vector<Eigen::Index> columns;
  std::vector<bool> has_sign;
  std::vector<double> prior_nats;
  double size_sd = 1.0;
  std::vector<Eigen::Index> companions = {};  ///< that are free like θ, whichever of the effects are there
  double companion_sd = 1.0;
};

struct ScanInput {
  const Model* model = nullptr;
  const std::vector<MeasuredRun>* runs = nullptr;
  const std::vector<LinearisedRun>* fitted = nullptr;
  const std::vector<Regressor>* drivers = nullptr;
  const std::vector<DesignRun>* designs = nullptr;
  ThetaPrior prior;
  ScanMembers members;
  FluxGrid grid;
  std::vector<FluxPlace> places;  ///< where the best set is most probable, and where nothing is
  double mean_heat_W = 1.0;       ///< sets the scale that the prior expects
};

/// Best first; at most `most`.
std::vector<ScanResult> scan_drivers(const ScanInput& input, const SelectionRules& rules, std::size_t most);

}  // namespace heatsoak
