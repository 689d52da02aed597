// Samples of all tolerances, draws of a duty, and when a verdict is decided.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <set>

#include "base/lanes.h"
#include "given_demand.h"
#include "select/decision.h"
#include "select/evaluate.h"
#include "select/spread.h"
#include "simple_motor.h"
#include "support/seed_rate.h"
#include "support/source_folder.h"

namespace heatsoak::select {
namespace {

TEST(Samples, same_seed_same_bits_for_any_number_of_threads) {
  const robot::Robot robot = robot_of_file("roboteam_twente_v2024");
  duty::Duty duty = duty_of_file("paper_intermittent");
  shorten(duty, 60);
  const std::vector<motor::Motor> motors{motor_of_file("maxon_ecx_flat_32l_48v"), motor_of_file("maxon_ecx_flat_42m_24v"),
                                         motor_of_file("nanotec_df45l024048_a2")};
  EvaluateOptions options{.samples = 61, .seed = 7, .threads = 1, .with_curves = true, .with_bands = true};
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  const std::vector<MotorEvaluation> one = evaluate(robot, duty, duty.demand(robot, options.seed), motors, options);
  for (const int threads : {1, 2, 3, 8}) {
    options.threads = threads;
    const std::vector<MotorEvaluation> many = evaluate(robot, duty, duty.demand(robot, options.seed), motors, options);
    ASSERT_EQ(many.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].motor_id, many[i].motor_id);
      for (const auto& [a, b] :
           {std::pair{one[i].winding_peak_C, many[i].winding_peak_C}, std::pair{one[i].stator_peak_C, many[i].stator_peak_C}}) {
        EXPECT_EQ(bits(a.nominal), bits(b.nominal));
        EXPECT_EQ(bits(*a.p05), bits(*b.p05));
        EXPECT_EQ(bits(*a.p50), bits(*b.p50));
        EXPECT_EQ(bits(*a.p95), bits(*b.p95));
      }
      EXPECT_EQ(one[i].probability_over_limit, many[i].probability_over_limit);
      EXPECT_EQ(one[i].curves.winding_p95_C, many[i].curves.winding_p95_C);
      EXPECT_EQ(one[i].curves.winding_C, many[i].curves.winding_C);
    }
  }
}

TEST(Samples, another_seed_is_another_draw) {
  const motor::Motor motor = motor_of_file("maxon_ecx_flat_32l_48v");
  const robot::Robot robot = robot_of_file("roboteam_twente_v2024");
  duty::Duty duty = duty_of_file("paper_intermittent");
  shorten(duty, 20);
  std::set<double> medians_C;
  std::set<double> nominal_C;
  constexpr std::uint64_t kSeeds = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const MotorEvaluation result = evaluate_one(motor, robot, duty, {.samples = 40, .seed = seed});
    medians_C.insert(*result.winding_peak_C.p50);
    nominal_C.insert(result.winding_peak_C.nominal);
  }
  EXPECT_EQ(medians_C.size(), kSeeds);
  EXPECT_EQ(nominal_C.size(), 1U);
}

TEST(Samples, without_any_spread_all_are_the_nominal_one) {
  const MotorEvaluation result = evaluate_one(simple_motor(), simple_robot(), constant_current(5.0), {.samples = 20});
  EXPECT_NEAR(*result.winding_peak_C.p05, result.winding_peak_C.nominal, 0.01);
  EXPECT_NEAR(*result.winding_peak_C.p95, result.winding_peak_C.nominal, 0.01);
  EXPECT_EQ(result.probability_over_limit, 0.0);
}

/// Percentiles of the samples, averaged over the seeds 1 to `seeds`, and how often an interval contains the true value.
struct OverSeeds {
  double p05_C = 0.0, p50_C = 0.0, p95_C = 0.0;
  double probability = 0.0;
  std::vector<MotorEvaluation> each;

