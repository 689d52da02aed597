#include "thermal/effect.h"

#include <algorithm>
#include <array>

#include "thermal/effects_registry.h"

namespace heatsoak {

void HeatNames::name_flow(int from_node, int to_node, const Traced& heat_W) const {
  const std::string path = nodes.at(static_cast<std::size_t>(from_node)) + "_to_" + nodes.at(static_cast<std::size_t>(to_node)) + "_W";
  heat_W.name(std::array{path, law + "_" + path});
}

void HeatNames::name_source(int into_node, const Traced& heat_W) const {
  heat_W.name(std::array{law + "_W", law + "_" + nodes.at(static_cast<std::size_t>(into_node)) + "_W"});
}

const std::vector<EffectType>& all_effects() {
  static const std::vector<EffectType> kAll = [] {
    std::vector<EffectType> all;
    for (const auto& [name, make] : effects::registry) {
      all.push_back(make());
      all.back().name = name;
    }
    return all;
  }();
  return kAll;
}

const EffectType* find_effect(std::string_view name) {
  const auto found = std::ranges::find(all_effects(), name, &EffectType::name);
  return found == all_effects().end() ? nullptr : &*found;
}

}  // namespace heatsoak
