// One family of curves that heat may follow: at a node, over a driver, before a multiplier.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "estimation/linearised_run.h"
#include "estimation/model.h"

namespace heatsoak {

/// What the curve stands before.
enum class Multiplier {
  source,      ///< 1: g in W
  excess,      ///< T_node − T_ambient: g in W/K, positive takes heat out of the node
  copper,      ///< the copper loss: g is a share of it
  difference,  ///< T_node − T_other: g in W/K, positive carries heat from the node to the other
  current,     ///< rms of the current: g in W/A
  speed,       ///< mean of |ω|: g in W·s/rad
};
std::string_view unit_of(Multiplier multiplier);
std::string_view to_string(Multiplier multiplier);
/// The signal that heat goes with besides the driver, by the name that drivers have; empty where it is the driver alone.
std::string_view second_signal(Multiplier multiplier);

/// One family of curves.
struct ScanTerm {
  std::string node;
  std::string other;  ///< of `difference`; else empty
  Multiplier multiplier = Multiplier::source;
  int driver = 0;  ///< place in the list of drivers
};

/// All that the scan tries for any driver alone. What crosses to a node is tried only where a sensor is at both of its ends: of one that
/// nobody sees a curve over what the other shows can make anything.
std::vector<ScanTerm> terms_of_one_signal(const Model& model, const std::vector<MeasuredRun>& runs);
/// Losses that go with the current as with something else, or with the speed.
std::vector<ScanTerm> terms_of_two_signals(const Model& model, const std::vector<MeasuredRun>& runs);
/// Place among the nodes that unknown heat may reach; -1: none.
int flux_of(const Model& model, std::string_view node);

/// The multiplier along a run's intervals, from the fitted temperatures at their beginnings.
Eigen::VectorXd multiplier_along(const ScanTerm& term, const Model& model, const LinearisedRun& fitted, const MeasuredRun& run);

}  // namespace heatsoak
