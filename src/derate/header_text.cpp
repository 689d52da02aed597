#include "derate/header_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <system_error>
#include <utility>

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

/// Tokens up to a semicolon or a brace, or those of a line of the preprocessor. Statements do not depend on line breaks.
using Statement = std::span<const Token>;

std::vector<Statement> statements(std::string_view text, const std::vector<Token>& all) {
  std::vector<Statement> found;
  for (std::size_t begin = 0; begin < all.size();) {
    std::size_t end = begin;
    if (all[begin].text == "#") {
      const std::size_t line_end = std::min(text.find('\n', all[begin].place), text.size());
      while (end < all.size() && all[end].place < line_end) {
        ++end;
      }
    } else {
      while (end < all.size() && all[end].text != ";" && all[end].text != "{" && all[end].text != "}" && all[end].text != "#") {
        ++end;
      }
      end += end < all.size() && all[end].text != "#" ? 1 : 0;
    }
    found.emplace_back(all.data() + begin, end - begin);
    begin = end;
  }
  return found;
}

bool same_token(const Token& one, const Token& other) { return say_the_same(one.text, other.text); }
bool same_statement(Statement one, Statement other) { return std::ranges::equal(one, other, same_token); }

/// A statement of one header without an equal one in the other; an empty one is missing.
struct Unequal {
  Statement own;
  Statement other;
  std::size_t before = 0;  ///< index of the first header's statement before which a missing one belongs
};

/// Pairs statements by their position; `first` is the index of the first one in the first header.
void pair_up(std::span<const Statement> own, std::span<const Statement> other, std::size_t first, std::vector<Unequal>& found) {
  for (std::size_t i = 0; i < std::max(own.size(), other.size()); ++i) {
    found.push_back({i < own.size() ? own[i] : Statement(), i < other.size() ? other[i] : Statement(), first + std::min(i, own.size())});
  }
}

/// Lengths of the longest common subsequences of all pairs of ends (Wagner and Fischer 1974).
std::vector<int> common_lengths(std::span<const Statement> own, std::span<const Statement> other) {
  const std::size_t columns = other.size() + 1;
  std::vector<int> common((own.size() + 1) * columns, 0);
  for (std::size_t i = own.size(); i-- > 0;) {
    for (std::size_t k = other.size(); k-- > 0;) {
      common[i * columns + k] = same_statement(own[i], other[k]) ? common[(i + 1) * columns + k + 1] + 1
                                                                 : std::max(common[(i + 1) * columns + k], common[i * columns + k + 1]);
    }
  }
  return common;
}

/// Returns the statements outside of a longest common subsequence. Pairs them by position if there are too many.
std::vector<Unequal> unequal(std::span<const Statement> own, std::span<const Statement> other) {
  constexpr std::size_t kMostCompared = 4'000'000;
  const auto [one, two] = std::ranges::mismatch(own, other, same_statement);
  const auto same_begin = static_cast<std::size_t>(one - own.begin());
  own = own.subspan(same_begin);
  other = other.subspan(same_begin);
  std::vector<Unequal> found;
  if (own.size() * other.size() > kMostCompared) {
    pair_up(own, other, same_begin, found);
    return found;
  }
  const std::vector<int> common = common_lengths(own, other);
  const std::size_t columns = other.size() + 1;
  for (std::size_t i = 0, k = 0; i < own.size() || k < other.size(); ++i, ++k) {
    const std::size_t first_i = i;
    const std::size_t first_k = k;
    while (i < own.size() && k < other.size() && !same_statement(own[i], other[k])) {
      ++(common[(i + 1) * columns + k] >= common[i * columns + k + 1] ? i : k);
    }
    if (i == own.size() || k == other.size()) {
      i = own.size();
      k = other.size();
    }
    pair_up(own.subspan(first_i, i - first_i), other.subspan(first_k, k - first_k), same_begin + first_i, found);
  }
  return found;
}

/// Returns 0 for a physical law or a limit, 2 for a constant that is derived from them, 1 for the rest.
int rank(Statement statement) {
  constexpr std::string_view kLaws[] = {"rate_K_per_s", "change"};
  constexpr std::string_view kLimits[] = {"_LIMIT_", "_AMBIENT_", "_PERIOD_", "_MOST_CURRENT_", "_MOST_SPEED_", "_TORQUE_CONSTANT_"};
  constexpr std::string_view kDerived[] = {"_STRAIGHT_BELOW_", "_RESISTANCE_", "_WINDING_PER_STATOR_", "_LIMP_", "_NO_CURRENT_SPEED_",
                                           "_REACHABLE_",      "_resting",     "_possible_",           "_table", "_SENSOR_"};
  const auto contains_any = [&](std::span<const std::string_view> words, std::size_t tokens) {
    return std::ranges::any_of(statement.first(std::min(tokens, statement.size())), [&](const Token& token) {
      return std::ranges::any_of(words, [&](std::string_view word) { return token.text.find(word) != std::string_view::npos; });
    });
  };
  constexpr std::size_t kBegin = 4;  // "# define NAME", "const float name ="
  const bool is_define = statement.size() > 1 && statement.front().text == "#";
  const bool is_law = statement.size() > 3 && (std::ranges::find(kLaws, statement.front().text) != std::end(kLaws) ||
                                               (statement.front().text == "const" && statement[2].text.ends_with("_W")));
  if (is_law || (is_define && contains_any(kLimits, kBegin) && !contains_any(kDerived, kBegin))) {
    return 0;
  }
  return contains_any(kDerived, kBegin) ? 2 : 1;
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

std::vector<HeaderDifference> differences(std::string_view header, std::string_view other) {
  const std::vector<Token> own_tokens = tokens(header);
  const std::vector<Token> other_tokens = tokens(other);
  const std::vector<Statement> own = statements(header, own_tokens);
  const std::vector<Statement> others = statements(other, other_tokens);
  std::vector<std::pair<int, HeaderDifference>> found;
  for (const Unequal& each : unequal(own, others)) {
    const auto [one, two] = std::ranges::mismatch(each.own, each.other, same_token);
    const auto place_of = [](Statement statement, Statement::iterator token) {
      return token == statement.end() ? statement.back().place : token->place;
    };
    const std::size_t place = !each.own.empty()          ? place_of(each.own, one)
                              : each.before < own.size() ? own[each.before].front().place
                                                         : header.size() - 1;
    const auto lines = std::count(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(place), '\n');
    found.emplace_back(rank(each.own.empty() ? each.other : each.own),
                       HeaderDifference{1 + static_cast<int>(lines), each.own.empty() ? "(missing)" : line_around(header, place),
                                        each.other.empty() ? "(missing)" : line_around(other, place_of(each.other, two))});
  }
  std::ranges::stable_sort(found, {}, &std::pair<int, HeaderDifference>::first);
  std::vector<HeaderDifference> all;
  std::ranges::transform(found, std::back_inserter(all), &std::pair<int, HeaderDifference>::second);
  return all;
}

}  // namespace heatsoak::derate
