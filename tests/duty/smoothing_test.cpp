#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "duty/motion.h"
#include "support/seed_rate.h"

namespace heatsoak::duty {
namespace {

constexpr double kPi = std::numbers::pi;

double normal(base::Random& random) { return std::sqrt(-2.0 * std::log(random.uniform())) * std::cos(2.0 * kPi * random.uniform()); }

/// A coordinate that follows one target velocity after another with limited acceleration and jerk; one state per millisecond.
class LimitedMotion {
 public:
  struct State {
    double value = 0.0;
    double rate = 0.0;
    double acceleration = 0.0;
  };
  LimitedMotion(double duration_s, double play_share, double most_rate, double most_acceleration, double most_jerk, std::uint64_t seed) {
    base::Random random(seed, 11);
    State now;
    double goal = 0.0;
    double goal_until_s = 0.0;
    double play_until_s = 0.0;
    bool is_playing = false;
    for (double time_s = 0.0; time_s < duration_s; time_s += kStep_s) {
      if (time_s >= play_until_s) {
        is_playing = random.uniform() < play_share;
        play_until_s = time_s + 2.0 + 6.0 * random.uniform();
      }
      if (time_s >= goal_until_s) {
        goal = is_playing ? most_rate * (2.0 * random.uniform() - 1.0) : 0.0;
        goal_until_s = time_s + 0.3 + 1.5 * random.uniform();
      }
      const double off = goal - now.rate;
      const double wanted = std::copysign(std::min({most_acceleration, std::sqrt(most_jerk * std::abs(off)), 8.0 * std::abs(off)}), off);
      now.acceleration += std::clamp(wanted - now.acceleration, -most_jerk * kStep_s, most_jerk * kStep_s);
      now.rate += now.acceleration * kStep_s;
      now.value += now.rate * kStep_s;
      states_.push_back(now);
    }
  }
  [[nodiscard]] const State& at(double time_s) const {
    return states_[std::min(states_.size() - 1, static_cast<std::size_t>(std::lround(time_s / kStep_s)))];
  }

