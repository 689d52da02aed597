#include "thermal/network.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "thermal/evaluation.h"

namespace heatsoak::thermal {

int Network::add_parameter(NetworkParameter parameter) {
  if (!parameter.range.contains(parameter.value)) {
    throw std::logic_error(fmt::format("{} = {} is out of range", parameter.name, parameter.value));
  }
  parameters_.push_back(std::move(parameter));
  return static_cast<int>(parameters_.size()) - 1;
}

int Network::add_node(std::string name, double heat_capacity_J_per_K) {
  const int capacity = add_parameter({name + ".heat_capacity", "J/K", base::Range::positive(), heat_capacity_J_per_K, {}});
  return add_state(std::move(name), capacity);
}

int Network::add_state(std::string name, int capacity_index) {
  if (node_count() >= kMostNodes || find_node(name)) {
    throw std::logic_error(fmt::format("node '{}': the name is in use, or there are {} nodes already", name, kMostNodes - 1));
  }
  const int ambient = state_count();
  for (EffectInPlace& effect : effects_) {
    std::ranges::replace(effect.node_index, ambient, ambient + 1);
  }
  capacity_index_.push_back(capacity_index);
  node_names_.push_back(std::move(name));
  return ambient;
}

std::optional<int> Network::find_node(std::string_view name) const {
  if (name == kAmbient) {
    return state_count();
  }
  const auto found = std::ranges::find(node_names_, name);
  return found == node_names_.end() ? std::nullopt : std::optional(static_cast<int>(found - node_names_.begin()));
}

int Network::node(std::string_view name) const {
  const std::optional<int> index = find_node(name);
  if (!index) {
    throw std::logic_error(fmt::format("there is no node '{}'", name));
  }
  return *index;
}

std::string_view Network::node_name(int node) const {
  return node == state_count() ? kAmbient : std::string_view(node_names_.at(static_cast<std::size_t>(node)));
}

int Network::place_of_parameter(std::string_view name) const {
  const auto found = std::ranges::find(parameters_, name, &NetworkParameter::name);
  if (found == parameters_.end()) {
    throw std::logic_error(fmt::format("there is no parameter '{}'", name));
  }
  return static_cast<int>(found - parameters_.begin());
}

void Network::add_effect(std::string name, const EffectType& type, std::span<const std::string> nodes, std::span<const double> parameters,
                         const std::map<std::string, std::string>& shared) {
  if (nodes.size() != type.nodes.size() || parameters.size() != type.parameters.size() || nodes.size() > kMostRoles ||
      parameters.size() > kMostParameters) {
    throw std::logic_error(
        fmt::format("{}: {} needs {} nodes and {} parameters", name, type.name, type.nodes.size(), type.parameters.size()));
  }
  EffectInPlace effect{.name = std::move(name), .type = &type, .node_index = {}, .parameter_index = {}};
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const base::ParameterSpec& spec = type.parameters[i];
    if (const auto other = shared.find(std::string(spec.key)); other != shared.end()) {
      effect.parameter_index.push_back(place_of_parameter(other->second));
      continue;
    }
    effect.parameter_index.push_back(
        add_parameter({fmt::format("{}.{}", effect.name, spec.key), base::unit_of(type.parameters, i, parameters), spec.range,
                       parameters[i], spec.choices}));
  }
  for (std::size_t role = 0; role < nodes.size(); ++role) {
    if (const std::optional<int> capacity = type.nodes[role].own_capacity) {
      add_state(nodes[role], effect.parameter_index[static_cast<std::size_t>(*capacity)]);
    }
  }
  for (const std::string& node : nodes) {
    const std::optional<int> index = find_node(node);
    if (!index) {
      throw std::logic_error(fmt::format("{}: there is no node '{}'", effect.name, node));
    }
    effect.node_index.push_back(*index);
  }
  effects_.push_back(std::move(effect));
}

