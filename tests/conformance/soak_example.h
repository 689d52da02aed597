// The shipped logs of a motor on a chassis that absorbs heat, and the motor file for them.
#pragma once

#include <filesystem>
#include <string>

#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {

inline const std::filesystem::path kSoak = kSource / "reports/soak";
inline constexpr const char* kMotor = "maxon_ec45_flat_70w_24v";

/// Returns the path of a shipped log.
inline std::string log(const std::string& name) { return (kSoak / name).string(); }

/// Returns options that run the program in the folder.
inline RunOptions in(const TemporaryFolder& folder) {
  RunOptions options;
  options.folder = folder.path();
  return options;
}

/// The calibration of the README's example with the match that it holds out.
struct Calibrated {
  explicit Calibrated(const std::string& threads);

  std::string motor_file;  ///< text of the calibrated motor's file
  nlohmann::json answer;
};
/// Calibrates once for all tests of the process, in one thread.
const Calibrated& example_calibration();

}  // namespace heatsoak
