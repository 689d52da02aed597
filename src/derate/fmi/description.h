// Generates modelDescription.xml for FMI 2.0 and 3.0.
#pragma once

#include <span>
#include <string>

#include "derate/fmi/fmu.h"

namespace heatsoak::derate {

/// `compiled` lists the names of the C source files.
std::string description_fmi2(const FmuModel& model, std::span<const std::string> compiled);
std::string description_fmi3(const FmuModel& model);
std::string build_description_fmi3(const FmuModel& model, std::span<const std::string> compiled);

}  // namespace heatsoak::derate
