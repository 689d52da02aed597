// The program's version, written to answers and generated files.
#pragma once

#include <string_view>

namespace heatsoak::base {

/// Returns the version, "0.1.0+1a2b3c4d": the version of the project() line of CMakeLists.txt, and a hash of the sources that decide
/// numbers (cmake/source_hash.cmake). Two programs with the same version write the same files.
std::string_view program_version();

}  // namespace heatsoak::base
