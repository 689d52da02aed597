// Resolves names on the command line to motors, robots and duties: ids, or paths of the user's files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "duty/duty.h"
#include "duty/file_kind.h"
#include "input/data_folders.h"
#include "motor/motor.h"
#include "robot/robot.h"

namespace heatsoak::duty {

/// Reads files one after the other and collects the problems of all of them.
class NamedFiles {
 public:
  explicit NamedFiles(input::DataFolders folders) : folders_(std::move(folders)) {}

  /// Returns nothing if there is a problem, which throw_if_any() then reports. Contradicting values of a motor or robot are a problem, too
  /// (require_sound()), because verdicts and firmware need consistent ones.
  std::optional<motor::Motor> motor(const std::string& name);
  /// Returns the motor as its file states it, even with contradicting values; for commands that measure the motor.
  std::optional<motor::Motor> motor_as_written(const std::string& name);
  std::optional<robot::Robot> robot(const std::string& name);
  std::optional<Duty> duty(const std::string& name);
  std::optional<std::filesystem::path> motor_file(const std::string& name);
  /// Throws Failure (bad_input) with all problems; does nothing if there are none.
  void throw_if_any() const;

  [[nodiscard]] const input::DataFolders& folders() const { return folders_; }

 private:
  /// Returns the path of that name; throws if the file is of another kind.
  [[nodiscard]] std::filesystem::path file(FileKind kind, const std::string& name) const;
  template <class Read>
  auto attempt(const Read& read) -> std::optional<decltype(read())>;

  input::DataFolders folders_;
  std::vector<base::Failure> problems_;
};

/// Read a single file with the same checks; the motor as in motor_as_written(). Throw Failure (bad_input).
motor::Motor motor_named(const input::DataFolders& folders, const std::string& name);
/// Returns the robot's own motor, or nothing if its file is missing or wrong.
std::optional<motor::Motor> own_motor(const input::DataFolders& folders, const robot::Robot& robot);
robot::Robot robot_named(const input::DataFolders& folders, const std::string& name);

}  // namespace heatsoak::duty