 private:
  static constexpr double kStep_s = 0.001;
  std::vector<State> states_;
};

struct Game {
  LimitedMotion x;
  LimitedMotion y;
  LimitedMotion yaw;
  double duration_s = 0.0;
};

Game game(double play_share, double most_acceleration_m_per_s2, double most_jerk_m_per_s3, double duration_s = 300.0) {
  return {{duration_s, play_share, 2.0, most_acceleration_m_per_s2, most_jerk_m_per_s3, 1},
          {duration_s, play_share, 2.0, most_acceleration_m_per_s2, most_jerk_m_per_s3, 2},
          {duration_s, play_share, 6.0, 40.0, 600.0, 3},
          duration_s};
}

/// Simulated vision: noise of 2 mm and 10 mrad, 5 % of the frames lost, 0.5 % wrong by up to 100 mm and 0.5 rad.
RobotTrack seen(const Game& g, double rate_Hz, double noise_share = 1.0) {
  base::Random random(7, 7);
  RobotTrack track{{Team::yellow, 3}, {{}}};
  for (double time_s = 0.0; time_s < g.duration_s; time_s += 1.0 / rate_Hz) {
    const double stamp_s = std::round(time_s * 1000.0) / 1000.0;
    TrackPoint point{stamp_s, g.x.at(stamp_s).value, g.y.at(stamp_s).value, g.yaw.at(stamp_s).value};
    const bool is_lost = random.uniform() < 0.05;
    const bool is_wrong = random.uniform() < 0.005;
    point.x_m += noise_share * (0.002 * normal(random) + (is_wrong ? 0.2 * (random.uniform() - 0.5) : 0.0));
    point.y_m += noise_share * (0.002 * normal(random) + (is_wrong ? 0.2 * (random.uniform() - 0.5) : 0.0));
    point.yaw_rad += noise_share * (0.01 * normal(random) + (is_wrong ? random.uniform() - 0.5 : 0.0));
    if (!is_lost || noise_share == 0.0) {
      track.segments[0].push_back(point);
    }
  }
  return track;
}

struct Errors {
  double velocity_rms_m_per_s = 0.0;
  double acceleration_rms_m_per_s2 = 0.0;
  double place_share = 0.0;  ///< excess of ∫a² as a share
  double turn_share = 0.0;
};

Errors compare(const MotionTrack& motion, const Game& g) {
  double velocity = 0.0;
  double acceleration = 0.0;
  double place = 0.0;
  double true_place = 0.0;
  double turn = 0.0;
  double true_turn = 0.0;
  std::size_t count = 0;
  motion.for_each(1000.0, [&](const Motion& m, std::size_t) {
    const auto& x = g.x.at(m.time_s);
    const auto& y = g.y.at(m.time_s);
    const auto& yaw = g.yaw.at(m.time_s);
    velocity += std::pow(m.velocity_x_m_per_s - x.rate, 2) + std::pow(m.velocity_y_m_per_s - y.rate, 2);
    acceleration += std::pow(m.acceleration_x_m_per_s2 - x.acceleration, 2) + std::pow(m.acceleration_y_m_per_s2 - y.acceleration, 2);
    place += std::pow(m.acceleration_x_m_per_s2, 2) + std::pow(m.acceleration_y_m_per_s2, 2);
    true_place += std::pow(x.acceleration, 2) + std::pow(y.acceleration, 2);
    turn += std::pow(m.yaw_acceleration_rad_per_s2, 2);
    true_turn += std::pow(yaw.acceleration, 2);
    ++count;
  });
  const double n = 2.0 * static_cast<double>(count);
  return {std::sqrt(velocity / n), std::sqrt(acceleration / n), place / true_place - 1.0, turn / true_turn - 1.0};
}

TEST(Smoothing, NeitherLosesNorInventsMoreThanFivePercentOfTheHeat) {
  for (const double play_share : {0.9, 0.15}) {
    for (const auto& [acceleration, jerk] : {std::pair{2.0, 6.0}, std::pair{3.0, 20.0}, std::pair{5.0, 50.0}}) {
      const Game g = game(play_share, acceleration, jerk);
      for (const double rate_Hz : {60.0, 75.0, 100.0}) {
        const MotionTrack motion = smooth(seen(g, rate_Hz));
        const Errors e = compare(motion, g);
        const SmoothingReport& r = motion.report();
        SCOPED_TRACE(testing::Message() << "play " << play_share << ", " << acceleration << " m/s2, " << jerk << " m/s3, " << rate_Hz
                                        << " Hz: v " << e.velocity_rms_m_per_s << " a " << e.acceleration_rms_m_per_s2 << " place "
                                        << e.place_share << " turn " << e.turn_share);
        EXPECT_LT(std::abs(e.place_share), 0.05);
        EXPECT_LT(std::abs(e.turn_share), 0.05);
        EXPECT_LT(e.velocity_rms_m_per_s, 0.02);
        EXPECT_LT(e.acceleration_rms_m_per_s2, 0.5);
        EXPECT_NEAR(r.place.noise_m_or_rad, 0.002, 0.0002);
        EXPECT_NEAR(r.turn.noise_m_or_rad, 0.01, 0.001);
        std::printf(
            "play %.2f, %.0f m/s2, %2.0f m/s3, %3.0f Hz: v %.4f m/s, a %.3f m/s2, place %+.1f %%, turn %+.1f %%, bands %.1f and %.1f Hz\n",
            play_share, acceleration, jerk, rate_Hz, e.velocity_rms_m_per_s, e.acceleration_rms_m_per_s2, 100.0 * e.place_share,
            100.0 * e.turn_share, r.place.bandwidth_Hz, r.turn.bandwidth_Hz);
      }
    }
  }
}

TEST(Smoothing, KeepsTheHeatOfAMotionWithoutNoise) {
  const Game g = game(0.15, 3.0, 20.0);
  const MotionTrack motion = smooth(seen(g, 75.0, 0.0));
  const Errors e = compare(motion, g);
  EXPECT_LT(std::abs(e.place_share), 0.01);
  EXPECT_LT(std::abs(e.turn_share), 0.05);
  EXPECT_EQ(motion.report().place.outliers, 0U);
}

/// At the reported bandwidth a sine must come out with 1/√2 of its amplitude and in phase.
TEST(Smoothing, HasTheBandwidthItStates) {
  for (const double bandwidth_Hz : {3.0, 5.0, 8.0}) {
    for (const double rate_Hz : {60.0, 100.0}) {
      RobotTrack track{{Team::blue, 1}, {{}}};
      for (int i = 0; i < 40 * static_cast<int>(rate_Hz); ++i) {
        const double time_s = i / rate_Hz;
        // The amplitude is small, so that no point is treated as an outlier.
        track.segments[0].push_back({time_s, 0.003 * std::sin(2.0 * kPi * bandwidth_Hz * time_s), 0.0, 0.0});
      }
      const MotionTrack motion = smooth(track, {.bandwidth_Hz = bandwidth_Hz});
      EXPECT_DOUBLE_EQ(motion.report().place.bandwidth_Hz, bandwidth_Hz);
      double in_phase = 0.0;
      double across = 0.0;
      std::size_t count = 0;
      motion.for_each(1000.0, [&](const Motion& m, std::size_t) {
        if (m.time_s > 5.0 && m.time_s < 35.0) {
          in_phase += m.x_m * std::sin(2.0 * kPi * bandwidth_Hz * m.time_s);
          across += m.x_m * std::cos(2.0 * kPi * bandwidth_Hz * m.time_s);
          ++count;
        }
      });
      EXPECT_NEAR(2.0 * in_phase / static_cast<double>(count) / 0.003, std::sqrt(0.5), 0.02) << bandwidth_Hz << " of " << rate_Hz;
      EXPECT_NEAR(across / static_cast<double>(count) / 0.003, 0.0, 0.01);
    }
  }
}

TEST(Smoothing, SaysWhenTheFrameRateLimitsTheBandwidth) {
  RobotTrack track{{Team::blue, 1}, {{}}};
  for (int i = 0; i < 200; ++i) {
    track.segments[0].push_back({i * 0.1, std::sin(i * 0.1), 0.0, 0.0});
  }
  const MotionTrack motion = smooth(track, {.bandwidth_Hz = 5.0});
  EXPECT_NEAR(motion.report().place.bandwidth_Hz, 10.0 / 6.0, 1e-9);
}

TEST(Smoothing, SeesNoAccelerationOfARobotThatStands) {
  // Both are decided by statistics of 7500 noisy frames, whose scatter is a few per cent.
  EXPECT_TRUE(holds_for_share(0.99, 30, [](std::uint64_t seed) {
    base::Random random(seed, 3);
    RobotTrack track{{Team::blue, 1}, {{}}};
    for (int i = 0; i < 7500; ++i) {
      track.segments[0].push_back({i / 75.0, 0.002 * normal(random), 0.002 * normal(random), 0.01 * normal(random)});
    }
    const MotionTrack motion = smooth(track);
    double squares = 0.0;
    std::size_t count = 0;
    motion.for_each(200.0, [&](const Motion& m, std::size_t) {
      squares += std::pow(m.acceleration_x_m_per_s2, 2) + std::pow(m.acceleration_y_m_per_s2, 2);
      ++count;
    });
    return std::sqrt(squares / static_cast<double>(count)) < 0.1 && motion.report().place.is_mostly_noise() &&
           motion.report().turn.is_mostly_noise();
  }));
}

TEST(Smoothing, GivesTheSameInOnePieceAsInBlocks) {
  // Between detections the smoother reproduces a polynomial of fifth degree. A long polynomial spans many blocks.
  const Game g = game(0.9, 3.0, 20.0, 200.0);
  const RobotTrack whole = seen(g, 100.0, 0.0);
  RobotTrack tail = whole;
  tail.segments[0].erase(tail.segments[0].begin(), tail.segments[0].begin() + 2500);
  const MotionTrack a = smooth(whole, {.bandwidth_Hz = 4.0});
  const MotionTrack b = smooth(tail, {.bandwidth_Hz = 4.0});
  for (double time_s = 40.0; time_s < 195.0; time_s += 0.137) {
    ASSERT_NEAR(a.at(time_s)->acceleration_x_m_per_s2, b.at(time_s)->acceleration_x_m_per_s2, 1e-5) << time_s;
  }
}

TEST(Smoothing, GoesThroughItsPointsSmoothlyAndStopsWhereTheRobotIsLost) {
  const Game g = game(0.9, 3.0, 20.0, 20.0);
  RobotTrack track = seen(g, 75.0);
  track.segments.push_back(track.segments[0]);
  for (TrackPoint& point : track.segments[1]) {
    point.time_s += 30.0;
  }
  const MotionTrack motion = smooth(track);
  ASSERT_EQ(motion.segments().size(), 2U);
  EXPECT_FALSE(motion.at(-0.1));
  EXPECT_FALSE(motion.at(25.0));
  EXPECT_FALSE(motion.at(60.0));
  EXPECT_TRUE(motion.at(motion.segments()[1].back().time_s));
  const double h_s = 1e-4;
  for (double time_s = 0.5; time_s < 19.0; time_s += 0.0917) {
    const Motion before = *motion.at(time_s - h_s);
    const Motion here = *motion.at(time_s);
    const Motion after = *motion.at(time_s + h_s);
    ASSERT_NEAR((after.x_m - before.x_m) / (2.0 * h_s), here.velocity_x_m_per_s, 1e-4);
    ASSERT_NEAR((after.velocity_y_m_per_s - before.velocity_y_m_per_s) / (2.0 * h_s), here.acceleration_y_m_per_s2, 2e-2);
    ASSERT_NEAR((after.yaw_rad - before.yaw_rad) / (2.0 * h_s), here.yaw_rate_rad_per_s, 1e-3);
  }
  std::size_t visits = 0;
  motion.for_each(1000.0, [&](const Motion&, std::size_t) { ++visits; });
  EXPECT_NEAR(static_cast<double>(visits), 2.0 * 1000.0 * (motion.segments()[0].back().time_s - motion.segments()[0].front().time_s), 4.0);
}

TEST(Smoothing, TakesTracksTooShortToSmooth) {
  EXPECT_TRUE(smooth({{Team::blue, 1}, {}}).segments().empty());
  EXPECT_TRUE(smooth({{Team::blue, 1}, {{{0.0, 1.0, 2.0, 3.0}}}}).segments().empty());
  EXPECT_EQ(smooth({{Team::blue, 1}, {{{0.0, 1.0, 2.0, 3.0}, {0.1, 1.1, 2.0, 3.0}}}}).segments().size(), 1U);
}

}  // namespace
}  // namespace heatsoak::duty