  [[nodiscard]] testing::AssertionResult probability_is_covered(double truth) const {
    return covered(truth, [](const MotorEvaluation& motor) { return *motor.probability_interval; });
  }
  [[nodiscard]] testing::AssertionResult p95_is_covered(double truth_C) const {
    return covered(truth_C, [](const MotorEvaluation& motor) { return *motor.winding_p95_interval_C; });
  }

 private:
  [[nodiscard]] testing::AssertionResult covered(double truth, const std::function<Interval95(const MotorEvaluation&)>& interval) const {
    return holds_for_share(0.95, static_cast<int>(each.size()), [&](std::uint64_t seed) {
      const Interval95 one = interval(each[seed - 1]);
      return one.low <= truth && truth <= one.high;
    });
  }
};

OverSeeds over_seeds(int seeds, int samples, const motor::Motor& motor, const duty::Duty& duty) {
  OverSeeds all;
  for (int seed = 1; seed <= seeds; ++seed) {
    const MotorEvaluation& one =
        all.each.emplace_back(evaluate_one(motor, simple_robot(), duty, {.samples = samples, .seed = static_cast<std::uint64_t>(seed)}));
    all.p05_C += *one.winding_peak_C.p05 / seeds;
    all.p50_C += *one.winding_peak_C.p50 / seeds;
    all.p95_C += *one.winding_peak_C.p95 / seeds;
    all.probability += *one.probability_over_limit / seeds;
  }
  return all;
}

/// Returns the standard error of a share that is estimated from `draws` independent draws.
double share_error(double share, double draws) { return std::sqrt(share * (1.0 - share) / draws); }

// The peak increases with the resistance, so its quantiles follow from those of a normal distribution truncated at two standard deviations.
TEST(Samples, spread_of_the_resistance_alone_gives_the_quantiles_of_the_closed_form) {
  motor::Motor motor = simple_motor();
  set_value(motor, "terminal_resistance", &motor::MotorValues::terminal_resistance_ohm, resistance_within_10_percent());
  const boost::math::normal_distribution<> normal;
  const double outside = boost::math::cdf(normal, -2.0);
  const auto peak_C = [&](double share) {
    const double deviation_sd = boost::math::quantile(normal, outside + share * (1.0 - 2.0 * outside));
    return rest_C(kResistance_ohm * (1.0 + 0.05 * deviation_sd), 5.2);
  };
  double below = 0.0;
  constexpr int kCells = 10000;
  for (int i = 0; i < kCells; ++i) {
    below += peak_C((i + 0.5) / kCells) <= 155.0 ? 1.0 / kCells : 0.0;
  }
  ASSERT_GT(1.0 - below, 0.02);
  ASSERT_LT(1.0 - below, 0.98);
  const double width_K = peak_C(0.95) - peak_C(0.05);
  ASSERT_GT(width_K, 20.0);
  constexpr int kSeeds = 40, kSamples = 250;
  const OverSeeds found = over_seeds(kSeeds, kSamples, motor, constant_current(5.2));
  EXPECT_TRUE(found.probability_is_covered(1.0 - below));
  EXPECT_TRUE(found.p95_is_covered(peak_C(0.95)));
  // Four standard errors of a quantile of all 10 000 samples, which is that of the share divided by the density.
  const auto error_K = [&](double share) {
    return 4.0 * share_error(share, kSeeds * kSamples) * (peak_C(share + 0.01) - peak_C(share - 0.01)) / 0.02;
  };
  EXPECT_NEAR(found.p05_C, peak_C(0.05), error_K(0.05));
  EXPECT_NEAR(found.p50_C, peak_C(0.50), error_K(0.50));
  EXPECT_NEAR(found.p95_C, peak_C(0.95), error_K(0.95));
  EXPECT_NEAR(found.probability, 1.0 - below, 4.0 * share_error(below, kSeeds * kSamples));
}

