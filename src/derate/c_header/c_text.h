// Small pieces of C text: literals, arrays, comments, and patterns in which words are replaced.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "derate/rate_lines.h"

namespace heatsoak::c_header {

/// Shortest decimal that reads back to the same single-precision number: "0.01f"; in parentheses if negative. A value that is not finite
/// is a bug of the caller.
std::string literal(double value);

/// "static const float name[count] = {…};" with its line break.
std::string array(std::string_view name, const std::vector<double>& values);

/// The text without line breaks and without the end of a comment.
std::string in_comment(std::string text);

std::string in_capitals(std::string name);

using Words = std::vector<std::pair<std::string, std::string>>;
/// The pattern with each first word replaced by its second, in their order.
std::string replaced(std::string_view pattern, const Words& words);

/// How the header writes the laws: an input is a field of `input`.
const LineStyle& line_style();

}  // namespace heatsoak::c_header
