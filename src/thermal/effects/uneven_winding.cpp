#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct UnevenWinding {
  enum Node { winding, stator };
  enum Parameter { share };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    heat.flow(winding, stator, x.parameter(share) * x.at.copper_loss_W);
  }
};

}  // namespace

EffectType uneven_winding() {
  using enum UnevenWinding::Parameter;
  return {
      .name = {},
      .summary = "The winding is not isothermal: copper close to the iron passes its heat on at once.",
      .equation = "P_winding→stator = k · P_copper",
      .reference =
          "approximation of separate nodes for slots and end winding, as in P. H. Mellor, D. Roberts, D. R. Turner, Lumped parameter "
          "thermal "
          "model for electrical machines of TEFC design, IEE Proc. B 138 (1991)",
      .nodes = {{"winding", "winding"}, {"stator", "stator"}},
      .parameters =
          {{"share", "", base::Range::between(0.0, 0.5),
            "share of the copper loss that acts in the stator; the thermal resistance between winding and stator, which a data sheet "
            "states for the whole copper loss, must be fitted with it"}},
      .typical = "0.05 to 0.3 of the copper loss",
      .confounded_with =
          "Confounded with connection_resistance: with other thermal resistances, heat capacities and losses, the two differ only because "
          "the resistance of copper rises with temperature. A 4-wire measurement of plugs and leads separates them.",
      // 0.2 · 8 W = 1.6 W
      .example = {.parameters = {0.2}, .at = {.copper_loss_W = 8.0}, .temperature_C = {60.0, 40.0}, .expected_heat_W = {-1.6, 1.6}},
      .laws = laws<UnevenWinding>(),
      .needs = {Signal::current},
      .candidacy = {.size_parameter = share,
                    .variants = {{0.1}},
                    .family = "heat with current at the stator",
                    .experiment = "a 4-wire resistance of plugs and leads"},
      .moves_copper_loss = true,
  };
}

}  // namespace heatsoak::thermal::effects
