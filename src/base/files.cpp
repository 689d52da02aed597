#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak::base {
namespace {

[[noreturn]] void cannot_read(const std::filesystem::path& path, const std::string& reason) {
  throw bad_input({path.string()}, "", fmt::format("cannot be read: {}", reason));
}

struct Inputs {
  std::mutex mutex;
  std::set<std::filesystem::path> paths;
};
Inputs& inputs() {
  static Inputs all;
  return all;
}

/// Returns the absolute path of the file that the path names, which may not exist yet. weakly_canonical() alone does not follow a link to
/// a missing file. Sets `problem` if the links lead in a circle.
std::filesystem::path without_links(const std::filesystem::path& path, std::error_code& problem) {
  namespace fs = std::filesystem;
  constexpr int kMostLinks = 40;  // the limit of Linux
  fs::path target = fs::absolute(path, problem);
  for (int link = 0; link < kMostLinks && !problem; ++link) {
    target = fs::weakly_canonical(target, problem);
    std::error_code no_link;
    const fs::path next = fs::read_symlink(target, no_link);
    if (no_link || problem) {
      return target;
    }
    target = target.parent_path() / next;  // an absolute `next` replaces the folder
  }
  problem = std::make_error_code(std::errc::too_many_symbolic_link_levels);
  return target;
}

std::filesystem::path without_links(const std::filesystem::path& path) {
  std::error_code missing;
  return without_links(path, missing);
}

}  // namespace

void note_input(const std::filesystem::path& path) {
  const std::lock_guard lock(inputs().mutex);
  inputs().paths.insert(without_links(path));
}

bool is_input(const std::filesystem::path& path) {
  const std::lock_guard lock(inputs().mutex);
  return inputs().paths.contains(without_links(path));
}

bool are_one_file(const std::filesystem::path& one, const std::filesystem::path& other) {
  std::error_code missing;
  return without_links(one) == without_links(other) && !std::filesystem::is_other(one, missing);
}

std::string read_file(const std::filesystem::path& path, std::size_t largest_bytes) {
  // O_NONBLOCK: without it, opening a pipe that has no writer would block the program.
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) {
    cannot_read(path, std::strerror(errno));
  }
  struct Closer {
    int file;
    ~Closer() { ::close(file); }
  } closer{file};
  struct stat about {};
  if (::fstat(file, &about) != 0) {
    cannot_read(path, std::strerror(errno));
  }
  if (!S_ISREG(about.st_mode)) {
    cannot_read(path, S_ISDIR(about.st_mode) ? "it is a folder" : "it is a device or a pipe; expected a file");
  }
  note_input(path);
  std::string content;
  std::vector<char> chunk(1 << 16);
  for (;;) {
    const ssize_t got = ::read(file, chunk.data(), chunk.size());
    if (got < 0) {
      cannot_read(path, std::strerror(errno));
    }
    if (got == 0) {
      return content;
    }
    content.append(chunk.data(), static_cast<std::size_t>(got));
    if (content.size() > largest_bytes) {
      cannot_read(path, fmt::format("it is larger than {} MB, which no file of this kind is", largest_bytes / 1'000'000));
    }
  }
}

namespace {

[[noreturn]] void cannot_write(const std::filesystem::path& path, int error) {
  throw bad_input({path.string()}, "", fmt::format("cannot be written: {}", std::strerror(error)));
}

}  // namespace

