// Runs the real program, as a shell would, and says what it did.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace heatsoak {

struct RunOptions {
  std::filesystem::path folder;          ///< working directory; the test's own where empty
  std::vector<std::string> environment;  ///< "NAME=value" sets, "NAME" removes
  std::string program = HEATSOAK_PROGRAM;
  std::filesystem::path stdout_file;  ///< for devices; captured where empty
  std::filesystem::path stderr_file;
  unsigned time_limit_s = 120;  ///< ten times as much where sanitizers or counters are built in
};

/// What stands on a command line.
using Words = std::vector<std::string>;

inline Words operator+(Words first, const Words& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

struct ProgramRun {
  int exit_code = -1;  ///< 128 + signal where a signal ended it
  std::string out;
  std::string err;
  double memory_MB = 0.0;  ///< largest resident set; 0 where a sanitizer keeps what is freed

  /// The JSON on stdout, and nothing but JSON.
  [[nodiscard]] nlohmann::json json() const;
};

ProgramRun run(const Words& arguments, const RunOptions& options = {});
/// Through bash, as the example lines of the help are written; `heatsoak` is the program.
ProgramRun run_line(const std::string& line, const RunOptions& options = {});

/// A folder that is gone when the test ends.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::vector<std::string> names() const;  ///< of the entries, sorted

 private:
  std::filesystem::path path_;
};

std::string content_of(const std::filesystem::path& file);
void write(const std::filesystem::path& file, const std::string& content);

/// Names of the files of a folder that begin and end so, sorted.
std::vector<std::string> files_of(const std::filesystem::path& folder, const std::string& begin, const std::string& end);
/// A test's name from a file's: letters, digits and '_'.
std::string test_name(const std::string& file);

}  // namespace heatsoak
