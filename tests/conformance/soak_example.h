// The shipped logs of a motor on a chassis that soaks, and the motor that they are tried on.
#pragma once

#include <filesystem>

#include "support/source_folder.h"

namespace heatsoak {

inline const std::filesystem::path kSoak = kSource / "reports/soak";
inline constexpr const char* kMotor = "maxon_ec45_flat_70w_24v";

}  // namespace heatsoak
