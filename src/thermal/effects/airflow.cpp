#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct Airflow {
  enum Node { hot, cold };
  enum Parameter { conductance };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    heat.flow(hot, cold, x.parameter(conductance) * x.difference_K(hot, cold));
  }
};

}  // namespace

EffectType airflow() {
  using enum Airflow::Parameter;
  return {
      .name = {},
      .summary =
          "Additional cooling by air that something else moves past the motor, such as a fan or a draught: heat flow in proportion to the "
          "temperature difference.",
      .equation = "P_hot→cold = G · (T_hot − T_cold)",
      .reference = "Newton's law of cooling; VDI Heat Atlas, forced convection at a constant speed of the air",
      .nodes = {{"hot", "stator"}, {"cold", "ambient"}},
      .parameters = {{"conductance", "W/K", base::Range::non_negative(), "conductance in addition to that in still air"}},
      .typical = "0.05 to 0.3 W/K for a motor of 0.1 kg; a fan on a large one some W/K",
      .confounded_with =
          "Confounded with the resistance to ambient itself: only runs with and without the air, all else equal, separate them. At the "
          "winding, also with winding_through_flow, where the rotor moves the air.",
      // 0.2 W/K · (60 − 25) K = 7 W
      .example = {.parameters = {0.2}, .at = {}, .temperature_C = {60.0, 25.0}, .expected_heat_W = {-7.0, 7.0}},
      .laws = laws<Airflow>(),
      .needs = {},
      .candidacy = {.size_parameter = conductance,
                    .variants = {{0.15}},
                    .family = "more cooling than in still air",
                    .experiment = "the same load twice, once with the air held off by a screen"},
  };
}

}  // namespace heatsoak::thermal::effects
