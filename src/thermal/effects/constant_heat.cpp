#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct ConstantHeat {
  enum Node { heated };
  enum Parameter { power };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    heat.source(heated, x.parameter(power));
  }
};

}  // namespace

EffectType constant_heat() {
  using enum ConstantHeat::Parameter;
  return {
      .name = {},
      .summary = "A constant heat from outside: electronics in standby, a lamp, the sun, a hot neighbour that is not measured.",
      .equation = "P_node = P",
      .reference = "definition",
      .nodes = {{"heated", "stator"}},
      .parameters = {{"power", "W", base::Range::non_negative(), "heat that the node absorbs"}},
      .typical = "0.5 to 3 W",
      .confounded_with =
          "Confounded with an offset of the node's sensor or of the ambient sensor. The first minutes before power separate them.",
      // 1.5 W, independent of the operating point
      .example = {.parameters = {1.5}, .at = {}, .temperature_C = {40.0}, .expected_heat_W = {1.5}},
      .laws = laws<ConstantHeat>(),
      .needs = {},
      .candidacy = {.size_parameter = power,
                    .variants = {{1.0}},
                    .family = "heat that depends on no signal",
                    .experiment = "half an hour at rest in the same place, from equal temperatures of motor and surroundings",
                    .is_anywhere = true},
  };
}

}  // namespace heatsoak::thermal::effects
