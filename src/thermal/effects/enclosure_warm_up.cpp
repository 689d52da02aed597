#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct EnclosureWarmUp {
  enum Node { stator, enclosure, ambient };
  enum Parameter { conductance, leak_ratio, heat_ratio, heat_capacity };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S air_W_per_K = x.parameter(conductance);
    heat.source(enclosure, air_W_per_K * x.parameter(heat_ratio) * x.at.copper_loss_W);
    heat.flow(stator, enclosure, air_W_per_K * x.difference_K(stator, enclosure));
    heat.flow(enclosure, ambient, air_W_per_K * x.parameter(leak_ratio) * x.difference_K(enclosure, ambient));
  }
};

}  // namespace

EffectType enclosure_warm_up() {
  using enum EnclosureWarmUp::Parameter;
  return {
      .name = {},
      .summary = "The air in a closed body warms over a match, by this motor and by the other motors and electronics that work as hard.",
      .equation =
          "P_enclosure = G·h·P_copper, P_stator→enclosure = G·(T_stator − T_enclosure), "
          "P_enclosure→ambient = r·G·(T_enclosure − T_ambient)",
      .reference = "energy balance of the enclosed air; the other motors' heat is assumed in proportion to this one's copper loss",
      .nodes = {{"stator", "stator"}, {"enclosure", "enclosure_warm_up", heat_capacity}, {"ambient", "ambient"}},
      .parameters = {{"conductance", "W/K", base::Range::non_negative(), "conductance between stator and enclosed air"},
                     {"leak_ratio", "", base::Range::between(0.0, 100.0),
                      "conductance from enclosure to ambient per conductance from stator to enclosure"},
                     {"heat_ratio", "K/W", base::Range::non_negative(),
                      "heat of the other sources per copper loss of this motor, divided by the conductance"},
                     {"heat_capacity", "J/K", base::Range::positive(), "heat capacity of enclosed air and shell"}},
      .typical = "0.05 to 0.2 W/K, r = 5, h = 10 K/W: the air rises 5 to 20 K within some ten minutes",
      .confounded_with =
          "Confounded with third_node (the same without the others' heat), with I² heat that reaches the stator late through a driver or "
          "connection of its own heat capacity, and with a drift of the ambient sensor. A sensor in the enclosed air or lifting the cover "
          "separates them.",
      // others: 0.1 W/K · 10 K/W · 8 W = 8 W; from the stator 0.1 · (60 − 35) = 2.5 W; to ambient 0.1 · 5 · (35 − 25) = 5 W
      .example = {.parameters = {0.1, 5.0, 10.0, 300.0},
                  .at = {.copper_loss_W = 8.0},
                  .temperature_C = {60.0, 35.0, 25.0},
                  .expected_heat_W = {-2.5, 5.5, 5.0}},
      .laws = laws<EnclosureWarmUp>(),
      .needs = {Signal::current},
      .candidacy = {.size_parameter = conductance,
                    .variants = {{0.1, 5.0, 10.0, 300.0}},
                    .family = "a body that the motor warms",
                    .experiment = "the same run with the cover on and off, with a sensor in the enclosed air"},
  };
}

}  // namespace heatsoak::thermal::effects
