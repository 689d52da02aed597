#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct NaturalConvection {
  enum Node { hot, cold };
  enum Parameter { conductance, exponent };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    constexpr double kReference_K = 40.0;
    const S difference_K = x.difference_K(hot, cold);
    const S magnitude_K = named("convection_difference_magnitude_K", magnitude(difference_K));
    const S conductance_W_per_K = named("natural_convection_conductance_W_per_K",
                                        x.parameter(conductance) * power(magnitude_K / kReference_K, x.parameter(exponent)));
    heat.flow(hot, cold, conductance_W_per_K * difference_K);
  }
};

}  // namespace

EffectType natural_convection() {
  using enum NaturalConvection::Parameter;
  return {
      .name = {},
      .summary = "Buoyancy-driven convection: cooling grows more than in proportion to the temperature difference.",
      .equation = "P_hot→cold = G_40 · (|T_hot − T_cold|/(40 K))^p · (T_hot − T_cold), p = 1/4",
      .reference = "W. H. McAdams, Heat Transmission (1954): h ∝ ΔT^¼ laminar, ΔT^⅓ turbulent; VDI Heat Atlas, natural convection",
      .nodes = {{"hot", "stator"}, {"cold", "ambient"}},
      .parameters = {{"conductance", "W/K", base::Range::non_negative(), "conductance at a difference of 40 K"},
                     {"exponent", "", base::Range::between(0.1, 0.5), "exponent of the difference; 1/4 laminar, 1/3 turbulent"}},
      .typical = "0.03 to 0.1 W/K at 40 K: ±8 % of the resistance to ambient between 20 and 60 K",
      .confounded_with =
          "Confounded with a smaller resistance to ambient and with radiation: over one temperature range such a resistance reproduces 99 "
          "% of it. A cool-down from 80 K to 5 K above ambient separates them.",
      // (2.5/40)^0.25 = (1/16)^0.25 = 0.5; 0.1 W/K · 0.5 · 2.5 K = 0.125 W
      .example = {.parameters = {0.1, 0.25}, .at = {}, .temperature_C = {27.5, 25.0}, .expected_heat_W = {-0.125, 0.125}},
      .laws = laws<NaturalConvection>(),
      .needs = {},
      .candidacy = {.size_parameter = conductance,
                    .variants = {{0.1, 0.25}},
                    .family = "cooling that grows with temperature",
                    .experiment = "a cool-down at rest from 80 K to 5 K above ambient, two hours long"},
  };
}

}  // namespace heatsoak::thermal::effects
