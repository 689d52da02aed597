#include "check/check_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/files.h"
#include "check/rewrite.h"

namespace heatsoak::check {
namespace {

constexpr std::size_t kLargestCheckFile_bytes = 1'000'000;

/// Reads all files; the problems of the invalid ones become one failure.
void read_check_files(const CheckJob& job, const input::DataFolders& folders, CheckAnswer& answer) {
  std::string message;
  std::vector<base::Diagnostic> problems;
  for (const std::string& name : job.files) {
    try {
      // The example in the help is a file that came with the program.
      answer.files.push_back(read_check_file(input::log_named(folders, name), folders, job.check_inputs));
    } catch (const base::Failure& failure) {
      if (failure.code() != base::ExitCode::bad_input) {
        throw;
      }
      message += failure.message();
      problems.insert(problems.end(), failure.diagnostics().begin(), failure.diagnostics().end());
    }
  }
  if (!problems.empty() || !message.empty()) {
    for (const CheckFile& file : answer.files) {
      problems.insert(problems.end(), file.unknown.begin(), file.unknown.end());
    }
    answer.invalid.emplace(base::ExitCode::bad_input, std::move(message), std::move(problems));
  }
}

/// Throws if the file was found beside the program, because it is not the user's.
void refuse_shipped(const std::filesystem::path& path, const CheckJob& job) {
  if (std::ranges::find(job.files, path.string()) == job.files.end()) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("{} is part of the installed program and is not rewritten; copy it first", path.string()));
  }
}

}  // namespace

bool CheckAnswer::passed() const { return !invalid && std::ranges::all_of(outcomes, &Outcome::passed); }

CheckAnswer run_check_job(const CheckJob& job, const input::DataFolders& folders, const base::JobProgress& progress) {
  CheckAnswer answer;
  read_check_files(job, folders, answer);
  if (answer.invalid && !job.evaluates_beside_invalid) {
    throw base::Failure(*answer.invalid);
  }
  CommandAnswers commands(job.run_command);
  for (const CheckFile& file : answer.files) {
    commands.run(file.checks);  // before the progress of the other checks, because a command shows its own
  }
  std::vector<base::JobPhase> phases;
  for (const CheckFile& file : answer.files) {
    std::ranges::move(check_phases(file), std::back_inserter(phases));
  }
  progress.expect(std::move(phases));
  for (const CheckFile& file : answer.files) {
    std::vector<Outcome> of_file = run_checks(file, job.threads, commands, progress);
    if (job.updates && !answer.invalid) {
      refuse_shipped(file.path, job);
      const std::string before = base::read_file(file.path, kLargestCheckFile_bytes);
      if (std::string after = with_new_limits(before, of_file, job.margin_share); after != before) {
        answer.rewritten.push_back({file.path, std::move(after)});
      }
    }
    std::ranges::move(of_file, std::back_inserter(answer.outcomes));
  }
  return answer;
}

}  // namespace heatsoak::check
