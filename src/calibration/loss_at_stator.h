// Loss at the stator for models whose total loss is measured as input power minus shaft power.
#pragma once

#include <string_view>

#include "thermal/network.h"

namespace heatsoak::calibration {

/// Name of its drag torque among the network's parameters.
inline constexpr std::string_view kDragAtStator = "loss_at_stator.drag_torque";

/// Adds an effect that moves the no-load loss from the winding to the stator. An input_power_loss puts all loss into the winding.
void add_loss_at_stator(thermal::Network& network, double drag_torque_Nm);

}  // namespace heatsoak::calibration
