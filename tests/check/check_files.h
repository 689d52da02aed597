// Reads and runs check files from their text.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/files.h"
#include "check/check_file.h"
#include "check/check_job.h"
#include "support/shipped_folders.h"

namespace heatsoak::check {

namespace fs = std::filesystem;

/// A check of the paper's duty, without limits.
inline const std::string kHead =
    "[[check]]\nname = \"paper\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"paper_intermittent\"\nmotor = \"maxon_ecx_flat_42m_24v\"\n";

class CheckFiles : public testing::Test {
 protected:
  CheckFiles() { fs::create_directory(folder_); }
  ~CheckFiles() override { fs::remove_all(folder_); }

  [[nodiscard]] CheckFile read(const std::string& text) const {
    base::write_file(folder_ / "a.check.toml", text);
    return read_check_file(folder_ / "a.check.toml", kShippedFolders);
  }
  [[nodiscard]] std::string message_of(const std::string& text) const {
    try {
      static_cast<void>(read(text));
    } catch (const base::Failure& failure) {
      return failure.what();
    }
    return "nothing was wrong";
  }
  [[nodiscard]] CheckJob job_of(const std::string& text, int threads = 1) const {
    base::write_file(folder_ / "a.check.toml", text);
    return {.files = {(folder_ / "a.check.toml").string()}, .threads = threads};
  }
  /// Returns the outcomes of the text. They point into `answer_`.
  [[nodiscard]] std::vector<Outcome> outcomes(const std::string& text) {
    answer_ = run_check_job(job_of(text), kShippedFolders);
    return answer_.outcomes;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / fmt::format("heatsoak_check_{}", static_cast<int>(getpid()));
  CheckAnswer answer_;
};

}  // namespace heatsoak::check
