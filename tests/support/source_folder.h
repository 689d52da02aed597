// Location of the tested checkout.
#pragma once

#include <filesystem>

namespace heatsoak {

inline const std::filesystem::path kSource = HEATSOAK_SOURCE_DIR;

}  // namespace heatsoak
