#include "input/document.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

#include "base/files.h"

namespace heatsoak::input {
namespace {

constexpr std::size_t kLargestToml_bytes = 1'000'000;
constexpr std::size_t kMostKeys = 1000;  ///< per table, because looking up a key is a linear search
constexpr int kMostDots = 16;            ///< per key

/// The parser's position is 0 for nodes that stand nowhere in the text, such as the table of a dotted key.
base::Location place(const toml::source_position& at, const std::string& file) {
  if (!at) {
    return {file};
  }
  return {file, static_cast<int>(at.line), static_cast<int>(at.column)};
}

/// Returns the first line with a key of more than kMostDots dots, if there is one. toml++ limits nested values but not dotted keys: the
/// recursive destructor of a.a.a.a… would overflow the stack. Outside of strings and comments only keys and numbers have dots.
std::optional<int> line_of_deep_key(std::string_view content) {
  int line = 1;
  int dots = 0;
  for (std::size_t i = 0; i < content.size(); ++i) {
    const char c = content[i];
    if (c == '#') {
      i = std::min(content.find('\n', i), content.size()) - 1;
    } else if (c == '"' || c == '\'') {
      const std::string_view quotes = content.substr(i, 3) == std::string(3, c) ? content.substr(i, 3) : content.substr(i, 1);
      for (i += quotes.size(); i < content.size() && content.substr(i, quotes.size()) != quotes; ++i) {
        line += content[i] == '\n' ? 1 : 0;
        i += c == '"' && content[i] == '\\' ? 1 : 0;
        if (i < content.size() && content[i] == '\n' && quotes.size() == 1) {
          return std::nullopt;  // not closed; the parser reports it
        }
      }
      i += quotes.size() - 1;
    } else if (c == '.') {
      if (++dots > kMostDots) {
        return line;
      }
    } else if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos) {
      dots = 0;
      line += c == '\n' ? 1 : 0;
    }
  }
  return std::nullopt;
}

Value convert(const toml::node& node, const std::string& file) {
  Value value;
  value.at = place(node.source().begin, file);
  if (const auto* table = node.as_table()) {
    value.kind = Value::Kind::table;
    if (table->size() > kMostKeys) {
      throw base::bad_input(value.at, "", fmt::format("a table of {} keys; expected at most {}", table->size(), kMostKeys));
    }
    for (const auto& [key, member] : *table) {
      value.members.push_back({std::string(key.str()), convert(member, file)});
    }
    std::ranges::stable_sort(value.members, {},
                             [](const Member& member) { return std::pair(member.value.at.line, member.value.at.column); });
  } else if (const auto* array = node.as_array()) {
    value.kind = Value::Kind::array;
    for (const toml::node& item : *array) {
      value.items.push_back(convert(item, file));
    }
  } else if (const auto* text = node.as_string()) {
    value.kind = Value::Kind::text;
    value.text = text->get();
  } else if (const auto* flag = node.as_boolean()) {
    value.kind = Value::Kind::boolean;
    value.boolean = flag->get();
  } else if (const auto* integer = node.as_integer()) {
    value.kind = Value::Kind::number;
    value.text = fmt::format("{}", integer->get());
  } else if (const auto* number = node.as_floating_point()) {
    value.kind = Value::Kind::number;
    value.text = fmt::format("{}", number->get());
  }
  return value;
}

/// Returns the last line that begins with a key of that name, if there is one.
std::optional<int> line_of_key(const toml::table& table, std::string_view name) {
  std::optional<int> line;
  for (const auto& [key, member] : table) {
    if (key.str() == name) {
      line = std::max(line, std::optional(static_cast<int>(key.source().begin.line)));
    }
    if (const toml::table* inner = member.as_table(); inner && !inner->is_inline()) {
      line = std::max(line, line_of_key(*inner, name));
    }
  }
  return line;
}

/// Returns the message of the parser; for a key that is given twice also the line of the first one.
std::string explanation(const toml::parse_error& error, std::string_view content) {
  const std::string_view said = error.description();
  const std::size_t from = said.find('\'');
  const std::size_t to = said.rfind('\'');
  if (said.find("redefine") == std::string_view::npos || to <= from) {
    return fmt::format("not valid TOML: {}", said);
  }
  const std::string_view path = said.substr(from + 1, to - from - 1);
  std::size_t end = 0;
  for (std::size_t line = 1; line < error.source().begin.line && end < content.size(); ++line) {
    end = std::min(content.find('\n', end), content.size() - 1) + 1;
  }
  std::optional<int> first_line;
  try {
    first_line = line_of_key(toml::parse(content.substr(0, end)), path.substr(path.rfind('.') + 1));
  } catch (const toml::parse_error&) {
    // The text before the second key ends inside a table or string. The message then omits the line of the first key.
  }
  return fmt::format("not valid TOML: '{}' is given twice{}; keep one of the two", path,
                     first_line ? fmt::format(", first in line {}", *first_line) : "");
}

}  // namespace

const Value* Value::find(std::string_view key) const {
  const auto found = std::ranges::find(members, key, &Member::key);
  return found == members.end() ? nullptr : &found->value;
}

std::string_view to_string(Value::Kind kind) {
  switch (kind) {
    case Value::Kind::text:
      return "a text";
    case Value::Kind::number:
      return "a number";
    case Value::Kind::boolean:
      return "true or false";
    case Value::Kind::array:
      return "a list";
    case Value::Kind::table:
      return "a table";
    case Value::Kind::other:
      return "a date or time";
  }
  return "?";
}

Value read_toml(const std::filesystem::path& path) { return parse_toml(base::read_file(path, kLargestToml_bytes), path.string()); }

base::Location place_of(const std::filesystem::path& path, std::string_view key) {
  base::Location place{path.string()};
  try {
    const Value root = read_toml(path);
    place = {path.string(), 1, 1};
    const Value* value = &root;
    while (!key.empty()) {
      const std::size_t dot = std::min(key.find('.'), key.size());
      value = value->find(key.substr(0, dot));
      if (value == nullptr) {
        break;
      }
      place = value->at;
      key.remove_prefix(std::min(dot + 1, key.size()));
    }
  } catch (const base::Failure&) {
    // A caller that needs only the place reports its own problem; the reader of the values reports a broken file.
  }
  return place;
}

Value parse_toml(const std::string& content, const std::string& file) {
  if (content.find('\0') != std::string::npos) {
    throw base::bad_input({file}, "", "cannot be read: it is a binary file; expected TOML text");
  }
  if (const std::optional<int> line = line_of_deep_key(content)) {
    throw base::bad_input({file, line, 1}, "", fmt::format("a key of more than {} dots, which no file of this kind has", kMostDots));
  }
  try {
    const toml::table table = toml::parse(content, file);
    Value root = convert(table, file);
    root.at = {file, 1, 1};
    return root;
  } catch (const toml::parse_error& error) {
    throw base::bad_input(place(error.source().begin, file), "", explanation(error, content));
  }
}

}  // namespace heatsoak::input
