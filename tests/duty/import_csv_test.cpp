#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/diagnostic.h"
#include "duty/game_to_demand.h"
#include "duty/recorded_game.h"
#include "ssl_log_writer.h"

namespace heatsoak {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing_logs::TemporaryFile;

constexpr const char* kHeader = "t_s,team,robot_id,x_m,y_m,yaw_rad\n";

std::string table(int rows) {
  std::string text = kHeader;
  for (int i = 0; i < rows; ++i) {
    text += std::to_string(100.0 + i * 0.01) + ",blue,7," + std::to_string(i * 0.01) + ",1.5,0\n";
  }
  return text;
}

std::string failure_of(const std::string& text) {
  const TemporaryFile file("game.csv", text);
  try {
    (void)import_game(file.path());
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_input);
    return failure.what();
  }
  return "no failure";
}

TEST(ImportCsv, ReadsATableWithItsOwnTime) {
  const TemporaryFile file("game.csv", table(300));
  const RecordedGame game = import_game(file.path());
  ASSERT_EQ(game.tracks.size(), 1U);
  EXPECT_EQ(to_string(game.tracks[0].robot), "blue 7");
  ASSERT_EQ(game.tracks[0].segments.size(), 1U);
  EXPECT_EQ(game.tracks[0].segments[0].size(), 300U);
  EXPECT_DOUBLE_EQ(game.tracks[0].segments[0].front().time_s, 100.0);
  EXPECT_NEAR(game.tracks[0].segments[0].back().x_m, 2.99, 1e-9);
  EXPECT_TRUE(game.phases.empty());
}

TEST(ImportCsv, TakesColumnsInAnyOrderAndRobotsOneAfterTheOther) {
  std::string text = "yaw_rad,extra,y_m,x_m,robot_id,team,t_s\n";
  for (const char* robot : {"0,yellow", "1,yellow", "0,blue"}) {
    for (int i = 0; i < 200; ++i) {
      text += "0,9,0,0," + std::string(robot) + "," + std::to_string(i * 0.01) + "\n";
    }
  }
  const TemporaryFile file("game.csv", text);
  const RecordedGame game = import_game(file.path());
  EXPECT_EQ(game.tracks.size(), 3U);
  EXPECT_EQ(game.report.out_of_order, 0U);
}

TEST(ImportCsv, NamesThePlaceOfWhatIsWrong) {
  EXPECT_THAT(failure_of(table(3) + "101,yelow,7,0,0,0\n"),
              HasSubstr("game.csv:5:5: error: team: \"yelow\" is not yellow or blue; did you mean 'yellow'?"));
  EXPECT_THAT(failure_of(table(3) + "101,blue,7,zero,0,0\n"), HasSubstr("game.csv:5:12: error: x_m: \"zero\" is not a finite number"));
  EXPECT_THAT(failure_of(table(3) + "101,blue,1.5,0,0,0\n"), HasSubstr("game.csv:5:10: error: robot_id: 1.5 is no robot"));
  EXPECT_THAT(failure_of(table(3) + "101,blue,7,0,0\n"), HasSubstr("game.csv:5:1: error: has 5 cells where the header has 6"));
  EXPECT_THAT(failure_of("t_s,team,robot,x_m,y_m,yaw_rad\n0,blue,1,0,0,0\n"), HasSubstr("robot_id: there is no such column"));
  EXPECT_THAT(failure_of(kHeader), HasSubstr("holds no row"));
}

TEST(ImportCsv, LeavesOutRowsThatGoBackInTimeAndSaysWhichOnes) {
  const TemporaryFile file("game.csv", table(300) + "101,blue,7,0,0,0\n");
  const RecordedGame game = import_game(file.path());
  EXPECT_EQ(game.tracks[0].segments[0].size(), 300U);
  EXPECT_EQ(game.report.out_of_order, 1U);
  ASSERT_EQ(game.report.problems.size(), 1U);
  EXPECT_EQ(game.report.problems[0].at, 302U);
  EXPECT_THAT(sentences(game.report), Contains(HasSubstr("line 302: blue 7 at 101 s")));
}

TEST(ImportCsv, AJumpOfTheClockIsNoPause) {
  std::string text = kHeader;
  for (int i = 0; i < 2000; ++i) {
    const double time_s = 0.01 * i + (i < 1000 ? 0.0 : 1e9) + (i < 1500 ? 0.0 : 120.0);
    text += std::to_string(time_s) + ",blue,7," + std::to_string(0.5 * std::sin(0.02 * i)) + ",1.5,0\n";
  }
  const TemporaryFile file("game.csv", text);
  const GameDemand demand = demand_of_game(
      file.path(), "blue 7", read_robot(std::filesystem::path(HEATSOAK_SOURCE_DIR) / "robot_core/robots/tigers_v2020.toml"), 0.01);
  ASSERT_FALSE(demand.wheels.empty());
  EXPECT_NEAR(demand.wheels.front().duration_s(), 20.0 + 120.0, 0.1);
  EXPECT_THAT(demand.sentences, Contains(HasSubstr("jumps ahead by more than 3600 s 1 times")));
}

}  // namespace
}  // namespace heatsoak
