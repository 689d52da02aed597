#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "cli/command.h"
#include "cli/effect_topic.h"
#include "cli/threshold_topic.h"
#include "cli/verdict_topic.h"
#include "duty/duty.h"
#include "duty/file_kind.h"
#include "duty/match/match_duty.h"
#include "firmware/core_diagram.h"
#include "motor/datasheet_network.h"
#include "robot/robot.h"

namespace heatsoak::commands {
namespace {

/// Head that every duty file has in addition to its shape.
const std::string kDutyHead = R"(summary = "description of this load"
origin = "source, or whose judgement it is"
ambient = { value = "25 degC", origin = "estimated", derivation = "why this value", range = ["20 degC", "32 degC"] }
)";

using Json = nlohmann::ordered_json;

struct Description {
  std::string text;
  Json json;
};

std::string with_unit(double value, std::string_view unit) {
  return unit.empty() ? significant(value, 4) : fmt::format("{} {}", significant(value, 4), unit_for_display(unit));
}

Json parameter_json(std::string_view key, std::string_view unit, const ParameterValue& parameter) {
  Json json{
      {"key", key}, {"value", parameter.value}, {"unit", unit}, {"origin", to_string(parameter.origin)}, {"source", parameter.source}};
  if (parameter.spread) {
    json["range"] = {parameter.spread->low, parameter.spread->high};
  }
  for (const Confirmation& each : parameter.confirmed_by) {
    json["confirmed_by"][each.source] = each.value;
  }
  if (!parameter.derivation.empty()) {
    json["derivation"] = parameter.derivation;
  }
  return json;
}

/// Formats a deviation in percent: "+9"; below 1 % with one significant digit.
std::string percent_off(double bound, double value) {
  const double percent = 100.0 * (bound - value) / std::abs(value);
  return (percent < 0.0 ? "" : "+") + (std::abs(percent) < 1.0 ? significant(percent, 1) : fmt::format("{:.0f}", percent));
}

std::string parameter_text(std::string_view key, std::string_view unit, const ParameterValue& parameter) {
  std::string text = fmt::format("  {:36} {:>22}  {:12}", key, parameter.printed, to_string(parameter.origin));
  if (parameter.spread && unit == "rad") {
    text += fmt::format(" {} … {} °", significant(convert(parameter.spread->low, "rad", "deg"), 3),
                        significant(convert(parameter.spread->high, "rad", "deg"), 3));
  } else if (parameter.spread && unit != "degC" && parameter.value != 0.0) {
    text += fmt::format(" {} … {} %", percent_off(parameter.spread->low, parameter.value),
                        percent_off(parameter.spread->high, parameter.value));
  } else if (parameter.spread) {
    text +=
        fmt::format(" {} … {} {}", significant(parameter.spread->low, 3), significant(parameter.spread->high, 3), unit_for_display(unit));
  }
  text += parameter.source.empty() ? "\n" : fmt::format("  [{}]\n", parameter.source);
  for (const Confirmation& each : parameter.confirmed_by) {
    text += fmt::format("      {} states {}\n", each.source, each.printed);
  }
  return parameter.derivation.empty() ? text : text + fmt::format("      {}\n", parameter.derivation);
}

/// Describes the effects that the file adds to those of every motor.
void describe_own_effects(const Motor& motor, Description& result) {
  result.text += motor.effects.empty() ? "" : "\neffects that the file adds\n";
  for (const MotorEffect& effect : motor.effects) {
    Json json = {{"name", effect.name}, {"type", effect.type->name}, {"nodes", effect.nodes}, {"condition", effect.condition}};
    std::string where;
    for (const auto& [key, value] : effect.condition) {
      where += fmt::format(", found under {}={}", key, value);
    }
    result.text += fmt::format("  {} ({}) at {}{}\n", effect.name, effect.type->name, fmt::join(effect.nodes, ", "), where);
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      if (effect.type->parameters[i].choices.empty()) {
        const std::string_view unit = unit_of(effect.type->parameters, i, effect.values());
        result.text += parameter_text(effect.type->parameters[i].key, unit, effect.parameters[i]);
        json["figures"].push_back(parameter_json(effect.type->parameters[i].key, unit, effect.parameters[i]));
      }
    }
    result.json["effects"].push_back(std::move(json));
  }
}

