// Temporary log files for one test.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace heatsoak::recording {

class LogFile {
 public:
  LogFile(const std::string& name, const std::string& content)
      : folder_(std::filesystem::temp_directory_path() / ("heatsoak_" + std::to_string(::getpid()) + "_" + std::to_string(next_number()))) {
    std::filesystem::create_directories(folder_);
    add(name, content);
    path_ = folder_ / name;
  }
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
  ~LogFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  /// Adds another file to the folder.
  std::filesystem::path add(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  static int next_number() {
    static int number = 0;
    return ++number;
  }

  std::filesystem::path folder_;
  std::filesystem::path path_;
};

}  // namespace heatsoak::recording
