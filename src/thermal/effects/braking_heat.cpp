#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct BrakingHeat {
  enum Node { heated };
  enum Parameter { share };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S into_shaft_W = named("power_into_shaft_W", -x.at.shaft_power_W);
    heat.source(heated, x.parameter(share) * named("braking_power_W", positive_part(into_shaft_W)));
  }
};

}  // namespace

EffectType braking_heat() {
  using enum BrakingHeat::Parameter;
  return {
      .name = {},
      .summary = "Braking power that does not return to the battery: it becomes heat in the motor or in a brake on it.",
      .equation = "P_node = k · max(0, −P_shaft)",
      .reference = "conservation of energy",
      .nodes = {{"heated", "stator"}},
      .parameters = {{"share", "", base::Range::between(0.0, 1.0), "share of the braking power that heats the node"}},
      .typical = "0.1 to 1 of the braking power: hard stops make more heat than driving",
      .confounded_with =
          "Confounded with load_friction, which acts while driving too. The copper loss of the braking current is already in copper_loss.",
      // 0.5 · max(0, 30 W) = 15 W
      .example = {.parameters = {0.5}, .at = {.shaft_power_W = -30.0}, .temperature_C = {40.0}, .expected_heat_W = {15.0}},
      .laws = laws<BrakingHeat>(),
      .needs = {Signal::shaft_power},
      .candidacy = {.size_parameter = share,
                    .variants = {{0.3}},
                    .family = "heat with load at the stator",
                    .experiment = "the same run with soft and with hard stops; one stop with the driver switched off"},
  };
}

}  // namespace heatsoak::thermal::effects
