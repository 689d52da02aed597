// Lint of motor, robot and duty files by name.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "input/data_folders.h"
#include "motor/lint.h"

namespace heatsoak::duty {

struct FilesLint {
  std::vector<std::string> files;            ///< checked files
  std::vector<motor::LintFinding> findings;  ///< errors, then warnings, then notes; each in the order of files and lines

  [[nodiscard]] std::size_t count(motor::LintFinding::Level level) const;
};

/// Checks files, folders of them, and ids of motors, robots and duties. Throws Failure (bad_input) with every problem if a name is unknown
/// or a file cannot be read.
FilesLint lint_files(std::span<const std::string> names, const input::DataFolders& folders);

}  // namespace heatsoak::duty
