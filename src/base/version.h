// The program's version, written to answers and generated files.
#pragma once

#include <string_view>

namespace heatsoak::base {

/// Returns the version, "0.1.0"; set by the project() line of CMakeLists.txt.
std::string_view program_version();

}  // namespace heatsoak::base
