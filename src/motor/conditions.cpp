#include "motor/conditions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <vector>

#include "base/diagnostic.h"
#include "thermal/network.h"

namespace heatsoak::motor {
namespace {

/// A hot motor under load, with all signals that a law may need.
thermal::OperatingPoint<double> at_work() {
  thermal::OperatingPoint<double> at;
  for (std::size_t row = 0; row < thermal::kQuantityCount; ++row) {
    if (const std::optional<double> usual = thermal::kQuantities<double>[row].usual) {
      thermal::set_quantity(at, row, *usual);
    }
  }
  return at;
}

double probe_C(const std::string& node) { return node == "winding" ? 100.0 : node == "stator" ? 70.0 : 40.0; }

}  // namespace

bool acts_by_default(const MotorEffect& effect, std::span<const double> parameters) {
  thermal::Network network;
  for (std::size_t role = 0; role < effect.nodes.size(); ++role) {
    const std::string& node = effect.nodes[role];
    const bool is_own = effect.type->nodes[role].own_capacity.has_value();
    if (!is_own && node != thermal::Network::kAmbient && !network.find_node(node)) {
      network.add_node(node, 1.0);
    }
  }
  network.add_effect(effect.name, *effect.type, effect.nodes, parameters);
  std::vector<double> state_C;
  for (int node = 0; node < network.state_count(); ++node) {
    state_C.push_back(probe_C(std::string(network.node_name(node))));
  }
  std::vector<double> heat_W(static_cast<std::size_t>(network.node_count()));
  network.balance_W(at_work(), network.values(), state_C, heat_W);
  const auto hottest = std::ranges::max_element(state_C) - state_C.begin();
  return state_C.empty() || heat_W[static_cast<std::size_t>(hottest)] >= 0.0;
}

std::vector<std::string> unstated_fit_conditions(const Motor& motor) {
  std::map<std::string, std::vector<std::string>> by_key;
  for (const std::string& each : motor.fit ? motor.fit->training.conditions : std::set<std::string>{}) {
    by_key[each.substr(0, each.find('='))].push_back(each);
  }
  std::vector<std::string> unstated;
  for (const auto& [key, all] : by_key) {
    const bool has_effect = std::ranges::any_of(motor.effects, [&](const MotorEffect& effect) { return effect.condition.contains(key); });
    if (all.size() == 1 && !has_effect && !motor.assumed.contains(key)) {
      unstated.push_back(all.front());
    }
  }
  return unstated;
}

Motor under(Motor motor, const std::map<std::string, std::string>& conditions) {
  std::set<std::string> there;
  for (const MotorEffect& effect : motor.effects) {
    for (const auto& [key, value] : effect.condition) {
      there.insert(fmt::format("{}={}", key, value));
    }
  }
  const std::vector<std::string> of_fit = unstated_fit_conditions(motor);
  there.insert(of_fit.begin(), of_fit.end());
  for (const auto& [key, value] : conditions) {
    if (std::ranges::find(of_fit, fmt::format("{}={}", key, value)) != of_fit.end()) {
      continue;
    }
    const bool is_key = std::ranges::any_of(motor.effects, [&](const MotorEffect& effect) { return effect.condition.contains(key); });
    if (!is_key) {
      throw base::Failure(base::ExitCode::bad_input,
                          there.empty()
                              ? fmt::format("condition {}={}: no effect of {} depends on a condition", key, value, motor.id)
                              : fmt::format("condition {}={}: expected one of {}'s: {}", key, value, motor.id, fmt::join(there, ", ")));
    }
  }
  std::erase_if(motor.effects, [&](const MotorEffect& effect) {
    return std::ranges::any_of(effect.condition, [&](const auto& part) {
      const auto found = conditions.find(part.first);
      return found != conditions.end() && found->second != part.second;
    });
  });
  for (MotorEffect& effect : motor.effects) {
    std::erase_if(effect.condition, [&](const auto& part) { return conditions.contains(part.first); });
  }
  motor.assumed = conditions;
  return motor;
}

bool depends_on(const Motor& motor, const std::string& key) {
  const std::vector<std::string> of_fit = unstated_fit_conditions(motor);
  return std::ranges::any_of(motor.effects, [&](const MotorEffect& effect) { return effect.condition.contains(key); }) ||
         std::ranges::any_of(of_fit, [start = key + "="](const std::string& each) { return each.starts_with(start); });
}

Motor under_its_own(Motor motor, std::map<std::string, std::string> conditions) {
  std::erase_if(conditions, [&](const auto& each) { return !depends_on(motor, each.first); });
  return under(std::move(motor), conditions);
}

std::vector<std::string> conditions_without_runs(const Motor& motor) {
  const std::set<std::string> fitted = motor.fit ? motor.fit->training.conditions : std::set<std::string>{};
  std::vector<std::string> missing;
  for (const auto& [key, value] : motor.assumed) {
    const std::string stated = fmt::format("{}={}", key, value);
    if (std::ranges::any_of(fitted, [start = key + "="](const std::string& each) { return each.starts_with(start); }) &&
        !fitted.contains(stated)) {
      missing.push_back(stated);
    }
  }
  return missing;
}

}  // namespace heatsoak::motor
