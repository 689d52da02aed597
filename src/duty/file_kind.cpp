#include "duty/file_kind.h"

#include <fmt/format.h>

#include <algorithm>

#include "duty/duty.h"

namespace heatsoak::duty {

std::string_view to_string(FileKind kind) {
  switch (kind) {
    case FileKind::motor:
      return "motor";
    case FileKind::robot:
      return "robot";
    case FileKind::duty:
      break;
  }
  return "duty";
}

std::optional<FileKind> evident_kind(const input::Value& root) {
  if (root.find("shape") || root.find("base") ||
      std::ranges::any_of(all_shapes(), [&](const ShapeType& shape) { return root.find(shape.name) != nullptr; })) {
    return FileKind::duty;
  }
  if (root.find("wheels") || root.find("drive")) {
    return FileKind::robot;
  }
  return root.find("figures") || root.find("conventions") ? std::optional(FileKind::motor) : std::nullopt;
}

FileKind file_kind(const std::filesystem::path& file) { return evident_kind(input::read_toml(file)).value_or(FileKind::motor); }

base::Failure other_kind(const std::filesystem::path& file, FileKind kind, std::string_view expected) {
  return base::bad_input(
      {file.string()}, "",
      fmt::format("is a {0} file; expected a file with {1}. `heatsoak lint FILE` checks a {0} file", to_string(kind), expected));
}

}  // namespace heatsoak::duty
