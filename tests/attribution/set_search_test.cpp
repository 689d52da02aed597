// The evidence of sets of effects, compared with integrals by other methods: dense covariances, and sums over a fine grid of sizes.
#include "attribution/set_search.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace heatsoak::attribution {
namespace {

struct Problem {
  Eigen::MatrixXd theta;       ///< matrix, n × t
  Eigen::MatrixXd candidates;  ///< matrix, n × e
  Eigen::VectorXd residual;
  estimation::ThetaPrior prior;
};

/// Linear problem with white noise of variance 1, so no whitening is needed.
Problem problem(std::uint32_t seed, double size) {
  constexpr Eigen::Index kRows = 60;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&](Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd drawn(rows, columns);
    for (double& each : drawn.reshaped()) {
      each = normal(random);
    }
    return drawn;
  };
  Problem out;
  out.theta = draw(kRows, 2);
  out.candidates = draw(kRows, 4);
  out.candidates.col(1) = 0.9 * out.candidates.col(0) + 0.4 * out.candidates.col(1);
  out.prior.mean = Eigen::Vector2d(0.3, -0.2);
  out.prior.precision = Eigen::Vector2d(4.0, 1.0).asDiagonal();
  out.residual = draw(kRows, 1) + size * out.candidates.col(0) + out.theta * Eigen::Vector2d(0.5, -0.4);
  return out;
}

estimation::Reduced reduced_of(const Problem& of) {
  Eigen::MatrixXd all(of.residual.size(), of.theta.cols() + of.candidates.cols() + 1);
  all << of.theta, of.candidates, of.residual;
  return estimation::reduced({all.transpose() * all, 0.0}, of.prior);
}

/// ln N(residual | mean of θ, 1 + Θ Λ⁻¹ Θᵀ + Z S Zᵀ), with sizes of mean 0 and covariance S.
double dense_nats(const Problem& of, const std::vector<int>& members, double sd) {
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(of.residual.size(), of.residual.size());
  covariance += of.theta * of.prior.precision.inverse() * of.theta.transpose();
  for (const int member : members) {
    covariance += sd * sd * of.candidates.col(member) * of.candidates.col(member).transpose();
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::VectorXd off = of.residual - of.theta * of.prior.mean;
  return -0.5 * off.dot(factor.solve(off)) - factor.matrixLLT().diagonal().array().log().sum();
}

TEST(SetSearch, EvidenceOfSizesOfEitherSignIsThatOfTheDenseCovariance) {
  constexpr double kSize_sd = 2.0;
  const std::vector<CandidateRule> rules(4, CandidateRule{.has_sign = false, .id = "", .family = ""});
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    const Problem one = problem(seed, 0.4);
    const estimation::Reduced point = reduced_of(one);
    for (const std::vector<int>& members : {std::vector<int>{0}, {1, 2}, {0, 1, 3}}) {
      const double gain_nats = set_gain_nats(point, columns_of(members, rules, kSize_sd));
      EXPECT_NEAR(gain_nats, dense_nats(one, members, kSize_sd) - dense_nats(one, {}, kSize_sd), 1e-6);
    }
  }
}

/// Reference: midpoint sum over φ ≥ 0 of 2·N(φ; 0, s²)·N(residual − z·φ), with θ integrated out.
TEST(SetSearch, EvidenceOfASizeWithASignIsTheIntegralOverIt) {
  constexpr double kSize_sd = 2.0;
  const std::vector<CandidateRule> rules(4, CandidateRule{.has_sign = true, .id = "", .family = ""});
  for (const double size : {0.5, 0.1, 0.0, -0.3}) {
    const Problem one = problem(7, size);
    const double gain_nats = set_gain_nats(reduced_of(one), columns_of({0}, rules, kSize_sd));
    constexpr int kSteps = 40000;
    constexpr double kStep = 12.0 / kSteps;
    double sum = 0.0;
    const double none_nats = dense_nats(one, {}, kSize_sd);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(one.residual.size(), one.residual.size());
    covariance += one.theta * one.prior.precision.inverse() * one.theta.transpose();
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    const double log_root = factor.matrixLLT().diagonal().array().log().sum();
    const Eigen::VectorXd off = one.residual - one.theta * one.prior.mean;
    const Eigen::VectorXd column = one.candidates.col(0);
    const double a = off.dot(factor.solve(off)), b = off.dot(factor.solve(column)), c = column.dot(factor.solve(column));
    for (int i = 0; i < kSteps; ++i) {
      const double phi = (i + 0.5) * kStep;
      const double prior = 2.0 * std::exp(-0.5 * phi * phi / (kSize_sd * kSize_sd)) / (kSize_sd * std::sqrt(2.0 * M_PI));
      sum += kStep * prior * std::exp(-0.5 * (a - 2.0 * phi * b + phi * phi * c) - log_root - none_nats);
    }
    EXPECT_NEAR(gain_nats, std::log(sum), 1e-3) << size;
  }
}

