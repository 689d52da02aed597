#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct NeighbourCoupling {
  enum Node { node, surroundings };
  enum Parameter { conductance };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    if (x.at.knows(kNeighbour)) {
      heat.flow(node, surroundings, x.parameter(conductance) * difference_K(x.temperature_C(node), x.at.neighbour_C));
    }
  }
};

}  // namespace

EffectType neighbour_coupling() {
  using enum NeighbourCoupling::Parameter;
  return {
      .name = {},
      .summary =
          "Heat from or to the neighbouring motor, through the chassis or the air between. If its temperature is unknown, no heat is "
          "counted.",
      .equation = "P_node→surroundings = G·(T_node − T_neighbour)",
      .reference = "Newton's law of cooling; the neighbour's temperature is given and is part of the surroundings",
      .nodes = {{"node", "stator"}, {"surroundings", "ambient", {}, true}},
      .parameters = {{"conductance", "W/K", base::Range::non_negative(), "conductance between the two motors"}},
      .typical = "0.02 to 0.1 W/K between motors on one plate",
      .confounded_with = "Confounded with third_node and enclosure_warm_up. Running the neighbour alone separates them.",
      // 0.05 W/K · (40 − 60) K = −1 W: the hotter neighbour adds 1 W to the node
      .example = {.parameters = {0.05},
                  .at = {.neighbour_C = 60.0, .known = kNeighbour},
                  .temperature_C = {40.0, 25.0},
                  .expected_heat_W = {1.0, -1.0}},
      .laws = laws<NeighbourCoupling>(),
      .needs = {Signal::neighbour_temperature},
      .candidacy = {.size_parameter = conductance,
                    .variants = {{0.05}},
                    .family = "heat from the neighbourhood",
                    .experiment = "the neighbour alone under load, with this motor at rest and logged"},
  };
}

}  // namespace heatsoak::thermal::effects
