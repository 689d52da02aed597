// Where motors, robots and duties are found.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak {

/// The folders of data files; the stem of a file is the id of what it holds.
struct DataFolders {
  std::filesystem::path motors;
  std::filesystem::path robots;
  std::filesystem::path duties;
  std::filesystem::path shipped;  ///< what the names of logs that came with the program begin from

  /// Looks beside the program: the installed share/heatsoak, or the source tree that holds the build folder.
  /// `database`, where not empty, is used instead: a folder that holds motor_db/, or itself a motor_db folder.
  /// Throws Failure (bad_input) where nothing is found.
  static DataFolders find(const std::filesystem::path& database);
};

/// Stems of the *.toml files of a folder, sorted.
std::vector<std::string> ids_in(const std::filesystem::path& folder);

/// The file of `name` in the folder; a name with a '/' or ending in ".toml" is a path of the user's own.
/// Throws Failure (bad_input) with "did you mean". `kind` is for the message: "motor".
std::filesystem::path file_of(const std::filesystem::path& folder, std::string_view kind, std::string_view name);

/// A log of the user's own or, where there is none of that name here, the one that came with the program.
std::filesystem::path log_named(const DataFolders& folders, const std::filesystem::path& name);

}  // namespace heatsoak