void Network::limit_current_by(std::string_view copper_effect) {
  const auto found = std::ranges::find(effects_, copper_effect, &EffectInPlace::name);
  if (found == effects_.end() || found->parameter_index.size() != 2 || found->node_index.size() != 1) {
    throw std::logic_error(fmt::format("'{}' is not a copper loss of this network", copper_effect));
  }
  drive_.emplace(DriveStage::Places{found->parameter_index[0], found->parameter_index[1], found->node_index[0]});
}

std::vector<double> Network::values() const {
  std::vector<double> all;
  for (const NetworkParameter& parameter : parameters_) {
    all.push_back(parameter.value);
  }
  return all;
}

template <class S>
void Network::rate_K_per_s(OperatingPoint<S>& at, std::span<const S> parameters, std::span<S> temperature_C, std::span<S> rate) const {
  std::array<S, kMostNodes> heat_W;  // NOLINT(cppcoreguidelines-pro-type-member-init): those in use are set in the next lines
  const std::size_t states = node_names_.size();
  std::fill_n(heat_W.begin(), states + 1, S(0.0));
  temperature_C[states] = at.ambient_C;
  evaluate<S>(at, parameters.data(), temperature_C.data(), [&](const EffectInPlace& effect, const OperatingPoint<S>& driven) {
    HeatBook<S> heat(heat_W.data(), effect.node_index.data());
    book<S>(effect, driven, parameters.data(), temperature_C.data(), effect.node_index.data(), heat);
  });
  for (std::size_t node = 0; node < states; ++node) {
    rate[node] = heat_W[node] / parameters[static_cast<std::size_t>(capacity_index_[node])];
  }
}

void Network::balance_W(const OperatingPoint<double>& at, std::span<const double> parameters, std::span<const double> state_C,
                        std::span<double> heat_W) const {
  std::array<double, kMostNodes> temperature_C{};
  std::copy_n(state_C.begin(), state_count(), temperature_C.begin());
  temperature_C[static_cast<std::size_t>(state_count())] = at.ambient_C;
  std::ranges::fill(heat_W, 0.0);
  OperatingPoint<double> own = at;
  double* row_W = heat_W.data();
  evaluate<double>(own, parameters.data(), temperature_C.data(), [&](const EffectInPlace& effect, const OperatingPoint<double>& driven) {
    HeatBook<double> heat(row_W, effect.node_index.data());
    book<double>(effect, driven, parameters.data(), temperature_C.data(), effect.node_index.data(), heat);
    row_W += node_count();
  });
}

void Network::trace(const OperatingPoint<Traced>& at, std::span<const Traced> temperature_C, std::span<TracedHeat> node_heat) const {
  const std::vector<double> values_of_all = values();
  const std::vector<Traced> parameters(values_of_all.begin(), values_of_all.end());
  std::ranges::fill(node_heat, TracedHeat());
  Formula* const formula = temperature_C.front().formula();
  std::vector<std::string> nodes;
  for (int node = 0; node < node_count(); ++node) {
    nodes.emplace_back(node_name(node));
  }
  if (formula != nullptr && drive_) {
    formula->begin_law("copper_loss");
  }
  OperatingPoint<Traced> own = at;
  evaluate<Traced>(own, parameters.data(), temperature_C.data(), [&](const EffectInPlace& effect, const OperatingPoint<Traced>& driven) {
    HeatBook<Traced> heat(node_heat.data(), effect.node_index.data(), {std::string(effect.type->name), nodes});
    if (formula != nullptr) {
      formula->begin_law(std::string(effect.type->name));
    }
    book<Traced>(effect, driven, parameters.data(), temperature_C.data(), effect.node_index.data(), heat);
  });
}

template void Network::rate_K_per_s<double>(OperatingPoint<double>&, std::span<const double>, std::span<double>, std::span<double>) const;
template void Network::rate_K_per_s<Lanes>(OperatingPoint<Lanes>&, std::span<const Lanes>, std::span<Lanes>, std::span<Lanes>) const;

}  // namespace heatsoak::thermal
