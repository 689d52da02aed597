#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "cli/command.h"
#include "duty/duty.h"
#include "motor/datasheet_network.h"
#include "robot/robot.h"

namespace heatsoak::commands {
namespace {

using Json = nlohmann::ordered_json;

struct Description {
  std::string text;
  Json json;
};

std::string with_unit(double value, std::string_view unit) {
  return unit.empty() ? significant(value, 4) : fmt::format("{} {}", significant(value, 4), unit_for_display(unit));
}

Json figure_json(std::string_view key, std::string_view unit, const Figure& figure) {
  Json json{{"key", key}, {"value", figure.value}, {"unit", unit}, {"origin", to_string(figure.origin)}, {"source", figure.source}};
  if (figure.spread) {
    json["range"] = {figure.spread->low, figure.spread->high};
  }
  for (const Confirmation& each : figure.confirmed_by) {
    json["confirmed_by"][each.source] = each.value;
  }
  if (!figure.derivation.empty()) {
    json["derivation"] = figure.derivation;
  }
  return json;
}

std::string figure_text(std::string_view key, std::string_view unit, const Figure& figure) {
  std::string text = fmt::format("  {:36} {:>22}  {:12}", key, figure.printed, to_string(figure.origin));
  if (figure.spread && unit != "degC") {
    text += fmt::format(" {:+.0f} … {:+.0f} %", 100.0 * (figure.spread->low / figure.value - 1.0),
                        100.0 * (figure.spread->high / figure.value - 1.0));
  } else if (figure.spread) {
    text += fmt::format(" {} … {} °C", significant(figure.spread->low, 3), significant(figure.spread->high, 3));
  }
  text += figure.source.empty() ? "\n" : fmt::format("  [{}]\n", figure.source);
  for (const Confirmation& each : figure.confirmed_by) {
    text += fmt::format("      {} says {}\n", each.source, each.printed);
  }
  return figure.derivation.empty() ? text : text + fmt::format("      {}\n", figure.derivation);
}

Description describe_motor(const Motor& motor) {
  Description result{fmt::format("{}: {} {}{}{}\n{} thermal data; file {}\n", motor.id, motor.manufacturer, motor.name,
                                 motor.part_number.empty() ? "" : ", ", motor.part_number, data_quality(motor), motor.file.string()),
                     {{"kind", "motor"},
                      {"id", motor.id},
                      {"manufacturer", motor.manufacturer},
                      {"name", motor.name},
                      {"data_quality", data_quality(motor)}}};
  result.text += "\nfigures (value, origin, 95 % band or range, source)\n";
  for (const MotorFigureSpec& each : motor_figure_specs()) {
    if (const auto found = motor.figures.find(each.spec.key); found != motor.figures.end()) {
      result.text += figure_text(each.spec.key, each.spec.unit, found->second);
      result.json["figures"].push_back(figure_json(each.spec.key, each.spec.unit, found->second));
    }
  }
  result.text += "\nthermal network\n";
  const Network network = datasheet_network(motor, nominal_sample(motor));
  for (const NetworkParameter& each : network.parameters()) {
    result.text += fmt::format("  {:36} {:>22}\n", each.name, with_unit(each.value, each.unit));
    result.json["network"].push_back({{"name", each.name}, {"value", each.value}, {"unit", each.unit}});
  }
  result.text += "\nsources\n";
  for (const auto& [id, what] : motor.sources) {
    result.text += fmt::format("  {}: {}\n", id, what);
  }
  result.text += motor.notes.empty() ? "" : fmt::format("\nnotes\n  {}\n", fmt::join(motor.notes, "\n  "));
  result.json["sources"] = motor.sources;
  result.json["notes"] = motor.notes;
  return result;
}

Description describe_robot(const Robot& robot) {
  std::string limits =
      std::isfinite(robot.voltage_limit_V) ? fmt::format(", command at most {} V", significant(robot.voltage_limit_V, 4)) : "";
  limits +=
      std::isfinite(robot.current_limit_A) ? fmt::format(", at most {} A", significant(robot.current_limit_A, 4)) : ", no current limit";
  std::vector<std::string> angles;
  for (const double angle_rad : robot.wheel_axis_rad) {
    angles.push_back(significant(convert(angle_rad, "rad", "deg"), 4));
  }
  return {
      fmt::format(
          "{}: {}\n  mass {} kg, wheel radius {} mm, contact radius {} mm, wheel axes at {} °\n  motor {}, gear {}:1, {} commutation\n"
          "  battery {} V{}\n  source: {}\n",
          robot.id, robot.name, significant(robot.mass_kg, 4), significant(1e3 * robot.wheel_radius_m, 3),
          significant(1e3 * robot.wheel_contact_radius_m, 3), fmt::join(angles, ", "), robot.drive_motor, significant(robot.gear_ratio, 3),
          robot.commutation == Commutation::block ? "block" : "sinusoidal", significant(robot.battery_V, 3), limits, robot.source),
      {{"kind", "robot"},
       {"id", robot.id},
       {"name", robot.name},
       {"motor", robot.drive_motor},
       {"mass_kg", robot.mass_kg},
       {"wheel_radius_m", robot.wheel_radius_m},
       {"gear_ratio", robot.gear_ratio},
       {"available_V", robot.available_V()},
       {"source", robot.source}}};
}

Description describe_duty(const Duty& duty) {
  return {fmt::format("{}: {}\n  shape {}, ambient {:.0f} °C\n  load: {}\n  {}\n", duty.id, duty.summary, duty.shape, duty.ambient_C.value,
                      duty.origin, fmt::join(duty.notes, "\n  ")),
          {{"kind", "duty"},
           {"id", duty.id},
           {"summary", duty.summary},
           {"origin", duty.origin},
           {"shape", duty.shape},
           {"ambient_C", duty.ambient_C.value},
           {"notes", duty.notes}}};
}

Description describe_effect(const EffectType& effect) {
  Description result{fmt::format("{}: {}\n\n  {}\n\n", effect.name, effect.summary, effect.equation),
                     {{"kind", "effect"},
                      {"id", effect.name},
                      {"summary", effect.summary},
                      {"equation", effect.equation},
                      {"reference", effect.reference}}};
  std::string keys;
  for (const ParameterSpec& spec : effect.parameters) {
    result.text +=
        fmt::format("  {:26} {:8} {}; {}\n", spec.key, unit_for_display(spec.unit), spec.meaning, to_string(spec.range, spec.unit));
    result.json["parameters"].push_back({{"key", spec.key}, {"unit", spec.unit}, {"meaning", spec.meaning}});
    keys += fmt::format(
        "{} = {{ value = \"… {}\", origin = \"estimated\", source = \"…\", derivation = \"…\", range = [\"… {}\", \"… {}\"] }}\n", spec.key,
        spec.unit, spec.unit, spec.unit);
  }
  for (const NodeRole& role : effect.nodes) {
    result.text += fmt::format("  {:26} {:8} node; '{}' unless named\n", role.role, "", role.default_node);
  }
  result.text +=
      fmt::format("\n  typical size: {}\n  look-alikes: {}\n  reference: {}\n\nin a motor file:\n[effects.my_{}]\ntype = \"{}\"\n{}",
                  effect.typical, effect.look_alike, effect.reference, effect.name, effect.name, keys);
  return result;
}

/// Names are unique across kinds; a path is looked into by what it holds.
Description describe(const std::string& name, const DataFolders& folders) {
  if (const EffectType* effect = find_effect(name)) {
    return describe_effect(*effect);
  }
  for (const ShapeType& shape : all_shapes()) {
    if (shape.name == name) {
      return {fmt::format("{}: a duty shape, {}\n\n{}", shape.name, shape.summary, shape.example),
              {{"kind", "shape"}, {"id", shape.name}, {"example", shape.example}}};
    }
  }
  std::vector<std::string> known;
  const auto has = [&](const std::filesystem::path& folder) {
    const std::vector<std::string> ids = ids_in(folder);
    known.insert(known.end(), ids.begin(), ids.end());
    return std::ranges::find(ids, name) != ids.end();
  };
  if (has(folders.motors)) {
    return describe_motor(read_motor(folders.motors / (name + ".toml")));
  }
  if (has(folders.robots)) {
    return describe_robot(read_robot(folders.robots / (name + ".toml")));
  }
  if (has(folders.duties)) {
    return describe_duty(read_duty(folders.duties / (name + ".toml")));
  }
  for (const EffectType& effect : all_effects()) {
    known.emplace_back(effect.name);
  }
  throw Failure(ExitCode::bad_input,
                fmt::format("there is no '{}' among motors, robots, duties, shapes and effects{}", name, did_you_mean(name, known)));
}

}  // namespace

Command describe() {
  return {.name = {},
          .summary = "Says what a motor, robot, duty, duty shape or effect is: figures with origin, equations, sources",
          .example = "heatsoak describe maxon_ecx_flat_32l_48v",
          .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
            const auto name = std::make_shared<std::string>();
            app.add_option("name", *name, "id, as `heatsoak list` shows it")->required();
            session.add_data_option(app);
            session.add_json_option(app);
            return [name, &session] {
              Description description = describe(*name, session.folders());
              session.say(description.text);
              Json json{{"schema", "heatsoak.describe/1"}};
              json.update(description.json);
              session.answer(json);
              return ExitCode::done;
            };
          }};
}

}  // namespace heatsoak::commands
