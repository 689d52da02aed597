#include "present/list.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/help_page.h"
#include "cli/quantity_option.h"

namespace heatsoak::cli::commands {
namespace {

/// Returns the tables of all verbs, as their help describes them.
std::vector<present::TableOutput> table_outputs(const CLI::App& program) {
  std::vector<present::TableOutput> all;
  for (const HelpPage& page : help_pages(program)) {
    for (const HelpOption& option : page.options) {
      if (option.value == fmt::format("FILE{}", kTableEnding)) {
        all.push_back({std::string(kTableEnding), option.meaning.substr(0, option.meaning.find(';')),
                       fmt::format("{} {}", page.verb, option.names.front())});
      }
    }
  }
  return all;
}

}  // namespace

Command list() {
  return {.name = {},
          .summary = "Lists motors, robots, duties, effects, formats, thresholds of checks, signals, or topics of describe",
          .example = "heatsoak list motors",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto kind = std::make_shared<std::string>();
            app.add_option("kind", *kind, "kind of names; topics: all that `heatsoak describe` explains")
                ->check(CLI::IsMember(present::listed_kinds()));
            session.add_data_option(app);
            session.add_answer_options(app);
            return [kind, &app, &session] {
              session.show(present::list_document(*kind, session.folders(), table_outputs(*app.get_parent())));
              return base::ExitCode::done;
            };
          }};
}

}  // namespace heatsoak::cli::commands
