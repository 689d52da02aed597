// Reads and writes whole files. Error messages name the reason of the operating system.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace heatsoak::base {

/// Returns all bytes of a regular file. Throws Failure (bad_input) if it cannot be read or is larger than `largest_bytes`.
std::string read_file(const std::filesystem::path& path, std::size_t largest_bytes);

/// Records that a file was opened as an input, so that no output overwrites it. Thread-safe.
void note_input(const std::filesystem::path& path);
/// Returns whether this process has read the file. Links and relative names are resolved.
bool is_input(const std::filesystem::path& path);

/// Returns whether both paths name the same file after links are resolved. False for devices and pipes, which may take several outputs.
bool are_one_file(const std::filesystem::path& one, const std::filesystem::path& other);

struct OutputFile {
  std::filesystem::path path;
  std::string content;
};

/// An output file that is written piece by piece, so that memory does not grow with its size. It stays without a name until write_files()
/// publishes it; if that never happens, nothing is left on disk. A device or pipe receives the bytes as they are produced.
/// Throws Failure (bad_input) on errors.
class StreamedFile {
 public:
  explicit StreamedFile(std::filesystem::path path);
  StreamedFile(const StreamedFile&) = delete;
  StreamedFile& operator=(const StreamedFile&) = delete;
  ~StreamedFile();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  void write(std::string_view content);

 private:
  friend void write_files(std::span<const OutputFile> files, std::span<const std::unique_ptr<StreamedFile>> streamed);
  struct State;
  std::filesystem::path path_;
  std::unique_ptr<State> state_;
};

/// Writes all files or none. Each is written without a name or under a temporary one, and renamed when all of them are complete. Links are
/// followed; a device or pipe receives the bytes directly. A file that is replaced keeps its permissions, a new one keeps to the umask.
/// Throws Failure (bad_input) on errors and if two outputs have the same target.
void write_files(std::span<const OutputFile> files, std::span<const std::unique_ptr<StreamedFile>> streamed = {});

/// Throws Failure (bad_input) as write_files() would if a file of this name cannot be written. Leaves nothing on the disk, and does not
/// open a device or pipe.
void require_writable(const std::filesystem::path& path);

/// Writes one file in the same way.
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace heatsoak::base
