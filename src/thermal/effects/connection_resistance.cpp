#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct ConnectionResistance {
  enum Node { stator };
  enum Parameter { resistance };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    heat.source(stator, x.parameter(resistance) * x.at.current_rms_A * x.at.current_rms_A);
  }
};

}  // namespace

EffectType connection_resistance() {
  using enum ConnectionResistance::Parameter;
  return {
      .name = {},
      .summary =
          "Plugs, solder and leads have a resistance outside the winding; its heat enters at the stator, the slow side of the motor.",
      .equation = "P_stator = R_connection · I²",
      .reference = "Joule's law; R. Holm, Electric Contacts, 4th edition (1967)",
      .nodes = {{"stator", "stator"}},
      .parameters = {{"resistance", "ohm", base::Range::non_negative(),
                      "resistance of both leads and their contacts, outside the winding"}},
      .typical = "5 to 20 mΩ: 0.3 to 1.3 W at 8 A",
      .confounded_with =
          "Confounded with a lag of the stator's sensor, with driver_heat (|I|), and with uneven_winding. A 4-wire measurement of the "
          "resistance between driver and terminals separates them.",
      // 0.01 Ω · (8 A)² = 0.64 W
      .example = {.parameters = {0.01}, .at = {.current_rms_A = 8.0}, .temperature_C = {40.0}, .expected_heat_W = {0.64}},
      .laws = laws<ConnectionResistance>(),
      .needs = {Signal::current},
      .candidacy =
          {.size_parameter = resistance,
           .variants = {{0.02}},
           .family = "heat with current at the stator",
           .experiment =
               "a 4-wire resistance of the leads; a step of current at standstill, logged fast, separates it from a lag of the sensor"},
  };
}

}  // namespace heatsoak::thermal::effects
