#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct MagnetWeakening {
  enum Node { winding, magnet };
  enum Parameter { temperature_coefficient };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    constexpr double kWidth_K = 2.0;
    const S warmer_K = named("magnet_above_25C_K", x.temperature_C(magnet) - 25.0);
    const S weaker = named("magnet_weakening_ratio", x.parameter(temperature_coefficient) * soft_positive_part(warmer_K, kWidth_K));
    heat.source(winding, 2.0 * weaker * x.at.copper_loss_W);
  }
};

}  // namespace

EffectType magnet_weakening() {
  using enum MagnetWeakening::Parameter;
  return {
      .name = {},
      .summary =
          "Warm magnets give less torque per ampere: for a demanded torque more current flows than the torque constant of a cold motor "
          "gives.",
      .equation = "P_winding = P_copper · 2·β·max(0, T_magnet − 25 °C), first order of 1/(1 − β·ΔT)², corner rounded over 2 K",
      .reference = "reversible temperature coefficient of remanence, IEC 60404-8-1: NdFeB −0.10 to −0.12 %/K, ferrite −0.2 %/K",
      .nodes = {{"winding", "winding"}, {"magnet", "stator"}},
      .parameters = {{"temperature_coefficient", "1/K", base::Range::between(0.0, 0.01), "loss of torque constant per kelvin above 25 °C"}},
      .typical = "0.001 to 0.0012 1/K: 14 % more copper loss at 60 K",
      .confounded_with =
          "Confounded with a temperature coefficient of the resistance that is too low. If the current was measured, the measurement "
          "already contains the effect, and diagnose does not test it.",
      // ΔT = 1.5 K: soft part (1.5 + √(1.5² + 2²))/2 = (1.5 + 2.5)/2 = 2 K; 2 · 0.001/K · 2 K · 10 W = 0.04 W
      .example = {.parameters = {0.001}, .at = {.copper_loss_W = 10.0}, .temperature_C = {60.0, 26.5}, .expected_heat_W = {0.04, 0.0}},
      .laws = laws<MagnetWeakening>(),
      .needs = {Signal::current},
      .candidacy = {.size_parameter = temperature_coefficient,
                    .variants = {{0.0012}},
                    .family = "extra copper loss",
                    .experiment = "the back-EMF per speed, cold and hot; the same torque demand from a cold and from a hot motor",
                    .is_in_current = true},
  };
}

}  // namespace heatsoak::thermal::effects
