#include "thermal/law.h"
#include "thermal/reference_point.h"

namespace heatsoak::thermal::effects {
namespace {

struct AirGapStirring {
  enum Node { hot, cold };
  enum Parameter { conductance };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S conductance_W_per_K = named("air_gap_conductance_W_per_K", x.parameter(conductance) * speed_ratio(x.at.speed_mean_rad_per_s));
    heat.flow(hot, cold, conductance_W_per_K * x.difference_K(hot, cold));
  }
};

}  // namespace

EffectType air_gap_stirring() {
  using enum AirGapStirring::Parameter;
  return {
      .name = {},
      .summary = "The rotor stirs the air in the gap, which carries heat from the winding to the stator and housing.",
      .equation = "P_hot→cold = G_500 · |ω|/(500 rad/s) · (T_hot − T_cold)",
      .reference =
          "K. M. Becker, J. Kaye, Measurements of diabatic flow in an annulus with an inner rotating cylinder, J. Heat Transfer 84 (1962); "
          "linear in speed as the simplest of its regimes",
      .nodes = {{"hot", "winding"}, {"cold", "stator"}},
      .parameters = {{"conductance", "W/K", base::Range::non_negative(), "conductance at 500 rad/s, in addition to that at rest"}},
      .typical = "0.02 to 0.08 W/K at 500 rad/s: 10 to 25 % smaller difference between winding and stator",
      .confounded_with =
          "Confounded with winding_through_flow, which takes the heat to ambient instead. The stator's temperature separates them.",
      // 0.1 W/K · 250/500 · (90 − 60) K = 1.5 W
      .example = {.parameters = {0.1},
                  .at = {.speed_mean_rad_per_s = 250.0},
                  .temperature_C = {90.0, 60.0},
                  .expected_heat_W = {-1.5, 1.5}},
      .laws = laws<AirGapStirring>(),
      .needs = {Signal::speed},
      .candidacy = {.size_parameter = conductance,
                    .variants = {{0.08}},
                    .family = "winding cooled with speed",
                    .experiment = "one current at standstill and at two speeds, winding and stator both logged"},
  };
}

}  // namespace heatsoak::thermal::effects
