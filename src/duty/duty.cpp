#include "duty/duty.h"

#include <fmt/format.h>

#include <algorithm>

#include "duty/shapes_registry.h"
#include "input/document.h"

namespace heatsoak {

const std::vector<ShapeType>& all_shapes() {
  static const std::vector<ShapeType> kAll = [] {
    std::vector<ShapeType> all;
    for (const auto& [name, make] : shapes::registry) {
      all.push_back(make());
      all.back().name = name;
    }
    return all;
  }();
  return kAll;
}

Duty read_duty(const std::filesystem::path& path) {
  const Value root = read_toml(path);
  Diagnostics diagnostics;
  Reader top(root, "", diagnostics);
  Duty duty;
  duty.id = path.stem().string();
  duty.file = path;
  duty.load.value = 1.0;
  duty.summary = top.text("summary", Need::required).value_or("");
  duty.origin = top.text("origin", Need::required).value_or("");
  duty.notes = top.texts("notes", Need::optional);
  duty.ambient_C = top.figure({"ambient", "degC", Range::between(-40.0, 100.0), "air around the motor"}, Need::required).value_or(Figure{});
  std::vector<std::string_view> names;
  for (const ShapeType& shape : all_shapes()) {
    names.push_back(shape.name);
  }
  duty.shape = top.choice("shape", names, Need::required).value_or("");
  const auto shape = std::ranges::find(all_shapes(), duty.shape, &ShapeType::name);
  if (shape != all_shapes().end()) {
    if (std::optional<Reader> table = top.table(duty.shape, Need::required)) {
      shape->read(*table, path.parent_path(), duty);
      table->finish();
    }
    top.finish();
  }
  diagnostics.throw_if_any();
  return duty;
}

}  // namespace heatsoak
