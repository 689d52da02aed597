// Lint of motor, robot and duty files by name.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "input/data_folders.h"
#include "motor/lint.h"

namespace heatsoak::duty {

struct FilesLint {
  std::vector<std::string> files;                ///< checked files
  std::vector<motor::LintFinding> findings;      ///< errors, then warnings, then notes; each in the order of files and lines
  std::optional<base::Failure> unreadable = {};  ///< problems of the names and files that cannot be read, if others can

  [[nodiscard]] std::size_t count(motor::LintFinding::Level level) const;
};

/// Checks files, folders of them, and ids of motors, robots and duties. Throws Failure (bad_input) with every problem if none of them can
/// be read.
FilesLint lint_files(std::span<const std::string> names, const input::DataFolders& folders);

}  // namespace heatsoak::duty
