#include "duty/named_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "motor/default_spread.h"
#include "robot/robot_lint.h"

namespace heatsoak::duty {

namespace {

/// States how to use a table in place of a TOML file.
std::string csv_words(FileKind kind) {
  const std::string begin = fmt::format("is a CSV table; expected a {} file (TOML)", to_string(kind));
  return kind == FileKind::duty ? begin +
                                      " with shape = \"recorded\" that names the table, see `heatsoak describe recorded`; `heatsoak duty "
                                      "--import` writes both from the log of a game"
                                : begin;
}

}  // namespace

template <class Read>
auto NamedFiles::attempt(const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const base::Failure& failure) {
    if (failure.code() != base::ExitCode::bad_input) {
      throw;
    }
    problems_.push_back(failure);
    return std::nullopt;
  }
}

std::optional<motor::Motor> NamedFiles::motor(const std::string& name) {
  return attempt([&] { return motor::read_sound_motor(file(FileKind::motor, name)); });
}

std::optional<motor::Motor> NamedFiles::motor_as_written(const std::string& name) {
  return attempt([&] { return motor::read_motor(file(FileKind::motor, name)); });
}

std::optional<robot::Robot> NamedFiles::robot(const std::string& name) {
  return attempt([&] { return robot::read_sound_robot(file(FileKind::robot, name)); });
}

std::optional<Duty> NamedFiles::duty(const std::string& name) {
  return attempt([&] { return read_duty(file(FileKind::duty, name)); });
}

std::optional<std::filesystem::path> NamedFiles::motor_file(const std::string& name) {
  return attempt([&] { return file(FileKind::motor, name); });
}

void NamedFiles::throw_if_any() const {
  std::string message;
  std::vector<base::Diagnostic> diagnostics;
  std::vector<std::string> reported;
  for (const base::Failure& each : problems_) {
    if (std::ranges::find(reported, each.what()) != reported.end()) {
      continue;
    }
    reported.emplace_back(each.what());
    message += (message.empty() || each.message().empty() ? "" : "\n") + each.message();
    diagnostics.insert(diagnostics.end(), each.diagnostics().begin(), each.diagnostics().end());
  }
  if (!problems_.empty()) {
    throw base::Failure(base::ExitCode::bad_input, std::move(message), std::move(diagnostics));
  }
}

std::filesystem::path NamedFiles::file(FileKind kind, const std::string& name) const {
  const std::filesystem::path& folder = kind == FileKind::motor   ? folders_.motors
                                        : kind == FileKind::robot ? folders_.robots
                                                                  : folders_.duties;
  std::filesystem::path path = input::file_of(folder, to_string(kind), name);
  if (path.string() != name) {
    return path;  // an id: the folder determines the kind
  }
  if (std::error_code error; path.extension() == ".csv" && std::filesystem::exists(path, error)) {
    throw base::bad_input({name}, "", csv_words(kind));
  }
  const FileKind found = evident_kind(input::read_toml(path)).value_or(kind);
  if (found != kind) {
    throw base::bad_input(
        {name}, "",
        fmt::format("is a {} file; expected a {} file here (`heatsoak list {}` shows those that are there)", to_string(found),
                    to_string(kind), kind == FileKind::duty ? "duties" : fmt::format("{}s", to_string(kind))));
  }
  return path;
}

motor::Motor motor_named(const input::DataFolders& folders, const std::string& name) {
  NamedFiles named(folders);
  const std::optional<motor::Motor> motor = named.motor_as_written(name);
  named.throw_if_any();
  return *motor;
}

std::optional<motor::Motor> own_motor(const input::DataFolders& folders, const robot::Robot& robot) {
  return NamedFiles(folders).motor_as_written(robot.drive.motor_name());
}

robot::Robot robot_named(const input::DataFolders& folders, const std::string& name) {
  NamedFiles named(folders);
  const std::optional<robot::Robot> robot = named.robot(name);
  named.throw_if_any();
  return *robot;
}

}  // namespace heatsoak::duty
