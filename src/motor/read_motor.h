// Reads a motor file and collects its problems instead of throwing.
#pragma once

#include <filesystem>

#include "base/diagnostic.h"
#include "motor/motor.h"

namespace heatsoak::motor {

/// Like read_motor(path), but adds the problems to `diagnostics`, so that the caller can look for more. Values that could not be read are
/// absent; required ones are kUnknown. Throws Failure (bad_input) if the file is not valid TOML.
Motor read_motor(const std::filesystem::path& path, base::Diagnostics& diagnostics);

}  // namespace heatsoak::motor
