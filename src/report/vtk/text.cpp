#include "report/vtk/text.h"

#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include <cstddef>
#include <string_view>

#include "base/unit_names.h"

namespace heatsoak::report {
namespace {

/// Returns the length of the valid UTF-8 sequence at `at`; 0 if it is invalid.
std::size_t sequence_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned lead = byte(at);
  const std::size_t length = lead < 0x80                   ? 1
                             : lead >= 0xC2 && lead < 0xE0 ? 2
                             : (lead & 0xF0) == 0xE0       ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xC0) != 0x80) {
      return 0;
    }
  }
  const unsigned second = byte(at + 1);
  const bool is_overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool is_surrogate_or_beyond = (lead == 0xED && second >= 0xA0) || (lead == 0xF4 && second >= 0x90);
  const bool is_noncharacter = lead == 0xEF && second == 0xBF && byte(at + 2) >= 0xBE;
  return is_overlong || is_surrogate_or_beyond || is_noncharacter ? 0 : length;
}

void trim_end(std::string& line) {
  while (!line.empty() && line.back() == ' ') {
    line.pop_back();
  }
}

}  // namespace

std::string printable(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = sequence_length(text, at);
    const bool is_control = static_cast<unsigned char>(text[at]) < 0x20;
    result += length == 0 ? "\uFFFD" : is_control ? " " : text.substr(at, length);
    at += length == 0 ? 1 : length;
  }
  return result;
}

double text_width_px(const std::string& text, const TextStyle& style) {
  // VTK measures with its built-in Arial; DejaVu Sans, a common default, is wider.
  const double widest_font = style.is_bold ? 1.18 : 1.12;
  vtkNew<vtkTextProperty> property;
  property->SetFontFamilyToArial();
  property->SetFontSize(style.size_px);
  property->SetBold(style.is_bold);
  vtkTextRenderer::Metrics metrics;
  constexpr int kOnePointPerPixel_dpi = 72;
  vtkTextRenderer::GetInstance()->GetMetrics(property, vtkStdString(text), metrics, kOnePointPerPixel_dpi, vtkTextRenderer::FreeType);
  return widest_font * (metrics.BoundingBox[1] - metrics.BoundingBox[0] + 1);
}

std::vector<std::string> wrapped(const std::string& text, const TextStyle& style, double width_px) {
  std::vector<std::string> lines;
  std::string line;
  // Bytes of `line` after which it may be broken; 0: none. A name is broken only if it is longer than a line.
  std::size_t after_space = 0;
  std::size_t after_underscore = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::string character = text.substr(at, sequence_length(text, at));
    at += character.size();
    if (character != " " && !line.empty() && text_width_px(line + character, style) > width_px) {
      const std::size_t breakable = after_space > 0 ? after_space : after_underscore;
      std::string rest = line.substr(breakable == 0 ? line.size() : breakable);
      line.resize(line.size() - rest.size());
      trim_end(line);
      lines.push_back(line);
      line = std::move(rest);
      const std::size_t underscore = line.rfind('_');
      after_underscore = underscore == std::string::npos ? 0 : underscore + 1;
      after_space = 0;
    }
    line += character;
    const bool is_place =
        character == " " && !base::is_number_with_unit(std::string_view(text).substr(0, at - 1), std::string_view(text).substr(at));
    after_space = is_place ? line.size() : after_space;
    after_underscore = character == "_" ? line.size() : after_underscore;
  }
  trim_end(line);
  if (!line.empty()) {
    lines.push_back(line);
  }
  return lines;
}

}  // namespace heatsoak::report
