#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct StallPhaseImbalance {
  enum Node { winding };
  enum Parameter { excess, stall_speed };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    constexpr double kStepsPerSpeed = 5.0;
    const S stalled = named("stalled_share", soft_step(kStepsPerSpeed * (1.0 - x.at.speed_mean_rad_per_s / x.parameter(stall_speed))));
    heat.source(winding, x.parameter(excess) * x.at.copper_loss_W * stalled);
  }
};

}  // namespace

EffectType stall_phase_imbalance() {
  using enum StallPhaseImbalance::Parameter;
  return {
      .name = {},
      .summary = "A motor that holds without turning heats its phases unevenly: the hottest one gets up to twice the mean copper loss.",
      .equation = "P_winding = P_copper · k / (1 + e^(−5·(1 − |ω|/ω_s))): a step as wide as a fifth of ω_s",
      .reference = "sinusoidal currents at standstill: peak² against mean square is 2; block commutation: two of three phases carry all",
      .nodes = {{"winding", "winding"}},
      .parameters = {{"excess", "", base::Range::between(0.0, 1.0), "excess of the hottest phase over the mean copper loss, at standstill"},
                     {"stall_speed", "rad/s", base::Range::between(0.1, 1000.0), "speed below which the phases no longer share the heat"}},
      .typical = "0.3 to 1 below about 10 rad/s",
      .confounded_with =
          "Confounded with third_node if runs begin with a stall. Turning the rotor by 60 electrical degrees between stalls separates "
          "them.",
      // half of the excess at the stall speed: 0.5 · 0.8 · 10 W = 4 W
      .example = {.parameters = {0.8, 10.0},
                  .at = {.speed_mean_rad_per_s = 10.0, .copper_loss_W = 10.0},
                  .temperature_C = {60.0},
                  .expected_heat_W = {4.0}},
      .laws = laws<StallPhaseImbalance>(),
      .needs = {Signal::current, Signal::speed},
      .candidacy = {.size_parameter = excess,
                    .variants = {{0.4, 5.0}, {0.4, 20.0}},
                    .family = "extra copper loss",
                    .experiment = "locked-rotor pulses of one current at three rotor angles, 60 electrical degrees apart"},
  };
}

}  // namespace heatsoak::thermal::effects
