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

/// A statement in which two headers differ.
struct HeaderDifference {
  int line = 0;            ///< line of the first different token in the first header, from 1
  std::string text;        ///< text of that line, shortened to 100 bytes
  std::string other_text;  ///< line of the other header at the same place
};

/// Returns the statements in which two headers differ: physical laws and limits first, then the others, and last the constants that are
/// derived from them; each group in the order of the header. Ignores comments, line breaks, derating tables, versions, signatures and
/// include guards. Numbers that agree to 1 in 10⁴ are equal.
std::vector<HeaderDifference> differences(std::string_view header, std::string_view other);

}  // namespace heatsoak::derate
