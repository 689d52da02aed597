// The answer of `check` over several files: one report of all problems, and the files with new limits.
#include "check/check_job.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include "base/files.h"
#include "support/shipped_folders.h"

namespace heatsoak::check {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class CheckJobs : public testing::Test {
 protected:
  CheckJobs() { fs::create_directory(folder_); }
  ~CheckJobs() override { fs::remove_all(folder_); }

  /// Writes a check of the nominal peak and returns its name. `limit` is in degC.
  [[nodiscard]] std::string put(const std::string& name, const std::string& limit) const {
    const fs::path file = folder_ / (name + ".check.toml");
    base::write_file(file, "[[check]]\nname = \"" + name +
                               "\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"paper_intermittent\"\nmotor = \"maxon_ecx_flat_42m_24v\"\n"
                               "samples = \"80\"\n[check.limits]\nwinding_peak_p95 = \"at most " +
                               limit + "\"\n");
    return file.string();
  }

  fs::path folder_ = fs::path(testing::TempDir()) / fmt::format("heatsoak_check_job_{}", static_cast<int>(getpid()));
};

TEST_F(CheckJobs, ProblemsOfAllFilesAreOneReport) {
  const std::string good = put("good", "150 degC");
  const std::string no_unit = put("no_unit", "150");
  const std::string in_volt = put("in_volt", "150 V");
  CheckJob job{.files = {no_unit, good, in_volt}};
  try {
    run_check_job(job, kShippedFolders);
    FAIL();
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), AllOf(HasSubstr(no_unit), HasSubstr(in_volt), testing::Not(HasSubstr(good))));
  }
  // For a report that names every limit, the valid file is evaluated all the same. The job does not pass.
  job.evaluates_beside_invalid = true;
  const CheckAnswer answer = run_check_job(job, kShippedFolders);
  ASSERT_EQ(answer.outcomes.size(), 1U);
  EXPECT_TRUE(answer.outcomes.front().passed());
  EXPECT_TRUE(answer.invalid);
  EXPECT_FALSE(answer.passed());
}

TEST_F(CheckJobs, OnlyFilesWhoseLimitsChangeAreRewritten) {
  const std::string tight = put("tight", "30 degC");
  CheckJob job{.files = {tight}, .updates = true};
  const CheckAnswer first = run_check_job(job, kShippedFolders);
  ASSERT_EQ(first.rewritten.size(), 1U);
  EXPECT_EQ(first.rewritten.front().path, tight);
  EXPECT_THAT(base::read_file(tight, 1'000'000), HasSubstr("at most 30 degC")) << "the job itself writes nothing";
  EXPECT_TRUE(first.passed());
  base::write_file(tight, first.rewritten.front().text);
  const CheckAnswer second = run_check_job(job, kShippedFolders);
  EXPECT_TRUE(second.rewritten.empty());
  EXPECT_TRUE(second.passed());
}

TEST_F(CheckJobs, FilesOfTheProgramAreNotRewritten) {
  CheckJob job{.files = {"reports/check/twente.check.toml"}, .updates = true};
  try {
    run_check_job(job, kShippedFolders);
    FAIL();
  } catch (const base::Failure& failure) {
    EXPECT_THAT(failure.message(), HasSubstr("is part of the installed program and is not rewritten"));
  }
}

}  // namespace
}  // namespace heatsoak::check
