#include "program_run.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace heatsoak {
namespace fs = std::filesystem;
namespace {

void redirect(int descriptor, const fs::path& file) {
  const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT, 0600);
  if (opened < 0 || ::dup2(opened, descriptor) < 0) {
    ::_exit(126);
  }
}

[[noreturn]] void become(const std::vector<std::string>& arguments, const RunOptions& options, const fs::path& out, const fs::path& err) {
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  redirect(STDOUT_FILENO, options.stdout_file.empty() ? out : options.stdout_file);
  redirect(STDERR_FILENO, options.stderr_file.empty() ? err : options.stderr_file);
  if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) {
    ::_exit(126);
  }
  // Tests look for sentences, which a line of 80 characters would break.
  ::setenv("COLUMNS", "1000", 1);
  for (const std::string& each : options.environment) {
    const std::size_t equals = each.find('=');
    equals == std::string::npos ? ::unsetenv(each.c_str()) : ::setenv(each.substr(0, equals).c_str(), each.substr(equals + 1).c_str(), 1);
  }
  std::vector<char*> words;
  std::string program = options.program;
  words.push_back(program.data());
  Words own = arguments;
  for (std::string& each : own) {
    words.push_back(each.data());
  }
  words.push_back(nullptr);
  ::alarm(options.time_limit_s * HEATSOAK_SLOWNESS);  // survives execv and ends a hanging program
  ::execv(program.c_str(), words.data());
  ::_exit(127);
}

}  // namespace

nlohmann::json ProgramRun::json() const { return nlohmann::json::parse(out); }

ProgramRun run(const std::vector<std::string>& arguments, const RunOptions& options) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  const fs::path err = folder.path() / "err";
  const pid_t child = ::fork();
  if (child < 0) {
    throw std::runtime_error("fork failed");
  }
  if (child == 0) {
    become(arguments, options, out, err);
  }
  int status = 0;
  rusage used{};
  if (::wait4(child, &status, 0, &used) != child) {
    throw std::runtime_error("wait4 failed");
  }
  ProgramRun result;
  result.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
#ifndef __SANITIZE_ADDRESS__
  result.memory_MB = static_cast<double>(used.ru_maxrss) / 1024.0;
#endif
  result.out = options.stdout_file.empty() ? content_of(out) : "";
  result.err = options.stderr_file.empty() ? content_of(err) : "";
  return result;
}

ProgramRun run_line(const std::string& line, const RunOptions& options) {
  RunOptions in_shell = options;
  in_shell.program = "/bin/bash";
  in_shell.environment.push_back("PATH=" + fs::path(HEATSOAK_PROGRAM).parent_path().string() + ":" + std::getenv("PATH"));
  return run({"-c", line}, in_shell);
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "heatsoak_test_XXXXXX").string();
  if (!::mkdtemp(pattern.data())) {
    throw std::runtime_error("no temporary folder");
  }
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryFolder::names() const { return files_of(path_, "", ""); }

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write(const fs::path& file, const std::string& content) {
  std::ofstream stream(file, std::ios::binary);
  stream << content;
  if (!stream.flush()) {
    throw std::runtime_error("cannot write " + file.string());
  }
}

std::vector<std::string> files_of(const fs::path& folder, const std::string& begin, const std::string& end) {
  std::vector<std::string> names;
  for (const fs::directory_entry& each : fs::directory_iterator(folder)) {
    const std::string name = each.path().filename().string();
    if (name.starts_with(begin) && name.ends_with(end)) {
      names.push_back(name);
    }
  }
  std::ranges::sort(names);
  return names;
}

std::string test_name(const std::string& file) {
  std::string name = file.substr(0, file.rfind('.'));
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

}  // namespace heatsoak
