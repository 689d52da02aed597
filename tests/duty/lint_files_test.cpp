// The answer of `lint`: names of files, folders and ids, and every problem in one report.
#include "duty/lint_files.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <tuple>

#include "base/diagnostic.h"
#include "base/files.h"
#include "motor/read_motor.h"
#include "robot/robot_lint.h"
#include "support/shipped.h"
#include "support/shipped_folders.h"

namespace heatsoak::duty {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class LintFiles : public testing::Test {
 protected:
  LintFiles() { fs::create_directories(folder_); }
  ~LintFiles() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  static std::vector<std::string> words(const std::vector<motor::LintFinding>& findings) {
    std::vector<std::string> all;
    for (const motor::LintFinding& each : findings) {
      all.push_back(each.at.file + ": " + message_of(each));
    }
    return all;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("lint_files_" + std::to_string(::getpid()));
};

// A folder is the same as all of its files, an id the same as its file, in the order in which they are named.
TEST_F(LintFiles, FolderAndIdsStandForTheirFiles) {
  for (const char* id : {"maxon_ecx_flat_32l_48v", "maxon_ec45_flat_70w_24v"}) {
    fs::copy(kSource / "motor_db" / (std::string(id) + ".toml"), folder_);
  }
  const std::string first = (folder_ / "maxon_ec45_flat_70w_24v.toml").string();
  const std::string second = (folder_ / "maxon_ecx_flat_32l_48v.toml").string();
  const FilesLint of_folder = lint_files(std::vector{folder_.string()}, kShippedFolders);
  const FilesLint of_files = lint_files(std::vector{first, second}, kShippedFolders);
  EXPECT_THAT(of_folder.files, ElementsAre(first, second));
  EXPECT_EQ(words(of_folder.findings), words(of_files.findings));
  const std::string robot = (kSource / "robot_core/robots/roboteam_twente_v2024.toml").string();
  const FilesLint of_ids = lint_files(std::vector<std::string>{"roboteam_twente_v2024", "division_a_match"}, kShippedFolders);
  EXPECT_THAT(of_ids.files, ElementsAre(robot, (kSource / "duty_profiles/division_a_match.toml").string()));
  EXPECT_EQ(words(of_ids.findings), words(robot::lint(robot::read_robot(robot), input::ids_in(kShippedFolders.motors))));
}

// Findings come from the law of the file's kind: a motor file with the findings of motor::lint(), and one more without rotor inertia.
TEST_F(LintFiles, MotorWithoutRotorInertiaIsNotedAtItsFile) {
  std::size_t without = 0;
  for (const std::string& id : input::ids_in(kShippedFolders.motors)) {
    const motor::Motor motor = shipped_motor(id);
    const FilesLint lint = lint_files(std::vector{id}, kShippedFolders);
    const std::size_t more = motor.nominal.rotor_inertia_kg_m2 ? 0 : 1;
    without += more;
    ASSERT_EQ(lint.findings.size(), motor::lint(motor).size() + more) << id;
    EXPECT_EQ(lint.count(motor::LintFinding::Level::error), 0U) << id;
    EXPECT_TRUE(more == 0 || std::ranges::count(lint.findings, "rotor_inertia", &motor::LintFinding::key) == 1) << id;
  }
  EXPECT_GT(without, 0U);
}

// A template with a wrong value: the checks of the data sheet give notes and errors on several lines.
TEST_F(LintFiles, ErrorsComeFirstThenWarningsThenNotesInTheOrderOfLines) {
  const auto wrong = [&](const std::string& id) {
    std::string text = base::read_file(kSource / "motor_db" / (id + ".toml"), 1'000'000);
    const std::string key = "torque_constant = { value = \"";
    const std::size_t from = text.find(key) + key.size();
    text.replace(from, text.find('"', from) - from, "90 mN m/A");
    return put(id + ".toml", text);
  };
  const FilesLint lint =
      lint_files(std::vector{wrong("maxon_ec45_flat_70w_24v"), wrong("maxon_ec45_flat_70w_30v_402685")}, kShippedFolders);
  EXPECT_GT(lint.count(motor::LintFinding::Level::error), 0U);
  EXPECT_GT(lint.count(motor::LintFinding::Level::note), 0U);
  const auto place = [&](const motor::LintFinding& each) {
    return std::tuple(each.level, std::ranges::find(lint.files, each.at.file), each.at.line);
  };
  EXPECT_TRUE(std::ranges::is_sorted(lint.findings, {}, place));
}

// Three broken names in one report: an unknown id, a file that is no TOML, and a folder without files.
TEST_F(LintFiles, AllProblemsAreReportedAtOnce) {
  const std::string broken = put("broken.toml", "id = \n");
  fs::create_directory(folder_ / "empty");
  try {
    lint_files(std::vector<std::string>{"maxon_ecx_flat_32l_48", broken, (folder_ / "empty").string()}, kShippedFolders);
    FAIL();
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_THAT(failure.message(), HasSubstr("did you mean 'maxon_ecx_flat_32l_48v'?"));
    EXPECT_THAT(failure.message(), HasSubstr("there is no .toml file in the folder"));
    ASSERT_FALSE(failure.diagnostics().empty());
    EXPECT_EQ(failure.diagnostics().front().at.file, broken);
    EXPECT_EQ(failure.diagnostics().front().at.line, 1);
  }
}

TEST_F(LintFiles, LogsArePassedToTheVerbThatChecksThem) {
  const std::string log = put("sim.csv", "time_s,current_A\n0,1\n1,2\n");
  try {
    lint_files(std::vector{log}, kShippedFolders);
    FAIL();
  } catch (const base::Failure& failure) {
    ASSERT_EQ(failure.diagnostics().size(), 1U) << failure.what();
    EXPECT_THAT(failure.diagnostics().front().message, HasSubstr("`heatsoak log inspect FILE`"));
  }
}

// A broken file beside a readable one: the findings of the other are kept.
TEST_F(LintFiles, UnreadableFilesDoNotHideFindings) {
  const std::string broken = put("broken.toml", "id = \n");
  const std::string sound = "maxon_dcx19s_24v";
  const FilesLint alone = lint_files(std::vector{sound}, kShippedFolders);
  const FilesLint both = lint_files(std::vector{broken, sound}, kShippedFolders);
  ASSERT_FALSE(alone.findings.empty());
  EXPECT_FALSE(alone.unreadable);
  EXPECT_EQ(words(both.findings), words(alone.findings));
  ASSERT_TRUE(both.unreadable);
  EXPECT_EQ(both.unreadable->code(), base::ExitCode::bad_input);
  EXPECT_EQ(both.unreadable->diagnostics().front().at.file, broken);
}

}  // namespace
}  // namespace heatsoak::duty
