#include "thermal/law.h"
#include "thermal/reference_point.h"

namespace heatsoak::thermal::effects {
namespace {

struct BearingFriction {
  enum Node { stator };
  enum Parameter { loss, viscous_share, thinning };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S square_ratio = named("speed_squared_ratio", x.at.speed_rms_rad_per_s * x.at.speed_rms_rad_per_s /
                                                            (kReferenceSpeed_rad_per_s * kReferenceSpeed_rad_per_s));
    const S viscous = named("viscous_friction_share",
                            x.parameter(viscous_share) * exponential(-x.parameter(thinning) * (x.temperature_C(stator) - 25.0)));
    heat.source(stator,
                x.parameter(loss) * ((1.0 - x.parameter(viscous_share)) * speed_ratio(x.at.speed_mean_rad_per_s) + viscous * square_ratio));
  }
};

}  // namespace

EffectType bearing_friction() {
  using enum BearingFriction::Parameter;
  return {
      .name = {},
      .summary = "Friction of bearings and seals: a dry part ∝ |ω| and a viscous part ∝ ω² that falls as the grease warms.",
      .equation = "P_stator = P_500 · ((1 − v)·|ω|/(500 rad/s) + v·e^(−κ·(T_stator − 25 °C))·(ω_rms/(500 rad/s))²)",
      .reference = "SKF, Rolling bearings: the SKF model for calculating the frictional moment; A. Palmgren's load and viscous moments",
      .nodes = {{"stator", "stator"}},
      .parameters = {{"loss", "W", base::Range::non_negative(), "loss at 500 rad/s and 25 °C"},
                     {"viscous_share", "", base::Range::between(0.0, 1.0), "share of the loss that is viscous"},
                     {"thinning", "1/K", base::Range::between(0.0, 0.05),
                      "relative fall of the viscous part per kelvin; mineral grease 0.02 to 0.04"}},
      .typical = "0.2 to 1 W at 500 rad/s",
      .confounded_with =
          "Confounded with iron_loss_hysteresis and iron_loss_eddy, which depend on speed in the same way. Only the decrease with "
          "temperature differs; without it no temperature separates them.",
      // 1 W · (0.5 · 0.5 + 0.5 · e^(−0.02/K · 50 K) · 0.25) = 0.25 + 0.125·e^(−1) = 0.25 + 0.04598493014643030 = 0.2959849301464303 W
      .example = {.parameters = {1.0, 0.5, 0.02},
                  .at = {.speed_mean_rad_per_s = 250.0, .speed_rms_rad_per_s = 250.0},
                  .temperature_C = {75.0},
                  .expected_heat_W = {0.2959849301464303}},
      .laws = laws<BearingFriction>(),
      .needs = {Signal::speed},
      .candidacy =
          {.size_parameter = loss,
           .variants = {{0.5, 0.7, 0.02}},
           .family = "speed loss at the stator",
           .experiment =
               "turn the motor from outside with the supply off and the magnets out, cold and warm: the remaining loss is friction"},
  };
}

}  // namespace heatsoak::thermal::effects