TEST(Samples, median_of_symmetric_spreads_is_near_the_nominal_peak) {
  motor::Motor motor = simple_motor();
  set_value(motor, "terminal_resistance", &motor::MotorValues::terminal_resistance_ohm, resistance_within_10_percent());
  base::ParameterValue inner;
  inner.value = kInner_K_per_W;
  inner.origin = base::Origin::measured;
  inner.spread = base::Spread{base::Spread::Kind::tolerance, 0.9 * kInner_K_per_W, 1.1 * kInner_K_per_W, true};
  set_value(motor, "thermal_resistance_winding_stator", &motor::MotorValues::thermal_resistance_winding_stator_K_per_W, inner);
  const OverSeeds found = over_seeds(10, 200, motor, constant_current(5.0));
  const double nominal_C = found.each.front().winding_peak_C.nominal;
  EXPECT_NEAR(found.p50_C, nominal_C, 0.01 * (nominal_C - 25.0));
  for (const MotorEvaluation& one : found.each) {
    EXPECT_LT(*one.winding_peak_C.p05, nominal_C - 3.0);
    EXPECT_GT(*one.winding_peak_C.p95, nominal_C + 3.0);
  }
}

// In half of the draws the limit is uniform between 105 and 155 °C, so it is below 130 °C in a quarter of all draws.
TEST(Samples, a_limit_that_may_be_lower_makes_a_pass_marginal) {
  motor::Motor motor = simple_motor();
  base::ParameterValue limit;
  limit.value = 155.0;
  limit.spread = base::Spread{base::Spread::Kind::range, 105.0, 165.0, false};
  set_value(motor, "winding_limit", &motor::MotorValues::winding_limit_C, limit);
  const double current_A = std::sqrt(105.0 / (1.0 + 0.0039 * 105.0) / 3.0);  // has its steady state at 130 °C
  constexpr int kSeeds = 20, kSamples = 200;
  const OverSeeds found = over_seeds(kSeeds, kSamples, motor, constant_current(current_A));
  for (const MotorEvaluation& one : found.each) {
    EXPECT_EQ(one.verdict, Verdict::marginal);
    EXPECT_EQ(one.limiting_factor, LimitingFactor::winding_temperature);
  }
  EXPECT_TRUE(found.probability_is_covered(0.25));
  EXPECT_NEAR(found.probability, 0.25, 4.0 * share_error(0.25, kSeeds * kSamples));
}

TEST(Samples, ambient_of_the_duty_moves_the_peak_with_it) {
  duty::Duty duty = constant_current(5.0);
  duty.ambient_C.spread = base::Spread{base::Spread::Kind::range, 15.0, 35.0, false};
  constexpr int kSeeds = 20, kSamples = 200;
  const OverSeeds found = over_seeds(kSeeds, kSamples, simple_motor(), duty);
  const double nominal_C = found.each.front().winding_peak_C.nominal;
  // T_W = T_A + c·(1+α(T_A−25))/(1−α·c) with c = 75 K: 1 + α·75/(1−α·75) = 1.4134 K per K. The 5th percentile of 15 … 35 °C is 16 °C.
  constexpr double kPeak_K = 9.0 * 1.4134;
  const double error_K = 4.0 * share_error(0.05, kSeeds * kSamples) * 20.0 * 1.4134;
  EXPECT_NEAR(found.p05_C, nominal_C - kPeak_K, error_K);
  EXPECT_NEAR(found.p95_C, nominal_C + kPeak_K, error_K);
  EXPECT_TRUE(found.p95_is_covered(nominal_C + kPeak_K));
}

// Clopper and Pearson's interval for 10 of 100 is 0.0490 to 0.1762. The binomial distribution gives the percentile's ranks among 100.
TEST(Spread, sampling_error_is_that_of_the_textbook) {
  std::vector<double> samples_C(100);
  std::vector<char> over(100, 0);
  for (std::size_t i = 0; i < 100; ++i) {
    samples_C[i] = static_cast<double>(99 - i);
    over[i] = i < 10 ? 1 : 0;
  }
  const DrawIntervals intervals = sample_intervals(samples_C, over);
  EXPECT_NEAR(intervals.probability.low, 0.0490, 5e-5);
  EXPECT_NEAR(intervals.probability.high, 0.1762, 5e-5);
  EXPECT_GE(intervals.p95.low, 88.0);
  EXPECT_LE(intervals.p95.low, 91.0);
  EXPECT_GE(intervals.p95.high, 98.0);
}

