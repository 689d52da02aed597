// Runs the real program like a shell and returns its results.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace heatsoak {

struct RunOptions {
  std::filesystem::path folder = {};          ///< working directory; if empty, the test's own
  std::vector<std::string> environment = {};  ///< "NAME=value" sets a variable, "NAME" removes it
  std::string program = HEATSOAK_PROGRAM;
  std::filesystem::path stdout_file = {};  ///< for devices; if empty, stdout is captured
  std::filesystem::path stderr_file = {};
  unsigned time_limit_s = 120;  ///< multiplied by ten in builds with sanitizers or counters
};

/// Arguments of a command line.
using Words = std::vector<std::string>;

inline Words operator+(Words first, const Words& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

struct ProgramRun {
  int exit_code = -1;  ///< 128 + signal if a signal ended the program
  std::string out;
  std::string err;
  double memory_MB = 0.0;  ///< largest resident set; 0 with sanitizers, which keep freed memory

  /// Parses stdout, which must contain nothing but JSON.
  [[nodiscard]] nlohmann::json json() const;
};

ProgramRun run(const Words& arguments, const RunOptions& options = {});
/// Runs a line in bash, like the example lines of the help; `heatsoak` is the program.
ProgramRun run_line(const std::string& line, const RunOptions& options = {});

/// Temporary folder, deleted by the destructor.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::vector<std::string> names() const;  ///< sorted names of the entries

 private:
  std::filesystem::path path_;
};

std::string content_of(const std::filesystem::path& file);
void write(const std::filesystem::path& file, const std::string& content);

/// Returns the sorted names of files in a folder with this beginning and end.
std::vector<std::string> files_of(const std::filesystem::path& folder, const std::string& begin, const std::string& end);
/// Converts a file name to a valid test name: letters, digits and '_'.
std::string test_name(const std::string& file);

}  // namespace heatsoak
