#include "present/wrap.h"

#include <algorithm>

#include "base/unit_names.h"

namespace heatsoak::present {
namespace {

/// Returns the length of the first word; a number and its unit are one.
std::size_t first_word(std::string_view text) {
  std::size_t end = text.find(' ');
  while (end != std::string_view::npos && base::is_number_with_unit(text.substr(0, end), text.substr(end + 1))) {
    end = text.find(' ', end + 1);
  }
  return std::min(end, text.size());
}

}  // namespace

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string_view leading(std::string_view text, std::size_t count) {
  std::size_t end = 0;
  while (end < text.size() && (width_of(text.substr(0, end)) < count || (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)) {
    ++end;
  }
  return text.substr(0, end);
}

std::string_view trailing(std::string_view text, std::size_t count) {
  return text.substr(leading(text, width_of(text) - std::min(count, width_of(text))).size());
}

std::string wrapped(std::string_view text, std::string_view first, std::size_t width) {
  const std::string indent(width_of(first), ' ');
  std::string result;
  std::string line(first);
  bool is_begin = true;
  while (!text.empty()) {
    const std::size_t end = first_word(text);
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!is_begin && width_of(line) + 1 + width_of(word) > width) {
      result += line + "\n";
      line = indent;
      is_begin = true;
    }
    line += is_begin ? "" : " ";
    line += word;
    is_begin = false;
  }
  return result + line;
}

std::string folded(std::string_view text, std::size_t width) {
  std::string result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
    result += width_of(line) > width ? wrapped(line.substr(indent), line.substr(0, indent), width) : std::string(line);
    result += end < text.size() ? "\n" : "";
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

}  // namespace heatsoak::present
