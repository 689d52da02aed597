// A file of the user as a tree in which every value knows its place.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak {

struct Member;

struct Value {
  enum class Kind { text, number, boolean, array, table, other };
  Kind kind = Kind::other;
  Location at;
  std::string text;  ///< of a text; of a number as it was written
  bool boolean = false;
  std::vector<Value> items;     ///< of an array
  std::vector<Member> members;  ///< of a table, in the order of the file

  [[nodiscard]] const Value* find(std::string_view key) const;
};

struct Member {
  std::string key;
  Value value;
};

/// "a text", "a number", …: for messages.
std::string_view to_string(Value::Kind kind);

/// Reads a TOML file of at most 1 MB, 1000 keys per table and 16 dots per key. Throws Failure (bad_input) that says the place of the first
/// error of syntax, or why the file cannot be read.
Value read_toml(const std::filesystem::path& path);

/// Where the file has the dotted key, or the last table on the way to it; no line where the file cannot be read.
Location place_of(const std::filesystem::path& path, std::string_view key);

/// As read_toml, for text that is at hand; `file` is its name in messages.
Value parse_toml(const std::string& content, const std::string& file);

}  // namespace heatsoak
