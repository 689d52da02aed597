// Where lost power is measured as a whole: the part of it that arises at the stator.
#pragma once

#include <string_view>

#include "thermal/network.h"

namespace heatsoak {

/// Its drag torque, as a parameter of the network.
inline constexpr std::string_view kDragAtStator = "loss_at_stator.drag_torque";

/// Moves the no-load loss from the winding, where an input_power_loss has all of it, to the stator.
void add_loss_at_stator(Network& network, double drag_torque_Nm);

}  // namespace heatsoak
