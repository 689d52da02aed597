// The drive core on the command line: its guard, and motors ranked by games in closed loop.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "program_run.h"
#include "support/shipped.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;
using testing::HasSubstr;

const Words kRobot{"--robot", "roboteam_twente_v2024", "--duty", "division_b_match"};

TEST(SimulateGuard, shadow_says_what_it_would_limit_and_changes_no_temperature) {
  const Words motor = Words{"simulate", "--motor", "maxon_ecx_flat_32l_48v"} + kRobot + Words{"--json", "-"};
  const ProgramRun shadow = run(motor);
  ASSERT_EQ(shadow.exit_code, 0) << shadow.err;
  EXPECT_THAT(shadow.err, HasSubstr("thermal guard (shadow), jerk_limited: would have limited no motor in 29 min;"));
  const json with = shadow.json();
  EXPECT_EQ(with.at("guard").at("use"), "shadow");
  EXPECT_TRUE(with.at("guard").at("why_none").is_null());
  EXPECT_EQ(with.at("sensing"), "real");
  EXPECT_EQ(with.at("verdict"), "pass") << "a motor without a stator limit cannot exceed it";
  const ProgramRun off = run(motor + Words{"--guard", "off"});
  const json without = off.json();
  EXPECT_THAT(off.err, HasSubstr("thermal guard: off"));
  EXPECT_EQ(with.at("winding_peak_C"), without.at("winding_peak_C"));
  EXPECT_EQ(without.at("planners").at(0).at("guard_limited_s"), 0.0);
  // The guard's observer multiplies the heat by a safety factor and assumes hotter air.
  EXPECT_GT(with.at("planners").at(0).at("guard_winding_peak_C").get<double>(), with.at("winding_peak_C").get<double>());
}

TEST(EvaluateClosedLoop, ranks_by_games_and_does_not_depend_on_threads) {
  const Words words =
      Words{"evaluate"} + kRobot +
      Words{"--motors", "maxon_ecx_flat_32l_48v,maxon_ecx_flat_42m_24v", "--samples", "0", "--closed-loop", "--games", "2",
            "--no-changes", "--json", "-"};
  const ProgramRun one = run(words + Words{"--threads", "1"});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(one.out, run(words + Words{"--threads", "2"}).out);
  EXPECT_THAT(one.err, HasSubstr("Closed loop: 2 games driven by the drive core, seeds 1 to 2"));
  EXPECT_THAT(one.err, HasSubstr("Driven in a closed loop, nominal values, 2 games: "));
  const json motors = one.json().at("motors");
  ASSERT_EQ(motors.size(), 2U);
  double margin_before_K = 1e9;
  for (const json& each : motors) {
    const json loop = each.at("closed_loop");
    EXPECT_EQ(loop.at("verdict"), "pass");
    EXPECT_EQ(loop.at("games"), 2);
    for (const char* const key : {"winding_peak_C", "stator_peak_C", "distance_m", "tracking_rms_m", "guard_limited_s"}) {
      EXPECT_LE(loop.at(key).at("low"), loop.at(key).at("nominal")) << key;
      EXPECT_LE(loop.at(key).at("nominal"), loop.at(key).at("high")) << key;
    }
    EXPECT_LT(loop.at("winding_peak_C").at("low"), loop.at("winding_peak_C").at("high"));
    // Compared with inverse dynamics, the closed loop adds corrections, slip and warm windings. The temperature rise must not change by
    // more than 35 %.
    EXPECT_NEAR(loop.at("winding_peak_C").at("nominal").get<double>() - 25.0, each.at("winding_peak_C").at("nominal").get<double>() - 25.0,
                0.35 * (each.at("winding_peak_C").at("nominal").get<double>() - 25.0));
    const double margin_K = each.at("winding_limit_C").get<double>() - loop.at("winding_peak_C").at("high").get<double>();
    EXPECT_LE(margin_K, margin_before_K);
    margin_before_K = margin_K;
  }
}

/// Writes the shipped robot without its [friction].
fs::path bare_robot(const TemporaryFolder& folder) {
  std::string robot = content_of(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  const std::size_t begin = robot.find("[friction]");
  robot.erase(begin, robot.find("[traction]") - begin);
  write(folder.path() / "bare.toml", robot);
  return folder.path() / "bare.toml";
}

TEST(RobotWithoutFriction, is_simulated_with_assumed_friction_and_without_feed_forward) {
  const TemporaryFolder folder;
  const std::string bare = bare_robot(folder).string();
  const Words words{"--robot", bare, "--duty", "division_b_match", "--json", "-"};
  const ProgramRun driven = run(Words{"simulate", "--motor", "maxon_ecx_flat_42m_24v", "--guard", "off"} + words);
  ASSERT_EQ(driven.exit_code, 0) << driven.err;
  EXPECT_THAT(driven.err, HasSubstr("bare.toml has no [friction]: the feed-forward of friction is off"));
  EXPECT_TRUE(driven.json().at("is_friction_assumed").get<bool>());
  const ProgramRun ranked = run(Words{"evaluate", "--motors", "maxon_ecx_flat_42m_24v", "--samples", "0", "--closed-loop", "--games", "1",
                                      "--guard", "off", "--no-changes"} +
                                words);
  ASSERT_EQ(ranked.exit_code, 0) << ranked.err;
  EXPECT_THAT(ranked.err, HasSubstr("the feed-forward of friction is off"));
  EXPECT_TRUE(ranked.json().at("is_friction_assumed").get<bool>());
}

TEST(EvaluateClosedLoop, is_for_matches) {
  const ProgramRun result = run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--closed-loop"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--closed-loop can drive only a match"));
}

}  // namespace
}  // namespace heatsoak
