#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct ContactLaw {
  enum Node { hot, cold };
  enum Parameter { conductance, mean_ratio, difference_ratio };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    constexpr double kMean_C = 60.0;
    constexpr double kDifference_K = 30.0;
    constexpr double kPer_K = 100.0;
    const S difference_K = x.difference_K(hot, cold);
    const S mean_C = named("contact_mean_C", 0.5 * (x.temperature_C(hot) + x.temperature_C(cold)));
    const S ratio = named("contact_ratio", power(x.parameter(mean_ratio), (mean_C - kMean_C) / kPer_K) *
                                               power(x.parameter(difference_ratio), (difference_K - kDifference_K) / kPer_K));
    heat.flow(hot, cold, x.parameter(conductance) * ratio * difference_K);
  }
};

}  // namespace

EffectType contact_law() {
  return {
      .name = {},
      .summary =
          "A conductance between two nodes that varies exponentially with their mean temperature and with their difference, in parallel to "
          "the constant resistance between them.",
      .equation = "P_hot→cold = G · r_m^((T_mean − 60 °C)/100 K) · r_d^((ΔT − 30 K)/100 K) · ΔT",
      .reference =
          "an empirical law; D. Staton, A. Boglietti, A. Cavagnino, Solving the more difficult aspects of electric motor thermal analysis, "
          "IEEE Trans. Energy Convers. 20 (2005): gaps between parts determine the contact and change with temperature",
      .nodes = {{"hot", "winding"}, {"cold", "stator"}},
      .parameters =
          {{"conductance", "W/K", base::Range::non_negative(), "conductance at a mean temperature of 60 °C and a difference of 30 K"},
           {"mean_ratio", "", base::Range::between(0.01, 100.0), "factor on the conductance, per 100 K more of the mean temperature"},
           {"difference_ratio", "", base::Range::between(0.01, 100.0), "factor on the conductance, per 100 K more of the difference"}},
      .typical = "half of the conductance between winding and stator, with ratios of 0.3 to 3",
      .confounded_with =
          "Confounded with contact_temperature_dependence, a contact that appears in one step, and with a winding of several bodies. This "
          "effect is for forecasts: it represents any cause of a nonlinear conductance.",
      // mean 110 °C, difference 80 K: 0.5 W/K · 4^0.5 · 4^0.5 · 80 K = 0.5 · 4 · 80 = 160 W
      .example = {.parameters = {0.5, 4.0, 4.0}, .at = {}, .temperature_C = {150.0, 70.0}, .expected_heat_W = {-160.0, 160.0}},
      .laws = laws<ContactLaw>(),
  };
}

}  // namespace heatsoak::thermal::effects
