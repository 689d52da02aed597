// Widths and line breaks of text for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace heatsoak::present {

/// In characters of UTF-8; every character that the program prints is one column wide.
std::size_t width_of(std::string_view text);

/// The first `count` characters.
std::string_view leading(std::string_view text, std::size_t count);

/// The last `count` characters.
std::string_view trailing(std::string_view text, std::size_t count);

/// `text` in lines of at most `width` characters, broken at blanks; a longer word keeps a line of its own. `first` stands before the
/// first line and blanks of its width before the others. Ends without a line break.
std::string wrapped(std::string_view text, std::string_view first, std::size_t width);

}  // namespace heatsoak::present
