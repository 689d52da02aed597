#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct ThirdNode {
  enum Node { node, body, ambient };
  enum Parameter { conductance, leak_ratio, heat_capacity };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S& coupling_W_per_K = x.parameter(conductance);
    heat.flow(node, body, coupling_W_per_K * x.difference_K(node, body));
    heat.flow(body, ambient, coupling_W_per_K * x.parameter(leak_ratio) * x.difference_K(body, ambient));
  }
};

}  // namespace

EffectType third_node() {
  using enum ThirdNode::Parameter;
  return {
      .name = {},
      .summary = "A body of its own that the motor warms: mount, chassis, rotor, end winding. It makes the tail of a cool-down long.",
      .equation =
          "P_node→body = G·(T_node − T_body), P_body→ambient = r·G·(T_body − T_ambient), C_body·dT_body/dt = P_node→body − P_body→ambient",
      .reference =
          "P. H. Mellor, D. Roberts, D. R. Turner, Lumped parameter thermal model for electrical machines of TEFC design, IEE Proc. B 138 "
          "(1991)",
      .nodes = {{"node", "stator"}, {"body", "third_node", heat_capacity}, {"ambient", "ambient"}},
      .parameters = {{"conductance", "W/K", base::Range::non_negative(), "conductance between node and body"},
                     {"leak_ratio", "", base::Range::between(0.0, 100.0),
                      "conductance from body to ambient per conductance from node to body"},
                     {"heat_capacity", "J/K", base::Range::positive(), "heat capacity of the body"}},
      .typical = "0.05 to 0.3 W/K and 30 to 500 J/K (aluminium 900 J/(kg K), steel 460 J/(kg K))",
      .confounded_with =
          "Confounded with enclosure_warm_up, a drift of a sensor, and a body of another heat capacity. A long soak with cool-down and "
          "weighing the part separate them.",
      // into the body 0.2 W/K · (60 − 40) K = 4 W; out of it 0.5 · 0.2 W/K · (40 − 20) K = 2 W
      .example = {.parameters = {0.2, 0.5, 100.0}, .at = {}, .temperature_C = {60.0, 40.0, 20.0}, .expected_heat_W = {-4.0, 2.0, 2.0}},
      .laws = laws<ThirdNode>(),
      .needs = {},
      .candidacy = {.size_parameter = conductance,
                    // A leak of 0 could not be fitted, because shape parameters are fitted in logarithms; hardly any body has none.
                    .variants = {{0.15, 0.1, 60.0}, {0.15, 0.1, 300.0}, {0.15, 0.6, 300.0}, {1.0, 0.02, 60.0}},
                    .family = "a body that the motor warms",
                    .experiment = "an hour of soak at constant load and two hours of cool-down",
                    .is_anywhere = true},
  };
}

}  // namespace heatsoak::thermal::effects
