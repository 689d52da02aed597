// Matches on the command line: the closed loop, a comparison of planners, and the sources of heat.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Runs without guard, because preparing the guard takes longer than the match.
const Words kMatch{"simulate", "--motor", "maxon_ecx_flat_42m_24v", "--robot", "roboteam_twente_v2024", "--duty", "division_b_match",
                   "--guard",  "off"};

TEST(SimulateMatch, writes_every_signal_in_bounded_memory) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  const ProgramRun result = run(kMatch + Words{"--out", "trace.csv", "--every", "0.1 s", "--seed", "3", "--json", "-"}, options);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_LT(result.memory_MB, 200.0);
  const json answer = result.json();
  std::istringstream lines(content_of(folder.path() / "trace.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_THAT(line, HasSubstr("time_s,phase,duel,plan_x_m"));
  const auto columns = std::ranges::count(line, ',');
  double last_s = 0.0;
  double hottest_C = 0.0;
  int rows = 0;
  for (; std::getline(lines, line); ++rows) {
    ASSERT_EQ(std::ranges::count(line, ','), columns);
    const double now_s = std::stod(line);
    EXPECT_NEAR(now_s - last_s, rows == 0 ? 0.0 : 0.1, 1e-6);
    last_s = now_s;
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; std::getline(cells, cell, ','); ++i) {
      if (i >= 16 && i < 16 + 4 * 9 && (i - 16) % 9 == 0) {
        hottest_C = std::max(hottest_C, std::stod(cell));
      }
    }
  }
  EXPECT_NEAR(0.1 * rows, answer.at("duration_s").get<double>(), 0.11);
  EXPECT_NEAR(hottest_C, answer.at("winding_peak_C").get<double>(), 0.5);
}

TEST(SimulateMatch, both_planners_stand_side_by_side) {
  const ProgramRun result = run(kMatch + Words{"--planner", "both", "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("jerk_limited  bang_bang"));
  EXPECT_THAT(result.err, HasSubstr("synthetic"));
  const json planners = result.json().at("planners");
  ASSERT_EQ(planners.size(), 2U);
  for (const json& each : planners) {
    double lost_J = 0.0;
    for (const auto& [name, value_J] : each.at("energy").items()) {
      lost_J += name == "battery_J" || name == "external_J" ? -value_J.get<double>() : value_J.get<double>();
    }
    EXPECT_NEAR(lost_J, 0.0, 0.1);
    double phases_J = 0.0;
    for (const json& phase : each.at("phases")) {
      phases_J += phase.at("copper_J").get<double>();
    }
    EXPECT_NEAR(phases_J, each.at("energy").at("copper_J").get<double>(), 0.1);
  }
}

TEST(SimulateMatch, same_seed_same_bytes) {
  const std::string once = run(kMatch + Words{"--json", "-"}).out;
  EXPECT_EQ(once, run(kMatch + Words{"--json", "-"}).out);
  EXPECT_NE(once, run(kMatch + Words{"--json", "-", "--seed", "2"}).out);
}

TEST(SimulateMatch, an_empty_battery_is_no_pass) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  std::string text = content_of(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  const std::size_t at = text.find("capacity = { value = \"1300 mA h\"");
  ASSERT_NE(at, std::string::npos);
  const std::size_t end = text.find(" }\n", at) + 2;  // the derivation continues over several lines
  text.replace(at, end - at, R"(capacity = { value = "20 mA h", origin = "estimated", derivation = "a battery that was not charged" })");
  write(folder.path() / "flat.toml", text);
  const ProgramRun result = run({"simulate", "--motor", "maxon_ecx_flat_42m_24v", "--robot", "flat.toml", "--duty", "division_b_match",
                                 "--guard", "off", "--json", "-"},
                                options);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("the battery is empty after"));
  const json answer = result.json();
  EXPECT_EQ(answer.at("verdict"), "infeasible");
  const json drive = answer.at("planners").at(0);
  EXPECT_GT(drive.at("battery_empty_s").get<double>(), 60.0);
  const json energy = drive.at("energy");
  EXPECT_LT(std::abs(energy.at("residual_J").get<double>()), 1e-3 * energy.at("battery_J").get<double>());
}

TEST(DutyImport, says_why_no_robot_can_be_followed) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  std::string text = "t_s,team,robot_id,x_m,y_m,yaw_rad\n";
  for (int i = 0; i < 200; ++i) {
    text += std::to_string(0.01 * i) + (i % 2 == 0 ? ",blue,3,1,-2,0\n" : ",blue,3,1500,-20,0\n");
  }
  write(folder.path() / "game.csv", text.substr(0, text.find("0.300000")));
  const ProgramRun result = run({"duty", "--import", "game.csv", "--robot", "tigers_v2020"}, options);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("no robot is seen long enough"));
  EXPECT_THAT(result.err, HasSubstr("15 detections left out: not a number, no such robot, outside any field"));
}

