#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct NoLoadLoss {
  enum Node { stator };
  enum Parameter { drag_torque };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    heat.source(stator, x.parameter(drag_torque) * x.at.speed_mean_rad_per_s);
  }
};

}  // namespace

EffectType no_load_loss() {
  return {
      .name = {},
      .summary = "Iron and bearing loss as given in a data sheet: one constant drag torque K_t·I_0.",
      .equation = "P_stator = M_drag · |ω|",
      .reference = "maxon, key information on motor data: iron loss is treated like additional friction",
      .nodes = {{"stator", "stator"}},
      .parameters = {{"drag_torque", "N m", base::Range::non_negative(), "torque constant times no-load current"}},
      .typical = "1 to 5 W at no-load speed",
      .confounded_with =
          "Confounded with iron_loss_hysteresis and dry bearing friction, which are the same term. Eddy-current loss grows with ω² "
          "instead.",
      // 0.008 N m · 500 rad/s = 4 W
      .example = {.parameters = {0.008},
                  .at = {.current_rms_A = 0.0, .speed_mean_rad_per_s = 500.0, .speed_rms_rad_per_s = 500.0, .ambient_C = 25.0},
                  .temperature_C = {40.0},
                  .expected_heat_W = {4.0}},
      .laws = laws<NoLoadLoss>(),
      .needs = {Signal::speed},
  };
}

}  // namespace heatsoak::thermal::effects
