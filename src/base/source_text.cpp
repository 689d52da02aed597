#include "base/source_text.h"

#include <algorithm>
#include <cctype>

namespace heatsoak::base {
namespace {

bool is_of_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '\''; }

/// Returns whether the apostrophe at `place` separates digits, as in 1'000 or 0xFF'FF.
bool is_digit_separator(std::string_view source, std::size_t place) {
  std::size_t begin = place;
  while (begin > 0 && is_of_word(source[begin - 1])) {
    --begin;
  }
  return begin < place && std::isdigit(static_cast<unsigned char>(source[begin])) != 0;
}

/// Returns the place after the literal that begins at `begin`.
std::size_t end_of_literal(std::string_view source, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < source.size() && source[end] != source[begin]) {
    end += source[end] == '\\' ? 2 : 1;
  }
  return std::min(end + 1, source.size());
}

std::string without_empty_lines(std::string_view text) {
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
    if (!line.empty()) {
      result.append(line).append("\n");
    }
    begin = end + 1;
  }
  return result;
}

}  // namespace

std::string without_comments(std::string_view source) {
  std::string text;
  for (std::size_t i = 0; i < source.size();) {
    const std::string_view next = source.substr(i, 2);
    if (next == "//") {
      i = std::min(source.find('\n', i), source.size());
    } else if (next == "/*") {
      const std::size_t end = source.find("*/", i + 2);
      i = end == std::string_view::npos ? source.size() : end + 2;
      text += ' ';
    } else {
      const bool is_literal = source[i] == '"' || (source[i] == '\'' && !is_digit_separator(source, i));
      const std::size_t end = is_literal ? end_of_literal(source, i) : i + 1;
      text.append(source.substr(i, end - i));
      i = end;
    }
  }
  return without_empty_lines(text);
}

}  // namespace heatsoak::base
