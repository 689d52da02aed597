// Motor files whose thermal values were fitted to heat from measured power.
#pragma once

#include <optional>

#include "motor/motor.h"

namespace heatsoak::motor {

/// Returns the heat input of the fitted runs if it is from measured power, which no duty states and no firmware measures.
inline std::optional<HeatInput> measured_power(const Motor& motor) {
  const std::optional<HeatInput> heat = motor.fit ? motor.fit->heat_input : std::nullopt;
  return heat == HeatInput::input_power || heat == HeatInput::power_balance ? heat : std::nullopt;
}

}  // namespace heatsoak::motor
