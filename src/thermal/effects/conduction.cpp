#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct Conduction {
  enum Node { hot, cold };
  enum Parameter { thermal_resistance };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    heat.flow(hot, cold, x.difference_K(hot, cold) / x.parameter(thermal_resistance));
  }
};

}  // namespace

EffectType conduction() {
  return {
      .name = {},
      .summary = "Heat flows between two nodes in proportion to their difference in temperature.",
      .equation = "P_hot→cold = (T_hot − T_cold) / R_th",
      .reference = "Fourier's law; the R_th1 and R_th2 of maxon's data sheets",
      .nodes = {{"hot", "stator"}, {"cold", "ambient"}},
      .parameters = {{"thermal_resistance", "K/W", base::Range::between(1e-3, std::numeric_limits<double>::infinity()),
                      "thermal resistance between the two nodes"}},
      .typical = "winding to stator 1 to 8 K/W, stator to ambient 1.5 to 18 K/W",
      .confounded_with =
          "Confounded with natural_convection and radiation, which over a narrow temperature range act as a resistance too. A cool-down "
          "from 80 K to 5 K above ambient separates them.",
      // (80 °C − 30 °C) / 2.5 K/W = 20 W leave the hot node and reach the cold one
      .example = {.parameters = {2.5}, .at = {}, .temperature_C = {80.0, 30.0}, .expected_heat_W = {-20.0, 20.0}},
      .laws = laws<Conduction>(),
  };
}

}  // namespace heatsoak::thermal::effects
