#include "cli/file_kind.h"

#include <algorithm>

#include "duty/duty.h"
#include "input/document.h"

namespace heatsoak {

FileKind file_kind(const std::filesystem::path& file) {
  const Value root = read_toml(file);
  if (root.find("shape") || std::ranges::any_of(all_shapes(), [&](const ShapeType& shape) { return root.find(shape.name) != nullptr; })) {
    return FileKind::duty;
  }
  return root.find("wheels") || root.find("drive") ? FileKind::robot : FileKind::motor;
}

}  // namespace heatsoak
