// Compares the lasting current of a derating with the current that the motor needs to turn itself.
#pragma once

#include <optional>

#include "derate/derating.h"

namespace heatsoak::derate {

/// A continuous use, in which the motor turns without a load.
struct OwnFriction {
  double needed_A = 0.0;         ///< no-load current: friction and iron loss per torque constant, at every speed above 0
  double speed_rad_per_s = 0.0;  ///< no-load speed on a full battery, or the fastest continuous use if that is slower
  double lasting_A = 0.0;        ///< lasting current at that speed, in the worst hot case
  double at_standstill_A = 0.0;  ///< lasting current at standstill, in the worst hot case
  double held_rad_per_s = 0.0;   ///< highest speed up to which the lasting current is at least `needed_A`; 0 if there is none

  [[nodiscard]] bool holds() const { return lasting_A >= needed_A; }
};

/// Returns the comparison, or nothing if the derating has no continuous uses. Between the speeds of the uses the square of the lasting
/// current is linear in the speed, which is exact for the network of a data sheet.
std::optional<OwnFriction> own_friction(const Derating& derating);

/// Throws Failure (limit_exceeded) if the motor cannot turn itself continuously at the speed that a full battery reaches. An unloaded wheel
/// reaches this speed in any duty. At higher speeds something else turns the motor, so no current is required there.
void require_own_friction(const Derating& derating);

}  // namespace heatsoak::derate
