// JSON of values without a stated tolerance.
#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "motor/motor.h"

namespace heatsoak {

/// Returns [{"motor","key","origin","low_ratio","high_ratio"}]: bounds of the assumed range as ratios to the value.
nlohmann::ordered_json default_spreads_json(std::span<const Motor> motors);

}  // namespace heatsoak
