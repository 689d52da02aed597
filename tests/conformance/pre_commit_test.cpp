// Hooks for pre-commit, run by pre-commit in a repository of a team.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "program_run.h"
#include "support/skip_reasons.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

using testing::HasSubstr;

constexpr const char* kConfiguration = R"(repos:
  - repo: ../hooks
    rev: v1.0
    hooks:
      - id: heatsoak-lint
      - id: heatsoak-check
        args: [robot.check.toml]
)";

constexpr const char* kLimits = R"([[check]]
name = "ours bears the load of the paper"
robot = "roboteam_twente_v2024"
duty = "paper_intermittent"
motor = "motors/ours.toml"

[check.limits]
winding_peak_p95 = "at most 70 degC"
)";

/// A team's repository beside one that holds only the hooks of this project. Nothing is read from the settings of the user.
class PreCommit : public testing::Test {
 protected:
  void SetUp() override {
    if (run_line("pre-commit --version").exit_code != 0) {
      GTEST_SKIP() << HEATSOAK_FAILS_CI << "pre-commit is not installed, so the hooks are not tested";
    }
    std::filesystem::create_directories(team_ / "motors");
    std::filesystem::create_directories(folder_.path() / "hooks");
    std::filesystem::copy(kSource / ".pre-commit-hooks.yaml", folder_.path() / "hooks");
    write(team_ / ".pre-commit-config.yaml", kConfiguration);
    write(team_ / "robot.check.toml", kLimits);
    write(team_ / "motors/ours.toml", motor());
    const ProgramRun made = here(
        "git -C ../hooks init -q && git -C ../hooks add . && git -C ../hooks commit -qm hooks && git -C ../hooks tag v1.0 && "
        "git init -q && git add . && pre-commit install >&2");
    ASSERT_EQ(made.exit_code, 0) << made.out << made.err;
  }

  static std::string motor() { return content_of(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml"); }

  /// Runs a line in the team's repository.
  ProgramRun here(const std::string& line) {
    const std::string home = folder_.path().string();
    RunOptions options;
    options.folder = team_;
    options.environment = {"HOME=" + home, "XDG_CACHE_HOME=" + home + "/cache", "PRE_COMMIT_HOME=" + home + "/pre-commit",
                           "GIT_CONFIG_NOSYSTEM=1", "GIT_AUTHOR_NAME=team", "GIT_AUTHOR_EMAIL=team@example.org",
                           "GIT_COMMITTER_NAME=team", "GIT_COMMITTER_EMAIL=team@example.org", "GIT_DIR", "GIT_INDEX_FILE",
                           "GIT_WORK_TREE"};
    return run_line(line, options);
  }

  /// Writes the motor file and commits it. Returns the result of `git commit`, with all that the hooks print.
  ProgramRun commit(const std::string& text) {
    write(team_ / "motors/ours.toml", text);
    return here("git add . && git commit -m change 2>&1");
  }

  TemporaryFolder folder_;
  std::filesystem::path team_ = folder_.path() / "team";
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return place == std::string::npos ? text : text.replace(place, from.size(), to);
}

TEST_F(PreCommit, LetsACommitPassThatKeepsTheLimits) {
  const ProgramRun done = commit(motor());
  EXPECT_EQ(done.exit_code, 0) << done.out;
  EXPECT_THAT(done.out, HasSubstr("limits of the robot hold"));
  EXPECT_THAT(done.out, HasSubstr("Passed"));
}

TEST_F(PreCommit, StopsACommitOfAContradictoryMotor) {
  const ProgramRun done = commit(replaced(motor(), "speed_constant = { value = \"339 rpm/V\"", "speed_constant = { value = \"3390 rpm/V\""));
  EXPECT_NE(done.exit_code, 0);
  EXPECT_THAT(done.out, HasSubstr("motors/ours.toml:"));
  EXPECT_NE(here("git rev-parse --verify -q HEAD").exit_code, 0) << "the commit was made";
}

TEST_F(PreCommit, StopsACommitThatBreaksALimit) {
  write(team_ / "robot.check.toml", replaced(kLimits, "70 degC", "40 degC"));
  const ProgramRun done = commit(motor());
  EXPECT_NE(done.exit_code, 0);
  EXPECT_THAT(done.out, HasSubstr("winding_peak"));
  EXPECT_NE(here("git rev-parse --verify -q HEAD").exit_code, 0) << "the commit was made";
}

}  // namespace
}  // namespace heatsoak
