// Reading and writing whole files, with the reason where it fails.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace heatsoak {

/// All bytes of a regular file of at most `largest_bytes`; else Failure (bad_input).
std::string read_file(const std::filesystem::path& path, std::size_t largest_bytes);

/// Whoever opens an input tells it here, so that no output replaces it. Any thread may.
void note_input(const std::filesystem::path& path);
/// Whether this process has read the file, under whatever name.
bool is_input(const std::filesystem::path& path);

/// Whether both name one file, under whatever name; a device or pipe takes any number of outputs.
bool are_one_file(const std::filesystem::path& one, const std::filesystem::path& other);

struct OutputFile {
  std::filesystem::path path;
  std::string content;
};

/// A file that is written as its content comes, and has no name until write_files() gives it one: what is not finished leaves nothing
/// behind, and memory does not grow with it. A device or pipe takes the bytes as they come. Throws Failure (bad_input).
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

/// Writes all of the files or none: each under a temporary name beside its path, and only when all are complete they
/// are renamed. A link is followed, and a device or pipe takes the bytes as they come. Throws Failure (bad_input), also
/// where two of them are the same file.
void write_files(std::span<const OutputFile> files, std::span<const std::unique_ptr<StreamedFile>> streamed = {});

/// One file in the same way.
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace heatsoak
