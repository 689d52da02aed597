// The shipped logs of a motor on a chassis that soaks, and the motor that they are tried on.
#pragma once

#include <filesystem>
#include <string>

#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {

inline const std::filesystem::path kSoak = kSource / "reports/soak";
inline constexpr const char* kMotor = "maxon_ec45_flat_70w_24v";

/// One of the shipped logs.
inline std::string log(const std::string& name) { return (kSoak / name).string(); }

/// Runs the program in the folder.
inline RunOptions in(const TemporaryFolder& folder) {
  RunOptions options;
  options.folder = folder.path();
  return options;
}

}  // namespace heatsoak
