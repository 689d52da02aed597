#include "present/list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/effect_topic.h"
#include "cli/threshold_topic.h"
#include "cli/verdict_topic.h"
#include "derate/exporter.h"
#include "duty/duty.h"
#include "duty/log_type.h"
#include "motor/motor.h"
#include "present/renderer.h"
#include "robot/robot.h"
#include "thermal/effect.h"

namespace heatsoak::cli::commands {
namespace {

/// Throws if the folder has no files: that indicates a wrong --db.
std::vector<std::string> some_ids_in(const std::filesystem::path& folder) {
  std::vector<std::string> ids = input::ids_in(folder);
  if (ids.empty()) {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("there is no .toml file in {}", folder.string()));
  }
  return ids;
}

using Rows = std::vector<present::NamedThing>;

/// Returns the first sentence; `describe` shows the rest.
std::string first_sentence(std::string_view text) {
  const std::size_t end = text.find(". ");
  return std::string(text.substr(0, end == std::string_view::npos ? end : end + 1));
}

Rows motors(const input::DataFolders& folders) {
  Rows result;
  for (const std::string& id : some_ids_in(folders.motors)) {
    const motor::Motor motor = motor::read_motor(folders.motors / (id + ".toml"));
    result.push_back({id, fmt::format("{} {} ({} thermal data)", motor.manufacturer, motor.name, motor::data_quality(motor))});
  }
  return result;
}

Rows robots(const input::DataFolders& folders) {
  Rows result;
  for (const std::string& id : some_ids_in(folders.robots)) {
    const robot::Robot robot = robot::read_robot(folders.robots / (id + ".toml"));
    result.push_back({id, fmt::format("{}, drives with {}", robot.name, robot.drive.motor)});
  }
  return result;
}

Rows duties(const input::DataFolders& folders) {
  Rows result;
  for (const std::string& id : some_ids_in(folders.duties)) {
    result.push_back({id, duty::read_duty(folders.duties / (id + ".toml")).summary});
  }
  return result;
}

Rows rows_of(const std::vector<Topic>& topics) {
  Rows result;
  for (const Topic& topic : topics) {
    result.push_back({topic.id, topic.summary});
  }
  return result;
}

Rows effects(const input::DataFolders& /*folders*/) {
  Rows result;
  for (const thermal::EffectType& effect : thermal::all_effects()) {
    result.push_back({std::string(effect.name), first_sentence(effect.summary)});
  }
  std::ranges::move(rows_of(all_topics()), std::back_inserter(result));
  return result;
}

Rows thresholds(const input::DataFolders& /*folders*/) { return rows_of(threshold_topics()); }

Rows formats(const input::DataFolders& /*folders*/) {
  Rows result;
  for (const duty::ShapeType& shape : duty::all_shapes()) {
    result.push_back({std::string(shape.name), fmt::format("duty: {}", shape.summary)});
  }
  for (const duty::LogType& log : duty::all_logs()) {
    result.push_back({std::string(log.name), fmt::format("recorded game: {}; duty --import LOG", log.summary)});
  }
  for (const derate::ExporterType& exporter : derate::all_exporters()) {
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
  return result;
}

/// Returns everything that `describe` explains.
Rows topics(const input::DataFolders& folders) {
  Rows result;
  for (const auto& rows : {motors, robots, duties, effects, thresholds}) {
    std::ranges::move(rows(folders), std::back_inserter(result));
  }
  for (const duty::ShapeType& shape : duty::all_shapes()) {
    result.push_back({std::string(shape.name), fmt::format("duty shape: {}", shape.summary)});
  }
  result.push_back({"verdict", verdict_topic().summary});
  result.push_back({"robot_core", "the blocks of the drive core and their signals"});
  return result;
}

struct Kind {
  std::string_view name;
  Rows (*rows)(const input::DataFolders& folders);
};
constexpr std::array<Kind, 7> kKinds{{{"motors", motors},
                                      {"robots", robots},
                                      {"duties", duties},
                                      {"effects", effects},
                                      {"formats", formats},
                                      {"thresholds", thresholds},
                                      {"topics", topics}}};

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  std::ranges::transform(kKinds, std::back_inserter(names), [](const Kind& kind) { return std::string(kind.name); });
  return names;
}

base::ExitCode run(const std::string& what, Session& session) {
  if (what.empty()) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("the kind of names to list is missing\nexpected one of {}\n`heatsoak list motors` lists the motors",
                                    fmt::join(kind_names(), ", ")));
  }
  const std::vector<present::NamedThing> all = std::ranges::find(kKinds, what, &Kind::name)->rows(session.folders());
  session.show(present::list_document(all));
  session.answer(present::list_json(what, all));
  return base::ExitCode::done;
}

}  // namespace

Command list() {
  return {
      .name = {},
      .summary = "Lists motors, robots, duties, effects, formats, thresholds of checks, or topics of describe",
      .example = "heatsoak list motors",
      .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
        const auto what = std::make_shared<std::string>();
        app.add_option("kind", *what, "kind of names; topics: all that `heatsoak describe` explains")->check(CLI::IsMember(kind_names()));
        session.add_data_option(app);
        session.add_answer_options(app);
        return [what, &session] { return run(*what, session); };
      }};
}

}  // namespace heatsoak::cli::commands
