#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct VehicleAirflow {
  enum Node { hot, cold };
  enum Parameter { conductance, exponent };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S conductance_W_per_K =
        named("vehicle_airflow_conductance_W_per_K", x.parameter(conductance) * power(x.at.vehicle_speed_m_per_s, x.parameter(exponent)));
    heat.flow(hot, cold, conductance_W_per_K * x.difference_K(hot, cold));
  }
};

}  // namespace

EffectType vehicle_airflow() {
  using enum VehicleAirflow::Parameter;
  return {
      .name = {},
      .summary = "Cooling by the air that flows past because the vehicle moves.",
      .equation = "P_hot→cold = G_1 · (v/(1 m/s))^p · (T_hot − T_cold), p = 0.6",
      .reference = "Nu ∝ Re^p for bodies in cross flow: VDI Heat Atlas, forced convection; R. Hilpert (1933)",
      .nodes = {{"hot", "stator"}, {"cold", "ambient"}},
      .parameters = {{"conductance", "W/K", base::Range::non_negative(), "conductance at 1 m/s, in addition to the cooling at rest"},
                     {"exponent", "", base::Range::between(0.2, 1.2), "exponent of the vehicle's speed"}},
      .typical = "0.02 to 0.05 W/K at 1 m/s: 30 % less resistance to ambient at full speed",
      .confounded_with = "Confounded with speed_dependent_convection. The same drive with the wheels off the ground separates them.",
      // 0.03 W/K · (4 m/s)^0.5 = 0.06 W/K; · (60 − 20) K = 2.4 W
      .example = {.parameters = {0.03, 0.5},
                  .at = {.vehicle_speed_m_per_s = 4.0},
                  .temperature_C = {60.0, 20.0},
                  .expected_heat_W = {-2.4, 2.4}},
      .laws = laws<VehicleAirflow>(),
      .needs = {Signal::vehicle_speed},
      .candidacy = {.size_parameter = conductance,
                    .variants = {{0.03, 0.6}},
                    .family = "cooling with speed",
                    .experiment = "the same wheel speeds on the floor and with the wheels off the ground"},
  };
}

}  // namespace heatsoak::thermal::effects
