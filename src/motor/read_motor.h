// A motor file whose problems are collected instead of thrown.
#pragma once

#include <filesystem>

#include "base/diagnostic.h"
#include "motor/motor.h"

namespace heatsoak {

/// As read_motor(path), but adds the problems to `diagnostics`, for whoever looks for more of them. Values that could not be read are NaN
/// or absent. Throws Failure (bad_input) where the file is no TOML.
Motor read_motor(const std::filesystem::path& path, Diagnostics& diagnostics);

}  // namespace heatsoak
