// Terminal resistance from measured voltage, current and speed.
#pragma once

#include <optional>
#include <span>

#include "calibration/findings.h"
#include "motor/motor.h"
#include "recording/recording.h"

namespace heatsoak::calibration {

/// Returns the terminal resistance at 25 °C if it differs by more than 15 % from that of the file. The law is V = R·I + K·ω with R at the
/// temperature of the winding. Empty if the logs lack a signal, or do not follow the law: means over rows with load steps do not.
std::optional<ResistanceDiffers> other_terminal_resistance(const motor::Motor& motor, std::span<const recording::Recording> recordings);

}  // namespace heatsoak::calibration
