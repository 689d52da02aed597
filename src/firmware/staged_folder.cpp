#include "firmware/staged_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <set>
#include <string>

#include "base/diagnostic.h"

namespace heatsoak::firmware {
namespace fs = std::filesystem;
namespace {

base::Failure unwritable(const fs::path& path, const std::error_code& problem) {
  return {base::ExitCode::bad_input,
          fmt::format("{} cannot be written: {}; choose another folder with --out", path.string(), problem.message())};
}

/// Without a trailing slash, links followed.
fs::path real_path(const fs::path& folder) {
  std::error_code problem;
  fs::path path = fs::weakly_canonical(fs::absolute(folder), problem);
  if (problem) {
    throw unwritable(folder, problem);
  }
  return path.has_filename() ? path : path.parent_path();
}

/// Paths of the files that an earlier run generated into the folder; empty without a list of them.
std::set<std::string> generated_before(const fs::path& folder) {
  std::set<std::string> paths;
  std::ifstream list(folder / kGeneratedFiles);
  for (std::string line; std::getline(list, line);) {
    paths.insert(line);
  }
  return paths;
}

bool has_write_permission(const fs::path& folder) {
  constexpr fs::perms kWrite = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  std::error_code problem;
  // The superuser may write to every folder, but a folder without any write permission is meant to stay as it is.
  return (fs::status(folder, problem).permissions() & kWrite) != fs::perms::none && access(folder.c_str(), W_OK | X_OK) == 0;
}

/// Throws if writing the files would overwrite something that no earlier run generated, or change a folder without write permission.
void check_replaced_files(const fs::path& folder, std::span<const CoreFile> files) {
  const std::set<std::string> generated = generated_before(folder);
  std::error_code problem;
  for (const CoreFile& file : files) {
    for (fs::path part = fs::path(file.path).parent_path(); !part.empty(); part = part.parent_path()) {
      const fs::file_status status = fs::symlink_status(folder / part, problem);
      if (fs::exists(status) && !fs::is_directory(status)) {
        throw base::Failure(base::ExitCode::bad_input,
                            fmt::format("{} is not a folder, but generated files belong into it; move it away or "
                                        "choose another folder with --out",
                                        (folder / part).string()));
      }
      if (fs::exists(status) && !has_write_permission(folder / part)) {
        throw unwritable(folder / part, std::make_error_code(std::errc::permission_denied));
      }
    }
    if (fs::exists(fs::symlink_status(folder / file.path, problem)) && !generated.contains(file.path)) {
      throw base::Failure(base::ExitCode::bad_input,
                          fmt::format("{} exists and {} does not list it as generated; move it away or choose another folder with --out",
                                      (folder / file.path).string(), kGeneratedFiles));
    }
  }
}

/// Copies the files that a user added, but no generated file of an older version. The files keep their times, so that `make` sees that old
/// objects are older than new sources.
void copy_others(const fs::path& from, const fs::path& to) {
  const std::set<std::string> generated = generated_before(from);
  std::error_code problem;
  for (fs::recursive_directory_iterator at(from, problem), end; at != end && !problem; at.increment(problem)) {
    const fs::path path = at->path().lexically_relative(from);
    if (fs::is_directory(at->symlink_status())) {
      fs::create_directories(to / path, problem);
    } else if (!generated.contains(path.generic_string())) {
      fs::copy(at->path(), to / path, fs::copy_options::copy_symlinks | fs::copy_options::skip_existing, problem);
      if (!problem && fs::is_regular_file(at->symlink_status())) {
        fs::last_write_time(to / path, fs::last_write_time(at->path(), problem), problem);
      }
    }
    if (problem) {
      break;
    }
  }
  if (problem) {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("the files in {} cannot be kept: {}", from.string(), problem.message()));
  }
}

}  // namespace

void check_target_folder(const fs::path& folder, bool may_replace) {
  const fs::path path = real_path(folder);
  std::error_code problem;
  const fs::file_status status = fs::status(path, problem);
  if (fs::exists(status) && !fs::is_directory(status)) {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("--out {} is a file; expected a folder, which may be new", folder.string()));
  }
  if (const fs::path parent = path.parent_path();
      !fs::exists(status) && fs::exists(parent, problem) && !fs::is_directory(parent, problem)) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("--out {}: {} is a file; expected a folder", folder.string(), parent.string()));
  }
  if (!fs::exists(status) && !fs::is_directory(path.parent_path(), problem)) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("--out {}: there is no folder {}; make it first", folder.string(), path.parent_path().string()));
  }
  if (path == path.parent_path()) {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("--out {}: expected a folder of its own", folder.string()));
  }
  // The folder is replaced as a whole: a shell inside would stay in the old one, which is deleted.
  if (const fs::path here = fs::current_path(problem); fs::is_directory(status) && std::ranges::mismatch(path, here).in1 == path.end()) {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("--out {} contains the current folder {}; change to another folder first",
                                                               folder.string(), here.string()));
  }
  if (fs::is_directory(status) && !may_replace && !fs::is_empty(path, problem)) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("--out {} is not empty; name another folder, or --force replaces the generated files in it "
                                    "and keeps all others",
                                    folder.string()));
  }
  if (!problem && fs::is_directory(status) && !has_write_permission(path)) {
    problem = std::make_error_code(std::errc::permission_denied);
  }
  if (problem) {
    throw unwritable(path, problem);
  }
}

StagedFolder::StagedFolder(const fs::path& folder, std::span<const CoreFile> files, bool may_replace) : folder_(real_path(folder)) {
  check_target_folder(folder, may_replace);
  check_replaced_files(folder_, files);
  stage_ = folder_.parent_path() / fmt::format(".{}.{}.new", folder_.filename().string(), getpid());
  std::error_code problem;
  fs::remove_all(stage_, problem);
  if (!fs::create_directory(stage_, problem)) {
    throw unwritable(folder_, problem);
  }
  try {
    write(files);
    if (fs::is_directory(folder_, problem)) {
      copy_others(folder_, stage_);
      fs::permissions(stage_, fs::status(folder_).permissions());
    }
  } catch (...) {
    fs::remove_all(stage_, problem);
    throw;
  }
}

StagedFolder::~StagedFolder() {
  if (!stage_.empty()) {
    std::error_code left;
    fs::remove_all(stage_, left);
  }
}

void StagedFolder::write(std::span<const CoreFile> files) const {
  for (const CoreFile& file : files) {
    const fs::path path = stage_ / file.path;
    std::error_code problem;
    fs::create_directories(path.parent_path(), problem);
    errno = 0;
    std::ofstream stream(path, std::ios::binary);
    stream << file.content;
    stream.close();
    if (!stream) {
      const std::error_code reason(errno != 0 ? errno : EIO, std::generic_category());
      throw unwritable(folder_ / file.path, problem ? problem : reason);
    }
  }
}

void StagedFolder::commit() {
  std::error_code problem;
  const fs::path old = folder_.parent_path() / fmt::format(".{}.{}.old", folder_.filename().string(), getpid());
  const bool is_replaced = fs::exists(folder_, problem);
  if (is_replaced) {
    fs::rename(folder_, old, problem);
  }
  if (!problem) {
    fs::rename(stage_, folder_, problem);
    if (problem && is_replaced) {
      std::error_code lost;
      fs::rename(old, folder_, lost);
    }
  }
  if (problem) {
    throw unwritable(folder_, problem);
  }
  stage_.clear();
  fs::remove_all(old, problem);
}

}  // namespace heatsoak::firmware
