#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct ContactTemperatureDependence {
  enum Node { hot, cold };
  enum Parameter { conductance, midpoint, steepness };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S mean_C = named("contact_mean_C", 0.5 * (x.temperature_C(hot) + x.temperature_C(cold)));
    const S present = named("warm_contact_share", soft_step(x.parameter(steepness) * (mean_C - x.parameter(midpoint))));
    heat.flow(hot, cold, x.parameter(conductance) * present * x.difference_K(hot, cold));
  }
};

}  // namespace

EffectType contact_temperature_dependence() {
  using enum ContactTemperatureDependence::Parameter;
  return {
      .name = {},
      .summary =
          "A thermal contact that changes with its own temperature: parts that expand into each other, potting that softens, a gap that "
          "opens. This is the part of the contact that appears or disappears; the rest stays in the parallel resistance.",
      .equation = "P_hot→cold = G/(1 + e^(−κ·(T_mean − T_mid)))·(T_hot − T_cold), T_mean of both nodes",
      .reference =
          "D. Staton, A. Boglietti, A. Cavagnino, Solving the more difficult aspects of electric motor thermal analysis, IEEE Trans. "
          "Energy "
          "Convers. 20 (2005): gaps between parts determine the contact; the step is a modelling choice",
      .nodes = {{"hot", "winding"}, {"cold", "stator"}},
      .parameters = {{"conductance", "W/K", base::Range::non_negative(), "conductance that appears or disappears"},
                     {"midpoint", "degC", base::Range::between(-60.0, 400.0),
                      "mean temperature at which half of the conductance is present"},
                     {"steepness", "1/K", base::Range::between(-1.0, 1.0),
                      "steepness κ of the step, whose width is 1/κ; above 0: appears with rising temperature, below 0: disappears"}},
      .typical = "0.03 to 0.1 W/K with 1/κ of 20 K: 5 to 15 % of the conductance between winding and stator over 30 K",
      .confounded_with =
          "Confounded with a wrong temperature coefficient of the copper and with contact_ageing. Alternating hot and cold runs separate "
          "them.",
      // mean of 80 and 60 °C is the midpoint: half of 0.1 W/K · 20 K = 1 W
      .example = {.parameters = {0.1, 70.0, 0.05}, .at = {}, .temperature_C = {80.0, 60.0}, .expected_heat_W = {-1.0, 1.0}},
      .laws = laws<ContactTemperatureDependence>(),
      .needs = {},
      .candidacy = {.size_parameter = conductance,
                    .variants = {{0.1, 60.0, 0.05}, {0.1, 60.0, -0.05}},
                    .family = "contact between winding and stator",
                    .experiment = "locked-rotor pulses of one current at a cold and at a preheated stator, alternating"},
  };
}

}  // namespace heatsoak::thermal::effects
