// `heatsoak friction`: answer, JSON, and logs that it refuses.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "program_run.h"
#include "robot/robot.h"
#include "short_runs.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

TEST(Json, of_friction_keeps_the_contract) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "measured.toml").string();
  const ProgramRun result = run({"friction", "--robot", "roboteam_twente_v2024", kFrictionLog.string(), "--out", out, "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json answer = result.json();
  EXPECT_EQ(answer.at("schema"), "heatsoak.friction/1");
  ASSERT_EQ(answer.at("wheels").size(), 4U);
  for (const json& wheel : answer["wheels"]) {
    EXPECT_TRUE(wheel.at("index").is_number_unsigned());
    for (const char* key : {"damping_V_s_per_rad", "a_V", "b_V", "phase_rad"}) {
      const json& estimate = wheel.at(key);
      EXPECT_LE(estimate.at("ci95").at(0), estimate.at("value")) << key;
      EXPECT_GE(estimate.at("ci95").at(1), estimate.at("value")) << key;
    }
    EXPECT_GT(wheel.at("r2"), 0.5);
    EXPECT_FALSE(wheel.at("lack_of_fit").get<bool>());
    EXPECT_TRUE(wheel.at("repeats_V").is_number());
    EXPECT_EQ(wheel.at("rows_used").get<int>() + wheel.at("rows_left_out").get<int>(), answer.at("rows").get<int>());
  }
  EXPECT_TRUE(answer.at("before").at("rmse").is_number());
  EXPECT_TRUE(answer.at("after").at("rmse").is_number());
  // The written file must be a robot that all other verbs accept.
  EXPECT_EQ(run({"lint", out}).exit_code, 0);
  EXPECT_THAT(run({"describe", out}).out, HasSubstr("friction test, steady_state_test.csv"));
  const std::string trace = (folder.path() / "trace.csv").string();
  EXPECT_EQ(
      run({"simulate", "--motor", "maxon_ec45_flat_70w_24v", "--robot", out, "--duty", "paper_intermittent", "--out", trace}).exit_code, 0);
  EXPECT_NE(
      run({"evaluate", "--robot", out, "--duty", "paper_intermittent", "--motors", "maxon_ec45_flat_70w_24v", "--samples", "3"}).exit_code,
      2);
}

/// A single roll-out has no scatter, so its fitted parameters have no interval. They must not be reported as given by a file.
TEST(Friction, of_one_roll_out_has_no_intervals_and_is_not_called_given) {
  constexpr double kHeading_rad = 0.1;
  constexpr double kDrag_m_per_s2 = 0.8;
  constexpr double kRate_per_s = 0.5;
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "roll_out.csv").string();
  std::string text = "time_s,battery_V,heading_rad";
  for (int wheel = 1; wheel <= 4; ++wheel) {
    text += fmt::format(",wheel_speed_rad_per_s_{0},wheel_pwm_ratio_{0}", wheel);
  }
  const robot::Robot robot = robot::read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  for (int row = 0; row < 300; ++row) {
    const double free_m_per_s = (1.8 + kDrag_m_per_s2 / kRate_per_s) * std::exp(-kRate_per_s * 0.01 * row) - kDrag_m_per_s2 / kRate_per_s;
    text += fmt::format("\n{:.2f},24,{}", 0.01 * row, kHeading_rad);
    for (const double axis_rad : robot.wheels.axis_rad) {
      const double noise_rad_per_s = 0.05 * std::sin(12.9 * row + 78.2 * axis_rad);
      text += fmt::format(",{:.4f},0",
                          std::max(0.0, free_m_per_s) / robot.wheels.radius_m * std::sin(kHeading_rad - axis_rad) + noise_rad_per_s);
    }
  }
  write(log, text + "\n");
  const ProgramRun result = run({"friction", "--robot", "roboteam_twente_v2024", "--method", "roll_out", log, "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("(no interval)"));
  EXPECT_THAT(result.err, Not(HasSubstr("(given)")));
  const json wheels = result.json().at("wheels");
  for (const json& wheel : wheels) {
    EXPECT_GT(wheel.at("damping_V_s_per_rad").at("value"), 0.0);
    EXPECT_TRUE(wheel.at("damping_V_s_per_rad").at("ci95").at(0).is_null());
  }
}

// The wheels of another robot have other angles, so every value would be wrong.
TEST(Friction, refuses_a_log_with_more_wheels_than_the_robot) {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "three.csv").string();
  const Words command{"friction", "--robot", (kSource / "tests/data/robots/festo_robotino.toml").string(), log};
  for (const bool is_turning : {true, false}) {
    std::string text = "time_s,heading_rad,battery_V";
    for (int wheel = 1; wheel <= 4; ++wheel) {
      text += fmt::format(",wheel_speed_rad_per_s_{0},wheel_pwm_ratio_{0}", wheel);
    }
    for (int row = 0; row < 100; ++row) {
      text += fmt::format("\n{:.2f},0,24,10,0.1,-5,0.1,-5,0.1,{},0", 0.01 * row, is_turning ? "3" : "0");
    }
    write(log, text + "\n");
    const ProgramRun done = run(command);
    const auto said = HasSubstr("three.csv: error: the log has values of wheel 4, but the robot's file has 3 wheels");
    if (is_turning) {
      EXPECT_EQ(done.exit_code, 2);
      EXPECT_THAT(done.err, AllOf(said, HasSubstr("--as-is")));
      EXPECT_THAT(run(command + Words{"--as-is"}).err, Not(said));
    } else {
      EXPECT_THAT(done.err, Not(HasSubstr("wheel 4"))) << "a logger with a fixed number of columns";
    }
  }
}

/// The example with an additional 1.5 V sin 2θ at wheel 2. Columns are time, battery, heading on the field, yaw, then speed and modulation.
TEST(Json, of_friction_says_where_its_law_does_not_hold) {
  std::istringstream log(content_of(kFrictionLog));
  std::string changed;
  for (std::string line; std::getline(log, line); changed += '\n') {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) {
      cells.push_back(cell);
    }
    if (!changed.empty() && cells.size() > 7 && !cells[7].empty() && std::abs(std::stod(cells[7])) > 0.01) {
      const double heading_rad = std::stod(cells[2]) - std::stod(cells[3]);
      cells[7] = fmt::format("{:.5f}", std::stod(cells[7]) + 1.5 * std::sin(2.0 * heading_rad) / std::stod(cells[1]));
    }
    changed += fmt::format("{}", fmt::join(cells, ","));
  }
  const TemporaryFolder folder;
  write(folder.path() / "log.csv", changed);
  RunOptions inside;
  inside.folder = folder.path();
  const ProgramRun result = run({"friction", "--robot", "roboteam_twente_v2024", "log.csv", "--as-is", "--json", "-"}, inside);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json answer = result.json();
  const char* const sentence = "the residual of wheel 2 depends on θ: ";
  EXPECT_THAT(result.err, HasSubstr(sentence));
  EXPECT_THAT(answer.at("findings").get<std::vector<std::string>>(), Contains(HasSubstr(sentence)));
  EXPECT_TRUE(answer.at("wheels").at(1).at("lack_of_fit").get<bool>());
  EXPECT_FALSE(answer.at("wheels").at(0).at("lack_of_fit").get<bool>());
  EXPECT_GT(answer["wheels"][1].at("left_V"), 0.5);
}

