// Width and line breaks of text in a chart.
#pragma once

#include <string>
#include <vector>

namespace heatsoak::report {

struct TextStyle {
  int size_px = 12;
  bool is_bold = false;
  unsigned char color[3] = {0x22, 0x22, 0x22};
};

/// Heights of letters above and below the baseline, relative to the size of the text.
inline constexpr double kAscent_ratio = 0.85;
inline constexpr double kDescent_ratio = 0.25;

/// Returns valid UTF-8 in one line; invalid bytes, such as in file names, and control characters are replaced.
std::string printable(const std::string& text);

/// Returns a width with a safety margin, because the reader's sans-serif font is unknown and may be wider.
double text_width_px(const std::string& text, const TextStyle& style);

/// Breaks text into lines no wider than `width_px`, after a space or `_` if possible. An empty text gives no line.
std::vector<std::string> wrapped(const std::string& text, const TextStyle& style, double width_px);

}  // namespace heatsoak::report
