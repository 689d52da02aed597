// Helpers for C text: literals, arrays, comments and replacement of placeholders.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "derate/rate_lines.h"

namespace heatsoak::derate::c_header {

/// Returns the shortest decimal that reads back to the same single-precision number, such as "0.01f"; in parentheses if negative. The value
/// must be finite.
std::string literal(double value);

/// Returns "static const float name[count] = {…};" and a line break.
std::string array(std::string_view name, const std::vector<double>& values);

/// Returns the text without line breaks and without "*/", so that it can stand in a comment.
std::string in_comment(std::string text);

std::string in_capitals(std::string name);

using Words = std::vector<std::pair<std::string, std::string>>;
/// Replaces every first word of a pair in the pattern by the second one, pair by pair.
std::string replaced(std::string_view pattern, const Words& words);

/// Breaks lines of C text that are longer than 140 characters: comments at a space, code behind a comma or before an operator. Lines of
/// the preprocessor stay whole.
std::string wrapped(std::string_view text);

/// Returns the text of a file of robot_core that the drive core and the exported headers share, without its include of <stdint.h>, which a
/// header has at its top.
std::string shared_text(std::string_view file);

/// Syntax of the laws in the C header; an input is a field of `input`.
const LineStyle& line_style();

}  // namespace heatsoak::derate::c_header
