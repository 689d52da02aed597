// A parsed TOML file as a tree in which every value has its file position.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak::input {

struct Member;

struct Value {
  enum class Kind { text, number, boolean, array, table, other };
  Kind kind = Kind::other;
  base::Location at;
  std::string text;  ///< content of a text; a number as written in the file
  bool boolean = false;
  std::vector<Value> items;     ///< elements of an array
  std::vector<Member> members;  ///< members of a table, in the order of the file

  [[nodiscard]] const Value* find(std::string_view key) const;
};

struct Member {
  std::string key;
  Value value;
};

/// Returns "a text", "a number", …, for messages.
std::string_view to_string(Value::Kind kind);

/// Reads a TOML file. Throws Failure (bad_input) if it cannot be read, at the first syntax error, or if it exceeds 1 MB, 1000 keys per
/// table or 16 dots per key.
Value read_toml(const std::filesystem::path& path);

/// Returns the position of a dotted key, or of the last table on its path that exists. If the file cannot be read or parsed, it has no line.
base::Location place_of(const std::filesystem::path& path, std::string_view key);

/// Like read_toml() for a text in memory; `file` is its name in messages.
Value parse_toml(const std::string& content, const std::string& file);

}  // namespace heatsoak::input