/// Rules of four candidates of different families.
std::vector<CandidateRule> four_rules() {
  std::vector<CandidateRule> rules;
  for (const char* const id : {"a", "b", "c", "d"}) {
    rules.push_back({true, -4.5, id, id, {}, 1.0});
  }
  return rules;
}

TEST(SetSearch, NamesWhatIsThereAndItsProbabilityAddsUp) {
  std::vector<CandidateRule> rules = four_rules();
  rules[1].family = "a";  // nearly collinear with column a
  const SelectionRules defaults;
  const SetSearch found({reduced_of(problem(3, 2.0))}, rules, defaults);
  ASSERT_FALSE(found.sets().front().members.empty());
  EXPECT_EQ(found.sets().front().members.front(), 0);
  EXPECT_GT(found.family_probability(found.sets().front(), 0), 0.99);
  double sum = 0.0;
  for (const EffectSet& set : found.sets()) {
    sum += set.probability;
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  const SetSearch nothing({reduced_of(problem(3, 0.0))}, rules, defaults);
  EXPECT_TRUE(nothing.sets().front().members.empty());
}

/// Two identical columns share their probability; the probability of the family stays high.
TEST(SetSearch, IndistinguishableEffectsAreCertainAsAFamily) {
  Problem one = problem(5, 1.0);
  one.candidates.col(1) = one.candidates.col(0);
  std::vector<CandidateRule> rules = four_rules();
  rules[1].family = "a";
  const SelectionRules defaults;
  const SetSearch found({reduced_of(one)}, rules, defaults);
  const EffectSet& best = found.sets().front();
  ASSERT_EQ(best.members.size(), 1U);
  EXPECT_GT(found.family_probability(best, 0), 0.99);
  EXPECT_EQ(found.stand_ins(best, 0, 5.0), std::vector<int>{best.members.front() == 0 ? 1 : 0});
}

/// Two identical columns of different families: neither is certain, but one of them acts.
TEST(SetSearch, OneOfTwoThatMayReplaceEachOtherIsCertain) {
  Problem one = problem(5, 1.0);
  one.candidates.col(1) = one.candidates.col(0);
  std::vector<CandidateRule> rules = four_rules();
  const SelectionRules defaults;
  const SetSearch found({reduced_of(one)}, rules, defaults);
  const EffectSet& best = found.sets().front();
  ASSERT_EQ(best.members.size(), 1U);
  EXPECT_LT(found.family_probability(best, 0), 0.6);
  EXPECT_GT(found.family_probability(best, 0, found.stand_ins(best, 0, 5.0)), 0.99);
}

/// The linear evidence of the best set was too high. The set whose non-linear fit confirms its evidence becomes the best. Sets without a
/// fit get the same correction.
TEST(SetSearch, FitsDecideAmongTheBestSets) {
  std::vector<CandidateRule> rules = four_rules();
  const SelectionRules defaults;
  SetSearch found({reduced_of(problem(3, 2.0))}, rules, defaults);
  const std::vector<EffectSet> before = found.sets();
  ASSERT_GT(before.size(), 5U);
  int fits = 0;
  found.reconsider(
      [&](const std::vector<int>& members, const SetSearch::AtBest& at) {
        ++fits;
        return at.evidence_nats + (members == before[1].members ? 2.0 : -60.0);
      },
      6);
  EXPECT_EQ(fits, 2) << "the second one kept what it promised";
  EXPECT_EQ(found.sets().front().members, before[1].members);
  EXPECT_NEAR(found.sets().front().log_probability_nats, before[1].log_probability_nats + 2.0, 1e-9);
  EXPECT_EQ(found.sets()[1].members, before[2].members);
  EXPECT_NEAR(found.sets()[1].log_probability_nats, before[2].log_probability_nats + 2.0, 1e-9);
}

/// A log that contradicts the model, for example with exchanged sensors.
TEST(SetSearch, KeepsItsProbabilitiesIfEveryFitFails) {
  std::vector<CandidateRule> rules = four_rules();
  const SelectionRules defaults;
  SetSearch found({reduced_of(problem(3, 2.0))}, rules, defaults);
  const std::vector<EffectSet> before = found.sets();
  found.reconsider([](const std::vector<int>&, const SetSearch::AtBest&) { return -std::numeric_limits<double>::infinity(); }, 6);
  EXPECT_EQ(found.sets().front().members, before.front().members);
  EXPECT_NEAR(found.sets().front().probability, before.front().probability, 1e-12);
}

}  // namespace
}  // namespace heatsoak::attribution
