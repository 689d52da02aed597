// All mistakes are reported at once, each with advice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string kMotorFile = (kSource / "motor_db/maxon_ec45_flat_70w_24v.toml").string();
const std::string kRobotFile = (kSource / "robot_core/robots/tigers_v2020.toml").string();
const std::string kDutyFile = (kSource / "duty_profiles/paper_intermittent.toml").string();

TEST(AllAtOnce, wrong_ids_of_every_kind) {
  const ProgramRun result = run({"evaluate", "--robot", "tigers_v2021", "--duty", "paper_intermitent", "--motors",
                                 "maxon_ec45_flat_70w_24,maxon_dcx19s_24v,foo", "--json", "-"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("no robot 'tigers_v2021'"), HasSubstr("no duty 'paper_intermitent'"),
                                HasSubstr("no motor 'maxon_ec45_flat_70w_24'"), HasSubstr("no motor 'foo'")));
  EXPECT_EQ(result.json().at("error").at("code"), 2);
  const ProgramRun simulated = run({"simulate", "--robot", "a", "--duty", "b", "--motor", "c"});
  EXPECT_THAT(simulated.err, AllOf(HasSubstr("no robot 'a'"), HasSubstr("no duty 'b'"), HasSubstr("no motor 'c'")));
}

TEST(AllAtOnce, wrong_ids_beside_wrong_files) {
  const TemporaryFolder folder;
  write(folder.path() / "robot.toml", "name = 1\n[wheels]\nradius = 2\n");
  const ProgramRun result = run({"evaluate", "--robot", (folder.path() / "robot.toml").string(), "--duty", "nosuch", "--motors", "foo"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("no duty 'nosuch'"), HasSubstr("no motor 'foo'"), HasSubstr("robot.toml:3:10: error: wheels.radius")));
}

// The program reports a misspelt motor and a wrong option value together, so that a user corrects both at once.
TEST(AllAtOnce, wrong_ids_beside_wrong_options) {
  const ProgramRun result =
      run({"steady", "--motor", "maxon_ec45_flat_70w_24", "--current-on", "6V", "--time-on", "1s", "--time-off", "1s"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("no motor 'maxon_ec45_flat_70w_24'"), HasSubstr("--current-on")));
  const auto evaluated = [](const char* motors) {
    return run({"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermittent", "--motors", motors, "--plot", "x.jpg"}).err;
  };
  EXPECT_THAT(evaluated("maxon_dcx19s_24v,foo"), AllOf(HasSubstr("no motor 'foo'"), HasSubstr("x.jpg")));
  EXPECT_THAT(evaluated("maxon_dcx19s_24v,maxon_ecx_flat_32l_48v"), Not(HasSubstr("no motor")));
  EXPECT_THAT(evaluated("all"), Not(HasSubstr("no motor")));
}

// Contradicting values of a robot are refused by every verb that computes with them, at the same place.
TEST(ImplausibleRobot, is_refused_by_every_verb) {
  const TemporaryFolder folder;
  std::string text = content_of(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  const std::string radius = "\nradius = \"28 mm\"";
  text.replace(text.find(radius), radius.size(), "\nradius = \"62 mm\"");
  const std::string robot = (folder.path() / "robot.toml").string();
  write(robot, text);
  const auto line =
      std::to_string(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find("radius = \"62")), '\n') + 1);
  const std::string place = robot + ":" + line + ":";
  const std::string motor = "maxon_ecx_flat_32l_48v";
  const std::string out = (folder.path() / "out").string();
  for (const Words& words :
       std::vector<Words>{{"evaluate", "--robot", robot, "--duty", "paper_intermittent", "--motors", motor, "--json", "-"},
                          {"simulate", "--robot", robot, "--duty", "paper_intermittent", "--motor", motor, "--json", "-"},
                          {"derate", "--robot", robot, "--motor", motor, "--out", out, "--json", "-"},
                          {"generate", "core", "--robot", robot, "--motor", motor, "--out", out, "--json", "-"},
                          {"duty", "--robot", robot, "--duty", "paper_intermittent", "--json", "-"}}) {
    const ProgramRun result = run(words);
    EXPECT_EQ(result.exit_code, 2) << words.front();
    EXPECT_THAT(result.err, HasSubstr(place)) << words.front();
    const nlohmann::json diagnostics = result.json().at("error").at("diagnostics");
    ASSERT_EQ(diagnostics.size(), 1U) << words.front();
    EXPECT_EQ(diagnostics.at(0).at("key"), "wheels.radius") << words.front();
  }
  EXPECT_EQ(run({"lint", robot}).exit_code, 1);
  write(folder.path() / "check.toml", "[[check]]\nname = \"a\"\nrobot = \"robot.toml\"\nduty = \"paper_intermittent\"\nmotor = \"" + motor +
                                          "\"\n[check.limits]\nwinding_peak_p95 = \"at most 150 degC\"\n");
  const ProgramRun checked = run({"check", (folder.path() / "check.toml").string()});
  EXPECT_EQ(checked.exit_code, 1) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("wheels.radius"));
}

