#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct InputPowerLoss {
  enum Node { heated };
  enum Parameter { share };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S balance_W = named("input_minus_shaft_power_W", x.at.input_power_W - x.at.shaft_power_W);
    heat.source(heated, x.parameter(share) * named("lost_power_W", positive_part(balance_W)));
  }
};

}  // namespace

EffectType input_power_loss() {
  return {
      .name = {},
      .summary = "All loss, as measured electrical input power minus shaft power: for motors whose losses are not known one by one.",
      .equation = "P_node = k · max(0, P_input − P_shaft)",
      .reference = "conservation of energy; IEC 60034-2-1, direct measurement of input and output",
      .nodes = {{"heated", "stator"}},
      .parameters = {{"share", "", base::Range::between(0.0, 1.0),
                      "share of the lost power that heats the node; the rest heats the driver or another node"}},
      .typical = "0.2 to 1; the power of a propeller or a wheel counts as shaft power",
      .confounded_with = "Confounded with copper_loss and the speed losses, which are its parts: use either them or this at one node.",
      // 0.8 · (30 W − 20 W) = 8 W
      .example = {.parameters = {0.8},
                  .at = {.shaft_power_W = 20.0, .input_power_W = 30.0},
                  .temperature_C = {40.0},
                  .expected_heat_W = {8.0}},
      .laws = laws<InputPowerLoss>(),
      .needs = {Signal::input_power, Signal::shaft_power},
      .candidacy = {},
  };
}

}  // namespace heatsoak::thermal::effects