/// An output file that is invisible until publish(). It has no name (O_TMPFILE), so that even a killed process leaves no partial file. File
/// systems without O_TMPFILE (NFS) and systems without /proc get a temporary name instead.
class UnfinishedFile {
 public:
  /// `in_place` opens the target itself: a device or pipe must not be replaced by a renamed file. A file that is replaced keeps its
  /// permissions.
  UnfinishedFile(std::filesystem::path target, bool in_place)
      : target_(std::move(target)), temporary_(fmt::format("{}.{}.partial", target_.string(), ::getpid())), is_in_place_(in_place) {
    if (in_place) {
      descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    } else {
      const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
      descriptor_ = ::open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
      const bool can_be_linked = descriptor_ >= 0 && ::access("/proc/self/fd", X_OK) == 0;
      if (!can_be_linked && (descriptor_ >= 0 || errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL)) {
        if (descriptor_ >= 0) {
          ::close(descriptor_);
        }
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        has_temporary_name_ = descriptor_ >= 0;
      }
    }
    if (descriptor_ < 0) {
      cannot_write(target_, errno);
    }
    if (!in_place) {
      keep_permissions();
    }
  }
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  ~UnfinishedFile() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
    if (has_temporary_name_) {
      ::unlink(temporary_.c_str());
    }
  }

  void write(std::string_view content) {
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0 && errno != EINTR) {
        cannot_write(target_, errno);
      }
      content.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
    }
  }

  void publish() {
    if (!is_in_place_ && !has_temporary_name_) {
      // linkat() cannot replace an existing file, rename() can. The temporary name exists only between the two calls.
      ::unlink(temporary_.c_str());
      has_temporary_name_ =
          ::linkat(AT_FDCWD, fmt::format("/proc/self/fd/{}", descriptor_).c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) == 0;
      if (!has_temporary_name_) {
        cannot_write(target_, errno);
      }
    }
    // A full disk may be reported only by close().
    if (::close(std::exchange(descriptor_, -1)) != 0 || (!is_in_place_ && std::rename(temporary_.c_str(), target_.c_str()) != 0)) {
      cannot_write(target_, errno);
    }
    has_temporary_name_ = false;
  }

 private:
  /// Runs before the first byte is written, so that nobody else can read the content of a private file.
  void keep_permissions() {
    constexpr mode_t kPermissions = 0777;
    struct stat before {};
    struct stat now {};
    if (::stat(target_.c_str(), &before) != 0 || ::fstat(descriptor_, &now) != 0) {
      return;  // a new file keeps to the umask
    }
    const mode_t kept = before.st_mode & kPermissions;
    if (kept != (now.st_mode & kPermissions) && ::fchmod(descriptor_, kept) != 0) {
      const int error = errno;
      ::close(std::exchange(descriptor_, -1));
      if (has_temporary_name_) {
        ::unlink(temporary_.c_str());
      }
      cannot_write(target_, error);
    }
  }

  std::filesystem::path target_;
  std::string temporary_;
  int descriptor_ = -1;
  bool is_in_place_ = false;
  bool has_temporary_name_ = false;
};

struct OutputTarget {
  std::filesystem::path path;
  bool in_place = false;
};

namespace {

OutputTarget target_of(const std::filesystem::path& path) {
  struct stat about {};
  const bool exists = ::stat(path.c_str(), &about) == 0;
  if (exists && S_ISDIR(about.st_mode)) {
    cannot_write(path, EISDIR);
  }
  if (exists && ::access(path.c_str(), W_OK) != 0) {
    cannot_write(path, errno);
  }
  const bool in_place = exists && !S_ISREG(about.st_mode);
  std::error_code problem;
  std::filesystem::path target = without_links(path, problem);
  if (problem && !in_place) {
    cannot_write(path, problem.value());
  }
  return {problem ? path : std::move(target), in_place};
}

}  // namespace

struct StreamedFile::State {
  explicit State(const std::filesystem::path& path) : target(target_of(path)), file(target.path, target.in_place) {}

  void flush() {
    file.write(buffer);
    buffer.clear();
  }

  OutputTarget target;
  UnfinishedFile file;
  std::string buffer;
};

StreamedFile::StreamedFile(std::filesystem::path path) : path_(std::move(path)), state_(std::make_unique<State>(path_)) {}
StreamedFile::~StreamedFile() = default;

void StreamedFile::write(std::string_view content) {
  constexpr std::size_t kChunk_bytes = 1 << 16;
  state_->buffer += content;
  if (state_->buffer.size() >= kChunk_bytes) {
    state_->flush();
  }
}

void write_files(std::span<const OutputFile> files, std::span<const std::unique_ptr<StreamedFile>> streamed) {
  std::vector<std::unique_ptr<UnfinishedFile>> unfinished;
  std::vector<std::filesystem::path> taken;
  const auto take = [&taken](const std::filesystem::path& path, const OutputTarget& target) {
    if (!target.in_place && std::ranges::find(taken, target.path) != taken.end()) {
      throw bad_input({path.string()}, "", "is the target of two outputs");
    }
    taken.push_back(target.path);
  };
  for (const auto& each : streamed) {
    take(each->path_, each->state_->target);
    each->state_->flush();
  }
  for (const OutputFile& file : files) {
    const OutputTarget target = target_of(file.path);
    take(file.path, target);
    unfinished.push_back(std::make_unique<UnfinishedFile>(target.path, target.in_place));
    unfinished.back()->write(file.content);
  }
  for (const auto& each : streamed) {
    each->state_->file.publish();
  }
  for (const auto& each : unfinished) {
    each->publish();
  }
}

void require_writable(const std::filesystem::path& path) {
  if (const OutputTarget target = target_of(path); !target.in_place) {
    const UnfinishedFile never_published(target.path, false);
  }
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  const OutputFile file{path, std::string(content)};
  write_files({&file, 1});
}

}  // namespace heatsoak::base