TEST(DutyImport, other_units_are_suspected) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  const std::string header = "t_s,team,robot_id,x_m,y_m,yaw_rad\n";
  std::string millimetres = header;
  std::string degrees = header;
  for (int i = 0; i < 400; ++i) {
    millimetres += std::to_string(0.01 * i) + ",blue,3,1500,-20,0\n";
    degrees += std::to_string(0.01 * i) + ",blue,3,1,1," + std::to_string(std::fmod(0.9 * i, 360.0)) + "\n";
  }
  for (const auto& [text, said] : {std::pair(millimetres, "millimetres"), std::pair(degrees, "degrees")}) {
    write(folder.path() / "game.csv", text);
    const ProgramRun result = run({"duty", "--import", "game.csv", "--robot", "tigers_v2020"}, options);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr(said));
  }
}

TEST(DutyImport, says_that_times_may_be_in_milliseconds) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  std::string text = "t_s,team,robot_id,x_m,y_m,yaw_rad\n";
  for (int i = 0; i < 400; ++i) {
    text += std::to_string(10 * i) + ",blue,3,1,1,0\n";
  }
  write(folder.path() / "game.csv", text);
  const ProgramRun result = run({"duty", "--import", "game.csv", "--robot", "tigers_v2020", "--out", "duty.csv"}, options);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("t_s advances by 10 s from row to row of a robot"));
  EXPECT_THAT(result.err, HasSubstr("is it in milliseconds"));
  EXPECT_THAT(folder.names(), testing::ElementsAre("game.csv"));
}

TEST(Describe, a_duty_shape_is_a_file_to_start_from) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  write(folder.path() / "my_game.csv", "time_s,torque_1_Nm,speed_1_rad_per_s\n0,0.1,20\n1,0,0\n");
  for (const std::string shape : {"intermittent", "recorded"}) {
    const json described = run({"describe", shape, "--json", "-"}, options).json();
    write(folder.path() / "mine.toml", described.at("example").get<std::string>());
    const ProgramRun result = run({"lint", "mine.toml"}, options);
    EXPECT_EQ(result.exit_code, 0) << shape << "\n" << result.err;
  }
}

/// Working folder that contains mine.toml.
struct OwnRobot {
  OwnRobot() {
    write(folder.path() / "mine.toml", robot);
    options.folder = folder.path();
  }
  const TemporaryFolder folder;
  const std::string robot = content_of(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  RunOptions options;
};

/// A user who takes --json for a switch may put an input file behind it, which must not be overwritten.
TEST(Outputs, an_answer_replaces_answers_only) {
  const auto& [folder, robot, options] = OwnRobot();
  for (const Words& line : {Words{"lint", "--json", "mine.toml"}, Words{"steady", "--json=mine.toml"},
                            Words{"evaluate", "--sampels", "0", "--json", "mine.toml"}, Words{"list", "motors", "--json", "mine.toml"}}) {
    const ProgramRun result = run(line, options);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("and --json would overwrite it")) << result.err;
    EXPECT_EQ(content_of(folder.path() / "mine.toml"), robot);
  }
  EXPECT_EQ(run({"lint", "--json", "--db", "."}, options).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "--db"));
  write(folder.path() / "empty.json", "");
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(run({"list", "motors", "--json", "empty.json"}, options).exit_code, 0) << "an answer replaces one before";
  }
}

// A script that reads the file must not see the answer before as that of the failed command.
TEST(Outputs, an_error_replaces_a_report_that_is_json) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  const Words steady{"steady", "--current-on", "3A", "--time-on", "1s", "--time-off", "1s", "--report", "r.json", "--motor"};
  EXPECT_EQ(run(steady + Words{"maxon_ecx_flat_42m_24v"}, options).exit_code, 0);
  EXPECT_EQ(run(steady + Words{"nobody"}, options).exit_code, 2);
  EXPECT_THAT(content_of(folder.path() / "r.json"), testing::AllOf(HasSubstr("\"error\""), HasSubstr("nobody")));
}

