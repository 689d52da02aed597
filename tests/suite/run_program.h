#pragma once
// Calls `heatsoak diagnose` for each motor of a folder.
#include <filesystem>
#include <string>
#include <vector>

namespace heatsoak::suite {

struct RunOptions {
  std::filesystem::path data;     ///< folder of the motors
  std::filesystem::path answers;  ///< folder for answers, one JSON and one record per motor
  std::string program;
  std::string only;  ///< beginning of the names of the motors to run
  int jobs = 1;
};

/// Names of the motors in a folder, sorted.
std::vector<std::string> motors_in(const std::filesystem::path& data, const std::string& only);

/// Runs the program and writes answers. Returns the number of runs without a documented exit code.
int run_motors(const RunOptions& options);

/// Exit codes that are answers: done, limit exceeded, bad input, data cannot answer.
bool is_answer(int exit_code);

}  // namespace heatsoak::suite
