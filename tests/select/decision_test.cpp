// Predictions of the samples that decide a verdict, and of the work until then.
#include "select/decision.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/binomial_bound.h"
#include "base/random.h"

namespace heatsoak::select {
namespace {

/// Returns the evaluation of games of which `over` exceed a limit with all their samples.
MotorEvaluation of_games(int over, int games) {
  MotorEvaluation motor;
  motor.games = games;
  motor.samples = 8 * games;
  const double share = static_cast<double>(over) / games;
  const base::ShareInterval interval = base::share_interval(share, games, error_share(games, true));
  const base::ShareInterval never = base::share_interval(0.0, games, error_share(games, true));
  motor.verdict = share > kMajority ? Verdict::fail : interval.high > kMarginalProbability ? Verdict::marginal : Verdict::pass;
  motor.probability_over_limit = share;
  motor.probability_interval = Interval95{interval.low, interval.high};
  motor.short_probability = 0.0;
  motor.short_interval = Interval95{never.low, never.high};
  motor.samples_needed = samples_needed(motor, *motor.short_interval, true);
  return motor;
}

// Probabilities that are distributed as Jeffreys' prior: of the undecided ones, the predicted numbers decide the predicted shares.
TEST(DecidingSamples, decide_with_their_probability) {
  constexpr int kGames = 75;
  constexpr int kMostGames = 10'000;
  double undecided = 0.0;
  std::array<double, 2> decided{};
  std::array<double, 2> allowed{};
  for (std::uint64_t seed = 1; seed <= 1200; ++seed) {
    base::Random random(seed, 0);
    const double root = std::sin(0.5 * std::numbers::pi * random.uniform());
    const double probability = root * root;
    const auto over_in = [&](int games) {
      int over = 0;
      for (int i = 0; i < games; ++i) {
        over += random.uniform() < probability ? 1 : 0;
      }
      return over;
    };
    const int first = over_in(kGames);
    const MotorEvaluation motor = of_games(first, kGames);
    const DecidingSamples found = deciding_samples(motor);
    if (!motor.samples_needed) {
      EXPECT_FALSE(found.half);
      EXPECT_FALSE(found.nine_in_ten);
      continue;
    }
    undecided += 1.0;
    const std::array<std::optional<int>, 2> predicted{found.half, found.nine_in_ten};
    for (std::size_t i = 0; i < predicted.size(); ++i) {
      const int games = predicted.at(i) ? *predicted.at(i) / 8 : kMostGames;
      ASSERT_GT(games, kGames);
      allowed.at(i) += predicted.at(i) ? 1.0 : 0.0;
      decided.at(i) += predicted.at(i) && !of_games(first + over_in(games - kGames), games).samples_needed ? 1.0 : 0.0;
    }
    if (found.half && found.nine_in_ten) {
      EXPECT_LE(*found.half, *found.nine_in_ten);
    }
  }
  ASSERT_GT(undecided, 100.0);
  ASSERT_GT(allowed[0], 100.0);
  ASSERT_GT(allowed[1], 50.0);
  constexpr double kBeyondChance_sd = 4.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const double wanted = i == 0 ? 0.5 : 0.9;
    const double sd = std::sqrt(wanted * (1.0 - wanted) / allowed.at(i));
    EXPECT_NEAR(decided.at(i) / allowed.at(i), wanted, kBeyondChance_sd * sd) << allowed.at(i);
  }
}

// With the observed share taken as the true one, a share near the threshold seems to need several times as many games as it usually does.
TEST(DecidingSamples, near_the_threshold_are_fewer_than_with_the_same_share) {
  const MotorEvaluation motor = of_games(3, 75);
  ASSERT_TRUE(motor.samples_needed);
  const DecidingSamples found = deciding_samples(motor);
  ASSERT_TRUE(found.half);
  EXPECT_LT(2 * *found.half, *motor.samples_needed);
  EXPECT_GT(*found.half, motor.samples);
}

TEST(DecidingSamples, are_predicted_from_a_single_game_too) {
  for (const int games : {1, 2, 3}) {
    const DecidingSamples found = deciding_samples(of_games(0, games));
    ASSERT_TRUE(found.half && found.nine_in_ten) << games;
    EXPECT_GT(*found.half, 8 * games);
    EXPECT_GE(*found.nine_in_ten, 72 * 8) << "fewer games without a hit do not exclude 5 %";
  }
}

// 600 and 3000 samples are needed after 500: both motors take 1000, the second one then 2000 and 4000.
TEST(LaterWork, counts_a_motor_until_its_number_is_reached) {
  const std::array<int, 2> needed{600, 3000};
  const LaterWork work = later_work(needed, 500, 16'000);
  EXPECT_EQ(work.evaluations_count, 4.0);
  EXPECT_EQ(work.samples_count, 2.0 * 1000.0 + 2000.0 + 4000.0);
  EXPECT_EQ(later_work(needed, 500, 1500).samples_count, 2.0 * 1000.0 + 1500.0);
}

}  // namespace
}  // namespace heatsoak::select
