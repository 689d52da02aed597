// Checks whose inputs are wrong or missing, found when the file is read.
#include <gmock/gmock.h>
#include <unistd.h>

#include "base/files.h"
#include "check/check_file.h"
#include "check/command_answers.h"
#include "check/run_checks.h"
#include "check/typed_outcome.h"
#include "support/shipped_folders.h"

namespace heatsoak::check {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class CheckInputsOf : public testing::Test {
 protected:
  CheckInputsOf() { fs::create_directory(folder_); }
  ~CheckInputsOf() override { fs::remove_all(folder_); }

  fs::path folder_ = fs::path(testing::TempDir()) / ("heatsoak_inputs_" + std::to_string(getpid()));
};

TEST_F(CheckInputsOf, CommandsAreCheckedWhenTheFileIsRead) {
  const CheckInputs inputs = [](const std::vector<std::string>& words, const fs::path& folder) {
    if (words.front() == "steady") {
      return;
    }
    throw base::Failure(base::ExitCode::bad_input, "--motro is not known",
                        {{{"motor.toml", 4, 2}, "name", "is a number"}, {{(folder / "log.csv").string()}, "", "cannot be read"}});
  };
  base::write_file(folder_ / "a.check.toml",
                   "[[check]]\nname = \"a\"\n  command = \"evaluate --motro m\"\n[check.limits]\nx = \"at most 1\"\n"
                   "[[check]]\nname = \"b\"\ncommand = \"steady\"\n[check.limits]\nx = \"at least\"\n");
  std::string said;
  try {
    static_cast<void>(read_check_file(folder_ / "a.check.toml", kShippedFolders, inputs));
  } catch (const base::Failure& failure) {
    said = failure.what();
  }
  EXPECT_THAT(said, HasSubstr("a.check.toml:3:13: error: check[0].command: --motro is not known"));
  EXPECT_THAT(said, HasSubstr("a.check.toml:3:13: error: check[0].command: " + (folder_ / "log.csv").string() + ": cannot be read"));
  EXPECT_THAT(said, HasSubstr((folder_ / "motor.toml").string() + ":4:2: error: name: is a number")) << "its path begins at the check file";
  EXPECT_THAT(said, HasSubstr("check[1].limits.x"));
  EXPECT_THAT(said, Not(HasSubstr("check[1].command")));
}

TEST_F(CheckInputsOf, LintOfNothingFails) {
  base::write_file(folder_ / "a.check.toml", "[[check]]\nname = \"x\"\n[check.limits]\nlint_problems = \"at most 0\"\n");
  const CheckFile file = read_check_file(folder_ / "a.check.toml", kShippedFolders);
  const std::vector<Outcome> all = run_checks(file, 1, CommandAnswers());
  EXPECT_FALSE(all.front().passed());
  EXPECT_TRUE(reason_of<NothingToLint>(all.front()));
}

}  // namespace
}  // namespace heatsoak::check
