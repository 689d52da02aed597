#include "calibration/loss_at_stator.h"

#include <string>
#include <vector>

#include "thermal/law.h"

namespace heatsoak::calibration {
namespace {

struct LossAtStator {
  enum Node { winding, stator };
  enum Parameter { drag_torque };

  template <class S>
  static void book(const thermal::Situation<S>& x, thermal::HeatBook<S>& heat) {
    const S drag_W = x.parameter(drag_torque) * x.at.speed_mean_rad_per_s;
    // At most the total loss: otherwise, with less loss than in the data sheet, the winding would be cooled.
    heat.flow(winding, stator, drag_W - thermal::positive_part(drag_W - thermal::positive_part(x.at.input_power_W - x.at.shaft_power_W)));
  }
};

const thermal::EffectType& loss_at_stator() {
  static const thermal::EffectType type{
      .name = kDragAtStator.substr(0, kDragAtStator.find('.')),
      .summary = "No-load loss at the stator, subtracted from a power that is assigned to the winding.",
      .equation = "P_winding→stator = min(M_drag · |ω|, max(0, P_input − P_shaft))",
      .reference = "",
      .nodes = {{"winding", "winding"}, {"stator", "stator"}},
      .parameters = {{"drag_torque", "N m", base::Range::non_negative(), "torque constant times no-load current"}},
      .typical = "",
      .confounded_with = "",
      .example = {},
      .laws = thermal::laws<LossAtStator>(),
      .needs = {thermal::Signal::speed, thermal::Signal::input_power, thermal::Signal::shaft_power},
  };
  return type;
}

}  // namespace

void add_loss_at_stator(thermal::Network& network, double drag_torque_Nm) {
  network.add_effect(std::string(loss_at_stator().name), loss_at_stator(), std::vector<std::string>{"winding", "stator"},
                     std::vector<double>{drag_torque_Nm});
}

}  // namespace heatsoak::calibration
