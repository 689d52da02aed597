#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct Saturation {
  enum Node { winding };
  enum Parameter { excess, knee_current, knee_width };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S saturated =
        named("saturation_share", soft_step((x.at.current_rms_A / x.parameter(knee_current) - 1.0) / x.parameter(knee_width)));
    heat.source(winding, x.parameter(excess) * x.at.copper_loss_W * saturated);
  }
};

}  // namespace

EffectType saturation() {
  using enum Saturation::Parameter;
  return {
      .name = {},
      .summary = "Above the knee of the iron an ampere gives less torque: for a demanded torque more current flows than K_t gives.",
      .equation = "P_winding = P_copper · k / (1 + e^(−(I/I_knee − 1)/w))",
      .reference = "J. R. Hendershot, T. J. E. Miller, Design of Brushless Permanent-Magnet Machines: torque constant over current",
      .nodes = {{"winding", "winding"}},
      .parameters = {{"excess", "", base::Range::between(0.0, 5.0), "extra copper loss per copper loss, well above the knee"},
                     {"knee_current", "A", base::Range::between(0.01, 1e4), "equivalent DC current at which half of the excess is reached"},
                     {"knee_width", "", base::Range::between(0.01, 1.0),
                      "width of the knee as a share of the knee current; an ordinary knee: 0.1"}},
      .typical = "0.1 to 0.5 above two to four times the nominal current",
      .confounded_with =
          "Confounded with a temperature coefficient of the resistance that is too low: both act at high current. If the current was "
          "measured, the measurement already contains the effect.",
      // half of the excess at the knee current: 0.5 · 0.4 · 30 W = 6 W
      .example = {.parameters = {0.4, 12.0, 0.1},
                  .at = {.current_rms_A = 12.0, .copper_loss_W = 30.0},
                  .temperature_C = {60.0},
                  .expected_heat_W = {6.0}},
      .laws = laws<Saturation>(),
      .needs = {Signal::current},
      .candidacy = {.size_parameter = excess,
                    .variants = {{0.3, 6.0, 0.1}, {0.3, 10.0, 0.1}, {0.3, 16.0, 0.1}},
                    .family = "extra copper loss",
                    .experiment = "short stalls at rising currents with torque and current both measured"},
  };
}

}  // namespace heatsoak::thermal::effects
