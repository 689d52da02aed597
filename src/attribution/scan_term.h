// One family of heat curves: heat = g(signal) × multiplier at a node.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "estimation/linearised_run.h"
#include "estimation/model.h"

namespace heatsoak::attribution {

/// Factor that multiplies the curve g.
enum class Multiplier {
  source,      ///< 1; g in W
  excess,      ///< T_node − T_ambient; g in W/K, positive: heat leaves the node
  copper,      ///< copper loss; g dimensionless
  difference,  ///< T_node − T_other; g in W/K, positive: heat flows from the node to the other
  current,     ///< RMS current; g in W/A
  speed,       ///< mean of |ω|; g in W·s/rad
};
/// Properties of a multiplier.
struct MultiplierSpec {
  std::string_view name;
  std::string_view unit;                ///< unit of the curve g
  std::string_view form;                ///< `form` of the effect `tabulated`
  std::string_view second_signal = {};  ///< signal that the heat depends on besides that of the curve; empty: none
  bool is_conductance = false;          ///< positive values of g take heat out of the node
};
const MultiplierSpec& spec_of(Multiplier multiplier);

/// One family of curves.
struct ScanTerm {
  std::string node;
  std::string other;  ///< second node of `difference`; else empty
  Multiplier multiplier = Multiplier::source;
  int regressor = 0;  ///< index in the list of signals
};

/// Returns all families, without their signals. A flow between two nodes is included only if both have a sensor: the runs hardly
/// determine the temperature of a node without one. Heat that depends on current or speed as a second signal enters the stator.
std::vector<ScanTerm> scan_terms(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs);
/// Returns the index of the node among those with unknown heat; empty if it is not one of them.
std::optional<int> flux_of(const estimation::Model& model, std::string_view node);

/// Returns the multiplier per interval of a run, from the fitted temperatures at the start of each interval.
Eigen::VectorXd multiplier_along(const ScanTerm& term, const estimation::Model& model, const estimation::LinearisedRun& fitted,
                                 const estimation::MeasuredRun& run);

}  // namespace heatsoak::attribution