TEST(AllMotors, may_stand_beside_a_file) {
  const TemporaryFolder folder;
  write(folder.path() / "mine.toml", content_of(kMotorFile));
  const auto count = [&](const std::string& motors) {
    return run({"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermittent", "--samples", "0", "--json", "-", "--motors", motors})
        .json()
        .at("motors")
        .size();
  };
  EXPECT_EQ(count("all," + (folder.path() / "mine.toml").string()), count("all") + 1);
}

TEST(Evaluate, an_empty_name_in_a_list_of_motors_is_reported) {
  for (const std::string motors : {",", "maxon_dcx19s_24v,", ",maxon_dcx19s_24v"}) {
    const ProgramRun result = run({"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermittent", "--motors", motors});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("--motors " + motors + ": a name is missing before or after a comma"));
  }
}

// Files of another kind than expected.

struct Misplaced {
  std::string name;
  Words words;
  std::string said;
};
class WrongKind : public testing::TestWithParam<Misplaced> {};

TEST_P(WrongKind, is_reported_in_one_line) {
  const ProgramRun result = run(GetParam().words);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr(GetParam().said));
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
}

INSTANTIATE_TEST_SUITE_P(
    files, WrongKind,
    testing::Values(
        Misplaced{"motor_as_robot",
                  {"evaluate", "--robot", kMotorFile, "--duty", "paper_intermittent", "--motors", "maxon_dcx19s_24v"},
                  "maxon_ec45_flat_70w_24v.toml: error: is a motor file; expected a robot file here (`heatsoak list robots`"},
        Misplaced{"duty_as_robot", {"duty", "--robot", kDutyFile, "--duty", "division_a_match"}, "is a duty file; expected a robot file"},
        Misplaced{"motor_as_duty",
                  {"simulate", "--robot", "tigers_v2020", "--duty", kMotorFile, "--motor", "maxon_dcx19s_24v"},
                  "is a motor file; expected a duty file here (`heatsoak list duties`"},
        Misplaced{"robot_as_duty", {"duty", "--robot", "tigers_v2020", "--duty", kRobotFile}, "is a robot file; expected a duty file"},
        Misplaced{"robot_as_motor",
                  {"steady", "--motor", kRobotFile, "--current-on", "1", "--time-on", "1", "--time-off", "1"},
                  "is a robot file; expected a motor file"},
        Misplaced{"duty_as_motor",
                  {"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermittent", "--motors", kDutyFile},
                  "is a duty file; expected a motor file"},
        Misplaced{"robot_as_model",
                  {"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermittent", "--model", kRobotFile},
                  "is a robot file; expected a motor file"}),
    [](const auto& instance) { return instance.param.name; });

TEST(AllAtOnce, wrong_values_and_missing_options) {
  const ProgramRun result = run({"steady", "--current-on", "-3A", "--time-on=1kg", "--time-off", "-6s", "--ambient", "25degC"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("--current-on: -3A is out of range"), HasSubstr("--time-on"), HasSubstr("--time-off: -6s is out"),
                                HasSubstr("--motor is required"), Not(HasSubstr("--ambient"))));
}

TEST(AllAtOnce, wrong_numbers_and_words) {
  const ProgramRun result = run({"simulate", "--robot", "tigers_v2020", "--planner", "fast", "--every", "0", "--plot", "a.gif"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("--planner"), HasSubstr("--every"), HasSubstr("--plot: a.gif does not end in .svg or .png")));
}

TEST(AllAtOnce, options_that_do_not_exist) {
  const ProgramRun result = run({"evaluate", "--robt", "x", "--dty", "y"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("did you mean '--robot'?"), HasSubstr("did you mean '--duty'?")));
}

