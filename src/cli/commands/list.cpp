#include "present/list.h"

#include <CLI/App.hpp>
#include <memory>

#include "cli/command.h"

namespace heatsoak::cli::commands {

Command list() {
  return {.name = {},
          .summary = "Lists motors, robots, duties, effects, formats, thresholds of checks, or topics of describe",
          .example = "heatsoak list motors",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto kind = std::make_shared<std::string>();
            app.add_option("kind", *kind, "kind of names; topics: all that `heatsoak describe` explains")
                ->check(CLI::IsMember(present::listed_kinds()));
            session.add_data_option(app);
            session.add_answer_options(app);
            return [kind, &session] {
              session.show(present::list_document(*kind, session.folders()));
              return base::ExitCode::done;
            };
          }};
}

}  // namespace heatsoak::cli::commands
