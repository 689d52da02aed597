#include "input/document.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <toml++/toml.h>

namespace heatsoak {
namespace {

constexpr std::size_t kLargestToml_bytes = 16'000'000;

[[noreturn]] void cannot_read(const std::filesystem::path& path, const std::string& reason) {
  throw bad_input({path.string()}, "", "cannot be read: " + reason);
}

Location place(const toml::node& node, const std::string& file) {
  const toml::source_position at = node.source().begin;
  return {file, static_cast<int>(at.line), static_cast<int>(at.column)};
}

Value convert(const toml::node& node, const std::string& file) {
  Value value;
  value.at = place(node, file);
  if (const auto* table = node.as_table()) {
    value.kind = Value::Kind::table;
    for (const auto& [key, member] : *table) {
      value.members.emplace_back(std::string(key.str()), convert(member, file));
    }
    std::ranges::stable_sort(value.members, {}, [](const auto& member) {
      return std::pair(member.second.at.line, member.second.at.column);
    });
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

}  // namespace

const Value* Value::find(std::string_view key) const {
  const auto found = std::ranges::find_if(members, [key](const auto& member) { return member.first == key; });
  return found == members.end() ? nullptr : &found->second;
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

std::string read_file(const std::filesystem::path& path, std::size_t largest_bytes) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    cannot_read(path, std::strerror(errno));
  }
  struct Closer {
    int file;
    ~Closer() { ::close(file); }
  } closer{file};
  struct stat about{};
  if (::fstat(file, &about) != 0 || S_ISDIR(about.st_mode)) {
    cannot_read(path, S_ISDIR(about.st_mode) ? "it is a folder" : std::strerror(errno));
  }
  std::string content;
  std::vector<char> chunk(1 << 16);
  for (;;) {
    const ssize_t got = ::read(file, chunk.data(), chunk.size());
    if (got < 0) {
      cannot_read(path, std::strerror(errno));
    }
    if (got == 0) {
      return content;
    }
    content.append(chunk.data(), static_cast<std::size_t>(got));
    if (content.size() > largest_bytes) {
      cannot_read(path, fmt::format("it is larger than {} MB, which no file of this kind is", largest_bytes / 1'000'000));
    }
  }
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  const std::string temporary = path.string() + ".partial";
  const auto fail = [&](int error) {
    ::unlink(temporary.c_str());
    throw bad_input({path.string()}, "", fmt::format("cannot be written: {}", std::strerror(error)));
  };
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) {
    fail(errno);
  }
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0) {
      const int error = errno;
      ::close(file);
      fail(error);
    }
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::close(file) != 0 || std::rename(temporary.c_str(), path.c_str()) != 0) {
    fail(errno);
  }
}

Value read_toml(const std::filesystem::path& path) {
  const std::string content = read_file(path, kLargestToml_bytes);
  const std::string file = path.string();
  if (content.find('\0') != std::string::npos) {
    cannot_read(path, "it is a binary file; expected TOML text");
  }
  try {
    const toml::table table = toml::parse(content, file);
    Value root = convert(table, file);
    root.at = {file, 1, 1};
    return root;
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw bad_input({file, static_cast<int>(at.line), static_cast<int>(at.column)}, "", fmt::format("not valid TOML: {}", error.description()));
  }
}

}  // namespace heatsoak
