#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>

#include "base/delayed_signals.h"
#include "base/diagnostic.h"
#include "base/files.h"
#include "derate/fmi/fmu.h"

namespace heatsoak::derate {
namespace {

namespace fs = std::filesystem;

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "heatsoak_fmu_XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) {
      throw base::Failure(base::ExitCode::bad_input, fmt::format("{}: cannot be made: {}", pattern, std::strerror(errno)));
    }
    path_ = pattern;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code left;
    fs::remove_all(path_, left);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

constexpr std::string_view kSaid = "compiler.txt";
constexpr std::size_t kLargest_bytes = 16U << 20U;

/// Runs the command in the folder with both outputs redirected to kSaid. Returns its exit code; nothing if it did not start or a signal
/// ended it.
std::optional<int> run(std::vector<std::string> words, const fs::path& folder) {
  std::vector<char*> arguments;
  std::ranges::transform(words, std::back_inserter(arguments), [](std::string& word) { return word.data(); });
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, kSaid.data(), O_WRONLY | O_CREAT | O_TRUNC, S_IRUSR | S_IWUSR);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const bool is_started = posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (!is_started || ::waitpid(child, &status, 0) != child || !WIFEXITED(status)) {
    return std::nullopt;
  }
  return WEXITSTATUS(status);
}

/// FMI platform name of this machine; empty if the FMI version defines none.
std::string_view platform(FmiVersion version) {
#if defined(__x86_64__)
  return version == FmiVersion::fmi2 ? "linux64" : "x86_64-linux";
#elif defined(__aarch64__)
  return version == FmiVersion::fmi2 ? "" : "aarch64-linux";
#else
  return "";
#endif
}

}  // namespace

std::vector<FmuFile> with_binary(std::vector<FmuFile> files, const FmuModel& model, FmiVersion version, const std::string& compiler) {
  const std::string_view machine = platform(version);
  if (machine.empty()) {
    throw base::Failure(base::ExitCode::bad_input,
                        "this version of FMI has no name for this platform; leave --compiler out, the file then contains sources only");
  }
  const base::DelayedSignals delayed;
  const TemporaryFolder folder;
  // File names without a folder, so that the library contains no paths of this machine.
  std::vector<std::string> words{compiler, "-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared", "-fvisibility=hidden",
                                 "-o",     "unit.so"};
  constexpr std::string_view kSources = "sources/";
  for (const FmuFile& file : files) {
    if (!file.path.starts_with(kSources)) {
      continue;
    }
    const std::string name = file.path.substr(kSources.size());
    base::write_file(folder.path() / name, file.content);
    if (name.ends_with(".c")) {
      words.push_back(name);
    }
  }
  words.emplace_back("-lm");
  const std::optional<int> code = run(words, folder.path());
  if (code != 0) {
    std::error_code none;
    const std::string said =
        fs::exists(folder.path() / kSaid, none) ? base::read_file(folder.path() / kSaid, kLargest_bytes) : std::string();
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("--compiler {}: {}, expected a C99 compiler such as cc; without --compiler the file contains sources only{}{}",
                    compiler, !code || said.empty() ? "cannot be run" : fmt::format("ended with code {}", *code), said.empty() ? "" : "\n",
                    said));
  }
  files.push_back(
      {fmt::format("binaries/{}/{}.so", machine, model.identifier), base::read_file(folder.path() / "unit.so", kLargest_bytes)});
  std::ranges::sort(files, {}, &FmuFile::path);
  return files;
}

}  // namespace heatsoak::derate
