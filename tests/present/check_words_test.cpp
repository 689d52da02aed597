// Words of results and findings of `check`.
#include "present/check_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <exception>
#include <limits>
#include <vector>

#include "base/version.h"
#include "estimation/findings.h"
#include "present/failure_words.h"

namespace heatsoak::present {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const check::Limit kPeakLimit{check::find_threshold("winding_peak_p95"), 70.0, "degC", "at most 70 degC", {"a.toml", 9, 20}};
const check::Limit kMarginLimit{check::find_threshold("current_margin"), 3.0, "A", "at least 3 A", {"a.toml", 10, 18}};
const check::Limit kShareLimit{check::find_threshold("probability_over_limit"), 0.05, "%", "at most 5 %", {"a.toml", 11, 26}};
const check::Limit kTimeLimit{check::find_threshold("time_above"), 60.0, "s", "at most 60 s", {"a.toml", 12, 14}};

check::Outcome outcome(const check::Limit& limit, double value, check::Basis basis = {}) {
  check::Outcome result;
  result.limit = limit;
  result.measured = {.value = value, .basis = std::move(basis)};
  return result;
}

TEST(CheckWords, compare_a_value_with_its_limit) {
  const check::Outcome kept = outcome(kPeakLimit, 62.6);
  EXPECT_EQ(reason_words(kept), "");
  EXPECT_EQ(margin_words(kept), "+7.4 K");
  const check::Outcome broken = outcome(kMarginLimit, 2.5);
  EXPECT_EQ(reason_words(broken), "2.5 A is below the limit of 3 A");
  EXPECT_EQ(margin_words(broken), "-0.5 A");
  EXPECT_EQ(limit_words(broken), "at least 3 A");
}

TEST(CheckWords, state_that_an_event_never_happens) {
  check::Outcome never = outcome(kTimeLimit, std::numeric_limits<double>::infinity());
  never.measured->is_never = true;
  EXPECT_EQ(value_words(never), "never");
  EXPECT_EQ(margin_words(never), "–");
  EXPECT_EQ(reason_words(never), "it never happens; expected it within 60 s");
  never.not_rewritten = check::NoTimeSuffices{};
  EXPECT_THAT(reason_words(never), EndsWith("; the limit is not rewritten: no time is long enough"));
}

TEST(CheckWords, state_why_update_leaves_a_limit) {
  check::Outcome loose = outcome(kPeakLimit, 160.0);
  loose.not_rewritten = check::Looseness{"at most 167 degC", {155.0, check::LoosestBy::winding_limit}};
  EXPECT_EQ(reason_words(loose),
            "160.0 °C is above the limit of 70.0 °C; the limit is not rewritten: \"at most 167 degC\" is looser than the motor's own "
            "winding limit, 155.0 °C; expected that or a tighter limit");
  check::Outcome invalid = outcome(kPeakLimit, 60.0);
  invalid.not_rewritten = check::LimitInvalid{{check::LimitProblem::Kind::out_of_range, "at most 2000 degC", 2000.0}};
  EXPECT_THAT(reason_words(invalid), testing::StartsWith("the limit is not rewritten: \"at most 2000 degC\" is out of range; expected "));
}

TEST(CheckWords, advise_more_samples_only_where_the_limit_is_broken) {
  check::ShareBasis basis{.over = 0, .samples = 32, .games = {}, .limit_share = 0.05, .samples_needed = 72};
  EXPECT_EQ(basis_words(outcome(kShareLimit, 0.0894, basis)),
            "0 of 32 samples over, bound of 97.5 % confidence; 72 samples or more could meet 5 % with this share");
  EXPECT_EQ(basis_words(outcome(kShareLimit, 0.04, basis)), "0 of 32 samples over, bound of 97.5 % confidence");
  basis.games = 4;
  basis.samples_needed.reset();
  EXPECT_EQ(
      explanation_words(outcome(kShareLimit, 0.5, basis)),
      "50 % is above the limit of 5 %: 0 of 32 samples over, bound of 97.5 % confidence by 4 games; no number of samples can meet the "
      "limit with this share");
}

TEST(CheckWords, name_the_part_of_a_number_that_is_compared) {
  check::NumberBasis basis{
      .name = "motors.a.p95", .numbers = 2, .compared = check::Compared::interval, .value = 59.0, .interval = {55.3, std::nullopt}};
  EXPECT_EQ(basis_words(outcome(kPeakLimit, 68.4, basis)), "motors.a.p95, of 2 numbers; 59.0 °C, its 95 % interval 55.3 °C to unknown");
  basis.numbers = 1;
  basis.compared = check::Compared::percentile;
  EXPECT_EQ(basis_words(outcome(kPeakLimit, 59.0, basis)), "the percentile itself is compared: the answer has no interval for it");
  basis.compared = check::Compared::number;
  EXPECT_EQ(basis_words(outcome(kPeakLimit, 59.0, basis)), "");
}

TEST(CheckWords, of_a_failure_are_its_summary_and_its_problems) {
  const base::Failure failure(base::ExitCode::bad_input, "it failed",
                              {{{"a.toml", 5, 9}, "motor", "is missing"}, {{"b.h"}, {}, "is empty"}});
  EXPECT_EQ(words_of(check::Failed{failure}, kPeakLimit), "it failed; a.toml:5:9: motor: is missing; b.h: is empty");
}

// The command that computes the same alone gives this advice, too.
TEST(CheckWords, of_a_failure_of_its_own_type_are_those_of_the_verb) {
  check::Outcome failed;
  failed.limit = kPeakLimit;
  failed.limit.at = {"checks.toml", 8, 3};
  try {
    throw estimation::RunNotSimulated("run1", base::Failure(base::ExitCode::numerics_failed, "too fast"));
  } catch (const base::Failure& failure) {
    failed.reason = check::Failed{failure, std::current_exception()};
    EXPECT_EQ(reason_words(failed), in_words(failure).message());
  }
  EXPECT_THAT(located_explanation(failed), StartsWith("checks.toml:8:3: run1: too fast; check the units of the log's columns"));
}

TEST(CheckWords, name_one_place_which_is_that_of_the_problem) {
  check::Outcome failed;
  failed.limit = kPeakLimit;
  failed.limit.at = {"checks.toml", 8, 3};
  failed.reason = check::Failed{base::Failure(base::ExitCode::bad_input, "", {{{"checks.toml", 4, 9}, "motor", "a.toml: cannot be read"}})};
  EXPECT_EQ(place_of(failed).line, 4);
  EXPECT_EQ(located_explanation(failed), "checks.toml:4:9: motor: a.toml: cannot be read");
  EXPECT_EQ(unlocated_explanation(failed), "motor: a.toml: cannot be read");
  failed.reason = check::ResultNotFinite{};
  EXPECT_EQ(located_explanation(failed), "checks.toml:8:3: the result is not a number");
  EXPECT_EQ(unlocated_explanation(failed), "the result is not a number");
}

TEST(CheckWords, name_how_the_sensor_of_a_header_differs) {
  using derate::SensorDifference;
  const auto words = [](const SensorDifference& difference) { return words_of(check::SensorOptionsDiffer{"g.h", difference}, kPeakLimit); };
  EXPECT_THAT(words({SensorDifference::Kind::options_unstated}), StartsWith("g.h: the header has a temperature sensor and does not state"));
  EXPECT_THAT(words({SensorDifference::Kind::sensor_unexpected, "--thermistor stator"}),
              HasSubstr("expected the options that it was generated with: --thermistor stator"));
  EXPECT_THAT(words({SensorDifference::Kind::sensor_missing}), HasSubstr("the header has no temperature sensor"));
  EXPECT_THAT(
      words({SensorDifference::Kind::other_options, "", {{"--thermistor-accuracy", "1.5K", "10K"}, {"--thermistor-lag", "3s", {}}}}),
      HasSubstr("generated with --thermistor-accuracy 1.5K, not 10K; --thermistor-lag 3s, which is missing; use its options"));
}

TEST(CheckWords, name_what_an_answer_lacks) {
  const auto words = [](const check::Reason& reason) { return words_of(reason, kShareLimit); };
  EXPECT_EQ(words(check::NumberMissing{"distance.x", "planners.fast", {"planner", "distance_m"}}),
            "there is no 'distance.x' in 'planners.fast'; did you mean 'distance_m'?");
  EXPECT_EQ(words(check::NumberMissing{"zzz", "", {"planner", "distance_m"}}),
            "there is no 'zzz' in the answer; expected one of planner, distance_m");
  EXPECT_EQ(words(check::NumberMissing{"x", "verdict", {}}),
            "there is no 'x' in 'verdict', which has no members; `--json -` behind the command shows the numbers that it has");
  EXPECT_THAT(words(check::NumberMissing{"zzz", "", std::vector<std::string>(13, "abcdefgh")}), EndsWith("abcdefgh, …"));
  EXPECT_EQ(words(check::NumberIsGroup{"none", {}}), "'none' is empty");
  EXPECT_EQ(
      words(check::NumberIsCount{"over", 2.0}),
      "\"at most 5 %\" is a percentage, but 'over' is a whole number, 2; expected at most and a number without unit, such as \"at most "
      "2\"");
  EXPECT_THAT(words(check::IntervalUnbounded{"p95"}), HasSubstr("has no upper end"));
}

TEST(CheckWords, count_the_places_where_an_observer_differs) {
  const auto words = [](std::size_t count) { return words_of(check::ObserverDiffers{"guard.h", {7, "a", "b"}, count}, kPeakLimit); };
  EXPECT_THAT(words(1), HasSubstr("guard.h:7: the observer differs from that of a fresh header in 1 place, so"));
  EXPECT_THAT(words(3), HasSubstr("in 3 places, so"));
}

TEST(CheckWords, tell_an_upgrade_from_a_change_where_a_committed_table_fails) {
  const check::Limit limit{check::find_threshold("derating_excess"), 0.0, "A", "at most 0 A", {"a.toml", 9, 20}};
  derate::TablePlace place;
  place.difference_A = 0.3;
  const check::ExcessBasis old{place, 0.0, "0.0.9"};
  EXPECT_THAT(basis_words(outcome(limit, 0.3, old)), HasSubstr("; written by heatsoak 0.0.9, this program is "));
  EXPECT_THAT(basis_words(outcome(limit, 0.3, check::ExcessBasis{place, 0.0, {}})), Not(HasSubstr("written by")));
  EXPECT_THAT(basis_words(outcome(limit, 0.0, old)), Not(HasSubstr("written by"))) << "the limit holds";
  EXPECT_THAT(words_of(check::ObserverDiffers{"guard.h", {7, "a", "b"}, 1, "0.0.9"}, limit),
              EndsWith("generate the header again; written by heatsoak 0.0.9, this program is " + std::string(base::program_version()) +
                       ": an upgrade may explain the difference"));
}

}  // namespace
}  // namespace heatsoak::present
