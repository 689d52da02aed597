#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct Radiation {
  enum Node { hot, cold };
  enum Parameter { emissive_area };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    constexpr double kStefanBoltzmann_W_per_m2_K4 = 5.670374419e-8;
    constexpr double kZero_C = -273.15;
    const S hot_K = named("radiating_surface_K", x.temperature_C(hot) - kZero_C);
    const S cold_K = named("irradiated_surface_K", x.temperature_C(cold) - kZero_C);
    // a⁴ − b⁴ in factored form, because the difference of two large powers would lose digits.
    const S sum_K3 = (hot_K + cold_K) * (hot_K * hot_K + cold_K * cold_K);
    const S conductance_W_per_K =
        named("radiation_conductance_W_per_K", kStefanBoltzmann_W_per_m2_K4 * x.parameter(emissive_area) * sum_K3);
    heat.flow(hot, cold, conductance_W_per_K * (hot_K - cold_K));
  }
};

}  // namespace

EffectType radiation() {
  using enum Radiation::Parameter;
  return {
      .name = {},
      .summary = "Thermal radiation to surroundings at ambient temperature.",
      .equation = "P_hot→cold = ε·A·σ·(T_hot⁴ − T_cold⁴), T in kelvin",
      .reference = "Stefan-Boltzmann law; σ of CODATA 2018",
      .nodes = {{"hot", "stator"}, {"cold", "ambient"}},
      .parameters = {{"emissive_area", "m2", base::Range::between(0.0, 10.0),
                      "emissivity times surface; bare metal 0.1, paint and plastics 0.9"}},
      .typical = "0.004 to 0.01 m²: 0.03 to 0.06 W/K",
      .confounded_with =
          "Confounded with a smaller resistance to ambient, which reproduces 99.9 % of it over one temperature range, and with "
          "natural_convection, which curves the same way. A coat of matt paint changes radiation alone.",
      // 400 K to 300 K over 0.01 m²: 5.670374419e-8 · 0.01 · (2.56e10 − 8.1e9) = 5.670374419e-10 · 1.75e10 = 9.92315523325 W
      .example = {.parameters = {0.01}, .at = {}, .temperature_C = {126.85, 26.85}, .expected_heat_W = {-9.92315523325, 9.92315523325}},
      .laws = laws<Radiation>(),
      .needs = {},
      .candidacy = {.size_parameter = emissive_area,
                    .variants = {{0.008}},
                    .family = "cooling that grows with temperature",
                    .experiment = "a cool-down at rest from 80 K to 5 K above ambient, bare and with a coat of matt paint"},
  };
}

}  // namespace heatsoak::thermal::effects
