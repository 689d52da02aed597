#include "thermal/effect.h"

#include <algorithm>

#include "thermal/effects_registry.h"

namespace heatsoak::thermal {

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

}  // namespace heatsoak::thermal
