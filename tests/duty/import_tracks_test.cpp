// Tracks from single detections: cameras, gaps, false detections, clocks.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "duty/motion.h"
#include "duty/recorded_game.h"
#include "ssl_log_writer.h"

namespace heatsoak::duty {
namespace {

using namespace testing_logs;

RecordedGame import_log(const LogWriter& log) {
  const TemporaryFile file("tracks.log", log.bytes());
  return import_game(file.path());
}

SeenRobot still(double x_m = 0.0) { return {true, 3, x_m, 0.0, 0.0}; }

TEST(ImportTracks, JoinsCamerasByConfidenceAndDistance) {
  LogWriter log;
  const Message geometry = Message().message(2, camera_at(0, -3.0, 0.0)).message(2, camera_at(1, 3.0, 0.0));
  for (int i = 0; i < 600; ++i) {
    const double time_s = i * kFrame_s;
    // At x = -1.5 m the robot is 1.5 m from camera 0 and 4.5 m from camera 1, which sees it with an error of 20 mm.
    log.add(time_s, 4, vision(time_s, 0, {still(-1.5)}, i == 0 ? &geometry : nullptr));
    log.add(time_s, 4, vision(time_s + 0.004, 1, {still(-1.48)}));
  }
  const RecordedGame game = import_log(log);
  ASSERT_EQ(game.tracks.size(), 1U);
  EXPECT_EQ(game.tracks[0].segments[0].size(), 600U);
  EXPECT_EQ(game.report.merged, 600U);
  const double x_m = game.tracks[0].segments[0].back().x_m;
  EXPECT_GT(x_m, -1.5);
  EXPECT_LT(x_m, -1.49) << "the nearer camera has more of a say";
}

TEST(ImportTracks, HandsOverFromCameraToCameraWithoutAStep) {
  LogWriter log;
  base::Random random(1, 2);
  for (int i = 0; i < 1500; ++i) {
    const double time_s = i * kFrame_s;
    const double x_m = -1.0 + 0.1 * time_s;
    if (x_m < 0.2) {
      log.add(time_s, 4, vision(time_s, 0, {still(x_m + 0.002 * (random.uniform() - 0.5))}));
    }
    if (x_m > -0.2) {
      log.add(time_s, 4, vision(time_s, 1, {still(x_m + 0.03 + 0.002 * (random.uniform() - 0.5))}));  // error of 30 mm
    }
  }
  const RecordedGame game = import_log(log);
  ASSERT_EQ(game.tracks.size(), 1U);
  ASSERT_EQ(game.tracks[0].segments.size(), 1U);
  const MotionTrack motion = smooth(game.tracks[0], {.bandwidth_Hz = 5.0});
  double most_m_per_s2 = 0.0;
  motion.for_each(100.0, [&](const Motion& m, std::size_t) {
    if (m.time_s > 1.0 && m.time_s < 18.0) {
      most_m_per_s2 = std::max(most_m_per_s2, std::abs(m.acceleration_x_m_per_s2));
    }
  });
  EXPECT_LT(most_m_per_s2, 0.5) << "a step of 30 mm at 5 Hz would be more than 5 m/s2";
  EXPECT_NEAR(game.tracks[0].segments[0].back().x_m, -1.0 + 0.1 * 1499 * kFrame_s + 0.03, 0.005)
      << "in the end the camera's own word holds";
}

TEST(ImportTracks, BridgesShortGapsAndCutsLongOnes) {
  LogWriter log;
  for (int i = 0; i < 750; ++i) {
    const double time_s = i * kFrame_s;
    const bool is_lost = (time_s > 2.0 && time_s < 2.4) || (time_s > 5.0 && time_s < 5.6);
    log.add(time_s, 4, vision(time_s, 0, is_lost ? std::vector<SeenRobot>{} : std::vector{still()}));
  }
  const RecordedGame game = import_log(log);
  EXPECT_EQ(game.report.bridged_gaps, 1U);
  EXPECT_EQ(game.report.cuts, 1U);
  ASSERT_EQ(game.tracks[0].segments.size(), 2U);
  EXPECT_LT(game.tracks[0].segments[0].back().time_s, 5.01);
  EXPECT_GT(game.tracks[0].segments[1].front().time_s, 5.59);
}

TEST(ImportTracks, LeavesOutSightsTheRobotCannotReachButFollowsItWhenItIsMoved) {
  LogWriter log;
  for (int i = 0; i < 750; ++i) {
    const double time_s = i * kFrame_s;
    const double place_m = i < 400 ? 0.0 : 2.0;  // moved by hand
    const double error_m = i % 50 == 20 ? 1.0 : 0.0;
    log.add(time_s, 4, vision(time_s, 0, {still(place_m + error_m)}));
  }
  const RecordedGame game = import_log(log);
  EXPECT_EQ(game.report.outliers, 15U);
  EXPECT_EQ(game.report.teleports, 1U);
  ASSERT_EQ(game.tracks[0].segments.size(), 2U);
  EXPECT_NEAR(game.tracks[0].segments[1].front().time_s, 400 * kFrame_s, 1e-6);
  for (const TrackPoint& point : game.tracks[0].segments[1]) {
    ASSERT_NEAR(point.x_m, 2.0, 1e-6);
  }
}

TEST(ImportTracks, ChoosesBetweenTwoRobotsOfOneNumberInAFrame) {
  LogWriter log;
  for (int i = 0; i < 300; ++i) {
    const double time_s = i * kFrame_s;
    std::vector<SeenRobot> robots{still(0.5)};
    if (i > 50 && i % 3 == 0) {
      robots.insert(robots.begin(), SeenRobot{true, 3, -2.0, 1.0, 0.0, 1.0});  // another pattern misread as number 3
    }
    log.add(time_s, 4, vision(time_s, 0, robots));
  }
  const RecordedGame game = import_log(log);
  EXPECT_EQ(game.report.doubled, 83U);
  ASSERT_EQ(game.tracks[0].segments.size(), 1U);
  EXPECT_EQ(game.tracks[0].segments[0].size(), 300U);
  for (const TrackPoint& point : game.tracks[0].segments[0]) {
    ASSERT_NEAR(point.x_m, 0.5, 1e-6);
  }
}

TEST(ImportTracks, DropsRobotsThatAreSeenForAMomentOnly) {
  LogWriter log;
  for (int i = 0; i < 300; ++i) {
    std::vector<SeenRobot> robots{still()};
    if (i >= 100 && i < 130) {
      robots.push_back({false, 12, 1.0, 1.0, 0.0});
    }
    log.add(i * kFrame_s, 4, vision(i * kFrame_s, 0, robots));
  }
  const RecordedGame game = import_log(log);
  EXPECT_EQ(game.tracks.size(), 1U);
  EXPECT_EQ(game.report.short_segments, 1U);
}

TEST(ImportTracks, LeavesOutWhatIsNoRobotOnAField) {
  LogWriter log;
  for (int i = 0; i < 300; ++i) {
    log.add(
        i * kFrame_s, 4,
        vision(i * kFrame_s, 0,
               {still(), {true, 4, NAN, 0.0, 0.0}, {true, 5, 0.0, 1e6, 0.0}, {true, 400, 0.0, 0.0, 0.0}, {true, 6, 0.0, 0.0, INFINITY}}));
  }
  const RecordedGame game = import_log(log);
  EXPECT_EQ(game.tracks.size(), 1U);
  EXPECT_EQ(game.report.implausible, 1200U);
}

TEST(ImportTracks, CutsWhereTheClockJumpsAndKeepsTimeGoing) {
  for (const double jump_s : {-100.0, 3000.0}) {
    LogWriter log;
    for (int i = 0; i < 600; ++i) {
      const double time_s = i * kFrame_s;
      log.add(time_s, 4, vision(time_s + (i < 300 ? 0.0 : jump_s), 0, {still()}));
    }
    const RecordedGame game = import_log(log);
    EXPECT_EQ(game.report.clock_jumps, 1U);
    EXPECT_EQ(game.report.frames_out_of_time, 0U);
    ASSERT_EQ(game.tracks[0].segments.size(), 2U);
    EXPECT_NEAR(game.tracks[0].segments[1].back().time_s, 599 * kFrame_s, 0.01);
  }
}

TEST(ImportTracks, LeavesOutSingleFramesWithAWrongTime) {
  LogWriter log;
  for (int i = 0; i < 600; ++i) {
    const double time_s = i * kFrame_s;
    log.add(time_s, 4, vision(i % 100 == 50 ? -1e9 + i : time_s, 0, {still()}));
  }
  const RecordedGame game = import_log(log);
  EXPECT_EQ(game.report.clock_jumps, 0U);
  EXPECT_EQ(game.report.frames_out_of_time, 6U);
  ASSERT_EQ(game.tracks[0].segments.size(), 1U);
  EXPECT_EQ(game.tracks[0].segments[0].size(), 594U);
}

TEST(ImportTracks, ReconcilesCamerasWhoseClocksDiffer) {
  LogWriter log;
  for (int i = 0; i < 600; ++i) {
    const double time_s = i * kFrame_s;
    log.add(time_s, 4, vision(time_s, 0, {still()}));
    log.add(time_s, 4, vision(time_s + 7200.0, 1, {still()}));
  }
  const RecordedGame game = import_log(log);
  EXPECT_EQ(game.report.clock_jumps, 0U);
  EXPECT_EQ(game.report.merged, 600U);
  ASSERT_EQ(game.tracks[0].segments.size(), 1U);
}

}  // namespace
}  // namespace heatsoak::duty
