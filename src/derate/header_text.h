// Parser of generated C headers: reads their arrays and compares two headers.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::derate {

/// An array `static const float name[count] = {…};`, or of int32_t or int16_t.
struct HeaderArray {
  std::string name;
  std::vector<double> values;  ///< NaN for a value that cannot be read
  std::size_t begin = 0;       ///< position of the declaration in the text
  std::size_t end = 0;         ///< position after its "};"
};
/// Returns all arrays of a header.
std::vector<HeaderArray> header_arrays(std::string_view text);

/// First difference between two headers.
struct HeaderDifference {
  int line = 0;            ///< in the first header, from 1; 0 if both are equal
  std::string text;        ///< text of that line, shortened to 100 bytes
  std::string other_text;  ///< line of the other header at the same place
};

/// Returns the first token in which two headers differ. Ignores comments, derating tables, versions, signatures and include guards. Numbers
/// that agree to 1 in 10⁴ are equal.
HeaderDifference first_difference(std::string_view header, std::string_view other);

}  // namespace heatsoak::derate
