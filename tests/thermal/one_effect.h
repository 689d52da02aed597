// A single effect, and states to test it in, shared by the test suites that iterate over the registry.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "thermal/law.h"
#include "two_node.h"

namespace heatsoak::thermal {

/// Returns the heat per role; parameters and temperatures have the declared order.
template <class S>
std::vector<S> heat_W(const EffectType& type, const OperatingPoint<S>& at, const std::vector<S>& parameters,
                      const std::vector<S>& temperature_C) {
  std::vector<int> parameter_index(parameters.size());
  std::iota(parameter_index.begin(), parameter_index.end(), 0);
  std::vector<int> node_index(temperature_C.size());
  std::iota(node_index.begin(), node_index.end(), 0);
  std::vector<S> heat(temperature_C.size(), S(0.0));
  const Situation<S> situation(at, parameters.data(), parameter_index.data(), temperature_C.data(), node_index.data());
  HeatBook<S> book(heat.data(), node_index.data());
  if constexpr (std::is_same_v<S, double>) {
    type.laws->one(situation, book);
  } else if constexpr (std::is_same_v<S, Lanes>) {
    type.laws->lanes(situation, book);
  } else {
    type.laws->tangent(situation, book);
  }
  return heat;
}

inline double low_of(const base::Range& range) { return std::isfinite(range.low) ? range.low + (range.low_is_open ? 1e-6 : 0.0) : -1e6; }
inline double high_of(const base::Range& range) { return std::isfinite(range.high) ? range.high - (range.high_is_open ? 1e-6 : 0.0) : 1e6; }

inline double random_in(Chance& chance, const base::Range& range) {
  const double low = low_of(range);
  const double high = high_of(range);
  return low > 0.0 && high / low > 100.0 ? chance.by_ratio(low, high) : chance.between(low, high);
}

inline std::vector<double> random_parameters(Chance& chance, const EffectType& type) {
  std::vector<double> parameters;
  for (const base::ParameterSpec& spec : type.parameters) {
    parameters.push_back(spec.choices.empty() ? random_in(chance, spec.range) : chance.below(static_cast<int>(spec.choices.size())));
  }
  return parameters;
}

/// Draws an operating point from all permitted ranges, with a consistent `copper_loss_W`.
inline OperatingPoint<double> random_point(Chance& chance) {
  OperatingPoint<double> at;
  at.current_rms_A = chance.between(0.0, 100.0);
  at.speed_mean_rad_per_s = chance.between(0.0, 2000.0);
  at.speed_rms_rad_per_s = at.speed_mean_rad_per_s * chance.between(1.0, 2.0);
  at.ambient_C = chance.between(-40.0, 60.0);
  at.shaft_power_W = chance.between(-500.0, 500.0);
  at.input_power_W = chance.between(-500.0, 1000.0);
  at.bus_V = chance.between(0.0, 60.0);
  at.modulation_ratio = chance.between(0.0, 1.0);
  at.vehicle_speed_m_per_s = chance.between(0.0, 10.0);
  at.neighbour_C = chance.between(-40.0, 150.0);
  at.known = chance.below(2) == 1 ? kNeighbour : 0;
  at.age_h = chance.between(0.0, 1000.0);
  at.velocity_rad_per_s = at.speed_mean_rad_per_s * chance.between(-1.0, 1.0);
  at.acceleration_rad_per_s2 = chance.between(0.0, 1e4);
  at.copper_loss_W = chance.between(0.0, 500.0);
  // Signals without a range above.
  for (const OperatingQuantity<double>& quantity : kQuantities<double>) {
    if (quantity.signal && at.*quantity.value == OperatingPoint<double>{}.*quantity.value) {
      at.*quantity.value = chance.between(0.0, 2.0 * quantity.usual.value());
    }
  }
  return at;
}

inline std::vector<double> random_temperatures(Chance& chance, const EffectType& type) {
  std::vector<double> temperature_C;
  for (std::size_t i = 0; i < type.nodes.size(); ++i) {
    temperature_C.push_back(chance.between(-60.0, 400.0));
  }
  return temperature_C;
}

/// A neighbour is part of the surroundings. If these have a uniform temperature, the neighbour gets it, too.
inline void settle_neighbour(OperatingPoint<double>& at, const EffectType& type, const std::vector<double>& temperature_C) {
  for (std::size_t role = 0; role < type.nodes.size(); ++role) {
    if (type.nodes[role].default_node == Network::kAmbient) {
      at.neighbour_C = temperature_C[role];
    }
  }
}

inline double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }
inline double size_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0, [](double all, double each) { return all + std::abs(each); });
}

/// Adds the effect to a network under `name`, with new nodes of random capacity if nodes of these names do not exist.
inline std::vector<std::string> add_alone(Network& network, const std::string& name, const EffectType& type, Chance& chance) {
  std::vector<std::string> nodes;
  for (const NodeRole& role : type.nodes) {
    nodes.emplace_back(role.own_capacity ? name : role.default_node);
    if (!role.own_capacity && !network.find_node(nodes.back())) {
      network.add_node(nodes.back(), chance.by_ratio(1.0, 100.0));
    }
  }
  std::vector<double> parameters = random_parameters(chance, type);
  for (const NodeRole& role : type.nodes) {
    if (role.own_capacity) {
      parameters[static_cast<std::size_t>(*role.own_capacity)] = chance.by_ratio(1.0, 100.0);
    }
  }
  network.add_effect(name, type, nodes, parameters);
  return nodes;
}

class EveryEffect : public testing::TestWithParam<std::size_t> {
 protected:
  static const EffectType& type() { return all_effects()[GetParam()]; }
};

inline auto every_effect() { return testing::Range(std::size_t{0}, all_effects().size()); }
inline std::string name_of_effect(const testing::TestParamInfo<std::size_t>& effect) {
  return std::string(all_effects()[effect.param].name);
}

}  // namespace heatsoak::thermal
