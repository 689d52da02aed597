// The derating as JSON, for the exporter `json` and for `derate --json`.
#pragma once

#include <nlohmann/json.hpp>

#include "derate/derating.h"

namespace heatsoak::derate {

/// Returns the derating in schema heatsoak.derating/2. The entry "observer" holds equations and parameters if the network is that of the
/// data sheet without effects of the motor's own, else null. The answer of the command adds "version", "notes" and "warnings".
nlohmann::ordered_json derating_json(const Derating& derating);

}  // namespace heatsoak::derate
