#include "input/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace heatsoak::input {
namespace {

constexpr std::string_view kOpening = "\"\"\"\\";
constexpr std::string_view kClosing = "\"\"\"";

/// Positions of a string with its quotes, or of an array with its brackets.
struct Place {
  std::size_t begin = 0;
  std::size_t end = 0;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// Returns the position after the string that starts at the quote `begin`.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  std::size_t at = begin + 1;
  while (at < text.size() && text[at] != text[begin]) {
    at += text[at] == '\\' && text[begin] == '"' ? 2 : 1;
  }
  return std::min(at + 1, text.size());
}

/// True if a multi-line string keeps the value: its spaces at the beginning would be trimmed.
bool is_breakable(std::string_view text, const Place& place) {
  const std::string_view content = text.substr(place.begin + 1, place.size() - 2);
  return text[place.begin] == '"' && content.size() > 20 && !content.starts_with(' ') && content.find(' ') != std::string_view::npos;
}

/// Breaks one line.
class BrokenLine {
 public:
  explicit BrokenLine(std::string_view line) : indent_(line.substr(0, line.find_first_not_of(' '))) {
    const std::size_t value = line.find(" = [");
    if (line.size() > kLongestTomlLine && value < line.find('"')) {
      add_array(line, {value + 3, end_of_array(line, value + 3)}, 0);
    } else {
      add(line, 0);
    }
  }
  [[nodiscard]] const std::string& text() const { return out_; }

 private:
  [[nodiscard]] std::size_t column() const { return out_.size() - (out_.rfind('\n') + 1); }

  /// Adds a part of the line; breaks it unless it and `room` more bytes fit in the present line.
  void add(std::string_view part, std::size_t room) {
    if (column() + part.size() + room <= kLongestTomlLine) {
      out_ += part;
      return;
    }
    std::optional<Place> longest;
    std::optional<Place> array;
    for (std::size_t at = 0; at < part.size() && part[at] != '#';) {
      if (part[at] == '"' || part[at] == '\'') {
        const Place string{at, end_of_string(part, at)};
        longest = is_breakable(part, string) && (!longest || string.size() > longest->size()) ? string : longest;
        at = string.end;
        continue;
      }
      if (const std::size_t end = end_of_array(part, at); part[at] == '[' && (!array || end - at > array->size())) {
        array = Place{at, end};
      }
      ++at;
    }
    if (longest) {
      add(part.substr(0, longest->begin), kOpening.size());
      add_string(part.substr(longest->begin + 1, longest->size() - 2));
      add(part.substr(longest->end), room);
    } else if (array) {
      add_array(part, *array, room);
    } else {
      out_ += part;
    }
  }

  /// Adds the content of a basic string as a multi-line string.
  void add_string(std::string_view content) {
    constexpr std::size_t kWidth = 118;
    out_ += kOpening;
    while (!content.empty()) {
      out_ += '\n' + indent_ + "  ";
      std::size_t end = 0;
      // A line must not begin with a space, because the backslash before it trims spaces.
      for (std::size_t at = 0; at + 1 < content.size(); ++at) {
        const bool is_break = content[at] == ' ' && content[at + 1] != ' ';
        if (is_break && end > 0 && column() + at > kWidth) {
          break;
        }
        end = is_break ? at + 1 : end;
      }
      end = end == 0 || column() + content.size() <= kWidth ? content.size() : end;
      out_ += content.substr(0, end);
      content.remove_prefix(end);
      out_ += content.empty() ? "" : "\\";
    }
    out_ += kClosing;
  }

  /// Returns the position after the bracket that closes an array.
  static std::size_t end_of_array(std::string_view text, std::size_t begin) {
    int depth = 0;
    for (std::size_t at = begin; at < text.size();) {
      if (text[at] == '"' || text[at] == '\'') {
        at = end_of_string(text, at);
        continue;
      }
      depth += text[at] == '[' ? 1 : text[at] == ']' ? -1 : 0;
      ++at;
      if (depth == 0) {
        return at;
      }
    }
    return text.size();
  }

  /// Adds a part of the line, with new lines between elements of its array.
  void add_array(std::string_view part, const Place& array, std::size_t room) {
    out_ += part.substr(0, array.begin + 1);
    const std::size_t rest = part.size() - array.begin + room;
    if (column() + rest > kLongestTomlLine && indent_.size() + 2 + array.size() <= kLongestTomlLine) {
      out_ += '\n' + indent_ + "  ";
    }
    for (std::size_t begin = array.begin + 1; begin + 1 < array.end;) {
      std::size_t end = begin;
      while (end + 1 < array.end && part[end] != ',') {
        end = part[end] == '"' || part[end] == '\'' ? end_of_string(part, end) : part[end] == '[' ? end_of_array(part, end) : end + 1;
      }
      end += end + 1 < array.end ? 1 : 0;  // the comma
      const std::string_view element = part.substr(begin, end - begin);
      if (column() + element.size() + 1 > kLongestTomlLine) {
        out_ += '\n' + indent_ + "  ";
        add(element.substr(std::min(element.find_first_not_of(' '), element.size())), 1);
      } else {
        out_ += element;
      }
      begin = end;
    }
    add(part.substr(array.end - 1), room);
  }

  std::string indent_;
  std::string out_;
};

}  // namespace

std::string toml_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string with_short_lines(std::string_view toml) {
  std::string text;
  bool is_in_long_string = false;
  for (std::size_t begin = 0; begin < toml.size();) {
    const std::size_t end = std::min(toml.find('\n', begin), toml.size());
    const std::string_view line = toml.substr(begin, end - begin);
    int quotes = 0;
    for (std::size_t at = line.find(kClosing); at != std::string_view::npos; at = line.find(kClosing, at + kClosing.size())) {
      ++quotes;
    }
    text += is_in_long_string || quotes > 0 ? std::string(line) : BrokenLine(line).text();
    text += end < toml.size() ? "\n" : "";
    is_in_long_string = is_in_long_string != (quotes % 2 == 1);
    begin = end + 1;
  }
  return text;
}

}  // namespace heatsoak::input
