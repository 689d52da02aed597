#include <CLI/App.hpp>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "duty/lint_files.h"
#include "present/lint.h"

namespace heatsoak::cli::commands {
namespace {

base::ExitCode run(const std::vector<std::string>& names, Session& session) {
  const duty::FilesLint lint = duty::lint_files(names, session.folders());
  session.show(present::lint_document(lint));
  if (lint.unreadable) {
    return lint.unreadable->code();
  }
  return lint.count(motor::LintFinding::Level::error) + lint.count(motor::LintFinding::Level::warning) == 0
             ? base::ExitCode::done
             : base::ExitCode::limit_exceeded;
}

}  // namespace

Command lint_command() {
  return {
      .name = {},
      .summary =
          "Checks motor, robot and duty files: keys, units, and whether the values of a data sheet agree with each other; exit 1 if there "
          "is a "
          "warning or an error",
      .example = "heatsoak lint maxon_ec45_flat_70w_24v roboteam_twente_v2024 division_a_match",
      .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
        const auto files = std::make_shared<std::vector<std::string>>();
        app.add_option("files", *files, "TOML files, folders of them, or ids of motors, robots and duties")->required()->type_name("FILE");
        session.add_data_option(app);
        session.add_answer_options(app);
        return [files, &session] { return run(*files, session); };
      }};
}

}  // namespace heatsoak::cli::commands
