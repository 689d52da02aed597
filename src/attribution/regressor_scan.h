// Search for heat outside the catalogue: heat = g(signal) × multiplier at a node. The curve g is a sum of hat functions with a smoothness
// prior. Each curve competes in combination with every subset of the best set of effects.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "attribution/regressors.h"
#include "attribution/rules.h"
#include "attribution/scan_term.h"
#include "attribution/set_search.h"
#include "estimation/design.h"
#include "estimation/flux_grid.h"

namespace heatsoak::attribution {

/// One curve, with the subset and the unknown heat that make it most probable.
struct ScanResult {
  ScanTerm term;
  double usual = 1.0;  ///< typical size of the curve in the prior, in the curve's unit
  /// Gain in ln P: the best subset with the curve compared with the best subset without one. Each has its own unknown heat.
  double gain_nats = 0.0;
  /// Per recording: gain in ln p, given all others, at the same unknown heat with and without the curve.
  Eigen::VectorXd left_out_gain_nats;
  std::vector<double> knots;  ///< knots, in the unit of the signal
  Eigen::VectorXd curve;      ///< values of g at the knots, in the unit of the multiplier
  Eigen::VectorXd curve_sd;   ///< their standard deviations
  double mean_W = 0.0;        ///< mean magnitude of the heat over the intervals with a value of the signal
  double peak_W = 0.0;        ///< largest magnitude of that heat
  std::vector<int> beside;    ///< indices of the members in the best subset
};

/// Input of the scan. The pointers must be set and outlive the scan.
struct ScanInput {
  const estimation::Model* model = nullptr;
  const std::vector<estimation::MeasuredRun>* runs = nullptr;
  const std::vector<estimation::LinearisedRun>* fitted = nullptr;
  const std::vector<Regressor>* regressors = nullptr;
  const std::vector<estimation::DesignRun>* designs = nullptr;
  estimation::ThetaPrior prior;
  const std::vector<CandidateRule>* rules = nullptr;  ///< candidates, in the order of their columns in the design after those of θ
  std::vector<int> members;                           ///< the best set of effects
  estimation::FluxGrid grid;
  std::vector<estimation::FluxPlace> places;  ///< start points of the search: most probable with the best set, and without any effect
  double mean_heat_W = 1.0;                   ///< mean modelled heat, which scales the prior of the curves
};

/// Returns the best curves, at most `most`, best first; empty if there are no signals. The gain may be negative.
std::vector<ScanResult> scan_regressors(const ScanInput& input, const SelectionRules& rules, std::size_t most);

}  // namespace heatsoak::attribution
