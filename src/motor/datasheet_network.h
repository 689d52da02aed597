// From the figures of a data sheet to the thermal network.
#pragma once

#include <array>
#include <string_view>

#include "motor/motor.h"
#include "thermal/network.h"

namespace heatsoak {

/// The states of every motor's network; nodes of its own effects follow.
namespace states {
enum State : int { winding, stator, first_own };
}  // namespace states

/// Names of the effects that every datasheet network has.
inline constexpr std::array<std::string_view, 4> kDatasheetEffects{"copper_loss", "no_load_loss", "winding_stator", "stator_ambient"};

/// Whether the figures of every motor already stand for the losses of this type: another such effect is added to them.
bool is_loss_of_every_motor(const EffectType& type);

/// Winding and stator with C_w = τ_w/R_th1 and C_s = τ_m/R_th2 (the time constants of a sheet are C·R of one
/// element, not eigenvalues of the network), copper loss in the winding, K_t·I_0·|ω| at the stator, two thermal
/// resistances, and the effects that the file adds. The order of nodes and effects is the same for every sample.
Network datasheet_network(const Motor& motor, const MotorSample& sample);

/// Torque that the motor loses inside while it turns: K_t·I_0.
double drag_torque_Nm(const MotorValues& motor);

}  // namespace heatsoak
