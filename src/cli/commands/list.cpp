#include <fmt/format.h>

#include <CLI/App.hpp>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/effect_topic.h"
#include "cli/threshold_topic.h"
#include "derate/exporter.h"
#include "duty/duty.h"
#include "duty/log_type.h"
#include "motor/motor.h"
#include "present/renderer.h"
#include "robot/robot.h"
#include "thermal/effect.h"

namespace heatsoak::commands {
namespace {

struct Row {
  std::string id;
  std::string summary;
};

/// Throws if the folder has no files: that indicates a wrong --db.
std::vector<std::string> some_ids_in(const std::filesystem::path& folder) {
  std::vector<std::string> ids = ids_in(folder);
  if (ids.empty()) {
    throw Failure(ExitCode::bad_input, fmt::format("there is no .toml file in {}", folder.string()));
  }
  return ids;
}

std::vector<Row> rows(const std::string& what, const DataFolders& folders) {
  std::vector<Row> result;
  if (what == "motors") {
    for (const std::string& id : some_ids_in(folders.motors)) {
      const Motor motor = read_motor(folders.motors / (id + ".toml"));
      result.push_back({id, fmt::format("{} {} ({} thermal data)", motor.manufacturer, motor.name, data_quality(motor))});
    }
  } else if (what == "robots") {
    for (const std::string& id : some_ids_in(folders.robots)) {
      const Robot robot = read_robot(folders.robots / (id + ".toml"));
      result.push_back({id, fmt::format("{}, drives with {}", robot.name, robot.drive.motor)});
    }
  } else if (what == "duties") {
    for (const std::string& id : some_ids_in(folders.duties)) {
      result.push_back({id, read_duty(folders.duties / (id + ".toml")).summary});
    }
  } else if (what == "effects") {
    for (const EffectType& effect : all_effects()) {
      // First sentence only; `describe` shows the rest.
      const std::size_t end = effect.summary.find(". ");
      result.push_back({std::string(effect.name), std::string(effect.summary.substr(0, end == std::string_view::npos ? end : end + 1))});
    }
    for (const Topic& topic : all_topics()) {
      result.push_back({topic.id, topic.summary});
    }
  } else if (what == "thresholds") {
    for (const Topic& topic : threshold_topics()) {
      result.push_back({topic.id, topic.summary});
    }
  } else {
    for (const ShapeType& shape : all_shapes()) {
      result.push_back({std::string(shape.name), fmt::format("duty: {}", shape.summary)});
    }
    for (const LogType& log : all_logs()) {
      result.push_back({std::string(log.name), fmt::format("recorded game: {}; duty --import LOG", log.summary)});
    }
    for (const ExporterType& exporter : all_exporters()) {
      result.push_back({std::string(exporter.name), fmt::format("derating: {}; derate --to {}", exporter.summary, exporter.name)});
    }
    result.push_back({"svg", "picture: --plot FILE.svg"});
    result.push_back({"png", "picture: --plot FILE.png"});
    for (const present::Renderer& renderer : present::all_renderers()) {
      result.push_back({std::string(renderer.name),
                        fmt::format("answer: {}{}", renderer.summary,
                                    renderer.file_ending.empty() ? "" : fmt::format("; --report FILE{}", renderer.file_ending))});
    }
    result.push_back({"json", "answer: --json FILE"});
    result.push_back({"csv", "trace: simulate --out FILE.csv"});
  }
  return result;
}

ExitCode run(const std::string& what, Session& session) {
  if (what.empty()) {
    throw Failure(ExitCode::bad_input,
                  "the kind of names to list is missing; expected one of motors, robots, duties, effects, formats, thresholds: `heatsoak "
                  "list motors`");
  }
  const std::vector<Row> all = rows(what, session.folders());
  std::string text;
  nlohmann::ordered_json items = nlohmann::ordered_json::array();
  for (const Row& row : all) {
    text += fmt::format("{:34} {}\n", row.id, row.summary);
    items.push_back({{"id", row.id}, {"summary", row.summary}});
  }
  session.say(text);
  session.answer({{"schema", "heatsoak.list/1"}, {"kind", what}, {"items", items}});
  return ExitCode::done;
}

}  // namespace

Command list() {
  return {.name = {},
          .summary = "Lists what there is: motors, robots, duties, effects, formats or thresholds of checks",
          .example = "heatsoak list motors",
          .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
            const auto what = std::make_shared<std::string>();
            app.add_option("kind", *what, "motors, robots, duties, effects, formats or thresholds")
                ->check(CLI::IsMember({"motors", "robots", "duties", "effects", "formats", "thresholds"}));
            session.add_data_option(app);
            session.add_json_option(app);
            return [what, &session] { return run(*what, session); };
          }};
}

}  // namespace heatsoak::commands
