#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct ContactAgeing {
  enum Node { hot, cold };
  enum Parameter { conductance, time_constant, fresh_share };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S fresh = named("freshness_share", exponential(-x.at.age_h / x.parameter(time_constant)));
    const S present = named("present_contact_share", x.parameter(fresh_share) * fresh + (1.0 - x.parameter(fresh_share)) * (1.0 - fresh));
    heat.flow(hot, cold, x.parameter(conductance) * present * x.difference_K(hot, cold));
  }
};

}  // namespace

EffectType contact_ageing() {
  using enum ContactAgeing::Parameter;
  return {
      .name = {},
      .summary =
          "A thermal contact that changes with hours of running: glue that cracks, paste that dries, a clamp that settles. This is the "
          "part of the contact that appears or disappears; the rest stays in the parallel resistance.",
      .equation = "P_hot→cold = G·(f·e^(−a/τ) + (1 − f)·(1 − e^(−a/τ)))·(T_hot − T_cold), age a",
      .reference =
          "D. Staton, A. Boglietti, A. Cavagnino, Solving the more difficult aspects of electric motor thermal analysis, IEEE Trans. "
          "Energy "
          "Convers. 20 (2005): gaps between parts determine the contact; the exponential is a modelling choice",
      .nodes = {{"hot", "winding"}, {"cold", "stator"}},
      .parameters = {{"conductance", "W/K", base::Range::non_negative(),
                      "conductance that appears or disappears, in parallel to the settled contact"},
                     {"time_constant", "h", base::Range::positive(), "time constant of the change"},
                     {"fresh_share", "", base::Range::between(0.0, 1.0),
                      "share that is present when fresh; 1: lost with age, 0: appears with age"}},
      .typical = "0.03 to 0.1 W/K: 10 to 30 % of the conductance between winding and stator, over hours to hundreds of hours",
      .confounded_with =
          "Confounded with contact_temperature_dependence if each run is hotter than the one before. A repeated run at equal temperature "
          "separates them.",
      // new motor, so e^0 = 1: 0.1 W/K · (0.75·1 + 0.25·0) · (80 − 60) K = 1.5 W
      .example = {.parameters = {0.1, 10.0, 0.75}, .at = {.age_h = 0.0}, .temperature_C = {80.0, 60.0}, .expected_heat_W = {-1.5, 1.5}},
      .laws = laws<ContactAgeing>(),
      .needs = {Signal::age},
      .candidacy = {.size_parameter = conductance,
                    .variants = {{0.1, 2.0, 1.0}, {0.1, 2.0, 0.0}, {0.1, 50.0, 1.0}, {0.1, 50.0, 0.0}},
                    .family = "contact between winding and stator",
                    .experiment = "the same locked-rotor run at the first and at the last hour of a week, from equal temperatures"},
  };
}

}  // namespace heatsoak::thermal::effects
