// Locates the files of motors, robots, duties and logs.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::input {

/// The folders of data files. The stem of a file is the id of the motor, robot or duty.
struct DataFolders {
  std::filesystem::path motors;
  std::filesystem::path robots;
  std::filesystem::path duties;
  std::filesystem::path shipped;  ///< base folder for the relative names of logs that came with the program

  /// Searches beside the program: the installed share/heatsoak, or the source tree that contains the build folder. A non-empty `database`
  /// takes precedence for the folders it contains; it holds motor_db/, or is itself a motor_db folder. Throws Failure (bad_input) if a
  /// folder is not found.
  static DataFolders find(const std::filesystem::path& database);
};

/// Returns the stems of the *.toml files in a folder, sorted; empty if the folder cannot be read.
std::vector<std::string> ids_in(const std::filesystem::path& folder);

/// Returns whether a name is the path of a file, not an id: it has a '/' or ends in ".toml".
bool is_path(std::string_view name);

/// Returns the path of the file `name` in the folder. A path (is_path()) or an existing CSV file is returned as it is. Throws Failure (bad_input) with "did you mean" for an unknown name. `kind` is used in the message: "motor".
std::filesystem::path file_of(const std::filesystem::path& folder, std::string_view kind, std::string_view name);

/// Returns `name`, or the log shipped with the program if `name` is relative and exists only there.
std::filesystem::path log_named(const DataFolders& folders, const std::filesystem::path& name);

}  // namespace heatsoak::input
