#include "thermal/law.h"
#include "thermal/reference_point.h"

namespace heatsoak::thermal::effects {
namespace {

struct AcCopperLoss {
  enum Node { winding };
  enum Parameter { share };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S speed = speed_ratio(x.at.speed_rms_rad_per_s);
    heat.source(winding, x.parameter(share) * x.at.copper_loss_W * speed * speed);
  }
};

}  // namespace

EffectType ac_copper_loss() {
  using enum AcCopperLoss::Parameter;
  return {
      .name = {},
      .summary = "Skin and proximity effect: the current crowds in the wire, so copper loss grows with the square of the frequency.",
      .equation = "P_winding = P_copper · k_500 · (ω_rms / (500 rad/s))²",
      .reference =
          "P. L. Dowell, Effects of eddy currents in transformer windings, Proc. IEE 113 (1966), expanded for wires thin against the skin "
          "depth",
      .nodes = {{"winding", "winding"}},
      .parameters = {{"share", "", base::Range::between(0.0, 10.0), "extra copper loss per copper loss, at 500 rad/s"}},
      .typical = "0.05 to 0.4 of the copper loss at 500 rad/s",
      .confounded_with =
          "Confounded with armature_iron_loss, the same product of current and speed at the stator, and with winding_through_flow of the "
          "opposite sign, which cools the winding with speed.",
      // 0.2 · 8 W · (250/500)² = 0.4 W
      .example = {.parameters = {0.2},
                  .at = {.speed_rms_rad_per_s = 250.0, .copper_loss_W = 8.0},
                  .temperature_C = {60.0},
                  .expected_heat_W = {0.4}},
      .laws = laws<AcCopperLoss>(),
      .needs = {Signal::current, Signal::speed},
      .candidacy = {.size_parameter = share,
                    .variants = {{0.35}},
                    .family = "extra copper loss",
                    .experiment = "the same current at two speeds, each until the winding reaches a steady state"},
  };
}

}  // namespace heatsoak::thermal::effects