TEST(Outputs, never_replace_what_the_command_reads) {
  const auto& [folder, robot, options] = OwnRobot();
  const Words duty{"--robot", "mine.toml", "--duty", "paper_intermittent"};
  const Words evaluate{"--motors", "maxon_ecx_flat_42m_24v", "--samples", "0", "--json", "./mine.toml"};
  for (const Words& line : {Words{"duty", "--out", "mine.csv"} + duty, Words{"evaluate"} + duty + evaluate}) {
    const ProgramRun result = run(line, options);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("would overwrite it"));
    EXPECT_EQ(content_of(folder.path() / "mine.toml"), robot);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "mine.csv"));
  }
}

TEST(SimulateMatch, wrong_combinations_are_refused) {
  const Words robot{"simulate", "--motor", "maxon_ecx_flat_42m_24v", "--robot", "roboteam_twente_v2024"};
  for (const auto& [words, said] : std::vector<std::pair<Words, std::string>>{
           {robot, "one of --duty and --jerk-sweep"},
           {robot + Words{"--jerk-sweep", "--duty", "division_a_match"}, "one of --duty and --jerk-sweep"},
           {robot + Words{"--jerk-sweep", "--out", "x.csv"}, "--jerk-sweep has no signals"},
           {kMatch + Words{"--planner", "both", "--out", "x.csv"}, "--out holds one run"},
           {kMatch + Words{"--out", "x.csv", "--every", "1 ms"}, "too many rows"},
           {kMatch + Words{"--planner", "bangbang"}, "bang_bang"},
           {robot + Words{"--duty", "paper_intermittent", "--planner", "bang_bang"}, "--planner is for matches"},
           {robot + Words{"--duty", "paper_intermittent", "--guard", "on"}, "--guard and --sensing are for matches"},
           {kMatch + Words{"--sensing", "perfect"}, "ideal"}}) {
    const ProgramRun result = run(words);
    EXPECT_EQ(result.exit_code, 2) << said;
    EXPECT_THAT(result.err, HasSubstr(said));
    EXPECT_EQ(result.out, "");
  }
}

TEST(DutyMatch, an_option_without_effect_is_refused) {
  const Words robot{"--robot", "roboteam_twente_v2024"};
  const Words match = Words{"duty", "--duty", "division_a_match"} + robot;
  const Words load = Words{"duty", "--duty", "paper_intermittent"} + robot;
  const Words game = Words{"duty", "--import", "game.csv"} + robot;
  for (const auto& [words, said] : std::vector<std::pair<Words, std::string>>{
           {game + Words{"--planner", "bang_bang"}, "--planner is for matches"},
           {game + Words{"--planner", "jerk_limited"}, "--planner is for matches"},
           {game + Words{"--seed", "1"}, "--seed is for matches"},
           {match + Words{"--player", "yellow 3"}, "--player is for a recorded game"},
           {load + Words{"--planner", "bang_bang"}, "--planner is for matches; paper_intermittent is intermittent"},
           {load + Words{"--seed", "5"}, "--seed is for matches"},
           {match + Words{"--every", "1 s"}, "--every is for the rows of a table"},
           {match + Words{"--seed", "-1"}, "'-1' is not a whole number"},
           {match + Words{"--seed", "99999999999999999999"}, "is not a whole number from 0 to 18446744073709551615"},
           {kMatch + Words{"--seed", "-1"}, "'-1' is not a whole number"}}) {
    const ProgramRun result = run(words);
    EXPECT_EQ(result.exit_code, 2) << said;
    EXPECT_THAT(result.err, HasSubstr(said));
    EXPECT_EQ(result.out, "");
  }
}

TEST(Describe, a_match_shows_every_input_with_its_range) {
  const json described = run({"describe", "division_a_match", "--json", "-"}).json();
  ASSERT_FALSE(described.at("figures").empty());
  for (const json& parameter : described.at("figures")) {
    EXPECT_LT(parameter.at("range").at(0).get<double>(), parameter.at("range").at(1).get<double>()) << parameter.at("key");
    EXPECT_NE(parameter.at("meaning"), "");
    EXPECT_NE(parameter.at("derivation"), "");
  }
}

