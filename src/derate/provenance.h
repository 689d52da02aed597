// Records the program and the inputs that an exported file was made from.
#pragma once

#include <string>
#include <string_view>

#include "motor/motor.h"
#include "robot/robot.h"

namespace heatsoak::derate {

struct DerateOptions;

/// Check sum that identifies inputs: CRC-64/XZ (ECMA-182 polynomial, reflected), 16 hexadecimal digits.
inline constexpr std::string_view kInputHash = "CRC-64/XZ";
/// Returns the check sum of the bytes.
std::string input_hash(std::string_view bytes);

/// Origin of an exported file.
struct Provenance {
  std::string program_version;  ///< "heatsoak 0.1.0"
  std::string input_hash;       ///< kInputHash over the texts of both files and the options
};

/// Returns the options as the command line that gives them, with `approach_s` for an approach that the options leave open.
std::string options_text(const DerateOptions& options, double approach_s);

/// Reads the files of robot and motor again to compute their hash. Throws Failure (bad_input) if one cannot be read.
Provenance provenance_of(const motor::Motor& motor, const robot::Robot& robot, const DerateOptions& options);

}  // namespace heatsoak::derate
