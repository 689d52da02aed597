// The text of a generated C header: its arrays, and whether another header says the same.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak {

/// `static const float name[count] = {…};`
struct HeaderArray {
  std::string name;
  std::vector<double> values;  ///< one that cannot be read is NaN
  std::size_t begin = 0;       ///< of the declaration in the text
  std::size_t end = 0;
};
std::vector<HeaderArray> header_arrays(std::string_view text);

struct HeaderDifference {
  int line = 0;            ///< of the first header, from 1; 0 where both say the same
  std::string text;        ///< of that line
  std::string other_text;  ///< of the other header at the same place
};

/// The first word in which two headers differ, outside of comments, of the derating table and of the include guard. Numbers
/// are the same where they agree to 1 in 10⁴.
HeaderDifference first_difference(std::string_view header, std::string_view other);

}  // namespace heatsoak
