#include "thermal/law.h"
#include "thermal/reference_point.h"

namespace heatsoak::thermal::effects {
namespace {

struct WindingThroughFlow {
  enum Node { hot, cold };
  enum Parameter { conductance };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S conductance_W_per_K =
        named("through_flow_conductance_W_per_K", x.parameter(conductance) * speed_ratio(x.at.speed_mean_rad_per_s));
    heat.flow(hot, cold, conductance_W_per_K * x.difference_K(hot, cold));
  }
};

}  // namespace

EffectType winding_through_flow() {
  using enum WindingThroughFlow::Parameter;
  return {
      .name = {},
      .summary = "Open motors pump air through the winding: it cools to ambient directly, with speed.",
      .equation = "P_hot→cold = G_500 · |ω|/(500 rad/s) · (T_hot − T_cold)",
      .reference = "Newton's law of cooling; the flow of a centrifugal fan is linear in its speed (fan laws)",
      .nodes = {{"hot", "winding"}, {"cold", "ambient"}},
      .parameters = {{"conductance", "W/K", base::Range::non_negative(), "conductance at 500 rad/s"}},
      .typical = "0.03 to 0.1 W/K at 500 rad/s in outrunners, none in closed motors",
      .confounded_with =
          "Confounded with air_gap_stirring, which takes the heat to the stator instead, and with ac_copper_loss, which heats the winding "
          "with speed. Tape over the openings separates them.",
      // 0.1 W/K · 250/500 · (90 − 30) K = 3 W
      .example = {.parameters = {0.1},
                  .at = {.speed_mean_rad_per_s = 250.0},
                  .temperature_C = {90.0, 30.0},
                  .expected_heat_W = {-3.0, 3.0}},
      .laws = laws<WindingThroughFlow>(),
      .needs = {Signal::speed},
      .candidacy = {.size_parameter = conductance,
                    .variants = {{0.06}},
                    .family = "winding cooled with speed",
                    .experiment = "one current at two speeds, with the motor's openings free and taped"},
  };
}

}  // namespace heatsoak::thermal::effects
