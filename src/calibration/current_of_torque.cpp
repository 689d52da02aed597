#include "calibration/current_of_torque.h"

#include <map>
#include <string>
#include <vector>

#include "thermal/drive_stage.h"
#include "thermal/law.h"

namespace heatsoak::calibration {
namespace {

struct CurrentOfTorque {
  enum Node { winding };
  enum Parameter { resistance, temperature_coefficient, drag_torque, drag_of_rows, torque_constant };

  template <class S>
  static void book(const thermal::Situation<S>& x, thermal::HeatBook<S>& heat) {
    // At standstill there is no drag. A speed far below any that is measured keeps the quotient finite.
    constexpr double kStandstill_rad_per_s = 1e-3;
    const S speed = x.at.speed_mean_rad_per_s;
    const S turns_rad2_per_s2 = speed * speed + kStandstill_rad_per_s * kStandstill_rad_per_s;
    const S torque_Nm = x.at.shaft_power_W * speed / turns_rad2_per_s2;
    const S more_Nm = (x.parameter(drag_torque) - x.parameter(drag_of_rows)) * speed * speed / turns_rad2_per_s2;
    // I² − I_rows² = (I − I_rows) · (I + I_rows)
    const S both_Nm = 2.0 * torque_Nm + x.parameter(drag_torque) + x.parameter(drag_of_rows);
    const S squares_A2 = more_Nm * both_Nm / (x.parameter(torque_constant) * x.parameter(torque_constant));
    const S one_A = S(1.0);
    heat.source(winding, squares_A2 * thermal::DriveStage::copper_loss_W(one_A, x.parameter(resistance),
                                                                         x.parameter(temperature_coefficient), x.temperature_C(winding)));
  }
};

const thermal::EffectType& current_of_torque() {
  static const thermal::EffectType type{
      .name = "current_of_torque",
      .summary = "Copper loss of the current for the drag, beyond that of the drag with which the rows were read.",
      .equation = "P_winding = (I² − I_rows²) · R(T_winding) with I = (M + M_drag) / K_t and I_rows = (M + M_rows) / K_t",
      .reference = "",
      .nodes = {{"winding", "winding"}},
      .parameters = {{"terminal_resistance", "ohm", base::Range::positive(), "that of copper_loss"},
                     {"temperature_coefficient", "1/K", base::Range::between(0.0, 0.01), "that of copper_loss"},
                     {"drag_torque", "N m", base::Range::non_negative(), "that of no_load_loss"},
                     {"drag_of_rows", "N m", base::Range::non_negative(), "drag with which the current of the rows was computed"},
                     {"torque_constant", "N m/A", base::Range::positive(), "torque per current"}},
      .typical = "",
      .confounded_with = "",
      .example = {},
      .laws = thermal::laws<CurrentOfTorque>(),
      .needs = {thermal::Signal::speed, thermal::Signal::shaft_power},
  };
  return type;
}

}  // namespace

void add_current_of_torque(thermal::Network& network, double drag_torque_Nm, double torque_constant_Nm_per_A) {
  const std::map<std::string, std::string> shared{{"terminal_resistance", "copper_loss.terminal_resistance"},
                                                  {"temperature_coefficient", "copper_loss.temperature_coefficient"},
                                                  {"drag_torque", "no_load_loss.drag_torque"}};
  network.add_effect(std::string(current_of_torque().name), current_of_torque(), std::vector<std::string>{"winding"},
                     std::vector<double>{0.0, 0.0, 0.0, drag_torque_Nm, torque_constant_Nm_per_A}, shared);
}

}  // namespace heatsoak::calibration