TEST(ExitCode, of_friction_refuses_a_log_that_is_given_twice) {
  const TemporaryFolder folder;
  const std::string log = kFrictionLog.string();
  const std::string copy = (folder.path() / "copy.csv").string();
  fs::copy_file(log, copy);
  const ProgramRun result = run({"friction", "--robot", "roboteam_twente_v2024", log, copy});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("copy.csv:2:1: error: lines 2 to "), HasSubstr(" of " + log)));
}

TEST(ExitCode, of_friction_reports_all_bad_logs_and_writes_nothing) {
  const TemporaryFolder folder;
  write(folder.path() / "few_columns.csv", "time_s,wheel_speed_rad_per_s_1\n0,1\n1,2\n");
  write(folder.path() / "no_time.csv", "wheel_speed_rad_per_s_1\n1\n");
  const ProgramRun result = run({"friction", "--robot", "roboteam_twente_v2024", "few_columns.csv", kFrictionLog.string(), "no_time.csv",
                                 "missing.csv", "--out", "robot.toml"},
                                {.folder = folder.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("few_columns.csv:1:1: error: wheel_speed_rad_per_s_2: is missing"),
                                HasSubstr("no_time.csv:1:1: error: "), HasSubstr("missing.csv: error: ")));
  EXPECT_FALSE(fs::exists(folder.path() / "robot.toml"));
}

TEST(ExitCode, of_friction_is_3_if_no_wheel_turns) {
  const TemporaryFolder folder;
  const std::string standing = (folder.path() / "standing.csv").string();
  std::string text = "time_s,battery_V";
  for (const char* wheel : {"1", "2", "3", "4"}) {
    text += std::string(",wheel_speed_rad_per_s_") + wheel + ",wheel_pwm_ratio_" + wheel;
  }
  for (int row = 0; row < 500; ++row) {
    text += fmt::format("\n{:.2f},24,0,0,0,0,0,0,0,0", 0.01 * row);
  }
  write(standing, text + "\n");
  const ProgramRun result = run({"friction", "--robot", "roboteam_twente_v2024", standing});
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_THAT(result.err, HasSubstr("in no interval do the wheels turn steadily"));

  const std::string thermal = (folder.path() / "thermal.csv").string();
  write(thermal, "time_s,winding_C,current_A\n0,25,1\n1,26,1\n2,27,1\n");
  const ProgramRun wrong = run({"friction", "--robot", "roboteam_twente_v2024", thermal});
  EXPECT_EQ(wrong.exit_code, 2);
  for (const char* missing : {"wheel_speed_rad_per_s_1", "wheel_speed_rad_per_s_4"}) {
    EXPECT_THAT(wrong.err, HasSubstr(thermal + ":1:1: error: " + missing + ": is missing"));
  }
}

}  // namespace
}  // namespace heatsoak
