#include "thermal/drive_stage.h"
#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

struct CopperLoss {
  enum Node { winding };
  enum Parameter { terminal_resistance, temperature_coefficient };

  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    heat.source(winding, DriveStage::copper_loss_W(x.at.current_rms_A, x.parameter(terminal_resistance),
                                                   x.parameter(temperature_coefficient), x.temperature_C(winding)));
  }
};

}  // namespace

EffectType copper_loss() {
  return {
      .name = {},
      .summary = "Ohmic loss of the winding; the resistance rises with the winding's own temperature.",
      .equation = "P_winding = I² · R25 · (1 + α · (T_winding − 25 °C))",
      .reference = "IEC 60034-2-1; maxon, key information on motor data",
      .nodes = {{"winding", "winding"}},
      .parameters = {{"terminal_resistance", "ohm", base::Range::positive(), "resistance between two terminals at 25 °C"},
                     {"temperature_coefficient", "1/K", base::Range::between(0.0, 0.01),
                      "temperature coefficient of the resistance at 25 °C; copper 0.0039 1/K"}},
      .typical = "5 to 10 W at nominal current",
      .confounded_with =
          "Confounded with all heat capacities and thermal resistances together: a wrong resistance or current gain scales all heat. A "
          "4-wire resistance measurement separates them.",
      // (3 A)² · 0.6 Ω · (1 + 0.004 /K · 100 K) = 9 · 0.6 · 1.4 = 7.56 W
      .example = {.parameters = {0.6, 0.004},
                  .at = {.current_rms_A = 3.0, .speed_mean_rad_per_s = 0.0, .speed_rms_rad_per_s = 0.0, .ambient_C = 25.0},
                  .temperature_C = {125.0},
                  .expected_heat_W = {7.56}},
      .laws = laws<CopperLoss>(),
      .needs = {Signal::current},
  };
}

}  // namespace heatsoak::thermal::effects
