#include "base/xml_text.h"

#include <algorithm>
#include <cstddef>

namespace heatsoak::base {
namespace {

/// Length in bytes of the UTF-8 character at the beginning of `text`; 0 if it is invalid or XML 1.0 does not allow it (section 2.2).
/// Precondition: `text` is not empty.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(text[i])); };
  constexpr unsigned kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const unsigned first = byte(0);
  const std::size_t length = first < 0x80 ? 1 : first < 0xC0 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF8 ? 4 : 0;
  if (length < 2 || length > text.size()) {
    return length == 1 ? 1 : 0;
  }
  unsigned code = first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) {
      return 0;
    }
    code = code << 6U | (byte(i) & 0x3FU);
  }
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code < kLeast[length] || code > 0x10FFFF || is_surrogate || code == 0xFFFE || code == 0xFFFF ? 0 : length;
}

std::string escaped(std::string_view text, std::string_view newline) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const char c = text.front();
    if (length == 0) {
      result += '?';
    } else if (c == '\n') {
      result += newline;
    } else if (length > 1 || c == '\t' || static_cast<unsigned char>(c) >= 0x20) {
      result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return result;
}

}  // namespace

std::string xml_text(std::string_view text) { return escaped(text, "\n"); }

std::string xml_attribute(std::string_view text) { return escaped(text, "&#10;"); }

}  // namespace heatsoak::base
