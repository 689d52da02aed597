// Reads a motor file and collects its problems instead of throwing.
#pragma once

#include <filesystem>

#include "base/diagnostic.h"
#include "motor/motor.h"

namespace heatsoak::motor {

/// Like read_motor(path), but adds the problems to `diagnostics`, so that the caller can look for more. `parameters` contains
/// the values that could be read; `nominal` must not be used if a required one is missing. Throws Failure (bad_input) if the file is not
/// valid TOML.
Motor read_motor(const std::filesystem::path& path, base::Diagnostics& diagnostics);

}  // namespace heatsoak::motor