TEST(DutyMatch, heat_is_reported_by_phase_and_role) {
  const ProgramRun result = run({"duty", "--duty", "division_a_match", "--robot", "tigers_v2020", "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("keeper"));
  EXPECT_THAT(result.err, HasSubstr("duels (pushing at stall)"));
  EXPECT_THAT(result.err, HasSubstr("Share of torque squared"));
  const json answer = result.json();
  const json roles = answer.at("roles");
  ASSERT_EQ(roles.size(), 3U);
  double most_share = 0.0;
  double before_share = 0.0;
  for (const json& role : roles) {
    double sum_share = 0.0;
    double time_s = 0.0;
    for (const json& phase : role.at("phases")) {
      sum_share += phase.at("heat_share").get<double>();
      time_s += phase.at("time_s").get<double>();
      EXPECT_LE(phase.at("duel_heat_share").get<double>(), phase.at("heat_share").get<double>());
    }
    EXPECT_NEAR(sum_share, 1.0, 1e-5);
    EXPECT_NEAR(time_s, answer.at("duration_s").get<double>(), 0.1);
    most_share = std::max(most_share, role.at("heat_of_busiest_share").get<double>());
    // In play keeper, defender and attacker have increasing loads. Outside play all of them return to their places.
    const json running = role.at("phases").at(1);
    ASSERT_EQ(running.at("phase"), "running");
    const double in_play_share = running.at("heat_share").get<double>() * role.at("heat_of_busiest_share").get<double>();
    EXPECT_GT(in_play_share, before_share);
    before_share = in_play_share;
  }
  EXPECT_EQ(most_share, 1.0);
}

TEST(EvaluateMatch, a_match_and_its_own_export_give_the_same_temperature) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  const Words robot{"--robot", "roboteam_twente_v2024"};
  const ProgramRun written = run(Words{"duty", "--duty", "division_b_match", "--out", "match.csv"} + robot, options);
  ASSERT_EQ(written.exit_code, 0) << written.err;
  const auto peak_C = [&](const std::string& duty) {
    const Words motor{"--motors", "maxon_ecx_flat_32l_48v", "--samples", "0", "--no-changes", "--json", "-"};
    const ProgramRun evaluated = run(Words{"evaluate", "--duty", duty} + robot + motor, options);
    return evaluated.json().at("motors").at(0).at("winding_peak_C").at("nominal").get<double>();
  };
  // Rows of 0.01 s compared with bins of 0.25 s.
  EXPECT_NEAR(peak_C("match.toml"), peak_C("division_b_match"), 0.5);
}

TEST(EvaluateMatch, a_recording_costs_what_its_match_does) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  const Words robot{"--robot", "roboteam_twente_v2024"};
  // Ten times the usual number of rows would need half a gigabyte in memory.
  const ProgramRun written = run(Words{"duty", "--duty", "division_a_match", "--out", "match.csv", "--every", "1 ms"} + robot, options);
  ASSERT_EQ(written.exit_code, 0) << written.err;
  EXPECT_GT(std::filesystem::file_size(folder.path() / "match.csv"), 60'000'000U);
  EXPECT_LT(written.memory_MB, 60.0);
  options.time_limit_s = 60;
  const ProgramRun evaluated = run(Words{"evaluate", "--duty", "match.toml", "--samples", "100"} + robot, options);
  EXPECT_LE(evaluated.exit_code, 1) << evaluated.err;
  EXPECT_LT(evaluated.memory_MB, 100.0);
}

TEST(EvaluateMatch, says_that_the_duty_s_spread_is_included) {
  const Words line{"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "division_b_match", "--motors", "maxon_ecx_flat_42m_24v"};
  const ProgramRun sampled = run(line + Words{"--samples", "24", "--threads", "2", "--json", "-"});
  EXPECT_THAT(sampled.err, testing::ContainsRegex("3[ \n]games[ \n]with[ \n]different[ \n]inputs"));
  EXPECT_EQ(sampled.json().at("duty_draws"), 3);
  EXPECT_EQ(sampled.out, run(line + Words{"--samples", "24", "--threads", "1", "--json", "-"}).out);
  const ProgramRun nominal = run(line + Words{"--samples", "0", "--no-changes", "--json", "-"});
  EXPECT_EQ(nominal.json().at("duty_draws"), 0);
  EXPECT_THAT(nominal.err, testing::Not(HasSubstr("games")));
}

}  // namespace
}  // namespace heatsoak