Description describe_motor(const Motor& motor) {
  Description result{fmt::format("{}: {} {}{}{}\n{} thermal data; file {}\n", motor.id, motor.manufacturer, motor.name,
                                 motor.part_number.empty() ? "" : ", ", motor.part_number, data_quality(motor), motor.file.string()),
                     {{"kind", "motor"},
                      {"id", motor.id},
                      {"manufacturer", motor.manufacturer},
                      {"name", motor.name},
                      {"data_quality", data_quality(motor)}}};
  result.text += "\nparameters (value, origin, tolerance or range, source)\n";
  for (const MotorParameterSpec& each : motor_parameter_specs()) {
    if (const auto found = motor.parameters.find(each.spec.key); found != motor.parameters.end()) {
      result.text += parameter_text(each.spec.key, each.spec.unit, found->second);
      result.json["figures"].push_back(parameter_json(each.spec.key, each.spec.unit, found->second));
    }
  }
  result.text += "\nthermal network\n";
  const Network network = datasheet_network(motor, nominal_sample(motor));
  for (const NetworkParameter& each : network.parameters()) {
    const std::string value =
        each.choices.empty() ? with_unit(each.value, each.unit) : std::string(each.choices[static_cast<std::size_t>(each.value)].name);
    result.text += fmt::format("  {:36} {:>22}\n", each.name, value);
    result.json["network"].push_back(
        {{"name", each.name}, {"value", each.choices.empty() ? Json(each.value) : Json(value)}, {"unit", each.unit}});
  }
  for (const MotorEffect& effect : motor.effects) {
    if (!effect.column.empty()) {
      result.text += fmt::format("  {:36} {:>22}\n", effect.name + ".column", effect.column);
      result.json["network"].push_back({{"name", effect.name + ".column"}, {"value", effect.column}, {"unit", ""}});
    }
  }
  describe_own_effects(motor, result);
  result.text += motor.sensors.empty() ? "" : "\nsensor errors\n";
  for (const MotorSensor& sensor : motor.sensors) {
    result.text += fmt::format("  {} ({})\n", sensor.name, sensor.type->name) +
                   parameter_text(sensor.type->size.key, sensor.type->size.unit, sensor.size);
    Json json = parameter_json(sensor.type->size.key, sensor.type->size.unit, sensor.size);
    json["name"] = sensor.name;
    json["type"] = sensor.type->name;
    result.json["sensors"].push_back(std::move(json));
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

/// Returns the unit of a robot value by its key "table.key" or "friction.heading.wheel[0].key".
std::string_view robot_unit(std::string_view key) {
  const std::string_view last = key.substr(key.rfind('.') + 1);
  if (key.find('[') != std::string_view::npos) {
    return std::ranges::find(wheel_parameter_specs(), last, [](const auto& each) { return each.spec.key; })->spec.unit;
  }
  const auto is_it = [&](const auto& each) { return each.spec.key == last && key.starts_with(each.table); };
  return std::ranges::find_if(robot_parameter_specs(), is_it)->spec.unit;
}

Description describe_robot(const Robot& robot) {
  std::string limits =
      std::isfinite(robot.drive.voltage_limit_V) ? fmt::format(", command at most {} V", significant(robot.drive.voltage_limit_V, 4)) : "";
  limits += std::isfinite(robot.drive.current_limit_A) ? fmt::format(", at most {} A", significant(robot.drive.current_limit_A, 4))
                                                       : ", no current limit";
  std::vector<std::string> angles;
  for (const double angle_rad : robot.wheels.axis_rad) {
    angles.push_back(significant(convert(angle_rad, "rad", "deg"), 4));
  }
  Description result{
      fmt::format(
          "{}: {}\n  mass {} kg, wheel radius {} mm, contact radius {} mm, wheel axes at {} °\n  motor {}, gear {}:1, {} commutation\n"
          "  battery {} V{}\n  source: {}\n",
          robot.id, robot.name, significant(robot.mass_kg, 4), significant(1e3 * robot.wheels.radius_m, 3),
          significant(1e3 * robot.wheels.contact_radius_m, 3), fmt::join(angles, ", "), robot.drive.motor,
          significant(robot.drive.gear_ratio, 3), robot.drive.commutation == Commutation::block ? "block" : "sinusoidal",
          significant(robot.battery.nominal_V, 3), limits, robot.source),
      {{"kind", "robot"},
       {"id", robot.id},
       {"name", robot.name},
       {"motor", robot.drive.motor},
       {"mass_kg", robot.mass_kg},
       {"wheel_radius_m", robot.wheels.radius_m},
       {"gear_ratio", robot.drive.gear_ratio},
       {"available_V", robot.available_V()},
       {"source", robot.source}}};
  result.text += robot.parameters.empty() ? "" : "\nparameters (value, origin, range, source)\n";
  for (const auto& [key, parameter] : robot.parameters) {
    result.text += parameter_text(key, robot_unit(key), parameter);
    result.json["figures"].push_back(parameter_json(key, robot_unit(key), parameter));
  }
  return result;
}

/// Breaks text at blanks; lines after the first are indented.
std::string wrapped(std::string_view text, std::size_t indent) {
  constexpr std::size_t kWidth = 120;
  std::string result;
  std::size_t column = indent;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const auto width =
        static_cast<std::size_t>(std::ranges::count_if(text.substr(at, end - at), [](char c) { return (c & 0xC0) != 0x80; }));
    if (column > indent && column + 1 + width > kWidth) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += text.substr(at, end - at);
    column += width;
    at = end + 1;
  }
  return result;
}

Description describe_duty(const Duty& duty) {
  Description result{fmt::format("{}: {}\n  shape {}, ambient {:.0f} °C\n  load: {}\n  {}\n", duty.id, duty.summary, duty.shape,
                                 duty.ambient_C.value, duty.origin, fmt::join(duty.notes, "\n  ")),
                     {{"kind", "duty"},
                      {"id", duty.id},
                      {"summary", duty.summary},
                      {"origin", duty.origin},
                      {"shape", duty.shape},
                      {"ambient_C", duty.ambient_C.value},
                      {"notes", duty.notes}}};
  result.text += duty.parameters.empty() ? "" : "\nload\n";
  for (const auto& [spec, parameter] : duty.parameters) {
    const bool is_bare = parameter.printed.empty();
    result.text += is_bare ? fmt::format("  {:36} {:>22}\n", spec.key, with_unit(parameter.value, spec.unit))
                           : parameter_text(spec.key, spec.unit, parameter);
    result.json["figures"].push_back(is_bare ? Json{{"key", spec.key}, {"value", parameter.value}, {"unit", spec.unit}}
                                             : parameter_json(spec.key, spec.unit, parameter));
  }
  if (const auto match = std::dynamic_pointer_cast<const MatchDuty>(duty.shape_data)) {
    result.text += "\ninputs (value, origin, range, meaning)\n";
    for (std::size_t i = 0; i < match->inputs().parameters.size(); ++i) {
      const ParameterSpec& spec = match_input_specs()[i].spec;
      const ParameterValue& parameter = match->inputs().parameters[i];
      result.text += parameter_text(spec.key, spec.unit, parameter) + fmt::format("      {}\n", wrapped(spec.meaning, 6));
      Json json = parameter_json(spec.key, spec.unit, parameter);
      json["meaning"] = spec.meaning;
      result.json["figures"].push_back(json);
    }
  }
  return result;
}

std::string in_words(Signal signal) {
  std::string name(quantity_of(signal).name);
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// Returns lines of a motor file with the typical size, ready to paste.
std::string motor_file_lines(const EffectType& effect) {
  const std::vector<double>& values = effect.candidacy.variants.empty() ? effect.example.parameters : effect.candidacy.variants.front();
  std::string text = effect_table(effect.name);
  for (const NodeRole& role : effect.nodes) {
    text += !role.own_capacity ? fmt::format("{} = \"{}\"\n", role.role, role.default_node) : "";
  }
  for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
    const ParameterSpec& spec = effect.parameters[i];
    const std::string_view unit = unit_of(effect.parameters, i, values);
    if (!spec.choices.empty()) {
      text += fmt::format("{} = \"{}\"\n", spec.key, spec.choices[static_cast<std::size_t>(values[i])].name);
    } else {
      text += typical_value(spec.key, values[i], unit);
    }
  }
  return text;
}

void describe_parameters(const EffectType& effect, Description& result) {
  for (const ParameterSpec& spec : effect.parameters) {
    Json json{{"key", spec.key}, {"unit", spec.unit}, {"meaning", spec.meaning}};
    const std::string unit = spec.unit_of >= 0 ? fmt::format("as {}", effect.parameters[static_cast<std::size_t>(spec.unit_of)].key)
                                               : unit_for_display(spec.unit);
    const std::string range = spec.choices.empty() ? to_string(spec.range, spec.unit) : "one of";
    result.text += fmt::format("  {:24} {:10} {}\n", spec.key, unit, wrapped(fmt::format("{}; {}", spec.meaning, range), 38));
    for (const Choice& choice : spec.choices) {
      result.text += fmt::format("    {:22} {:10} {}\n", choice.name, unit_for_display(choice.unit), choice.meaning);
      json["choices"].push_back({{"name", choice.name}, {"unit", choice.unit}, {"meaning", choice.meaning}});
    }
    result.json["parameters"].push_back(json);
  }
  for (const NodeRole& role : effect.nodes) {
    const bool own = role.own_capacity.has_value();
    result.text +=
        fmt::format("  {:24} {:10} {}\n", role.role, "node",
                    own ? "of its own, named after the effect in the file" : fmt::format("'{}' unless named", role.default_node));
    result.json["nodes"].push_back({{"key", role.role}, {"default", own ? Json() : Json(role.default_node)}});
  }
}

Description describe_effect(const EffectType& effect) {
  Description result{
      fmt::format("{}: {}\n\n  {}\n\n", effect.name, wrapped(effect.summary, effect.name.size() + 2), wrapped(effect.equation, 2)),
      {{"kind", "effect"},
       {"id", effect.name},
       {"summary", effect.summary},
       {"equation", effect.equation},
       {"reference", effect.reference},
       {"typical", effect.typical},
       {"look_alike", effect.confounded_with}}};
  describe_parameters(effect, result);
  std::vector<std::string> needs;
  for (const Signal signal : effect.needs) {
    needs.push_back(in_words(signal));
  }
  result.json["needs"] = needs;
  const auto say = [&result](std::string_view what, std::string_view text) {
    result.text += text.empty() ? "" : fmt::format("  {:14} {}\n", what, wrapped(text, 17));
  };
  result.text += "\n";
  say("typical size", effect.typical);
  say("confounded", effect.confounded_with);
  const bool has_choice = std::ranges::any_of(effect.parameters, [](const ParameterSpec& spec) { return !spec.choices.empty(); });
  say("needs a log of", has_choice ? "the signal that was chosen" : fmt::format("{}", fmt::join(needs, ", ")));
  if (effect.candidacy.size_parameter) {
    say("family", effect.candidacy.family);
    say("experiment", effect.candidacy.experiment);
    result.json["family"] = effect.candidacy.family;
    result.json["experiment"] = effect.candidacy.experiment;
  }
  say("reference", effect.reference);
  result.text += fmt::format("\nat the end of a motor file{}:\n{}",
                             is_loss_of_every_motor(effect) ? ", where it is added to the same loss of the file's own parameters" : "",
                             motor_file_lines(effect));
  return result;
}

/// Formats as "Input: pose (m, rad), command_age_s (s)".
std::string signals_text(const SignalGroup& group, robot_core::Blocks readers) {
  std::vector<std::string> signals;
  for (const robot_core::SignalText& signal : group.signals) {
    if ((signal.to & readers) != 0) {
      signals.push_back(fmt::format("{} ({})", signal.name, signal.unit));
    }
  }
  return signals.empty() ? "" : fmt::format("{}: {}", group.carrier, fmt::join(signals, ", "));
}

Description describe_core() {
  Description result{
      "robot_core: the drive core, one control step of a robot on three or four omni wheels, in simulation and in firmware\n"
      "One call of robot_core::step() runs these blocks in this order; sources in robot_core/.\n",
      {{"kind", "core"}, {"id", "robot_core"}}};
  const std::vector<SignalGroup> groups = signal_groups();
  for (const robot_core::BlockText& block : robot_core::kBlocks) {
    result.text += fmt::format("\n{} {}, {}: {}() in {}\n    {}\n", block.number, block.title, rate_words(block.rate), block.function,
                               block.files, wrapped(block.task, 4));
    for (const SignalGroup& group : groups) {
      const std::string read = signals_text(group, robot_core::only(block.block));
      result.text += read.empty() ? "" : fmt::format("    reads  {}\n", wrapped(read, 11));
    }
    for (const SignalGroup& group : groups) {
      result.text += group.from == block.block ? fmt::format("    writes {}\n", wrapped(signals_text(group, ~0U), 11)) : "";
    }
    result.json["blocks"].push_back({{"number", block.number},
                                     {"function", block.function},
                                     {"files", block.files},
                                     {"title", block.title},
                                     {"task", block.task},
                                     {"rate", rate_words(block.rate)}});
  }
  for (const robot_core::SignalText& signal : robot_core::kSignals) {
    const bool is_input = signal.from == robot_core::Block::firmware;
    result.json["signals"].push_back({{"carrier", signal.carrier},
                                      {"name", signal.name},
                                      {"unit", signal.unit},
                                      {"from", is_input ? "firmware" : text_of(signal.from).number},
                                      {"to", numbers_of(signal.to)}});
  }
  result.text += "\n`heatsoak describe robot_core --diagram core.svg` draws them, `heatsoak generate core` writes the core for a robot.\n";
  return result;
}

constexpr std::string_view kCore = "robot_core";

Description describe_file(const std::filesystem::path& file) {
  switch (file_kind(file)) {
    case FileKind::duty:
      return describe_duty(read_duty(file));
    case FileKind::robot:
      return describe_robot(read_robot(file));
    case FileKind::motor:
      break;
  }
  return describe_motor(read_motor(file));
}

/// Names are unique across kinds. A path is described by the content of its file.
Description describe(const std::string& name, const DataFolders& folders) {
  if (name.ends_with(".toml")) {
    return describe_file(name);
  }
  if (const EffectType* effect = find_effect(name)) {
    return describe_effect(*effect);
  }
  for (const ShapeType& shape : all_shapes()) {
    if (shape.name == name) {
      const std::string file = kDutyHead + std::string(shape.example);
      return {fmt::format("{}: a duty shape, {}\n\n{}", shape.name, shape.summary, file),
              {{"kind", "shape"}, {"id", shape.name}, {"example", file}}};
    }
  }
  if (name == kCore) {
    return describe_core();
  }
  std::vector<std::string> known{std::string(kCore)};
  for (const ShapeType& shape : all_shapes()) {
    known.emplace_back(shape.name);
  }
  for (const std::vector<Topic>& topics : {all_topics(), threshold_topics(), {verdict_topic()}}) {
    for (const Topic& topic : topics) {
      if (topic.id == name) {
        return {topic.text, topic.json()};
      }
      known.push_back(topic.id);
    }
  }
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
  if (name == "motors" || name == "robots" || name == "duties" || name == "effects") {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("'{0}' is not one name: `heatsoak list {0}` lists the names, `heatsoak describe NAME` describes one of them", name));
  }
  throw Failure(ExitCode::bad_input, fmt::format("there is no '{}' among motors, robots, duties, shapes, effects, thresholds and verdict{}",
                                                 name, did_you_mean(name, known)));
}

}  // namespace

