#include "derate/c_header/c_text.h"

#include <embedded/shared_c_text.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <span>

#include "base/unit_names.h"

namespace heatsoak::derate::c_header {

namespace {

std::string bare_literal(double value) {
  const std::string text = fmt::format("{}", static_cast<float>(value));
  return text + (text.find_first_of(".e") == std::string::npos ? ".0f" : "f");
}

constexpr std::size_t kLongestLine = 140;

/// Returns the last place where a comment line may be broken, the beginning of the rest; npos if there is none after `first`.
std::size_t break_of_comment(std::string_view line, std::size_t first) {
  std::size_t last = line.rfind(' ', kLongestLine);
  while (last != std::string_view::npos && last > first && base::is_number_with_unit(line.substr(0, last), line.substr(last + 1))) {
    last = line.rfind(' ', last - 1);
  }
  return last == std::string_view::npos || last <= first ? std::string_view::npos : last + 1;
}

/// Returns where a code line may be broken: late, but outside of parentheses if possible.
std::size_t break_of_code(std::string_view line, std::size_t first) {
  constexpr std::string_view kEnds[] = {", ", " && ", " || ", " + ", " * ", " < ", " <= ", " == ", "{ "};
  constexpr std::string_view kBegins[] = {" ? ", " : ", " /* "};
  constexpr int kPerDepth = 60;
  std::size_t best = std::string_view::npos;
  int best_cost = std::numeric_limits<int>::max();
  int depth = 0;
  for (std::size_t i = 0; i < kLongestLine && i + 1 < line.size(); ++i) {
    depth += line[i] == '(' ? 1 : line[i] == ')' ? -1 : 0;
    const std::string_view done = line.substr(0, i + 1);
    const bool is_place = std::ranges::any_of(kEnds, [&](std::string_view each) { return done.ends_with(each); }) ||
                          std::ranges::any_of(kBegins, [&](std::string_view each) { return line.substr(i).starts_with(each); });
    const int cost = kPerDepth * depth - static_cast<int>(i);
    if (i > first && is_place && cost <= best_cost) {
      best_cost = cost;
      best = i + 1;
    }
  }
  return best;
}

/// Returns where the comment at the end of a line begins; npos if code follows its last comment.
std::size_t comment_at_end(std::string_view line) {
  const std::size_t opened = line.rfind("/*");
  const std::size_t closed = line.rfind("*/");
  const bool is_inside = closed != std::string_view::npos && closed + 2 < line.size();
  return opened != std::string_view::npos && (!is_inside || closed < opened) ? opened : std::string_view::npos;
}

/// Breaks one line. `is_comment`: it begins inside of a comment.
std::string wrapped_line(std::string_view line, bool is_comment) {
  if (line.size() <= kLongestLine || line.starts_with('#')) {
    return fmt::format("{}\n", line);
  }
  constexpr std::size_t kLatestComment = 90;  // a comment behind code is continued in its column if it begins before this one
  const std::size_t indent = line.find_first_not_of(' ');
  const std::size_t opened = is_comment ? indent : comment_at_end(line);
  const bool has_stars = is_comment && line.substr(indent).starts_with("* ");
  const bool continues_comment = opened <= kLatestComment;
  // The rest must be shorter than the line, although it gets an indent of its own.
  const std::size_t place = continues_comment ? break_of_comment(line, opened + 8) : break_of_code(line, indent + 8);
  if (place == std::string_view::npos) {
    return fmt::format("{}\n", line);
  }
  const std::string next(continues_comment ? opened + (is_comment ? 0 : 3) : indent + 4, ' ');
  const std::string rest = fmt::format("{}{}{}", next, has_stars ? "* " : "", line.substr(place));
  return fmt::format("{}\n", line.substr(0, line.find_last_not_of(' ', place - 1) + 1)) + wrapped_line(rest, continues_comment);
}

}  // namespace

std::string wrapped(std::string_view text) {
  std::string result;
  bool is_comment = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    result += wrapped_line(line, is_comment);
    const std::size_t opened = line.rfind("/*");
    const std::size_t closed = line.rfind("*/");
    if (opened != std::string_view::npos || closed != std::string_view::npos) {
      is_comment = closed == std::string_view::npos || (opened != std::string_view::npos && opened > closed);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

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

std::string shared_text(std::string_view file) {
  // The empty line after the include goes with it.
  constexpr std::string_view kInclude = "#include <stdint.h>\n";
  const std::span<const embedded::Text> all = embedded::shared_c_text();
  std::string text(std::ranges::find_if(all, [file](const embedded::Text& each) { return each.path.ends_with(file); })->text);
  const std::size_t at = text.find(kInclude);
  const bool is_alone = text.compare(at - 2, 2, "\n\n") == 0 && text[at + kInclude.size()] == '\n';
  return text.erase(at, kInclude.size() + (is_alone ? 1 : 0));
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
