// What is it, if it is not in the catalogue? Heat = g(driver) × multiplier at a node, with a curve g that nobody declared:
// seven hat functions with a prior that likes smooth curves, judged by evidence as every other term is.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "identify/attribution/drivers.h"
#include "identify/attribution/evidence_table.h"
#include "identify/attribution/scan_term.h"

namespace heatsoak {

struct ScanResult {
  ScanTerm term;
  double usual = 1.0;          ///< size of curves that the prior takes for usual, in the curve's unit
  double gain_nats = 0.0;      ///< evidence above the base's, both at their best unknown heat
  std::vector<double> knots;   ///< of the driver, in its unit
  Eigen::VectorXd curve;       ///< g at the knots, in unit_of(multiplier)
  Eigen::MatrixXd covariance;  ///< of the curve
  double mean_W = 0.0;         ///< of the heat's magnitude over the time it acts
  double peak_W = 0.0;         ///< 99 % of its magnitude
  FluxGrid::Place place;
  bool leaves_heat = false;  ///< it hardly changes how much heat is unknown: not what that heat comes and goes by
};

struct ScanInput {
  const Model* model = nullptr;
  const std::vector<MeasuredRun>* runs = nullptr;
  const std::vector<LinearisedRun>* fitted = nullptr;
  const std::vector<Driver>* drivers = nullptr;
  double mean_heat_W = 1.0;  ///< sets the scale that the prior expects
};

/// Best first; at most `most`. The table's base is what the curves are added to. Heat that goes with two signals is among them only where
/// no single one explains nearly as much.
std::vector<ScanResult> scan_drivers(const ScanInput& input, EvidenceTable& table, const SetScore& base, int most);

/// Draws the knots of the best few together where something happens between them, and sorts anew.
void zoom_in(const ScanInput& input, EvidenceTable& table, const SetScore& base, std::vector<ScanResult>& results);

}  // namespace heatsoak
