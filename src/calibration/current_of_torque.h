// Copper loss by which a log's torque heats the winding more or less if the drag differs from that of the motor file.
#pragma once

#include "thermal/network.h"

namespace heatsoak::calibration {

/// Adds the loss to a motor's network whose current is that for shaft torque and drag. Rows are read with the drag of the motor file
/// (`drag_torque_Nm`, `torque_constant_Nm_per_A` > 0); the network's own drag may be another, as in a fit of the no-load current. Without
/// this, a fit would change the drag but keep the current that follows from it. The network must have copper_loss and no_load_loss.
void add_current_of_torque(thermal::Network& network, double drag_torque_Nm, double torque_constant_Nm_per_A);

}  // namespace heatsoak::calibration
