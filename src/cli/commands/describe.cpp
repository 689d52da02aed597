#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/effect_topic.h"
#include "cli/threshold_topic.h"
#include "cli/verdict_topic.h"
#include "duty/duty.h"
#include "duty/file_kind.h"
#include "duty/match/match_duty.h"
#include "firmware/core_diagram.h"
#include "motor/datasheet_network.h"
#include "present/description.h"
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
  present::Document document;
  Json json;
};

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

/// Returns the effects that the file adds to those of every motor.
Json own_effects(const Motor& motor) {
  Json all;
  for (const MotorEffect& effect : motor.effects) {
    Json json = {{"name", effect.name}, {"type", effect.type->name}, {"nodes", effect.nodes}, {"condition", effect.condition}};
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      if (effect.type->parameters[i].choices.empty()) {
        const std::string_view unit = unit_of(effect.type->parameters, i, effect.values());
        json["figures"].push_back(parameter_json(effect.type->parameters[i].key, unit, effect.parameters[i]));
      }
    }
    all.push_back(std::move(json));
  }
  return all;
}

Json motor_json(const Motor& motor) {
  Json result{{"kind", "motor"},
              {"id", motor.id},
              {"manufacturer", motor.manufacturer},
              {"name", motor.name},
              {"data_quality", data_quality(motor)}};
  for (const MotorParameterSpec& each : motor_parameter_specs()) {
    if (const auto found = motor.parameters.find(each.spec.key); found != motor.parameters.end()) {
      result["figures"].push_back(parameter_json(each.spec.key, each.spec.unit, found->second));
    }
  }
  const Network network = datasheet_network(motor, nominal_sample(motor));
  for (const NetworkParameter& each : network.parameters()) {
    result["network"].push_back(
        {{"name", each.name},
         {"value", each.choices.empty() ? Json(each.value) : Json(each.choices[static_cast<std::size_t>(each.value)].name)},
         {"unit", each.unit}});
  }
  for (const MotorEffect& effect : motor.effects) {
    if (!effect.column.empty()) {
      result["network"].push_back({{"name", effect.name + ".column"}, {"value", effect.column}, {"unit", ""}});
    }
  }
  if (!motor.effects.empty()) {
    result["effects"] = own_effects(motor);
  }
  for (const MotorSensor& sensor : motor.sensors) {
    Json json = parameter_json(sensor.type->size.key, sensor.type->size.unit, sensor.size);
    json["name"] = sensor.name;
    json["type"] = sensor.type->name;
    result["sensors"].push_back(std::move(json));
  }
  result["sources"] = motor.sources;
  result["notes"] = motor.notes;
  return result;
}

Json robot_json(const Robot& robot) {
  Json result{{"kind", "robot"},
              {"id", robot.id},
              {"name", robot.name},
              {"motor", robot.drive.motor},
              {"mass_kg", robot.mass_kg},
              {"wheel_radius_m", robot.wheels.radius_m},
              {"gear_ratio", robot.drive.gear_ratio},
              {"available_V", robot.available_V()},
              {"source", robot.source}};
  for (const auto& [key, parameter] : robot.parameters) {
    result["figures"].push_back(parameter_json(key, present::robot_unit(key), parameter));
  }
  return result;
}

Json duty_json(const Duty& duty) {
  Json result{{"kind", "duty"},        {"id", duty.id},       {"summary", duty.summary},
              {"origin", duty.origin}, {"shape", duty.shape}, {"ambient_C", duty.ambient_C.value},
              {"notes", duty.notes}};
  for (const auto& [spec, parameter] : duty.parameters) {
    result["figures"].push_back(parameter.printed.empty() ? Json{{"key", spec.key}, {"value", parameter.value}, {"unit", spec.unit}}
                                                          : parameter_json(spec.key, spec.unit, parameter));
  }
  if (const auto match = std::dynamic_pointer_cast<const MatchDuty>(duty.shape_data)) {
    for (std::size_t i = 0; i < match->inputs().parameters.size(); ++i) {
      const ParameterSpec& spec = match_input_specs()[i].spec;
      Json json = parameter_json(spec.key, spec.unit, match->inputs().parameters[i]);
      json["meaning"] = spec.meaning;
      result["figures"].push_back(json);
    }
  }
  return result;
}

