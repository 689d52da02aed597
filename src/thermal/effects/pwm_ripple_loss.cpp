#include "thermal/law.h"
#include "thermal/reference_point.h"

namespace heatsoak::thermal::effects {
namespace {

struct PwmRippleLoss {
  enum Node { winding, stator };
  enum Parameter { loss, stator_share };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    const S duty = named("duty_ratio", magnitude(x.at.modulation_ratio));
    const S off_duty = named("off_duty_ratio", positive_part(named("one_minus_duty_ratio", 1.0 - duty)));
    const S bus_ratio = named("bus_voltage_ratio", x.at.bus_V / kReferenceBus_V);
    const S loss_W = named("ripple_loss_W", x.parameter(loss) * 4.0 * duty * off_duty * bus_ratio * bus_ratio);
    heat.source(winding, (1.0 - x.parameter(stator_share)) * loss_W);
    heat.source(stator, x.parameter(stator_share) * loss_W);
  }
};

}  // namespace

EffectType pwm_ripple_loss() {
  using enum PwmRippleLoss::Parameter;
  return {
      .name = {},
      .summary =
          "The driver's switching leaves a ripple of voltage, largest at half modulation, that heats copper and iron even without load.",
      .equation = "P = P_24 · 4·D·(1 − D) · (V_bus / 24 V)², D = |V_motor|/V_bus; (1 − s)·P to the winding, s·P to the stator",
      .reference =
          "variance D·(1 − D)·V² of a chopped voltage, see N. Mohan, T. Undeland, W. Robbins, Power Electronics, chapter on dc choppers; "
          "eddy currents take its square",
      .nodes = {{"winding", "winding"}, {"stator", "stator"}},
      .parameters = {{"loss", "W", base::Range::non_negative(), "loss at half modulation of 24 V"},
                     {"stator_share", "", base::Range::between(0.0, 1.0),
                      "share of the loss that heats the stator; 0: all in the winding"}},
      .typical = "0.3 to 2 W at half modulation of 24 V",
      .confounded_with =
          "Confounded with iron_loss_hysteresis at a single supply voltage, where modulation follows speed. Another supply voltage at the "
          "same speed separates them.",
      // 1.6 W · 4 · 0.25 · 0.75 · (12/24)² = 1.6 · 0.75 · 0.25 = 0.3 W, three quarters of it to the winding
      .example = {.parameters = {1.6, 0.25},
                  .at = {.modulation_ratio = 0.25, .bus_V = 12.0},
                  .temperature_C = {40.0, 35.0},
                  .expected_heat_W = {0.225, 0.075}},
      .laws = laws<PwmRippleLoss>(),
      .needs = {Signal::modulation, Signal::bus_voltage},
      .candidacy = {.size_parameter = loss,
                    .variants = {{1.0, 0.0}, {1.0, 1.0}},
                    .family = "switching loss in the motor",
                    .experiment = "one speed without load from two supply voltages: the ripple changes, friction and iron do not"},
  };
}

}  // namespace heatsoak::thermal::effects
