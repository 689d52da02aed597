#include "thermal/law.h"
#include "thermal/reference_point.h"

namespace heatsoak::thermal::effects {
namespace {

struct SpeedDependentConvection {
  enum Node { hot, cold };
  enum Parameter { conductance, exponent };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S conductance_W_per_K = named("forced_convection_conductance_W_per_K",
                                        x.parameter(conductance) * power(speed_ratio(x.at.speed_mean_rad_per_s), x.parameter(exponent)));
    heat.flow(hot, cold, conductance_W_per_K * x.difference_K(hot, cold));
  }
};

}  // namespace

EffectType speed_dependent_convection() {
  using enum SpeedDependentConvection::Parameter;
  return {
      .name = {},
      .summary = "The turning rotor (or the propeller or fan on its shaft) stirs the air: the motor cools better with speed.",
      .equation = "P_hot→cold = G_500 · (|ω|/(500 rad/s))^p · (T_hot − T_cold)",
      .reference = "Nu ∝ Re^p with p from 0.5 (laminar) to 0.8 (turbulent): VDI Heat Atlas, forced convection; R. Hilpert (1933)",
      .nodes = {{"hot", "stator"}, {"cold", "ambient"}},
      .parameters = {{"conductance", "W/K", base::Range::non_negative(), "conductance at 500 rad/s, in addition to the cooling at rest"},
                     {"exponent", "", base::Range::between(0.2, 1.2), "exponent of the speed; 0.5 laminar, 0.8 turbulent"}},
      .typical = "0.05 to 0.2 W/K at 500 rad/s: 20 to 60 % less resistance to ambient",
      .confounded_with =
          "Confounded with a speed loss of the opposite sign: only the growth with the temperature difference separates them, so the runs "
          "need spinning both hot and cold. Also confounded with vehicle_airflow if the wheels drive.",
      // 0.1 W/K · (125/500)^0.5 = 0.05 W/K; · (70 − 30) K = 2 W
      .example = {.parameters = {0.1, 0.5},
                  .at = {.speed_mean_rad_per_s = 125.0},
                  .temperature_C = {70.0, 30.0},
                  .expected_heat_W = {-2.0, 2.0}},
      .laws = laws<SpeedDependentConvection>(),
      .needs = {Signal::speed},
      .candidacy = {.size_parameter = conductance,
                    .variants = {{0.1, 0.5}, {0.1, 0.8}},
                    .family = "cooling with speed",
                    .experiment = "cool down from hot at standstill and again at speed without load; then spin from cold"},
  };
}

}  // namespace heatsoak::thermal::effects
