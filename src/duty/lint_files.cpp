#include "duty/lint_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "duty/duty.h"
#include "duty/file_kind.h"
#include "input/document.h"
#include "motor/read_motor.h"
#include "robot/robot.h"
#include "robot/robot_lint.h"

namespace heatsoak::duty {
namespace {

/// Reads the file as the kind that its keys indicate and returns its findings.
std::vector<motor::LintFinding> look_into(const std::filesystem::path& file, const input::DataFolders& folders) {
  if (file.extension() == ".csv") {
    throw base::bad_input({file.string()}, "", "is a table; expected a TOML file. `heatsoak log inspect FILE` checks a measured log");
  }
  switch (file_kind(file)) {
    case FileKind::duty:
      read_duty(file);
      return {};
    case FileKind::robot:
      return robot::lint(robot::read_robot(file), input::ids_in(folders.motors));
    case FileKind::motor:
      break;
  }
  base::Diagnostics problems;
  const motor::Motor motor = motor::read_motor(file, problems);
  if (problems.empty()) {
    std::vector<motor::LintFinding> findings = motor::lint(motor);
    if (!motor.nominal.rotor_inertia_kg_m2) {
      const std::string key = "rotor_inertia";
      findings.push_back(
          {motor::LintFinding::Level::note, "motion",
           motor::LintClause{motor::LintWords::rotor_inertia_missing, {motor::LintClause{motor::LintWords::closed_loop_needs_it}}},
           input::place_of(file, key), key});
    }
    return findings;
  }
  motor::add_lint_errors(motor, problems);
  problems.throw_if_any();
  return {};
}

/// Returns the file itself, every file of a folder, or the file of an id.
std::vector<std::string> files_named(const std::string& name, const input::DataFolders& folders) {
  std::vector<std::string> files;
  std::error_code unreachable;  // reading the file then reports the reason
  if (std::filesystem::is_directory(name, unreachable)) {
    for (const std::string& id : input::ids_in(name)) {
      files.push_back((std::filesystem::path(name) / fmt::format("{}.toml", id)).string());
    }
    if (files.empty()) {
      throw base::Failure(base::ExitCode::bad_input, fmt::format("there is no .toml file in the folder {}", name));
    }
    return files;
  }
  if (name.find('/') != std::string::npos || name.ends_with(".toml") || std::filesystem::exists(name, unreachable)) {
    return {name};
  }
  std::vector<std::string> known;
  for (const std::filesystem::path& folder : {folders.motors, folders.robots, folders.duties}) {
    for (const std::string& id : input::ids_in(folder)) {
      known.push_back(id);
      if (id == name) {
        files.push_back((folder / fmt::format("{}.toml", id)).string());
      }
    }
  }
  if (files.empty()) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("'{}' is not a file, folder, motor, robot or duty{}", name, base::did_you_mean(name, known)));
  }
  return files;
}

}  // namespace

std::size_t FilesLint::count(motor::LintFinding::Level level) const {
  return static_cast<std::size_t>(std::ranges::count(findings, level, &motor::LintFinding::level));
}

FilesLint lint_files(std::span<const std::string> names, const input::DataFolders& folders) {
  FilesLint result;
  std::vector<base::Diagnostic> unreadable;
  std::string unknown;
  bool is_any_readable = false;
  for (const std::string& name : names) {
    try {
      const std::vector<std::string> named = files_named(name, folders);
      result.files.insert(result.files.end(), named.begin(), named.end());
    } catch (const base::Failure& failure) {
      unknown += fmt::format("{}{}", unknown.empty() ? "" : "\n", failure.message());
      unreadable.insert(unreadable.end(), failure.diagnostics().begin(), failure.diagnostics().end());
    }
  }
  for (const std::string& file : result.files) {
    try {
      std::vector<motor::LintFinding> found = look_into(file, folders);
      std::ranges::stable_sort(found, {}, [](const motor::LintFinding& each) { return std::tuple(each.at.line, each.at.column); });
      result.findings.insert(result.findings.end(), found.begin(), found.end());
      is_any_readable = true;
    } catch (const base::Failure& failure) {
      unreadable.insert(unreadable.end(), failure.diagnostics().begin(), failure.diagnostics().end());
    }
  }
  if (!unreadable.empty() || !unknown.empty()) {
    result.unreadable.emplace(base::ExitCode::bad_input, std::move(unknown), std::move(unreadable));
    if (!is_any_readable) {
      throw base::Failure(*result.unreadable);
    }
  }
  std::ranges::stable_sort(result.findings, {}, &motor::LintFinding::level);
  return result;
}

}  // namespace heatsoak::duty
