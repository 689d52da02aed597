#include "derate/header_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace heatsoak::derate {
namespace {

/// Types of the arrays of a table; those of c_header_q15 are integers.
constexpr std::string_view kDeclarations[] = {"static const float ", "static const int32_t ", "static const int16_t "};

/// A word, a number or a sign, and its position in the text.
struct Token {
  std::string_view text;
  std::size_t place = 0;
};

bool is_of_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.'; }

/// True if the token begins with a digit, as "1.5f", "0x48u" and "2.5e-3f" do.
bool is_number(std::string_view text) { return std::isdigit(static_cast<unsigned char>(text.front())) != 0; }

/// Returns the value of a decimal literal with or without "f"; NaN for anything else, so that "12.4f * 8" is not read as 12.4.
double number(std::string_view text) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double value = kNone;
  const char* const end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, value);
  const bool is_whole = parsed == end || (parsed + 1 == end && *parsed == 'f');
  return error == std::errc() && is_whole ? value : kNone;
}

/// Returns the end of the token that begins at `i`. The sign of an exponent belongs to its number.
std::size_t end_of_token(std::string_view text, std::size_t i) {
  std::size_t end = i + 1;
  if (!is_of_word(text[i])) {
    return end;
  }
  const bool has_digits = is_number(text.substr(i, 1)) && text.substr(i, 2) != "0x";
  while (end < text.size() && (is_of_word(text[end]) || (has_digits && (text[end] == '-' || text[end] == '+') && text[end - 1] == 'e'))) {
    ++end;
  }
  return end;
}

/// True for "#define …VERSION …", which changes with the program, and "…_SIGNATURE …", which changes with the safety factor's last digit.
bool is_version_line(std::string_view line) {
  if (!line.starts_with("#define")) {
    return false;
  }
  line = line.substr(0, line.find('\n'));
  return line.find("VERSION") != std::string_view::npos || line.find("_SIGNATURE ") != std::string_view::npos;
}

/// Splits a header into tokens. Skips comments and version lines, and skips derating tables because compare() evaluates them.
std::vector<Token> tokens(std::string_view text) {
  std::vector<HeaderArray> arrays = header_arrays(text);
  // Keep the candidate values of inputs and the sensed observer's table: both are compared number by number.
  std::erase_if(arrays, [](const HeaderArray& each) {
    return each.name.find("_possible_") != std::string::npos || each.name.find("_sensed_") != std::string::npos;
  });
  std::vector<Token> all;
  for (std::size_t i = 0; i < text.size();) {
    const auto array = std::ranges::find(arrays, i, &HeaderArray::begin);
    if (text.substr(i, 2) == "/*") {
      const std::size_t end = text.find("*/", i + 2);
      i = end == std::string_view::npos ? text.size() : end + 2;
    } else if (text.substr(i, 2) == "//" || is_version_line(text.substr(i))) {
      i = std::min(text.find('\n', i), text.size());
    } else if (array != arrays.end()) {
      i = array->end;
    } else if (std::isspace(static_cast<unsigned char>(text[i])) != 0) {
      ++i;
    } else {
      const std::size_t end = end_of_token(text, i);
      all.push_back({text.substr(i, end - i), i});
      i = end;
    }
  }
  return all;
}

bool say_the_same(std::string_view one, std::string_view other) {
  constexpr double kSame_share = 1e-4;
  if (one == other) {
    return true;
  }
  // An include guard contains a checksum of the header's inputs.
  const auto is_guard = [](std::string_view text) { return text.starts_with("HEATSOAK_") && text.ends_with("_H"); };
  if (is_guard(one) && is_guard(other)) {
    return true;
  }
  if (!is_number(one) || !is_number(other)) {
    return false;
  }
  const double a = number(one);
  const double b = number(other);
  return std::abs(a - b) <= kSame_share * std::max(std::abs(a), std::abs(b));
}

/// Returns the values between commas.
std::vector<double> cells(std::string_view text) {
  std::vector<double> values;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = std::min(text.find(',', i), text.size());
    std::string_view cell = text.substr(i, end - i);
    cell.remove_prefix(std::min(cell.find_first_not_of(" \t\r\n"), cell.size()));
    cell.remove_suffix(cell.size() - std::min(cell.find_last_not_of(" \t\r\n") + 1, cell.size()));
    if (!cell.empty()) {
      values.push_back(number(cell));
    }
    i = end + 1;
  }
  return values;
}

std::string line_around(std::string_view text, std::size_t place) {
  const std::size_t before = text.rfind('\n', place);
  const std::size_t begin = before == std::string_view::npos || place == 0 ? 0 : before + 1;
  std::string_view line = text.substr(begin, std::min(text.find('\n', place), text.size()) - begin);
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  constexpr std::size_t kLongest = 100;
  return line.size() > kLongest ? fmt::format("{} …", line.substr(0, kLongest)) : std::string(line);
}

}  // namespace

std::vector<HeaderArray> header_arrays(std::string_view text) {
  std::vector<HeaderArray> all;
  for (const std::string_view declaration : kDeclarations) {
    for (std::size_t at = text.find(declaration); at != std::string_view::npos; at = text.find(declaration, at + 1)) {
      const std::size_t name = at + declaration.size();
      const std::size_t bracket = text.find('[', name);
      const std::size_t open = text.find('{', name);
      const std::size_t close = text.find("};", name);
      if (bracket < open && open < close && close != std::string_view::npos) {
        all.push_back({std::string(text.substr(name, bracket - name)), cells(text.substr(open + 1, close - open - 1)), at, close + 2});
      }
    }
  }
  return all;
}

HeaderDifference first_difference(std::string_view header, std::string_view other) {
  const std::vector<Token> own = tokens(header);
  const std::vector<Token> others = tokens(other);
  const auto [one, two] = std::ranges::mismatch(own, others, [](const Token& a, const Token& b) { return say_the_same(a.text, b.text); });
  if (one == own.end() && two == others.end()) {
    return {};
  }
  const std::size_t place = one == own.end() ? header.size() - 1 : one->place;
  const auto lines = std::count(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(place), '\n');
  return {1 + static_cast<int>(lines), line_around(header, place),
          two == others.end() ? std::string("(the fresh header ends here)") : line_around(other, two->place)};
}

}  // namespace heatsoak::derate
