// modelDescription.xml of both versions of FMI.
#pragma once

#include <span>
#include <string>

#include "derate/fmi/fmu.h"

namespace heatsoak {

/// `compiled`: names of the C files.
std::string description_fmi2(const FmuModel& model, std::span<const std::string> compiled);
std::string description_fmi3(const FmuModel& model);
std::string build_description_fmi3(const FmuModel& model, std::span<const std::string> compiled);

}  // namespace heatsoak
