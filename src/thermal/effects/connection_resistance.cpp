#include "thermal/effect.h"

namespace heatsoak::effects {
namespace {

enum Node { stator };
enum Parameter { resistance };

struct ConnectionResistance {
  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    heat.source(stator, x.parameter(resistance) * x.at.current_rms_A * x.at.current_rms_A);
  }
};

}  // namespace

EffectType connection_resistance() {
  return {
      .name = {},
      .summary = "Plugs, solder and leads have a resistance outside the winding; its heat enters at the slow side of the motor.",
      .equation = "P_stator = R_connection · I²",
      .reference = "Joule's law; R. Holm, Electric Contacts, 4th edition (1967)",
      .nodes = {{"stator", "stator"}},
      .parameters = {{"resistance", "ohm", Range::non_negative(), "of both leads and their contacts, outside the winding"}},
      .typical = "5 to 20 mΩ: 0.3 to 1.3 W at 8 A",
      .confounded_with =
          "A lag of the stator's sensor; driver_heat (|I|); where it is a few per cent of the heat, a winding of several bodies, loosely "
          "joined. A 4-wire measurement of the resistance between driver and terminals tells.",
      // 0.01 Ω · (8 A)² = 0.64 W
      .example = {.parameters = {0.01}, .at = {.current_rms_A = 8.0}, .temperature_C = {40.0}, .expected_heat_W = {0.64}},
      .laws = laws<ConnectionResistance>(),
      .needs = {Signal::current},
      .candidacy =
          {.size_parameter = resistance,
           .variants = {{0.02}},
           .family = "heat with current at the stator",
           .experiment =
               "a 4-wire resistance of the leads; a step of current at standstill, logged fast, tells it from a lag of the sensor"},
  };
}

}  // namespace heatsoak::effects