Command describe() {
  return {.name = {},
          .summary = "Describes a motor, robot, duty, duty shape, effect, threshold or verdict: values with origin, equations, sources",
          .example = "heatsoak describe maxon_ecx_flat_32l_48v",
          .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
            const auto name = std::make_shared<std::string>();
            const auto diagram = std::make_shared<std::string>();
            app.add_option("name", *name, "id, as `heatsoak list` shows it, a motor, robot or duty file, or robot_core")->required();
            app.add_option("--diagram", *diagram, "draw the block diagram of robot_core")
                ->check([](const std::string& file) { return file.ends_with(".svg") ? "" : "expected a name that ends in .svg"; })
                ->type_name("FILE.svg");
            session.add_data_option(app);
            session.add_json_option(app);
            return [name, diagram, &session] {
              Description description = describe(*name, session.folders());
              if (!diagram->empty()) {
                if (*name != kCore) {
                  throw Failure(ExitCode::bad_input,
                                fmt::format("--diagram: '{}' has no block diagram; expected `heatsoak describe {}`", *name, kCore));
                }
                session.write(*diagram, core_diagram_svg());
              }
              session.say(description.text);
              Json json{{"schema", "heatsoak.describe/1"}};
              json.update(description.json);
              session.answer(json);
              return ExitCode::done;
            };
          }};
}

}  // namespace heatsoak::commands
