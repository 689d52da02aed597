#include "thermal/law.h"
#include "thermal/reference_point.h"

namespace heatsoak::thermal::effects {
namespace {

struct ArmatureIronLoss {
  enum Node { stator };
  enum Parameter { loss };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S speed = speed_ratio(x.at.speed_rms_rad_per_s);
    heat.source(stator, x.parameter(loss) * (x.at.current_rms_A / kReferenceCurrent_A) * speed * speed);
  }
};

}  // namespace

EffectType armature_iron_loss() {
  using enum ArmatureIronLoss::Parameter;
  return {
      .name = {},
      .summary = "The current's own field distorts that of the magnets, so iron loss grows with load.",
      .equation = "P_stator = P_ref · |I|/(5 A) · (ω_rms / (500 rad/s))²",
      .reference =
          "P. H. Mellor, R. Wrobel, D. Holliday, A computationally efficient iron loss model for brushless AC machines that caters for "
          "rated flux and field weakened operation, IEMDC 2009",
      .nodes = {{"stator", "stator"}},
      .parameters = {{"loss", "W", base::Range::non_negative(), "loss at 5 A and 500 rad/s"}},
      .typical = "0.5 to 2 W at 5 A and 500 rad/s",
      .confounded_with = "Confounded with load_friction (|I·ω|) at the same node and ac_copper_loss (I²·ω²) in the winding.",
      // 2 W · 2.5/5 · (250/500)² = 0.25 W
      .example = {.parameters = {2.0},
                  .at = {.current_rms_A = 2.5, .speed_rms_rad_per_s = 250.0},
                  .temperature_C = {40.0},
                  .expected_heat_W = {0.25}},
      .laws = laws<ArmatureIronLoss>(),
      .needs = {Signal::current, Signal::speed},
      .candidacy = {.size_parameter = loss,
                    .variants = {{1.5}},
                    .family = "heat with load at the stator",
                    .experiment = "one mechanical power at low speed with high torque and at high speed with low torque"},
  };
}

}  // namespace heatsoak::thermal::effects
