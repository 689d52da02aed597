#include "thermal/law.h"
#include "thermal/reference_point.h"

namespace heatsoak::thermal::effects {
namespace {

struct Windage {
  enum Node { stator };
  enum Parameter { loss };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S rms_ratio = speed_ratio(x.at.speed_rms_rad_per_s);
    heat.source(stator, x.parameter(loss) * speed_ratio(x.at.speed_mean_rad_per_s) * rms_ratio * rms_ratio);
  }
};

}  // namespace

EffectType windage() {
  using enum Windage::Parameter;
  return {
      .name = {},
      .summary = "Air drag of the rotor (or of a fan on its shaft): the torque grows with ω², so the loss grows with ω³.",
      .equation = "P_stator = P_500 · |ω|·ω_rms² / (500 rad/s)³",
      .reference = "J. E. Vrancik, Prediction of windage power loss in alternators, NASA TN D-4849 (1968)",
      .nodes = {{"stator", "stator"}},
      .parameters = {{"loss", "W", base::Range::non_negative(), "loss at 500 rad/s"}},
      .typical = "below 0.1 W at 500 rad/s for a smooth rotor, 0.5 W with a fan",
      .confounded_with =
          "Confounded with iron_loss_eddy (ω²): only the highest speeds separate them. A cover over the rotor's openings changes windage "
          "alone.",
      // 0.5 W · (250/500)³ = 0.0625 W
      .example = {.parameters = {0.5},
                  .at = {.speed_mean_rad_per_s = 250.0, .speed_rms_rad_per_s = 250.0},
                  .temperature_C = {40.0},
                  .expected_heat_W = {0.0625}},
      .laws = laws<Windage>(),
      .needs = {Signal::speed},
      .candidacy = {.size_parameter = loss,
                    .variants = {{0.3}},
                    .family = "speed loss at the stator",
                    .experiment = "a staircase of speeds without load up to the highest one, with the rotor's openings free and covered"},
  };
}

}  // namespace heatsoak::thermal::effects