TEST(Spread, few_samples_determine_no_upper_end) {
  const std::vector<double> samples_C(71, 80.0);
  const std::vector<char> over(71, 0);
  EXPECT_TRUE(std::isinf(sample_intervals(samples_C, over).p95.high));
  const std::vector<double> more_C(72, 80.0);
  EXPECT_EQ(sample_intervals(more_C, std::vector<char>(72, 0)).p95.high, 80.0);
  EXPECT_EQ(fewest_samples_for_bound(false), 72);
  const auto of_draws = [](std::size_t draws) {
    const std::size_t samples = draws * base::kLanes;
    return draw_intervals(std::vector<double>(samples, 80.0), std::vector<char>(samples, 0), {draws, base::kLanes, 1}).p95.high;
  };
  const auto fewest = static_cast<std::size_t>(fewest_samples_for_bound(true) / base::kLanes);
  EXPECT_EQ(of_draws(fewest), 80.0);
  EXPECT_TRUE(std::isinf(of_draws(fewest - 1)));
}

// If none of n draws exceeds the limit, up to 3/n of all draws may do so (rule of three).
TEST(Spread, draws_that_are_all_alike_do_not_rule_the_others_out) {
  for (const std::size_t draws : {1U, 6U, 62U}) {
    const std::vector<double> samples_C(8 * draws, 80.0);
    const std::vector<char> none(8 * draws, 0);
    const std::vector<char> all(8 * draws, 1);
    const double unseen = 1.0 - std::pow(0.05, 1.0 / static_cast<double>(draws));
    EXPECT_NEAR(draw_intervals(samples_C, none, {draws, 8, 1}).probability.high, unseen, 1e-12);
    EXPECT_NEAR(draw_intervals(samples_C, all, {draws, 8, 1}).probability.low, 1.0 - unseen, 1e-12);
    EXPECT_EQ(std::isinf(draw_intervals(samples_C, none, {draws, 8, 1}).p95.high), draws < 20);
  }
}

// Blocks of samples use the draws in turn. Without other spread every peak has a closed form.
TEST(Evaluate, draws_of_a_duty_are_shared_by_the_samples) {
  const motor::Motor motor = simple_motor();
  const robot::Robot robot = simple_robot();
  duty::Duty duty = constant_current(1.0);
  duty.kind = duty::DutyKind::torque;
  const std::vector<double> torques_Nm{0.03, 0.06, 0.09, 0.12};  // currents of 1 A to 4 A
  std::vector<duty::WheelDemand> draws;
  for (const double torque_Nm : torques_Nm) {
    draws.push_back(steady_wheels(torque_Nm, 400.0).back());
  }
  const std::vector<duty::WheelDemand> nominal = steady_wheels(0.03, 600.0);
  EvaluateOptions options{.samples = 4 * 8 * 3, .with_curves = true, .with_bands = true};
  options.draws = draws;
  const MotorEvaluation result = evaluate(robot, duty, nominal, std::span(&motor, 1), options).front();
  EXPECT_NEAR(result.winding_peak_C.nominal, rest_C(kResistance_ohm, 1.0), 0.01);
  EXPECT_NEAR(*result.winding_peak_C.p05, rest_C(kResistance_ohm, 1.0), 0.01);
  EXPECT_NEAR(*result.winding_peak_C.p95, rest_C(kResistance_ohm, 4.0), 0.01);
  EXPECT_NEAR(*result.winding_peak_C.p50, 0.5 * (rest_C(kResistance_ohm, 2.0) + rest_C(kResistance_ohm, 3.0)), 0.01);
  // All four draws may be the same one: (1/4)^4 is less than 1/40. The interval therefore spans nearly all of them, and its upper end is
  // unknown.
  EXPECT_TRUE(std::isinf(result.winding_p95_interval_C->high));
  EXPECT_LE(result.winding_p95_interval_C->low, rest_C(kResistance_ohm, 3.0) + 0.01);
  // All draws end before the nominal duty, so the band in the chart also ends there.
  ASSERT_FALSE(result.curves.band_time_s.empty());
  EXPECT_LT(result.curves.band_time_s.back(), 410.0);
  EXPECT_EQ(result.curves.band_time_s.size(), result.curves.winding_p95_C.size());
  options.threads = 3;
  const MotorEvaluation again = evaluate(robot, duty, nominal, std::span(&motor, 1), options).front();
  EXPECT_EQ(again.winding_peak_C.p50, result.winding_peak_C.p50);
  EXPECT_EQ(again.curves.winding_p95_C, result.curves.winding_p95_C);
}

