// The answer of `check`: every threshold of several check files, and on request the files with new limits.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "check/check_file.h"
#include "check/run_checks.h"

namespace heatsoak::check {

struct CheckJob {
  std::vector<std::string> files;  ///< names given by the user; files that came with the program are found too
  bool updates = false;            ///< set the limits to the present values
  double margin_share = 0.05;      ///< room of the new limits, as in with_new_limits()
  int threads = 0;                 ///< 0: all cores; the result does not depend on it
};

struct RewrittenFile {
  std::filesystem::path path;
  std::string text;
};

struct CheckAnswer {
  std::vector<CheckFile> files;  ///< files that were read; `outcomes` points into them
  std::vector<Outcome> outcomes;
  std::vector<RewrittenFile> rewritten;  ///< files whose limits changed; not yet written

  [[nodiscard]] bool passed() const;
};

/// Throws Failure (bad_input) with the problems of all files together, or if a file that came with the program would have to be rewritten.
CheckAnswer run_check_job(const CheckJob& job, const input::DataFolders& folders, const base::ProgressFor& progress = {});

}  // namespace heatsoak::check