Json network_effect_json(const EffectType& effect) {
  Json result{{"kind", "effect"},
              {"id", effect.name},
              {"summary", effect.summary},
              {"equation", effect.equation},
              {"reference", effect.reference},
              {"typical", effect.typical},
              {"look_alike", effect.confounded_with}};
  for (const ParameterSpec& spec : effect.parameters) {
    Json json{{"key", spec.key}, {"unit", spec.unit}, {"meaning", spec.meaning}};
    for (const Choice& choice : spec.choices) {
      json["choices"].push_back({{"name", choice.name}, {"unit", choice.unit}, {"meaning", choice.meaning}});
    }
    result["parameters"].push_back(json);
  }
  for (const NodeRole& role : effect.nodes) {
    result["nodes"].push_back({{"key", role.role}, {"default", role.own_capacity ? Json() : Json(role.default_node)}});
  }
  result["needs"] = Json::array();
  for (const Signal signal : effect.needs) {
    result["needs"].push_back(present::signal_name(signal));
  }
  if (effect.candidacy.size_parameter) {
    result["family"] = effect.candidacy.family;
    result["experiment"] = effect.candidacy.experiment;
  }
  return result;
}

Json core_json() {
  Json result{{"kind", "core"}, {"id", "robot_core"}};
  for (const robot_core::BlockText& block : robot_core::kBlocks) {
    result["blocks"].push_back({{"number", block.number},
                                {"function", block.function},
                                {"files", block.files},
                                {"title", block.title},
                                {"task", block.task},
                                {"rate", rate_words(block.rate)}});
  }
  for (const robot_core::SignalText& signal : robot_core::kSignals) {
    const bool is_input = signal.from == robot_core::Block::firmware;
    result["signals"].push_back({{"carrier", signal.carrier},
                                 {"name", signal.name},
                                 {"unit", signal.unit},
                                 {"from", is_input ? "firmware" : text_of(signal.from).number},
                                 {"to", numbers_of(signal.to)}});
  }
  return result;
}

Description description_of(const Motor& motor) { return {present::motor_description(motor), motor_json(motor)}; }
Description description_of(const Robot& robot) { return {present::robot_description(robot), robot_json(robot)}; }
Description description_of(const Duty& duty) { return {present::duty_description(duty), duty_json(duty)}; }

constexpr std::string_view kCore = "robot_core";

Description describe_file(const std::filesystem::path& file) {
  switch (file_kind(file)) {
    case FileKind::duty:
      return description_of(read_duty(file));
    case FileKind::robot:
      return description_of(read_robot(file));
    case FileKind::motor:
      break;
  }
  return description_of(read_motor(file));
}

/// Names are unique across kinds. A path is described by the content of its file.
Description describe(const std::string& name, const DataFolders& folders) {
  if (name.ends_with(".toml")) {
    return describe_file(name);
  }
  if (const EffectType* effect = find_effect(name)) {
    return {present::effect_description(*effect), network_effect_json(*effect)};
  }
  for (const ShapeType& shape : all_shapes()) {
    if (shape.name == name) {
      const std::string file = kDutyHead + std::string(shape.example);
      return {present::shape_description(shape, file), {{"kind", "shape"}, {"id", shape.name}, {"example", file}}};
    }
  }
  if (name == kCore) {
    return {present::core_description(), core_json()};
  }
  std::vector<std::string> known{std::string(kCore)};
  for (const ShapeType& shape : all_shapes()) {
    known.emplace_back(shape.name);
  }
  for (const std::vector<Topic>& topics : {all_topics(), threshold_topics(), {verdict_topic()}}) {
    for (const Topic& topic : topics) {
      if (topic.id == name) {
        return {topic.document(), topic.json()};
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
    return description_of(read_motor(folders.motors / (name + ".toml")));
  }
  if (has(folders.robots)) {
    return description_of(read_robot(folders.robots / (name + ".toml")));
  }
  if (has(folders.duties)) {
    return description_of(read_duty(folders.duties / (name + ".toml")));
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
            session.add_answer_options(app);
            return [name, diagram, &session] {
              Description description = describe(*name, session.folders());
              if (!diagram->empty()) {
                if (*name != kCore) {
                  throw Failure(ExitCode::bad_input,
                                fmt::format("--diagram: '{}' has no block diagram; expected `heatsoak describe {}`", *name, kCore));
                }
                session.write(*diagram, core_diagram_svg());
                description.document.add_file(*diagram);
              }
              session.show(description.document);
              Json json{{"schema", "heatsoak.describe/1"}};
              json.update(description.json);
              session.answer(json);
              return ExitCode::done;
            };
          }};
}

}  // namespace heatsoak::commands
