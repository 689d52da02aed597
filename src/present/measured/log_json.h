// JSON of `log`.
#pragma once

#include <string>

#include "present/json.h"
#include "recording/inspect_log.h"

namespace heatsoak::present {

/// Returns the JSON of one log, an element of the answer of `log inspect`.
Json log_json(const recording::InspectedLog& log);

/// Returns the answer of `log convert`.
Json conversion_json(const recording::ConvertedLog& log, const std::string& out);

}  // namespace heatsoak::present
