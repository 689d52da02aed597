#include "derate/c_header/c_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace heatsoak::derate::c_header {

namespace {

std::string bare_literal(double value) {
  const std::string text = fmt::format("{}", static_cast<float>(value));
  return text + (text.find_first_of(".e") == std::string::npos ? ".0f" : "f");
}

}  // namespace

std::string literal(double value) { return value < 0.0 ? fmt::format("({})", bare_literal(value)) : bare_literal(value); }

std::string array(std::string_view name, const std::vector<double>& values) {
  std::string text = fmt::format("static const float {}[{}] = {{", name, values.size());
  constexpr std::size_t kInLine = 10;
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += fmt::format("{}{},", i % kInLine == 0 ? "\n    " : " ", bare_literal(values[i]));
  }
  return text + "};\n";
}

std::string in_comment(std::string text) {
  for (std::size_t at = text.find("*/"); at != std::string::npos; at = text.find("*/")) {
    text.replace(at, 2, "* /");
  }
  std::ranges::replace(text, '\n', ' ');
  return text;
}

std::string in_capitals(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return name;
}

std::string replaced(std::string_view pattern, const Words& words) {
  std::string text(pattern);
  for (const auto& [word, by] : words) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size())) {
      text.replace(at, word.size(), by);
    }
  }
  return text;
}

const LineStyle& line_style() {
  static const LineStyle style{
      .literal = literal,
      .signal =
          [](observed::Signal signal) { return fmt::format("input->{}", observed::signals()[static_cast<std::size_t>(signal)].name); },
      .square_root = "heatsoak_square_root"};
  return style;
}

}  // namespace heatsoak::derate::c_header
