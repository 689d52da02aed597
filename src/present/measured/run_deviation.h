// Document and JSON of `describe` for deviations of single runs.
#pragma once

#include <string>

#include "estimation/run_deviation.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

Document run_deviation_description(const estimation::RunDeviationType& type);
Json run_deviation_json(const estimation::RunDeviationType& type);

/// Formats the typical size with its unit.
std::string typical_size(const estimation::RunDeviationType& type);

/// States at which node and in which runs the deviation acts.
std::string place_of(const estimation::RunDeviationType& type);

}  // namespace heatsoak::present
