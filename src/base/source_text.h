// Text of C and C++ sources without what the compiler ignores.
#pragma once

#include <string>
#include <string_view>

namespace heatsoak::base {

/// Returns the source without comments, spaces at the end of lines and empty lines. Knows string and character literals and the digit
/// separator of C++; raw strings are not supported.
std::string without_comments(std::string_view source);

}  // namespace heatsoak::base
