#include "input/data_folders.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/diagnostic.h"

namespace heatsoak::input {
namespace fs = std::filesystem;
namespace {

DataFolders source_tree(const fs::path& root) { return {root / "motor_db", root / "robot_core" / "robots", root / "duty_profiles", root}; }

DataFolders installed(const fs::path& share) { return {share / "motor_db", share / "robots", share / "duty_profiles", share}; }

/// Never throws; a folder without permission counts as missing.
bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool complete(const DataFolders& folders) { return is_folder(folders.motors) && is_folder(folders.robots) && is_folder(folders.duties); }

DataFolders beside_the_program() {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  if (DataFolders found = installed(program.parent_path().parent_path() / "share" / "heatsoak"); complete(found)) {
    return found;
  }
  for (fs::path folder = program.parent_path(); folder != folder.parent_path(); folder = folder.parent_path()) {
    if (DataFolders found = source_tree(folder); complete(found)) {
      return found;
    }
  }
  // A build folder outside the source tree: use the tree that this file was compiled from.
  if (DataFolders found = source_tree(fs::path(__FILE__).parent_path().parent_path().parent_path()); complete(found)) {
    return found;
  }
  return {};
}

}  // namespace

DataFolders DataFolders::find(const fs::path& database) {
  DataFolders folders = beside_the_program();
  if (!database.empty()) {
    if (!is_folder(database)) {
      throw base::Failure(base::ExitCode::bad_input, fmt::format("--db {}: there is no such folder", database.string()));
    }
    for (const DataFolders& candidate : {source_tree(database), installed(database)}) {
      folders.motors = is_folder(candidate.motors) ? candidate.motors : folders.motors;
      folders.robots = is_folder(candidate.robots) ? candidate.robots : folders.robots;
      folders.duties = is_folder(candidate.duties) ? candidate.duties : folders.duties;
    }
    if (!is_folder(database / "motor_db")) {
      folders.motors = database;
    }
  }
  if (!complete(folders)) {
    throw base::Failure(
        base::ExitCode::bad_input,
        "the folders motor_db, duty_profiles and robots are found neither beside the program nor in share/heatsoak; name them "
        "with --db DIR");
  }
  return folders;
}

std::vector<std::string> ids_in(const fs::path& folder) {
  std::vector<std::string> ids;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".toml") {
      ids.push_back(entry.path().stem().string());
    }
  }
  std::ranges::sort(ids);
  return ids;
}

bool is_path(std::string_view name) { return name.find('/') != std::string_view::npos || name.ends_with(".toml"); }

fs::path file_of(const fs::path& folder, std::string_view kind, std::string_view name) {
  const std::vector<std::string> ids = ids_in(folder);
  std::error_code error;
  const bool is_table = name.ends_with(".csv") && fs::exists(name, error);
  if (is_path(name) || is_table) {
    const std::string stem = fs::path(name).stem().string();
    if (!fs::exists(name, error) && fs::path(name).filename() == name && std::ranges::find(ids, stem) != ids.end()) {
      throw base::Failure(base::ExitCode::bad_input,
                          fmt::format("there is no file {} in this folder; did you mean the {} '{}'?", name, kind, stem));
    }
    return name;
  }
  if (std::ranges::find(ids, name) == ids.end()) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("there is no {} '{}' in {}{} (`heatsoak list {}s` shows them)", kind, name, folder.string(),
                                    base::did_you_mean(name, ids), kind == "duty" ? "dutie" : kind));
  }
  return folder / fmt::format("{}.toml", name);
}

fs::path log_named(const DataFolders& folders, const fs::path& name) {
  std::error_code error;
  const bool is_only_there = name.is_relative() && !fs::exists(name, error) && fs::exists(folders.shipped / name, error);
  return is_only_there ? folders.shipped / name : name;
}

}  // namespace heatsoak::input
