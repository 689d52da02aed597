// The answer of `check`: every threshold of several check files, and on request the files with new limits.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "check/check_file.h"
#include "check/command_answers.h"
#include "check/run_checks.h"

namespace heatsoak::check {

struct CheckJob {
  std::vector<std::string> files;  ///< names given by the user; files that came with the program are found too
  bool updates = false;            ///< set the limits to the present values
  double margin_share = 0.05;      ///< room of the new limits, as in with_new_limits()
  int threads = 0;                 ///< 0: all cores; the result does not depend on it
  /// If some files are invalid, evaluate the others all the same, without `updates`, for a report that names every limit.
  bool evaluates_beside_invalid = false;
  RunCommand run_command = {};    ///< for the checks with a command
  CheckInputs check_inputs = {};  ///< for the same checks
};

struct RewrittenFile {
  std::filesystem::path path;
  std::string text;
};

struct CheckAnswer {
  std::vector<CheckFile> files;  ///< files that were read; `outcomes` points into them
  std::vector<Outcome> outcomes;
  std::vector<RewrittenFile> rewritten;  ///< files whose limits changed; not yet written
  /// Problems of all invalid files together; `outcomes` are those of the others. Only with CheckJob::evaluates_beside_invalid.
  std::optional<base::Failure> invalid = {};

  [[nodiscard]] bool passed() const;
};

/// Throws Failure (bad_input) with the problems of all files together, unless CheckAnswer::invalid holds them, or if a file that came with
/// the program would have to be rewritten.
CheckAnswer run_check_job(const CheckJob& job, const input::DataFolders& folders, const base::JobProgress& progress = {});

}  // namespace heatsoak::check
