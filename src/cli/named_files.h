// Motors, robots and duties by the names that a command line gives them: ids, or files of the user's own.
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

namespace heatsoak {

/// Reads them one after the other; what is wrong with one does not hide what is wrong with the next.
class NamedFiles {
 public:
  explicit NamedFiles(DataFolders folders) : folders_(std::move(folders)) {}

  /// Nothing where there is a problem, which throw_if_any() then tells. A motor whose values contradict each other is one
  /// (require_sound()): verdicts and firmware need one that can be.
  std::optional<Motor> motor(const std::string& name);
  /// As its file has it, contradictions included: for verbs that measure the motor.
  std::optional<Motor> motor_as_written(const std::string& name);
  std::optional<Robot> robot(const std::string& name);
  std::optional<Duty> duty(const std::string& name);
  std::optional<std::filesystem::path> motor_file(const std::string& name);
  /// Throws Failure (bad_input) with every problem.
  void throw_if_any() const;

  [[nodiscard]] const DataFolders& folders() const { return folders_; }

 private:
  /// The file of that name; throws where it describes something else.
  [[nodiscard]] std::filesystem::path file(FileKind kind, const std::string& name) const;
  template <class Read>
  auto attempt(const Read& read) -> std::optional<decltype(read())>;

  DataFolders folders_;
  std::vector<Failure> problems_;
};

/// One alone, with the same problems; the motor as its file has it.
Motor motor_named(const DataFolders& folders, const std::string& name);
Robot robot_named(const DataFolders& folders, const std::string& name);

}  // namespace heatsoak
