// Waiting time of a user: whole processes, from fork to exit.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

namespace {

/// Runs the program without output; returns false if its exit code is not `expected`.
bool ends_with(std::vector<std::string> arguments, int expected) {
  std::string program = HEATSOAK_PROGRAM;
  std::vector<char*> argv{program.data()};
  for (std::string& each : arguments) {
    argv.push_back(each.data());
  }
  argv.push_back(nullptr);
  posix_spawn_file_actions_t silent;
  posix_spawn_file_actions_init(&silent);
  posix_spawn_file_actions_addopen(&silent, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&silent, 2, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  int status = -1;
  const bool started = posix_spawn(&child, argv[0], &silent, nullptr, argv.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&silent);
  return started && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == expected;
}

void process(benchmark::State& state, const std::vector<std::string>& arguments, int expected) {
  for (auto _ : state) {
    if (!ends_with(arguments, expected)) {
      state.SkipWithError("the program did not end as expected");
      return;
    }
  }
}

const std::string kPicture =
    (std::filesystem::temp_directory_path() / ("heatsoak_benchmark_" + std::to_string(getpid()) + ".svg")).string();
// This motor exceeds its limit, so the exit code is 1.
const std::vector<std::string> kEvaluate{
    "evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--motors", "maxon_ecx_flat_32l_48v", "--samples", "0"};

std::vector<std::string> evaluate_with_picture() {
  std::vector<std::string> arguments = kEvaluate;
  arguments.insert(arguments.end(), {"--plot", kPicture});
  return arguments;
}

void process_with_picture(benchmark::State& state) {
  process(state, evaluate_with_picture(), 1);
  std::filesystem::remove(kPicture);
}

BENCHMARK_CAPTURE(process, version, std::vector<std::string>{"--version"}, 0)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(process, help, std::vector<std::string>{"--help"}, 0)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(process, evaluate_one_motor, kEvaluate, 1)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(process_with_picture)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