TEST(Describe, knows_what_begins_alike) {
  const ProgramRun result = run({"describe", "iron_lossX"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("did you mean 'iron_loss_"));
}

TEST(List, of_a_folder_without_files_is_refused) {
  const TemporaryFolder folder;
  const ProgramRun result = run({"list", "motors", "--db", folder.path().string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("there is no .toml file in " + folder.path().string()));
}

// 700 A through a motor rated for 3.3 A is a wrong input, not a failure of the numerics.
TEST(Evaluate, an_absurd_current_is_bad_input) {
  const TemporaryFolder folder;
  std::string robot = content_of(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  const auto replace = [&robot](const std::string& from, const std::string& to) {
    ASSERT_NE(robot.find(from), std::string::npos) << from;
    robot.replace(robot.find(from), from.size(), to);
  };
  replace("voltage_limit = \"12.5 V\"\n", "");
  replace("nominal_voltage = \"22.2 V\"", "nominal_voltage = \"2220 V\"");
  replace("full_voltage = { value = \"25.2 V\", origin = \"derived\", derivation = \"six cells of 4.2 V\" }",
          "full_voltage = { value = \"2520 V\", origin = \"derived\", derivation = \"six cells of 4.2 V\" }");
  write(folder.path() / "robot.toml", robot);
  write(folder.path() / "duty.toml",
        "summary = \"x\"\norigin = \"x\"\nshape = \"intermittent\"\nambient = { value = \"25 degC\", origin = \"estimated\", derivation = "
        "\"x\" }\n[intermittent]\ncurrent_on = { value = \"700 A\", origin = \"estimated\", derivation = \"x\" }\nspeed_on = \"0 "
        "rad/s\"\ntime_on = \"60 s\"\ntime_off = \"3600 s\"\nrepeats = \"3\"\n");
  const ProgramRun result = run({"evaluate", "--robot", (folder.path() / "robot.toml").string(), "--duty",
                                 (folder.path() / "duty.toml").string(), "--motors", "maxon_ec45_flat_70w_24v"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("maxon_ec45_flat_70w_24v: the duty drives 700 A"), HasSubstr("expected at most about ")));
}

TEST(Outputs, larger_than_the_limit_of_the_user_are_refused_and_leave_nothing) {
#ifdef HEATSOAK_COUNTED
  GTEST_SKIP() << "the limit would cut the counters' own files, and no later run could add to them";
#endif
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  const ProgramRun result =
      run_line("ulimit -f 10; heatsoak duty --robot roboteam_twente_v2024 --duty division_a_match --out duty.csv", inside);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("cannot be written: File too large"));
  EXPECT_THAT(folder.names(), IsEmpty());
}

// If the requested robot is not in the log, the message lists the robots of the log and the problems of the log.
TEST(Import, of_a_missing_robot_lists_the_present_ones) {
  const TemporaryFolder folder;
  std::string game = "t_s,team,robot_id,x_m,y_m,yaw_rad\n";
  for (int i = 0; i < 2000; ++i) {
    game += std::to_string(0.02 * i) + ",blue,7," + std::to_string(0.01 * i) + ",0,0\n";
  }
  write(folder.path() / "game.csv", game);
  write(folder.path() / "late.csv", game + "1,blue,7,0,0,0\n");
  const Words words{"duty", "--robot", "tigers_v2020", "--player", "yellow 3", "--import"};
  Words one = words;
  one.push_back((folder.path() / "late.csv").string());
  const ProgramRun result = run(one);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("there is no robot 'yellow 3'"), HasSubstr("the log has blue 7"), HasSubstr("time must increase")));
}

// Each file is valid, but of another kind than expected: one message says so, instead of one for each unknown key.
TEST(OtherKind, a_robot_or_motor_file_is_no_check_file) {
  for (const auto& [file, kind] : {std::pair(kRobotFile, "robot"), std::pair(kMotorFile, "motor"), std::pair(kDutyFile, "duty")}) {
    const ProgramRun result = run({"check", file});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, AllOf(HasSubstr(std::string("is a ") + kind + " file"), HasSubstr("[[check]]"), Not(HasSubstr("unknown"))));
  }
}

TEST(OtherKind, a_table_is_no_duty_and_the_message_says_how_to_use_it) {
  const TemporaryFolder folder;
  write(folder.path() / "log.csv", "time_s,torque_Nm,speed_rad_per_s\n0,0.1,100\n1,0.1,100\n");
  RunOptions inside;
  inside.folder = folder.path();
  for (const std::string& name : {std::string("log.csv"), (folder.path() / "log.csv").string()}) {
    const ProgramRun result = run({"evaluate", "--robot", "tigers_v2020", "--duty", name, "--motors", "maxon_dcx19s_24v"}, inside);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, AllOf(HasSubstr("is a CSV table"), HasSubstr("describe recorded"), HasSubstr("--import")));
  }
  EXPECT_THAT(run({"evaluate", "--robot", "tigers_v2020", "--duty", "gone.csv", "--motors", "maxon_dcx19s_24v"}, inside).err,
              HasSubstr("no duty 'gone.csv'"));
}

}  // namespace
}  // namespace heatsoak
