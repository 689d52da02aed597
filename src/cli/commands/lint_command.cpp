#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "duty/duty.h"
#include "duty/file_kind.h"
#include "input/document.h"
#include "motor/lint.h"
#include "motor/motor.h"
#include "motor/read_motor.h"
#include "present/lint.h"
#include "robot/robot.h"
#include "robot/robot_lint.h"

namespace heatsoak::commands {
namespace {

/// Reads the file as the kind that its keys indicate and returns its findings.
std::vector<LintFinding> look_into(const std::filesystem::path& file, const DataFolders& folders) {
  switch (file_kind(file)) {
    case FileKind::duty:
      read_duty(file);
      return {};
    case FileKind::robot:
      return lint(read_robot(file), ids_in(folders.motors));
    case FileKind::motor:
      break;
  }
  Diagnostics problems;
  const Motor motor = read_motor(file, problems);
  if (problems.empty()) {
    return lint(motor);
  }
  add_lint_errors(motor, problems);
  problems.throw_if_any();
  return {};
}

/// Returns the file itself, every file of a folder, or the file of an id.
std::vector<std::string> files_named(const std::string& name, const Session& session) {
  std::vector<std::string> files;
  std::error_code unreachable;  // reading the file then reports the reason
  if (std::filesystem::is_directory(name, unreachable)) {
    for (const std::string& id : ids_in(name)) {
      files.push_back((std::filesystem::path(name) / (id + ".toml")).string());
    }
    if (files.empty()) {
      throw Failure(ExitCode::bad_input, fmt::format("there is no .toml file in the folder {}", name));
    }
    return files;
  }
  if (name.find('/') != std::string::npos || name.ends_with(".toml") || std::filesystem::exists(name, unreachable)) {
    return {name};
  }
  const DataFolders folders = session.folders();
  std::vector<std::string> known;
  for (const std::filesystem::path& folder : {folders.motors, folders.robots, folders.duties}) {
    for (const std::string& id : ids_in(folder)) {
      known.push_back(id);
      if (id == name) {
        files.push_back((folder / (id + ".toml")).string());
      }
    }
  }
  if (files.empty()) {
    throw Failure(ExitCode::bad_input, fmt::format("'{}' is not a file, folder, motor, robot or duty{}", name, did_you_mean(name, known)));
  }
  return files;
}

ExitCode run(const std::vector<std::string>& names, Session& session) {
  std::vector<std::string> files;
  std::vector<Diagnostic> unreadable;
  std::string unknown;
  for (const std::string& name : names) {
    try {
      const std::vector<std::string> named = files_named(name, session);
      files.insert(files.end(), named.begin(), named.end());
    } catch (const Failure& failure) {
      unknown += (unknown.empty() ? "" : "\n") + failure.message();
      unreadable.insert(unreadable.end(), failure.diagnostics().begin(), failure.diagnostics().end());
    }
  }
  const DataFolders folders = session.folders();
  std::vector<LintFinding> found;
  nlohmann::ordered_json findings = nlohmann::ordered_json::array();
  for (const std::string& file : files) {
    try {
      for (const LintFinding& each : look_into(file, folders)) {
        found.push_back(each);
        findings.push_back({{"file", each.at.file},
                            {"line", each.at.line},
                            {"column", each.at.column},
                            {"level", to_string(each.level)},
                            {"check", each.check},
                            {"message", each.message}});
      }
    } catch (const Failure& failure) {
      unreadable.insert(unreadable.end(), failure.diagnostics().begin(), failure.diagnostics().end());
    }
  }
  if (!unreadable.empty() || !unknown.empty()) {
    throw Failure(ExitCode::bad_input, std::move(unknown), std::move(unreadable));
  }
  const auto errors = std::ranges::count(found, LintFinding::Level::error, &LintFinding::level);
  const auto warnings = std::ranges::count(found, LintFinding::Level::warning, &LintFinding::level);
  session.show(present::lint_document(found, files.size()));
  session.answer({{"schema", "heatsoak.lint/1"}, {"files", files}, {"errors", errors}, {"warnings", warnings}, {"findings", findings}});
  return errors + warnings == 0 ? ExitCode::done : ExitCode::limit_exceeded;
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
      .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
        const auto files = std::make_shared<std::vector<std::string>>();
        app.add_option("files", *files, "TOML files, folders of them, or ids of motors, robots and duties")->required()->type_name("FILE");
        session.add_data_option(app);
        session.add_answer_options(app);
        return [files, &session] { return run(*files, session); };
      }};
}

}  // namespace heatsoak::commands
