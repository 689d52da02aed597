// Longest line of a text.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace heatsoak {

/// Returns the number of bytes of the longest line.
inline std::size_t longest_line(std::string_view text) {
  std::size_t longest = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    longest = std::max(longest, end - begin);
    begin = end + 1;
  }
  return longest;
}

}  // namespace heatsoak
