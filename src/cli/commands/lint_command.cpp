#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "duty/duty.h"
#include "input/document.h"
#include "motor/lint.h"
#include "motor/motor.h"
#include "robot/robot.h"

namespace heatsoak::commands {
namespace {

/// Reads the file as what its keys say it is; the findings of a motor's figures are the lint proper.
std::vector<LintFinding> look_into(const std::filesystem::path& file) {
  const Value root = read_toml(file);
  const auto names_a_shape = [&](const ShapeType& shape) { return root.find(shape.name) != nullptr; };
  if (root.find("shape") || std::ranges::any_of(all_shapes(), names_a_shape)) {
    read_duty(file);
    return {};
  }
  if (root.find("wheels") || root.find("drive")) {
    read_robot(file);
    return {};
  }
  return lint(read_motor(file));
}

ExitCode run(const std::vector<std::string>& files, Session& session) {
  std::vector<Diagnostic> unreadable;
  std::string text;
  nlohmann::ordered_json findings = nlohmann::ordered_json::array();
  std::size_t errors = 0;
  for (const std::string& file : files) {
    try {
      for (const LintFinding& each : look_into(file)) {
        const bool is_error = each.level == LintFinding::Level::error;
        errors += is_error ? 1 : 0;
        text += fmt::format("{}:{}:{}: {}: {}: {}\n", each.at.file, each.at.line, each.at.column, is_error ? "error" : "note", each.check,
                            each.message);
        findings.push_back({{"file", each.at.file},
                            {"line", each.at.line},
                            {"column", each.at.column},
                            {"level", is_error ? "error" : "note"},
                            {"check", each.check},
                            {"message", each.message}});
      }
    } catch (const Failure& failure) {
      unreadable.insert(unreadable.end(), failure.diagnostics().begin(), failure.diagnostics().end());
    }
  }
  if (!unreadable.empty()) {
    throw Failure(ExitCode::bad_input, "", std::move(unreadable));
  }
  session.say(text + fmt::format("{} file{}: {}\n", files.size(), files.size() == 1 ? "" : "s",
                                 errors == 0 ? "sound" : fmt::format("{} errors", errors)));
  session.answer({{"schema", "heatsoak.lint/1"}, {"files", files}, {"errors", errors}, {"findings", findings}});
  return errors == 0 ? ExitCode::done : ExitCode::limit_exceeded;
}

}  // namespace

Command lint_command() {
  return {
      .name = {},
      .summary = "Checks motor, robot and duty files: keys, units, and whether a data sheet's figures agree with each other; exit 1 if not",
      .example = "heatsoak lint motor_db/maxon_ec45_flat_70w_24v.toml",
      .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
        const auto files = std::make_shared<std::vector<std::string>>();
        app.add_option("files", *files, "TOML files")->required()->type_name("FILE");
        session.add_json_option(app);
        return [files, &session] { return run(*files, session); };
      }};
}

}  // namespace heatsoak::commands
