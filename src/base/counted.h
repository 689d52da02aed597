// Counts with their nouns in texts for the user.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace heatsoak::base {

/// Formats a count with its noun: "1 file", "2 files".
std::string counted(std::size_t count, std::string_view what);

}  // namespace heatsoak::base
