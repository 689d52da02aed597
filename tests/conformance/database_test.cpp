// Other data bases: --db and paths of motors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

std::vector<std::string> ids(const json& list) {
  std::vector<std::string> result;
  for (const json& item : list.at("items")) {
    result.push_back(item.at("id"));
  }
  return result;
}

TEST(Database, may_be_a_copied_tree) {
  const TemporaryFolder folder;
  const std::string motor = "maxon_ec45_flat_70w_24v.toml";
  fs::create_directories(folder.path() / "motor_db");
  fs::create_directories(folder.path() / "duty_profiles");
  fs::copy_file(kSource / "motor_db" / motor, folder.path() / "motor_db" / "mine.toml");
  fs::copy_file(kSource / "duty_profiles" / "paper_intermittent.toml", folder.path() / "duty_profiles" / "my_duty.toml");
  const Words database{"--db", folder.path().string()};
  EXPECT_THAT(ids(run(Words{"list", "motors", "--json", "-"} + database).json()), UnorderedElementsAre("mine"));
  EXPECT_THAT(ids(run(Words{"list", "duties", "--json", "-"} + database).json()), UnorderedElementsAre("my_duty"));
  EXPECT_THAT(ids(run(Words{"list", "robots", "--json", "-"} + database).json()),
              Contains("tigers_v2020"));  // folders that are missing in the copy use the shipped data
  const ProgramRun result =
      run(Words{"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "my_duty", "--samples", "0", "--json", "-"} + database);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.json().at("motors").at(0).at("id"), "mine");
}

TEST(Database, may_be_a_folder_of_motor_files_alone) {
  const TemporaryFolder folder;
  fs::copy_file(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml", folder.path() / "mine.toml");
  const Words database{"--db", folder.path().string()};
  EXPECT_THAT(ids(run(Words{"list", "motors", "--json", "-"} + database).json()), UnorderedElementsAre("mine"));
  EXPECT_EQ(
      run(Words{"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--samples", "0"} + database).exit_code, 0);
  EXPECT_EQ(run(Words{"steady", "--motor", "mine", "--current-on", "6A", "--time-on", "4s", "--time-off", "6s"} + database).exit_code, 0);
}

TEST(Database, without_any_motor_passes_no_verdict) {
  const TemporaryFolder folder;
  const ProgramRun result =
      run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--db", folder.path().string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("there is no motor file"));
}

TEST(Database, a_motor_may_be_a_path) {
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  fs::copy_file(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml", folder.path() / "mine with blanks, ä.toml");
  const Words rest{"--current-on", "6A", "--time-on", "4s", "--time-off", "6s", "--json", "-"};
  for (const std::string& path : {std::string("mine with blanks, ä.toml"), std::string("./mine with blanks, ä.toml"),
                                  (folder.path() / "mine with blanks, ä.toml").string()}) {
    const ProgramRun result = run(Words{"steady", "--motor", path} + rest, inside);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.json().at("motor"), "mine with blanks, ä");
  }
}

TEST(Database, a_comma_may_be_part_of_a_path) {
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  fs::copy_file(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml", folder.path() / "small, fast.toml");
  const ProgramRun result = run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--motors",
                                 "small, fast.toml", "--samples", "0", "--json", "-"},
                                inside);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.json().at("motors").at(0).at("id"), "small, fast");
}

TEST(Database, two_motors_of_one_id_are_ambiguous) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"}) {
    fs::create_directory(folder.path() / name);
    fs::copy_file(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml", folder.path() / name / "x.toml");
  }
  const ProgramRun result = run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--motors",
                                 (folder.path() / "b/x.toml").string() + "," + (folder.path() / "a/x.toml").string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, testing::HasSubstr("two motors with the same id, 'x'"));
}

TEST(Database, a_robot_may_name_the_file_of_its_motor_beside_it) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "team");
  std::string robot = content_of(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  const std::string id = "motor = \"maxon_ecx_flat_32l_48v\"";
  robot.replace(robot.find(id), id.size(), "motor = \"my_motor.toml\"");
  write(folder.path() / "team/robot.toml", robot);
  RunOptions outside;
  outside.folder = folder.path();
  const ProgramRun missing = run({"lint", "team/robot.toml"}, outside);
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.out, testing::AllOf(HasSubstr("there is no file"), HasSubstr("team/my_motor.toml"))) << missing.err;
  fs::copy_file(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml", folder.path() / "team/my_motor.toml");
  EXPECT_EQ(run({"lint", "team/robot.toml"}, outside).exit_code, 0);
  const ProgramRun ranked =
      run({"evaluate", "--robot", "team/robot.toml", "--duty", "paper_intermittent", "--samples", "0", "--quiet"}, outside);
  EXPECT_THAT(ranked.out, HasSubstr("robot's own my_motor")) << ranked.err;
  write(folder.path() / "check.toml",
        "[[check]]\nname = \"own motor\"\nrobot = \"team/robot.toml\"\nduty = \"paper_intermittent\"\nsamples = \"500\"\n"
        "[check.limits]\nwinding_peak_p95 = \"at most 125 degC\"\n");
  const ProgramRun checked = run({"check", "check.toml"}, outside);
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("own motor (my_motor, robot, paper_intermittent)"));
}

TEST(Database, an_unknown_motor_of_a_robot_names_what_is_expected) {
  const TemporaryFolder folder;
  std::string robot = content_of(kSource / "robot_core/robots/tigers_v2020.toml");
  const std::string id = "motor = \"nanotec_df45l024048_a2\"";
  robot.replace(robot.find(id), id.size(), "motor = \"nanotec_df45l024048_a3\"");
  write(folder.path() / "robot.toml", robot);
  EXPECT_THAT(run({"lint", (folder.path() / "robot.toml").string()}).out,
              testing::ContainsRegex("expected an id of `heatsoak list motors`.*did you mean 'nanotec_df45l024048_a2'"));
}

TEST(Database, a_broken_file_is_reported_and_not_skipped) {
  const TemporaryFolder folder;
  fs::copy_file(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml", folder.path() / "good.toml");
  write(folder.path() / "broken.toml", "x =");
  for (const Words& words : {Words{"list", "motors"}, Words{"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermittent"}}) {
    const ProgramRun result = run(words + Words{"--db", folder.path().string()});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr("broken.toml:1:"));
  }
}

}  // namespace
}  // namespace heatsoak
