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
#include "firmware/core_diagram.h"
#include "present/description.h"
#include "present/description_json.h"
#include "robot/robot.h"

namespace heatsoak::cli::commands {
namespace {

/// Head that every duty file has in addition to its shape.
const std::string kDutyHead = R"(summary = "description of this load"
origin = "source, or whose judgement it is"
ambient = { value = "25 degC", origin = "estimated", derivation = "why this value", range = ["20 degC", "32 degC"] }
)";

using present::Json;

struct Description {
  present::Document document;
  Json json;
};

Description description_of(const motor::Motor& motor) { return {present::motor_description(motor), present::motor_json(motor)}; }
Description description_of(const robot::Robot& robot) { return {present::robot_description(robot), present::robot_json(robot)}; }
Description description_of(const duty::Duty& duty) { return {present::duty_description(duty), present::duty_file_json(duty)}; }

constexpr std::string_view kCore = "robot_core";

Description describe_file(const std::filesystem::path& file) {
  switch (duty::file_kind(file)) {
    case duty::FileKind::duty:
      return description_of(duty::read_duty(file));
    case duty::FileKind::robot:
      return description_of(robot::read_robot(file));
    case duty::FileKind::motor:
      break;
  }
  return description_of(motor::read_motor(file));
}

/// Names are unique across kinds. A path is described by the content of its file.
Description describe(const std::string& name, const input::DataFolders& folders) {
  if (name.ends_with(".toml")) {
    return describe_file(name);
  }
  if (const thermal::EffectType* effect = thermal::find_effect(name)) {
    return {present::effect_description(*effect), present::network_effect_json(*effect)};
  }
  for (const duty::ShapeType& shape : duty::all_shapes()) {
    if (shape.name == name) {
      const std::string file = kDutyHead + std::string(shape.example);
      return {present::shape_description(shape, file), present::shape_json(shape, file)};
    }
  }
  if (name == kCore) {
    return {present::core_description(), present::core_json()};
  }
  std::vector<std::string> known{std::string(kCore)};
  for (const duty::ShapeType& shape : duty::all_shapes()) {
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
    const std::vector<std::string> ids = input::ids_in(folder);
    known.insert(known.end(), ids.begin(), ids.end());
    return std::ranges::find(ids, name) != ids.end();
  };
  if (has(folders.motors)) {
    return description_of(motor::read_motor(folders.motors / (name + ".toml")));
  }
  if (has(folders.robots)) {
    return description_of(robot::read_robot(folders.robots / (name + ".toml")));
  }
  if (has(folders.duties)) {
    return description_of(duty::read_duty(folders.duties / (name + ".toml")));
  }
  for (const thermal::EffectType& effect : thermal::all_effects()) {
    known.emplace_back(effect.name);
  }
  if (name == "motors" || name == "robots" || name == "duties" || name == "effects") {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("'{0}' is not one name: `heatsoak list {0}` lists the names, `heatsoak describe NAME` describes one of them", name));
  }
  throw base::Failure(base::ExitCode::bad_input,
                      fmt::format("there is no '{}' among motors, robots, duties, shapes, effects, thresholds and verdict{}", name,
                                  base::did_you_mean(name, known)));
}

}  // namespace

Command describe() {
  return {.name = {},
          .summary = "Describes a motor, robot, duty, duty shape, effect, threshold or verdict: values with origin, equations, sources",
          .example = "heatsoak describe maxon_ecx_flat_32l_48v",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto name = std::make_shared<std::string>();
            const auto diagram = std::make_shared<std::string>();
            app.add_option("name", *name, "id, as `heatsoak list` shows it, a motor, robot or duty file, or robot_core")->required();
            app.add_option("--diagram", *diagram, "picture of the block diagram of robot_core")
                ->check([](const std::string& file) { return file.ends_with(".svg") ? "" : "expected a name that ends in .svg"; })
                ->type_name("FILE.svg");
            session.add_data_option(app);
            session.add_answer_options(app);
            return [name, diagram, &session] {
              Description description = describe(*name, session.folders());
              if (!diagram->empty()) {
                if (*name != kCore) {
                  throw base::Failure(base::ExitCode::bad_input,
                                      fmt::format("--diagram: '{}' has no block diagram; expected `heatsoak describe {}`", *name, kCore));
                }
                session.write(*diagram, firmware::core_diagram_svg());
                description.document.add_file(*diagram);
              }
              session.show(description.document);
              Json json{{"schema", "heatsoak.describe/1"}};
              json.update(description.json);
              session.answer(json);
              return base::ExitCode::done;
            };
          }};
}

}  // namespace heatsoak::cli::commands
