// Predictions of the samples that decide a verdict, and of the work until then.
#include "select/decision.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "base/binomial_bound.h"
#include "base/random.h"
#include "select/spread.h"

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
  motor.probability_over_limit = share;
  motor.probability_interval = Interval95{interval.low, interval.high};
  motor.short_probability = missed_share;
  motor.short_interval = Interval95{missing.low, missing.high};
  decide_by_samples(motor, true);
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

// Games with a known share over the limit: from one game on the verdict is marginal until it is decided, and then rarely wrong.
TEST(StatedVerdict, does_not_depend_on_the_number_of_games_until_they_decide) {
  constexpr int kMatches = 300;
  for (const double share : {0.005, 0.03, 0.2, 0.45, 0.6, 0.95}) {
    const Verdict right = share > kMajority ? Verdict::fail : share > kMarginalProbability ? Verdict::marginal : Verdict::pass;
    int wrong = 0;
    for (std::uint64_t seed = 1; seed <= kMatches; ++seed) {
      base::Random random(seed, 0);
      bool is_wrong = false;
      int over = 0;
      for (int games = 1; games <= 1200; ++games) {
        over += random.uniform() < share ? 1 : 0;
        if (games != 1 && games != 8 && games % 75 != 0) {
          continue;
        }
        const MotorEvaluation motor = of_games(over, games);
        if (!is_decided(motor)) {
          ASSERT_EQ(stated_verdict(motor), Verdict::marginal) << over << " of " << games;
        } else if (games == 75 || games == 150 || games == 300 || games == 600 || games == 1200) {
          is_wrong = is_wrong || stated_verdict(motor) != right;
        }
      }
      wrong += is_wrong ? 1 : 0;
    }
    EXPECT_LE(wrong, kError_share * kMatches + 3.0 * std::sqrt(kError_share * kMatches)) << share;
  }
}

// A motor that certainly misses the demand in most games is infeasible, whether or not it is also too hot in most of them.
TEST(DecidingSamples, of_temperatures_do_not_matter_if_the_demand_is_missed) {
  MotorEvaluation motor = of_games(38, 75, 74);
  motor.verdict = Verdict::infeasible;
  EXPECT_FALSE(samples_needed(motor, true));
  EXPECT_TRUE(of_games(38, 75, 1).samples_needed);
}

// Probabilities near a threshold need more games than anybody plays; those far from it are decided with certainty.
TEST(Prospect, another_round_follows_only_if_it_may_decide) {
  const int most = 32 * first_samples(true);
  EXPECT_TRUE(may_be_decided_by(Prospect(of_games(1, 75)), most));
  EXPECT_FALSE(may_be_decided_by(Prospect(of_games(60, 1200)), most)) << "5 % of 1200";
  EXPECT_FALSE(may_be_decided_by(Prospect(of_games(0, 75)), most)) << "decided";
}

// The predicted probability that a later number of games decides is the share of evaluations that it decides; so is that of the end of the
// rounds, which also end where further games would probably not decide.
TEST(Prospect, decides_and_ends_with_the_predicted_probability) {
  const int most = most_samples(true);
  constexpr int kGames = 75;
  constexpr int kTrials = 3000;
  for (const int over : {1, 3, 30}) {
    const MotorEvaluation motor = of_games(over, kGames);
    ASSERT_TRUE(motor.samples_needed) << over;
    const Prospect prospect(motor);
    EXPECT_EQ(prospect.decided_probability(motor.samples), 0.0);
    const boost::math::beta_distribution<> posterior(over + 0.5, kGames - over + 0.5);
    for (const int games : {150, 600, 1200, 2400}) {
      double decided = 0.0;
      double ended = 0.0;
      double passes = 0.0;
      std::map<int, bool> goes_on;  // by the games over the limit
      for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
        base::Random random(seed, 0);
        const double share = boost::math::quantile(posterior, random.uniform());
        const boost::math::binomial_distribution<> later(games - kGames, share);
        const int all = over + static_cast<int>(boost::math::quantile(later, random.uniform()));
        const MotorEvaluation then = of_games(all, games);
        decided += then.samples_needed ? 0.0 : 1.0;
        const auto [found, is_new] = goes_on.try_emplace(all, false);
        found->second = is_new ? then.samples < most && may_be_decided_by(Prospect(then), most) : found->second;
        ended += found->second ? 0.0 : 1.0;
        passes += share <= kMarginalProbability ? 1.0 : 0.0;
      }
      const double predicted = prospect.decided_probability(8 * games);
      const double sd = std::sqrt(0.25 / kTrials);
      EXPECT_NEAR(decided / kTrials, predicted, 5.0 * sd) << over << " of " << kGames << ", then " << games;
      if (games * 8 < most) {
        EXPECT_NEAR(ended / kTrials, prospect.ended_probability(8 * games, most), 5.0 * sd + 0.01) << over << ", then " << games;
      }
      EXPECT_NEAR(passes / kTrials, prospect.pass_probability(), 5.0 * sd) << over;
    }
  }
}

// A few games show how far the limit is from the peaks: far above them, near them, or far below.
TEST(Prospect, of_few_games_follows_the_distance_of_the_limit) {
  MotorEvaluation few;
  few.games = 6;
  few.samples = 48;
  few.short_probability = 0.0;
  few.winding_peak_C = {.nominal = 50.0, .p05 = 40.0, .p50 = 50.0, .p95 = 65.0};
  const auto with_limit = [&](double limit_C) {
    few.winding_limit_C = limit_C;
    return Prospect::of_few_games(few, 25.0);
  };
  const int first = first_samples(true);
  EXPECT_GT(with_limit(400.0).decided_probability(first), 0.9);
  EXPECT_GT(with_limit(400.0).pass_probability(), 0.9);
  EXPECT_LT(with_limit(65.0).decided_probability(first), 0.5);
  EXPECT_GT(with_limit(33.0).decided_probability(first), 0.7);
  EXPECT_LT(with_limit(33.0).pass_probability(), 0.1);
  few.short_probability = 1.0;
  EXPECT_EQ(with_limit(400.0).decided_probability(first), 1.0);
  EXPECT_EQ(with_limit(400.0).pass_probability(), 0.0);
}

}  // namespace
}  // namespace heatsoak::select
