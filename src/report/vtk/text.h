// How wide words are and where they may be broken.
#pragma once

#include <string>
#include <vector>

namespace heatsoak {

struct TextStyle {
  int size_px = 12;
  bool is_bold = false;
  unsigned char color[3] = {0x22, 0x22, 0x22};
};

/// Valid UTF-8 in one line: what XML cannot hold is replaced, whatever the names of files contain.
std::string printable(const std::string& text);

/// Generous, because the reader's sans-serif font is not known here and may be a wide one.
double text_width_px(const std::string& text, const TextStyle& style);

/// Lines no wider than `width_px`, broken after a space or `_`, else anywhere. No text, no line.
std::vector<std::string> wrapped(const std::string& text, const TextStyle& style, double width_px);

}  // namespace heatsoak
