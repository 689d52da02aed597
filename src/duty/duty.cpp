#include "duty/duty.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/air_range.h"
#include "duty/shapes_registry.h"
#include "input/document.h"

namespace heatsoak::duty {

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

namespace {

/// Returns `base` with the values of `own`. Tables are merged key by key, but a parameter is replaced as a whole.
input::Value merged(input::Value base, const input::Value& own) {
  for (const input::Member& member : own.members) {
    const auto same = std::ranges::find(base.members, member.key, &input::Member::key);
    if (same == base.members.end()) {
      base.members.push_back(member);
    } else if (same->value.kind == input::Value::Kind::table && member.value.kind == input::Value::Kind::table &&
               !same->value.find("value")) {
      same->value = merged(std::move(same->value), member.value);
    } else {
      same->value = member.value;
    }
  }
  base.at = own.at;
  return base;
}

/// Reads the file and merges it with the file in the same folder that its `base` names.
input::Value read_with_base(const std::filesystem::path& path, int depth = 0) {
  constexpr int kDeepest = 4;
  input::Value own = input::read_toml(path);
  const input::Value* const base = own.find("base");
  if (!base) {
    return own;
  }
  if (base->kind != input::Value::Kind::text) {
    throw base::bad_input(base->at, "base",
                          fmt::format("is {}; expected the id of a duty in the same folder", input::to_string(base->kind)));
  }
  if (depth >= kDeepest) {
    throw base::bad_input(base->at, "base",
                          "refers to a chain of more than four duties, expected at most four; check whether a file refers to itself");
  }
  std::filesystem::path file = path.parent_path() / (base->text.ends_with(".toml") ? base->text : base->text + ".toml");
  if (!std::filesystem::exists(file)) {
    throw base::bad_input(base->at, "base", fmt::format("there is no {}; expected the id of a duty in the same folder", file.string()));
  }
  std::erase_if(own.members, [](const input::Member& member) { return member.key == "base"; });
  return merged(read_with_base(file, depth + 1), own);
}

}  // namespace

Duty read_duty(const std::filesystem::path& path) {
  const input::Value root = read_with_base(path);
  base::Diagnostics diagnostics;
  input::Reader top(root, "", diagnostics);
  Duty duty;
  duty.id = path.stem().string();
  duty.file = path;
  duty.load.value = 1.0;
  duty.summary = top.text("summary", input::Need::required).value_or("");
  duty.origin = top.text("origin", input::Need::required).value_or("");
  duty.notes = top.texts("notes", input::Need::optional);
  duty.ambient_C = top.parameter({"ambient", "degC", base::kPossibleAir_C, "air around the motor"}, input::Need::required)
                       .value_or(base::ParameterValue{});
  std::vector<std::string_view> names;
  for (const ShapeType& shape : all_shapes()) {
    names.push_back(shape.name);
  }
  duty.shape = top.choice("shape", names, input::Need::required).value_or("");
  const auto shape = std::ranges::find(all_shapes(), duty.shape, &ShapeType::name);
  if (shape != all_shapes().end()) {
    if (std::optional<input::Reader> table = top.table(duty.shape, input::Need::required)) {
      shape->read(*table, path.parent_path(), duty);
      table->finish();
    }
    top.finish();
  }
  diagnostics.throw_if_any();
  return duty;
}

}  // namespace heatsoak::duty
