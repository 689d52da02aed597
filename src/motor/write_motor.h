// Writes a motor as a motor file.
#pragma once

#include <string>
#include <string_view>

#include "motor/motor.h"

namespace heatsoak::motor {

/// Source of the values that a calibration writes.
inline constexpr std::string_view kCalibrationSource = "calibration";

/// Returns the comma separated ids of both lists of sources, each id once.
std::string joined_sources(std::string_view ids, std::string_view more);

/// Returns the text of a file from which read_motor() gives the same motor, in this program's conventions. Values keep the text of their
/// original file if they have one.
std::string to_toml(const Motor& motor);

}  // namespace heatsoak::motor
