// Notes in answers about values without a stated tolerance.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "motor/motor.h"

namespace heatsoak {

/// Returns a line for each motor with a value that got a default spread; empty if there is none.
std::string default_spreads_text(std::span<const Motor> motors);

/// Returns [{"motor","key","origin","low_ratio","high_ratio"}]: bounds of the assumed range as ratios to the value.
nlohmann::ordered_json default_spreads_json(std::span<const Motor> motors);

}  // namespace heatsoak
