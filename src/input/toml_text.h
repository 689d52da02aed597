// Text as TOML.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace heatsoak::input {

/// Largest number of bytes per line in motor and robot files that this program writes.
inline constexpr std::size_t kLongestTomlLine = 160;

/// Quotes a text as a TOML basic string.
std::string toml_text(std::string_view text);

/// Breaks lines of more than kLongestTomlLine bytes: arrays between their elements, strings at spaces, as multi-line strings. The values
/// stay the same. Lines with multi-line strings, comments and words that are too long stay as they are.
std::string with_short_lines(std::string_view toml);

}  // namespace heatsoak::input
