// Predictions of the samples that decide a verdict, and of the work until then.
#include "select/decision.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/binomial_bound.h"
#include "base/random.h"

namespace heatsoak::select {
namespace {

/// Returns the evaluation of games of which `over` exceed a limit, and `missed` miss the demand, with all their samples.
MotorEvaluation of_games(int over, int games, int missed = 0) {
  MotorEvaluation motor;
  motor.games = games;
  motor.samples = 8 * games;
  const double share = static_cast<double>(over) / games;
  const base::ShareInterval interval = base::share_interval(share, games, error_share(games, true));
  const double missed_share = static_cast<double>(missed) / games;
  const base::ShareInterval missing = base::share_interval(missed_share, games, error_share(games, true));
  motor.verdict = share > kMajority ? Verdict::fail : interval.high > kMarginalProbability ? Verdict::marginal : Verdict::pass;
  motor.probability_over_limit = share;
  motor.probability_interval = Interval95{interval.low, interval.high};
  motor.short_probability = missed_share;
  motor.short_interval = Interval95{missing.low, missing.high};
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

// After 20 games without an event both probabilities are open. The numbers hold for both together.
TEST(DecidingSamples, cover_both_probabilities) {
  constexpr int kGames = 20;
  constexpr int kTrials = 2000;
  const DecidingSamples found = deciding_samples(of_games(0, kGames));
  ASSERT_TRUE(found.half);
  const int most = most_samples_at_all(true);
  const boost::math::beta_distribution<> posterior(0.5, kGames + 0.5);
  for (const auto& [samples, wanted] : {std::pair(*found.half, 0.5), std::pair(found.nine_in_ten.value_or(most), 0.9)}) {
    const int games = samples / 8;
    double decided = 0.0;
    for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
      base::Random random(seed, 0);
      const auto events = [&] {
        const double probability = boost::math::quantile(posterior, random.uniform());
        return static_cast<int>(boost::math::quantile(boost::math::binomial_distribution<>(games - kGames, probability), random.uniform()));
      };
      const int over = events();
      const int missed = events();
      decided += of_games(over, games, missed).samples_needed ? 0.0 : 1.0;
    }
    const double sd = std::sqrt(wanted * (1.0 - wanted) / kTrials);
    // One probability that is certainly too large decides alone, so that the numbers may be somewhat larger than necessary.
    if (samples < most) {
      EXPECT_GT(decided / kTrials, wanted - 4.0 * sd) << games;
    }
    EXPECT_LT(decided / kTrials, wanted + 0.1) << games;
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
    ASSERT_TRUE(found.half) << games;
    EXPECT_GT(*found.half, 8 * games);
    EXPECT_GE(found.nine_in_ten.value_or(8 * 10'000), 72 * 8) << "fewer games without a hit do not exclude 5 %";
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
