// Width and line breaks of text on a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace heatsoak::present {

/// Returns the number of UTF-8 characters; every character that the program prints is one column wide.
std::size_t width_of(std::string_view text);

/// Returns the first `count` characters.
std::string_view leading(std::string_view text, std::size_t count);

/// Returns the last `count` characters.
std::string_view trailing(std::string_view text, std::size_t count);

/// Breaks `text` at blanks into lines of at most `width` characters; a longer word gets a line of its own, and a number stays with its
/// unit. The first line starts with `first`, the others with as many blanks. No line break at the end.
std::string wrapped(std::string_view text, std::string_view first, std::size_t width);

/// Breaks the lines that are longer than `width`; the continuation is indented like its line.
std::string folded(std::string_view text, std::size_t width);

}  // namespace heatsoak::present