/// Returns motors whose limit is below the given peak in a share of the samples. The share is either near the 5 % of a verdict or far from
/// it.
motor::Motor limited_between(double low_C, double high_C) {
  motor::Motor motor = simple_motor();
  base::ParameterValue limit;
  limit.value = 155.0;
  limit.spread = base::Spread{base::Spread::Kind::range, low_C, high_C, false};
  set_value(motor, "winding_limit", &motor::MotorValues::winding_limit_C, limit);
  return motor;
}

TEST(UntilDecided, takes_more_samples_only_near_a_threshold) {
  const duty::Duty duty = constant_current(std::sqrt(105.0 / (1.0 + 0.0039 * 105.0) / 3.0), 60.0);
  motor::Motor near = limited_between(105.0, 165.0);
  near.id = "near";
  const double peak_C = evaluate_one(near, simple_robot(), duty).winding_peak_C.nominal;
  // Half of the draws are uniform between the lower end and the nominal limit, so 6.5 % of all draws are below the peak.
  near = limited_between(peak_C - 0.13 / 0.87 * (155.0 - peak_C), 165.0);
  near.id = "near";
  motor::Motor far = simple_motor();
  far.id = "far";
  const std::vector<motor::Motor> motors{near, far};
  bool takes_more = false;
  // A verdict may be wrong for 5 % of the seeds.
  EXPECT_TRUE(holds_for_share(0.95, 12, [&](std::uint64_t seed) {
    std::vector<duty::WheelDemand> draws;
    const std::vector<MotorEvaluation> results =
        evaluate_until_decided(simple_robot(), duty, duty.demand(simple_robot(), seed), motors,
                               {.samples = first_samples(duty.shape_data->has_unknowns()), .seed = seed}, most_samples(duty), draws);
    const auto of = [&](std::string_view id) { return *std::ranges::find(results, id, &MotorEvaluation::motor_id); };
    EXPECT_EQ(of("far").samples, 500) << seed;
    EXPECT_EQ(of("far").verdict, Verdict::pass) << seed;
    const MotorEvaluation found = of("near");
    takes_more |= found.samples > 500;
    EXPECT_TRUE(found.samples > 500 || !found.samples_needed) << seed;
    // A single request with the final number of samples must give the same answer.
    if (constexpr std::uint64_t kCompared = 3; seed <= kCompared) {
      const MotorEvaluation at_once = evaluate_one(near, simple_robot(), duty, {.samples = found.samples, .seed = seed});
      EXPECT_EQ(at_once.verdict, found.verdict) << seed;
      EXPECT_EQ(at_once.probability_over_limit, found.probability_over_limit) << seed;
      EXPECT_EQ(at_once.samples_needed.has_value(), found.samples_needed.has_value()) << seed;
    }
    return found.verdict == Verdict::marginal && !found.samples_needed;
  }));
  EXPECT_TRUE(takes_more);
}

