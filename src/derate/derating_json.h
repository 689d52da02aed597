// The derating as JSON, for the exporter of that name and for the answer of `derate --json`.
#pragma once

#include <nlohmann/json.hpp>

#include "derate/derating.h"

namespace heatsoak {

/// Schema heatsoak.derating/1. The observer's parameters stand in it where they have a closed form, which is the data sheet's network
/// without own effects; else null.
nlohmann::ordered_json derating_json(const Derating& derating);

}  // namespace heatsoak
