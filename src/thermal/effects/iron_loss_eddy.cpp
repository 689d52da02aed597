#include "thermal/law.h"
#include "thermal/reference_point.h"

namespace heatsoak::thermal::effects {
namespace {

struct IronLossEddy {
  enum Node { stator };
  enum Parameter { loss, exponent };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S speed = speed_ratio(x.at.speed_rms_rad_per_s);
    heat.source(stator, x.parameter(loss) * power(speed, x.parameter(exponent)));
  }
};

}  // namespace

EffectType iron_loss_eddy() {
  using enum IronLossEddy::Parameter;
  return {
      .name = {},
      .summary =
          "Eddy currents in stator iron (or in magnets and housing): driven by the rate of change of the field, so the loss grows with ω².",
      .equation = "P_stator = P_500 · (ω_rms / (500 rad/s))^p, p = 2",
      .reference =
          "G. Bertotti, General properties of power losses in soft ferromagnetic materials, IEEE Trans. Magn. 24 (1988): classical loss "
          "∝ f², excess loss ∝ f^1.5",
      .nodes = {{"stator", "stator"}},
      .parameters = {{"loss", "W", base::Range::non_negative(), "loss at 500 rad/s"},
                     {"exponent", "", base::Range::between(1.2, 3.0), "exponent of the speed; 2 for eddy currents, 1.5 for excess loss"}},
      .typical = "1 to 3 W at 500 rad/s",
      .confounded_with =
          "Confounded with iron_loss_hysteresis and dry friction (linear in speed) and windage (ω³); the total loss of a machine may "
          "follow one exponent between them. Eddy currents of the magnets heat the rotor first, like third_node with a lag.",
      // 2 W · (250/500)² = 0.5 W
      .example = {.parameters = {2.0, 2.0}, .at = {.speed_rms_rad_per_s = 250.0}, .temperature_C = {40.0}, .expected_heat_W = {0.5}},
      .laws = laws<IronLossEddy>(),
      .needs = {Signal::speed},
      .candidacy = {.size_parameter = loss,
                    .variants = {{2.0, 2.0}},
                    .family = "speed loss at the stator",
                    .experiment = "a staircase of speeds without load, each step until the stator reaches a steady state: does the loss "
                                  "grow with ω, ω² or ω³?"},
  };
}

}  // namespace heatsoak::thermal::effects