/// A load of the wheel that is drawn: a share of the draws is far above the motor's limit, all others far below.
class DrawnLoad final : public duty::DutyShape {
 public:
  explicit DrawnLoad(double heavy_share) : heavy_share_(heavy_share) {}
  [[nodiscard]] std::vector<duty::WheelDemand> demand(const robot::Robot& /*robot*/, std::uint64_t /*seed*/) const override {
    return steady_wheels(kLight_Nm, 400.0);
  }
  [[nodiscard]] bool has_unknowns() const override { return true; }
  [[nodiscard]] duty::WheelDemand draw(const robot::Robot& /*robot*/, std::uint64_t /*seed*/, std::uint64_t draw) const override {
    const double before = std::floor(heavy_share_ * static_cast<double>(draw));
    const bool is_heavy = std::floor(heavy_share_ * static_cast<double>(draw + 1)) > before;
    return steady_wheels(is_heavy ? kHeavy_Nm : kLight_Nm, 400.0).back();
  }

 private:
  static constexpr double kLight_Nm = 0.03;
  static constexpr double kHeavy_Nm = 0.3;
  double heavy_share_;
};

MotorEvaluation until_decided(double heavy_share) {
  duty::Duty duty = constant_current(1.0);
  duty.kind = duty::DutyKind::torque;
  duty.shape_data = std::make_shared<DrawnLoad>(heavy_share);
  const motor::Motor motor = simple_motor();
  std::vector<duty::WheelDemand> draws;
  const MotorEvaluation result =
      evaluate_until_decided(simple_robot(), duty, duty.demand(simple_robot(), 1), std::span(&motor, 1),
                             {.samples = first_samples(duty.shape_data->has_unknowns())}, most_samples(duty), draws)
          .front();
  EXPECT_EQ(draws.size(), static_cast<std::size_t>(result.games));
  return result;
}

// No heavy game among 75 decides, and 20 % do. For 37.5 % the upper end of Clopper and Pearson's interval is 0.51 after 75 games and 0.49
// after 150: most games pass. 2.5 % need some hundred games.
TEST(UntilDecided, plays_games_until_they_decide) {
  EXPECT_EQ(until_decided(0.0).games, 75);
  EXPECT_EQ(until_decided(0.2).games, 75);
  EXPECT_EQ(until_decided(0.375).games, 150);
  const MotorEvaluation late = until_decided(0.025);
  EXPECT_GE(late.games, 600);
  for (const double share : {0.0, 0.2, 0.375, 0.025}) {
    EXPECT_FALSE(until_decided(share).samples_needed) << share;
  }
  EXPECT_EQ(late.verdict, Verdict::pass);
}

// 4.7 % are too close to 5 % for 2400 games: the games end as soon as that is clear.
TEST(UntilDecided, stops_if_a_decision_is_out_of_reach) {
  const MotorEvaluation never = until_decided(0.047);
  EXPECT_LT(never.games, 2400);
  ASSERT_TRUE(never.samples_needed);
  EXPECT_GT(*never.samples_needed, 8 * 2400);
  EXPECT_FALSE(is_decided(never));
}

TEST(UntilDecided, as_many_games_are_played_as_are_asked_for) {
  const duty::Duty duty = duty_of_file("division_b_match");
  EXPECT_EQ(draw_count(duty, 4074), 510);
  EXPECT_EQ(draw_count(duty, most_samples_at_all(true)), most_samples_at_all(true) / 8);
}

TEST(Evaluate, draws_are_the_same_for_every_number_of_threads) {
  const duty::Duty duty = duty_of_file("division_b_match");
  const robot::Robot robot = robot_of_file("roboteam_twente_v2024");
  EXPECT_EQ(draw_count(duty, 0), 0);
  EXPECT_EQ(draw_count(duty, 9), 2);
  EXPECT_EQ(draw_count(constant_current(1.0), 500), 0);
  const auto torques = [&](int threads) {
    std::vector<double> all_Nm;
    for (const duty::WheelDemand& wheel : draw_demands(duty, robot, 5, 3, threads)) {
      all_Nm.push_back(wheel.bins.at(100).torque_rms_Nm);
      all_Nm.push_back(wheel.duration_s());
    }
    return all_Nm;
  };
  EXPECT_EQ(torques(1), torques(3));
}

}  // namespace
}  // namespace heatsoak::select
