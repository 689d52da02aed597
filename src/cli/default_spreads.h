// What answers say of motor files that give no tolerances.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "motor/motor.h"

namespace heatsoak {

/// A line for each motor with a value that got a default spread; empty where there is none.
std::string default_spreads_text(std::span<const Motor> motors);

/// [{"motor","key","origin","low_ratio","high_ratio"}]: bounds of the assumed range per value.
nlohmann::ordered_json default_spreads_json(std::span<const Motor> motors);

}  // namespace heatsoak
