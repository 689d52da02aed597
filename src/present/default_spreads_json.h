// JSON of values without a stated tolerance.
#pragma once

#include <span>

#include "motor/motor.h"
#include "present/json.h"

namespace heatsoak::present {

/// Returns [{"motor","key","origin","low_ratio","high_ratio"}]: bounds of the assumed range as ratios to the value.
Json default_spreads_json(std::span<const motor::Motor> motors);

}  // namespace heatsoak::present
