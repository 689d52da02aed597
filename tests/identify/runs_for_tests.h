// Runs with a known truth, made by SUNDIALS with steps of its own: nothing of the analysers that they test is in here.
#pragma once

#include <string>
#include <vector>

#include "base/random.h"
#include "identify/measured_run.h"
#include "identify/model.h"
#include "thermal/transient.h"

namespace heatsoak {

struct TwoNodeTruth {
  double winding_J_per_K = 18.0;
  double winding_stator_K_per_W = 1.6;
  double stator_J_per_K = 95.0;
  double stator_ambient_K_per_W = 5.5;
  double resistance_25C_ohm = 0.447;
  double temperature_coefficient_per_K = 0.0039;
};

inline Network two_node_network(const TwoNodeTruth& truth) {
  Network network;
  network.add_node("winding", truth.winding_J_per_K);
  network.add_node("stator", truth.stator_J_per_K);
  const auto add = [&](const char* name, const char* type, std::vector<std::string> nodes, std::vector<double> parameters) {
    network.add_effect(name, *find_effect(type), nodes, parameters);
  };
  add("copper_loss", "copper_loss", {"winding"}, {truth.resistance_25C_ohm, truth.temperature_coefficient_per_K});
  add("winding_stator", "conduction", {"winding", "stator"}, {truth.winding_stator_K_per_W});
  add("stator_ambient", "conduction", {"stator", "ambient"}, {truth.stator_ambient_K_per_W});
  network.limit_current_by("copper_loss");
  return network;
}

/// The four of the network free, known to `prior_sd` in their logarithms; unknown heat may reach both nodes.
inline Model two_node_model(const TwoNodeTruth& start, double prior_sd) {
  Model model{two_node_network(start), {}, {}, {}, {0, 1}};
  model.values = model.network.values();
  for (const char* name :
       {"winding.heat_capacity", "winding_stator.thermal_resistance", "stator.heat_capacity", "stator_ambient.thermal_resistance"}) {
    const auto parameters = model.network.parameters();
    const auto place = std::ranges::find(parameters, name, &NetworkParameter::name) - parameters.begin();
    model.set_free({.place = static_cast<int>(place), .by_log = true, .scale = 1.0, .low = 1e-3, .high = 1e6}, prior_sd);
  }
  return model;
}

}  // namespace heatsoak
