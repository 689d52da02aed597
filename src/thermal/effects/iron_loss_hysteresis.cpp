#include "thermal/law.h"
#include "thermal/reference_point.h"

namespace heatsoak::thermal::effects {
namespace {

struct IronLossHysteresis {
  enum Node { stator };
  enum Parameter { loss };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    heat.source(stator, x.parameter(loss) * speed_ratio(x.at.speed_mean_rad_per_s));
  }
};

}  // namespace

EffectType iron_loss_hysteresis() {
  using enum IronLossHysteresis::Parameter;
  return {
      .name = {},
      .summary = "Hysteresis of the iron: the same energy for every reversal of the field, so the loss is proportional to speed.",
      .equation = "P_stator = P_500 · |ω| / (500 rad/s)",
      .reference =
          "C. P. Steinmetz, On the law of hysteresis, Trans. AIEE 9 (1892): energy per cycle at one induction; G. Bertotti, General "
          "properties of power losses in soft ferromagnetic materials, IEEE Trans. Magn. 24 (1988)",
      .nodes = {{"stator", "stator"}},
      .parameters = {{"loss", "W", base::Range::non_negative(), "loss at 500 rad/s"}},
      .typical = "1 to 3 W at 500 rad/s",
      .confounded_with =
          "Confounded with the dry part of bearing_friction, which is the same term and cannot be separated by temperatures, and with "
          "iron_loss_eddy and windage, which curve upwards with speed. The no_load_loss of a data sheet is the same term too; this effect "
          "is then the part that the sheet omits.",
      // 2 W · 250/500 = 1 W
      .example = {.parameters = {2.0}, .at = {.speed_mean_rad_per_s = 250.0}, .temperature_C = {40.0}, .expected_heat_W = {1.0}},
      .laws = laws<IronLossHysteresis>(),
      .needs = {Signal::speed},
      .candidacy = {.size_parameter = loss,
                    .variants = {{2.0}},
                    .family = "speed loss at the stator",
                    .experiment = "a staircase of speeds without load, each step until the stator reaches a steady state: does the loss "
                                  "grow with ω, ω² or ω³?"},
  };
}

}  // namespace heatsoak::thermal::effects
