#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct RemainingLoss {
  enum Node { winding, stator };
  enum Parameter { share, winding_share };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S balance_W = named("input_minus_known_power_W", x.at.input_power_W - x.at.shaft_power_W - x.at.copper_loss_W);
    const S unexplained_W = named("unexplained_power_W", positive_part(balance_W));
    const S remaining_W = named("remaining_power_W", x.parameter(share) * unexplained_W);
    heat.source(winding, x.parameter(winding_share) * remaining_W);
    heat.source(stator, (1.0 - x.parameter(winding_share)) * remaining_W);
  }
};

}  // namespace

EffectType remaining_loss() {
  return {
      .name = {},
      .summary =
          "All loss other than copper loss, from measured power: electrical input power minus shaft power minus I²R. It replaces the "
          "no-load loss in runs that have the power balance.",
      .equation = "P = K · max(0, P_input − P_shaft − P_copper); the share ψ of it heats the winding, 1 − ψ the stator",
      .reference = "conservation of energy; IEC 60034-2-1, direct measurement of input and output",
      .nodes = {{"winding", "winding"}, {"stator", "stator"}},
      .parameters = {{"share", "", base::Range::between(0.0, 2.0),
                      "share of the measured remaining loss: 1 except for errors of the power measurement"},
                     {"winding_share", "", base::Range::between(0.0, 1.0),
                      "share of this loss that heats the winding; 0.5 if nothing is known"}},
      .typical = "share 1; 0.3 to 0.7 of it near the winding",
      .confounded_with =
          "Confounded with input_power_loss, which puts the whole balance into one node. Iron and friction losses are parts of this "
          "effect.",
      // 0.9 · (50 − 30 − 5) W = 13.5 W; 0.4 · 13.5 W = 5.4 W into the winding, 8.1 W into the stator
      .example = {.parameters = {0.9, 0.4},
                  .at = {.shaft_power_W = 30.0, .input_power_W = 50.0, .copper_loss_W = 5.0},
                  .temperature_C = {60.0, 40.0},
                  .expected_heat_W = {5.4, 8.1}},
      .laws = laws<RemainingLoss>(),
      .needs = {Signal::current, Signal::input_power, Signal::shaft_power},
  };
}

}  // namespace heatsoak::thermal::effects
