#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>

#include "cli/command.h"
#include "firmware/core_diagram.h"
#include "present/topics.h"

namespace heatsoak::cli::commands {
namespace {

base::ExitCode run(const std::string& name, const std::string& diagram, Session& session) {
  const present::Document document = present::description_of(name, session.folders());
  if (!diagram.empty()) {
    if (name != present::kCoreTopic) {
      throw base::Failure(base::ExitCode::bad_input,
                          fmt::format("--diagram: '{}' has no block diagram; expected `heatsoak describe {}`", name, present::kCoreTopic));
    }
    session.write(diagram, firmware::core_diagram_svg());
  }
  session.show(document);
  return base::ExitCode::done;
}

}  // namespace

Command describe() {
  return {.name = {},
          .summary = "Describes a motor, robot, duty, shape, effect, threshold, signal or verdict: values with origin, equations, sources",
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
            return [name, diagram, &session] { return run(*name, *diagram, session); };
          }};
}

}  // namespace heatsoak::cli::commands
