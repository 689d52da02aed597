#include "run_program.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

namespace heatsoak::suite {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) {
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return text + "'";
}

std::string logs_of_kind(const fs::path& folder, const std::string& kind) {
  std::vector<std::string> logs;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kind) && name.ends_with(".csv")) {
      logs.push_back(quoted(entry.path().string()));
    }
  }
  std::ranges::sort(logs);
  std::string all;
  for (const std::string& log : logs) {
    all += " " + log;
  }
  return all;
}

/// Exit code of a command; 128 + signal if a signal ended it.
int exit_code_of(const std::string& command) {
  const int status = std::system(command.c_str());
  if (WIFEXITED(status)) {
    return WEXITSTATUS(status);
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : 127;
}

/// Runs one motor and writes <answers>/<motor>.json (by the program) and <motor>.run.json (exit code and time).
int run_motor(const RunOptions& options, const std::string& motor) {
  const fs::path folder = options.data / motor;
  const fs::path json = options.answers / (motor + ".json");
  fs::remove(json);
  const std::string command = fmt::format("{} diagnose --model {} --train{} --holdout{} --out {} --quiet --json {} > {} 2>&1",
                                          quoted(options.program), quoted((folder / "start.toml").string()), logs_of_kind(folder, "train_"),
                                          logs_of_kind(folder, "holdout_"), quoted((options.answers / "out" / motor).string()),
                                          quoted(json.string()), quoted((options.answers / (motor + ".txt")).string()));
  const auto begin = std::chrono::steady_clock::now();
  const int exit_code = exit_code_of(command);
  const std::chrono::duration<double> wall_s = std::chrono::steady_clock::now() - begin;
  std::ofstream(options.answers / (motor + ".run.json"))
      << nlohmann::ordered_json{{"motor", motor}, {"exit_code", exit_code}, {"wall_s", wall_s.count()}}.dump(1) << '\n';
  return exit_code;
}

}  // namespace

bool is_answer(int exit_code) { return exit_code >= 0 && exit_code <= 3; }

std::vector<std::string> motors_in(const fs::path& data, const std::string& only) {
  std::vector<std::string> motors;
  for (const fs::directory_entry& entry : fs::directory_iterator(data)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory() && name.starts_with(only) && fs::exists(entry.path() / "truth.json")) {
      motors.push_back(name);
    }
  }
  std::ranges::sort(motors);
  return motors;
}

int run_motors(const RunOptions& options) {
  const std::vector<std::string> motors = motors_in(options.data, options.only);
  fs::create_directories(options.answers / "out");
  std::atomic<std::size_t> next = 0;
  std::atomic<int> failures = 0;
  std::vector<std::jthread> workers;
  for (int i = 0; i < std::max(1, options.jobs); ++i) {
    workers.emplace_back([&] {
      for (std::size_t at = next++; at < motors.size(); at = next++) {
        if (const int exit_code = run_motor(options, motors[at]); !is_answer(exit_code)) {
          fmt::print(stderr, "{}: exit code {}\n", motors[at], exit_code);
          ++failures;
        }
      }
    });
  }
  workers.clear();
  return failures;
}

}  // namespace heatsoak::suite
