#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct LoadFriction {
  enum Node { stator };
  enum Parameter { share };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    heat.source(stator, x.parameter(share) * named("shaft_power_magnitude_W", magnitude(x.at.shaft_power_W)));
  }
};

}  // namespace

EffectType load_friction() {
  using enum LoadFriction::Parameter;
  return {
      .name = {},
      .summary = "Friction that grows with load, of gear teeth, wheel bearings and rollers: a share of the power transmitted through them.",
      .equation = "P_stator = k · |P_shaft|",
      .reference = "Coulomb friction: a force in proportion to the load; 1 − efficiency of a gear stage in the catalogues",
      .nodes = {{"stator", "stator"}},
      .parameters = {{"share", "", base::Range::between(0.0, 1.0), "share of the shaft's power that heats the node"}},
      .typical = "0.03 to 0.08 of the mechanical power",
      .confounded_with = "Confounded with speed_dependent_convection of the opposite sign and armature_iron_loss (|I|·ω²).",
      // 0.05 · |−40 W| = 2 W; braking counts like driving
      .example = {.parameters = {0.05}, .at = {.shaft_power_W = -40.0}, .temperature_C = {40.0}, .expected_heat_W = {2.0}},
      .laws = laws<LoadFriction>(),
      .needs = {Signal::shaft_power},
      .candidacy = {.size_parameter = share,
                    .variants = {{0.05}},
                    .family = "heat with load at the stator",
                    .experiment = "one speed with and without load on the shaft, then one mechanical power at two speeds"},
  };
}

}  // namespace heatsoak::thermal::effects
