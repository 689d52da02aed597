// Builds the thermal network of a motor from its data sheet values.
#pragma once

#include <array>
#include <string_view>

#include "motor/motor.h"
#include "thermal/network.h"

namespace heatsoak::motor {

/// State nodes of every motor's network; nodes added by its effects follow.
namespace states {
enum State : int {
  winding,
  stator,
  first_own  ///< first node that an effect of the motor's file adds
};
}  // namespace states

/// Names of the effects in every data sheet network.
inline constexpr std::array<std::string_view, 4> kDatasheetEffects{"copper_loss", "no_load_loss", "winding_stator", "stator_ambient"};

/// Returns whether every motor's network already contains a loss of this type; an effect of that type is added on top of it.
bool is_loss_of_every_motor(const thermal::EffectType& type);

/// Network of two state nodes, winding and stator, with C_w = τ_w/R_th1 and C_s = τ_m/R_th2. The time constants of a sheet are C·R of one
/// element, not eigenvalues of the network. Effects: copper loss in the winding, K_t·I_0·|ω| at the stator, two thermal resistances, and
/// those that the file adds. The order of nodes and effects is the same for every sample.
thermal::Network datasheet_network(const Motor& motor, const MotorSample& sample);

}  // namespace heatsoak::motor
