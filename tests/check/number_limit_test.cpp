// Limits on numbers of a command's JSON answer.
#include "check/number_limit.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "check/answer_number.h"
#include "check/check_job.h"
#include "check/limit_words.h"
#include "check/not_evaluated.h"
#include "check/rewrite.h"
#include "check/typed_outcome.h"
#include "support/source_folder.h"

namespace heatsoak::check {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;

const Json kAnswer = Json::parse(R"({
  "schema": "heatsoak.simulate/1", "verdict": "pass", "cold_C": 10.6, "room_C": 25.0, "idle_s": 0.0, "shortfall_ratio": 0.00105, "allowed_A": 0.4, "runaway": false, "time_to_limit_s": null, "never": ["time_to_limit_s"], "margin_A": null, "none": [],
  "planners": [{"planner": "fast", "distance_m": 900.5, "peaks_C": {"p05": 40.0, "p95": 61.5, "p95_ci95": [58.0, 66.0]}},
               {"planner": "slow.2", "distance_m": 700.0, "peaks_C": {"p05": 30.0, "p95": 51.5, "p95_ci95": [48.0, null]}}],
  "probability_over_limit": 0.02, "probability_ci95": [0.005, 0.06], "over_share_ci95": [0.0, 0.01], "over": 2,
  "parameters": [{"name": "joint.conductance", "value": 0.25, "unit": "W/K", "ci95": [0.2, 0.31], "nats": 4.5}],
  "wheels": [{"index": 1, "damping_V_s_per_rad": {"value": 0.02, "ci95": [0.01, 0.03]}}],
  "coverage_90": {"winding_C": 0.93}, "error": {"winding_C": {"rmse_K": 2.5, "samples": 400}},
  "heat_W": {"mean": 1.5, "max": 4.0}, "limited_s": {"voltage": 3.0, "guard": 0.0}, "coefficient_per_K": 0.0039,
  "residual_tests": {"before": {"winding_C": {"periodogram_over_band": 1.1, "ljung_box_p": 0.4, "correlated_with": {"current": 0.1}}}},
  "power_balance_W": {"copper_loss": {"winding": 5.0}}, "curve": {"driver": [1.0], "driver_unit": "rad/s", "value": [2.0], "unit": "W"},
  "rest_of_hot_motor": [{"play": "5min", "rest_half_s": 240.0, "rest_all_s": null, "never": ["rest_all_s"]}], "drift_K": {"value": -1.0, "ci95": [-4.8, 0.05]}, "knots": [1.0, 2.0],
  "balance": {"share": 0.4, "mean_W": {"rotor": 2.0, "drag_share": 0.5, "ranges": {"drag_share": [-1, 1]}}},
  "ranges": {"probability_over_limit": [0, 1], "coverage_90": [0, 1], "idle_s": [0, null], "limited_s": [0, null], "mean_W": [0, null]}})");

/// Returns why there is no number of that name; a default NumberIsNull if there is one.
Reason refusal(std::string_view place) {
  try {
    static_cast<void>(numbers_at(kAnswer, place));
  } catch (const NotEvaluated& refused) {
    return refused.reason();
  }
  return NumberIsNull{};
}

TEST(AnswerNumbers, AreFoundByKeysNamesAndPlaces) {
  const auto value = [](std::string_view place) { return numbers_at(kAnswer, place).front().value; };
  EXPECT_EQ(value("planners.fast.distance_m"), 900.5);
  EXPECT_EQ(value("planners.slow.2.peaks_C.p95"), 51.5) << "a name with a dot";
  EXPECT_EQ(value("parameters.joint.conductance.value"), 0.25);
  EXPECT_EQ(value("wheels.1.damping_V_s_per_rad.value"), 0.02) << "an index in front of the element";
  EXPECT_EQ(value("knots.1"), 2.0);
  EXPECT_EQ(value("probability_ci95.1"), 0.06);
  std::vector<std::string> names;
  for (const AnswerNumber& each : numbers_at(kAnswer, "planners.*.peaks_C.*")) {
    names.push_back(each.name);
  }
  EXPECT_THAT(names, ElementsAre("planners.fast.peaks_C.p05", "planners.fast.peaks_C.p95", "planners.slow.2.peaks_C.p05",
                                 "planners.slow.2.peaks_C.p95"));
}

TEST(AnswerNumbers, ThatAreNotThereNameTheGroupThatWasReached) {
  const auto missing = [](std::string_view place) { return std::get<NumberMissing>(refusal(place)); };
  EXPECT_EQ(missing("planners.fast.distance").missing, "distance");
  EXPECT_EQ(missing("planners.fast.distance").group, "planners.fast");
  EXPECT_THAT(missing("planners.fast.distance").members, ElementsAre("planner", "distance_m", "peaks_C"));
  EXPECT_EQ(missing("planers.fast").missing, "planers.fast");
  EXPECT_EQ(missing("planers.fast").group, "");
  EXPECT_THAT(missing("planers.fast").members, testing::Contains("planners"));
  EXPECT_EQ(missing("none.*").group, "none");
  EXPECT_THAT(missing("none.*").members, testing::IsEmpty());
  EXPECT_EQ(missing("verdict.x").missing, "x");
  EXPECT_EQ(missing("planners.fast.distance_m.").group, "planners.fast");
}

TEST(AnswerNumbers, ThatAreNoNumbersSayWhatTheyAre) {
  EXPECT_THAT(std::get<NumberIsGroup>(refusal("planners.fast")).members, ElementsAre("planner", "distance_m", "peaks_C"));
  EXPECT_THAT(std::get<NumberIsGroup>(refusal("none")).members, testing::IsEmpty());
  EXPECT_EQ(std::get<NumberIsGroup>(refusal("")).name, "");
  EXPECT_EQ(std::get<NumberIsNull>(refusal("margin_A")).name, "margin_A");
  EXPECT_EQ(std::get<NumberIsOther>(refusal("verdict")).value, "\"pass\"");
  EXPECT_EQ(std::get<NumberIsOther>(refusal("runaway")).value, "false");
  EXPECT_EQ(std::get<NumberIsOther>(refusal("*")).name, "schema");
}

TEST(AnswerNumbers, HaveTheUnitOfTheirNameOrOfTheUnitBeside) {
  const auto unit = [](std::string_view place) { return numbers_at(kAnswer, place).front().unit; };
  EXPECT_EQ(unit("planners.fast.distance_m"), "m");
  EXPECT_EQ(unit("planners.fast.peaks_C.p95"), "degC");
  EXPECT_EQ(unit("parameters.joint.conductance.value"), "W/K");
  EXPECT_EQ(unit("parameters.joint.conductance.ci95.0"), "W/K");
  EXPECT_EQ(unit("parameters.joint.conductance.nats"), "");
  EXPECT_EQ(unit("wheels.1.damping_V_s_per_rad.ci95.1"), "V s/rad");
  EXPECT_EQ(unit("coverage_90.winding_C"), "") << "a share of a signal";
  EXPECT_EQ(unit("error.winding_C.rmse_K"), "K");
  EXPECT_EQ(unit("error.winding_C.samples"), "") << "a count of a signal";
  EXPECT_EQ(unit("heat_W.max"), "W");
  EXPECT_EQ(unit("limited_s.guard"), "s") << "a group of times";
  EXPECT_EQ(unit("residual_tests.before.winding_C.ljung_box_p"), "");
  EXPECT_EQ(unit("residual_tests.before.winding_C.periodogram_over_band"), "");
  EXPECT_EQ(unit("residual_tests.before.winding_C.correlated_with.current"), "");
  EXPECT_EQ(unit("power_balance_W.copper_loss.winding"), "W") << "a group of groups of powers";
  EXPECT_EQ(unit("curve.driver.0"), "rad/s");
  EXPECT_EQ(unit("curve.value.0"), "W");
  EXPECT_EQ(unit("probability_over_limit"), "");
  EXPECT_EQ(unit("knots.0"), "");
}

TEST(AnswerNumbers, HaveTheRangeThatTheAnswerDeclares) {
  const auto possible = [](std::string_view place) {
    const base::Range range = numbers_at(kAnswer, place).front().possible;
    return std::pair(range.low, range.high);
  };
  constexpr double kNone = std::numeric_limits<double>::infinity();
  EXPECT_EQ(possible("probability_over_limit"), std::pair(0.0, 1.0));
  EXPECT_EQ(possible("coverage_90.winding_C"), std::pair(0.0, 1.0)) << "a group";
  EXPECT_EQ(possible("limited_s.guard"), std::pair(0.0, kNone));
  EXPECT_EQ(possible("balance.mean_W.rotor"), std::pair(0.0, kNone)) << "declared further out";
  EXPECT_EQ(possible("balance.mean_W.drag_share"), std::pair(-1.0, 1.0)) << "the innermost declaration";
  EXPECT_EQ(possible("over"), std::pair(0.0, kNone)) << "a count";
  EXPECT_EQ(possible("balance.share"), std::pair(-kNone, kNone)) << "a name is no declaration";
  EXPECT_EQ(possible("drift_K.value"), std::pair(-kNone, kNone));
  EXPECT_TRUE(std::holds_alternative<NumberMissing>(refusal("ranges.idle_s.0"))) << "a declaration is no number of the answer";
}

class CommandChecks : public testing::Test {
 protected:
  CommandChecks() { fs::create_directory(folder_); }
  ~CommandChecks() override { fs::remove_all(folder_); }

  std::vector<Outcome> outcomes(const std::string& limits) {
    text_ = "[[check]]\nname = \"x\"\ncommand = 'heatsoak simulate --motor \"a b\"'\n[check.limits]\n" + limits;
    base::write_file(folder_ / "a.check.toml", text_);
    const std::string file = (folder_ / "a.check.toml").string();
    // The file is named twice, but its command runs only once.
    answer_ = run_check_job({.files = {file, file},
                             .run_command =
                                 [this](const std::vector<std::string>& words, const fs::path& folder) {
                                   ++runs_;
                                   EXPECT_THAT(words, ElementsAre("simulate", "--motor", "a b"));
                                   EXPECT_EQ(folder, folder_);
                                   return kAnswer;
                                 }},
                            {kSource / "motor_db", kSource / "robot_core/robots", kSource / "duty_profiles", kSource});
    return {answer_.outcomes.begin(), answer_.outcomes.begin() + static_cast<std::ptrdiff_t>(answer_.outcomes.size() / 2)};
  }
  std::string problem(const std::string& limits) {
    try {
      static_cast<void>(outcomes(limits));
    } catch (const base::Failure& failure) {
      return failure.what();
    }
    return "nothing was wrong";
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("heatsoak_numbers_" + std::to_string(getpid()));
  std::string text_;
  CheckAnswer answer_;
  int runs_ = 0;
};

TEST_F(CommandChecks, CompareEachNumberInItsUnit) {
  const std::vector<Outcome> all = outcomes(
      "\"planners.*.distance_m\" = \"at least 0.65 km\"\n"  // the shorter of both
      "planners.fast.distance_m = \"at most 900 m\"\n"      // a name with dots and without quotes
      "\"planners.fast.peaks_C.p95\" = \"at most 155 degF\"\n"
      "coverage_90.winding_C = \"at least 92 %\"\n"
      "over = \"at most 2\"\n"
      "coefficient_per_K = \"at most 0.004 1/K\"\n");
  EXPECT_EQ(runs_, 1);
  ASSERT_EQ(all.size(), 6U);
  EXPECT_TRUE(all[0].passed());
  EXPECT_EQ(all[0].measured->value, 700.0);
  EXPECT_EQ(basis_of<NumberBasis>(all[0]).name, "planners.slow.2.distance_m");
  EXPECT_EQ(basis_of<NumberBasis>(all[0]).numbers, 2U);
  EXPECT_NEAR(*all[0].margin_value(), 50.0, 1e-9);
  EXPECT_FALSE(all[1].passed());
  EXPECT_EQ(all[1].status(), Status::broken);
  EXPECT_TRUE(all[2].passed());
  EXPECT_NEAR(all[2].limit.value, 68.33, 0.01);
  EXPECT_TRUE(all[3].passed());
  EXPECT_EQ(all[3].measured->value, 0.93);
  EXPECT_TRUE(all[3].limit.type->is_share);
  EXPECT_TRUE(all[4].passed());
  EXPECT_TRUE(all[5].passed());
}

TEST_F(CommandChecks, CompareTheWorseEndOfAnInterval) {
  const std::vector<Outcome> all = outcomes(
      "probability_over_limit = \"at most 5 %\"\n"
      "\"parameters.joint.conductance.value\" = \"at least 0.22 W/K\"\n"
      "\"wheels.1.damping_V_s_per_rad.value\" = \"at most 0.03 V s/rad\"\n");
  EXPECT_FALSE(all[0].passed());
  EXPECT_EQ(all[0].measured->value, 0.06);
  EXPECT_EQ(basis_of<NumberBasis>(all[0]).compared, Compared::interval);
  EXPECT_EQ(basis_of<NumberBasis>(all[0]).value, 0.02);
  EXPECT_EQ(basis_of<NumberBasis>(all[0]).interval.low, 0.005);
  EXPECT_FALSE(all[1].passed());
  EXPECT_EQ(all[1].measured->value, 0.2);
  EXPECT_TRUE(all[2].passed());
}

// A threshold of the same name compares the same end.
TEST_F(CommandChecks, CompareTheWorseEndOfAPercentile) {
  const std::vector<Outcome> all = outcomes(
      "\"planners.fast.peaks_C.p95\" = \"at most 65 degC\"\n"
      "\"planners.slow.2.peaks_C.p95\" = \"at most 150 degC\"\n"
      "\"planners.*.peaks_C.p95\" = \"at least 47 degC\"\n"
      "\"planners.fast.peaks_C.p05\" = \"at most 50 degC\"\n");
  EXPECT_FALSE(all[0].passed());
  EXPECT_EQ(all[0].measured->value, 66.0);
  EXPECT_FALSE(all[1].measured) << "an interval without an upper end";
  ASSERT_TRUE(reason_of<IntervalUnbounded>(all[1]));
  EXPECT_EQ(reason_of<IntervalUnbounded>(all[1])->name, "planners.slow.2.peaks_C.p95");
  EXPECT_TRUE(all[2].passed());
  EXPECT_EQ(all[2].measured->value, 48.0);
  EXPECT_TRUE(all[3].passed());
  EXPECT_EQ(basis_of<NumberBasis>(all[3]).compared, Compared::percentile);
}

TEST_F(CommandChecks, NullOfATimeIsNever) {
  std::vector<Outcome> all = outcomes("time_to_limit_s = \"at least 60 s\"\n");
  EXPECT_TRUE(all[0].passed());
  EXPECT_TRUE(all[0].measured->is_never);
  all = outcomes("time_to_limit_s = \"at most 60 s\"\n");
  EXPECT_FALSE(all[0].passed());
  EXPECT_TRUE(all[0].measured->is_never);
  EXPECT_THAT(with_new_limits(text_, all, 0.05), HasSubstr("time_to_limit_s = \"at most 60 s\"")) << "no time is long enough";
  EXPECT_TRUE(std::holds_alternative<NoTimeSuffices>(all[0].not_rewritten.value()));
}

TEST_F(CommandChecks, NullThatTheAnswerDoesNotExplainIsNoTime) {
  const std::vector<Outcome> all = outcomes("margin_A = \"at most 60 A\"\n");
  EXPECT_TRUE(reason_of<NumberIsNull>(all[0]));
}

TEST_F(CommandChecks, NullOfARestIsNever) {
  std::vector<Outcome> all =
      outcomes("\"rest_of_hot_motor.5min.rest_all_s\" = \"at most 600 s\"\n\"rest_of_hot_motor.5min.rest_half_s\" = \"at most 600 s\"\n");
  EXPECT_FALSE(all[0].passed());
  EXPECT_TRUE(all[0].measured->is_never);
  EXPECT_TRUE(all[1].passed());
}

TEST_F(CommandChecks, UpdateWritesWholeNumbersForCounts) {
  std::vector<Outcome> all =
      outcomes("over = \"at most 1\"\n\"error.winding_C.samples\" = \"at least 1000\"\nplanners.fast.distance_m = \"at most 1 m\"\n");
  EXPECT_FALSE(all[0].passed() || all[1].passed() || all[2].passed());
  const std::string updated = with_new_limits(text_, all, 0.05);
  EXPECT_THAT(updated, HasSubstr("over = \"at most 3\""));
  EXPECT_THAT(updated, HasSubstr("\"error.winding_C.samples\" = \"at least 380\""));
  EXPECT_THAT(updated, HasSubstr("planners.fast.distance_m = \"at most 946 m\"")) << "900.5 m and 5 %, no count";
}

TEST_F(CommandChecks, LimitThatCannotBeEvaluatedFails) {
  const std::vector<Outcome> all = outcomes(
      "margin_A = \"at least 1 A\"\n"
      "\"planners.fast.distance_m\" = \"at least 5 s\"\n"
      "\"planners.fast.peaks_C.p95\" = [\"at most 70 K\", \"at most 400 K\"]\n"
      "\"error.winding_C.rmse_K\" = \"at most 5 degC\"\n"
      "distance_m = \"at least 5 m\"\n"
      "\"planners.fast.peaks_C\" = \"at most 5 degC\"\n"
      "\"error.winding_C.*\" = \"at most 5 K\"\n"
      "rank = \"at most 1\"\n");
  for (const Outcome& each : all) {
    EXPECT_FALSE(each.passed());
    EXPECT_FALSE(each.measured) << each.limit.type->name;
  }
  const auto problem_of_limit = [&all](std::size_t i) {
    return words_of(std::get<LimitInvalid>(all[i].reason.value()).problem, *all[i].limit.type);
  };
  EXPECT_TRUE(reason_of<NumberIsNull>(all[0]));
  EXPECT_THAT(problem_of_limit(1), testing::StartsWith("'s' is no unit of planners.fast.distance_m; expected one of m"));
  EXPECT_THAT(problem_of_limit(2), HasSubstr("\"at most 70 K\" is an absolute temperature"));
  EXPECT_THAT(problem_of_limit(3), HasSubstr("\"at most 400 K\" is an absolute temperature, 127 °C; expected \"at most 126.85 degC\""));
  EXPECT_THAT(problem_of_limit(4), HasSubstr("is a temperature, not a difference"));
  EXPECT_TRUE(reason_of<NumberMissing>(all[5]));
  EXPECT_TRUE(reason_of<NumberIsGroup>(all[6]));
  EXPECT_TRUE(reason_of<UnitsDiffer>(all[7]));
  EXPECT_TRUE(reason_of<NumberIsThreshold>(all[8]));
}

TEST(NumberLimit, InAnUnknownUnitNamesThoseOfTheNumber) {
  const auto problem = [](std::string_view name, std::string_view text) {
    Limit limit;
    return parse_number_limit(name, text, limit);
  };
  EXPECT_EQ(problem("winding_C", "at most 1.5 bananas"), "'bananas' is no unit of winding_C; expected degC");
  EXPECT_EQ(problem("fit.rmse_K", "at most 1.5 bananas"), "'bananas' is no unit of fit.rmse_K; expected K");
  EXPECT_EQ(problem("time_to_limit_s", "at least 2 bananas"), "'bananas' is no unit of time_to_limit_s; expected one of s, h, min, ms, us");
  EXPECT_THAT(problem("parameters.joint.value", "at most 2 bananas"),
              testing::AllOf(HasSubstr("'bananas' is no unit of parameters.joint.value; expected one of A"), HasSubstr(", degC"),
                             HasSubstr(", W")));
  EXPECT_EQ(problem("parameters.joint.value", "at most 2 W/K"), "");
}

TEST_F(CommandChecks, ACountIsNotComparedWithAPercentage) {
  const std::vector<Outcome> all =
      outcomes("over = \"at least 100 %\"\n\"error.winding_C.samples\" = \"at most 40 %\"\ncoverage_90.winding_C = \"at least 90 %\"\n");
  EXPECT_FALSE(all[0].measured || all[1].measured);
  ASSERT_TRUE(reason_of<NumberIsCount>(all[0]) && reason_of<NumberIsCount>(all[1]));
  EXPECT_EQ(reason_of<NumberIsCount>(all[0])->value, 2.0);
  EXPECT_EQ(reason_of<NumberIsCount>(all[1])->name, "error.winding_C.samples");
  EXPECT_TRUE(all[2].passed());
}

TEST_F(CommandChecks, AListLimitsBothSides) {
  const std::vector<Outcome> all = outcomes("over = [\"at least 1\", \"at most 3\"]\nplanners.fast.distance_m = [\"at least 1 km\"]\n");
  ASSERT_EQ(all.size(), 3U);
  EXPECT_TRUE(all[0].passed());
  EXPECT_TRUE(all[1].passed());
  EXPECT_FALSE(all[2].passed());
  EXPECT_EQ(all[1].limit.at.column, 23) << "each limit has its own place";
  EXPECT_THAT(problem("over = [\"at least 1\", 3]\n"), HasSubstr("is a number; expected a limit as text"));
}

TEST_F(CommandChecks, WrongLimitsAreReportedAtTheirPlace) {
  const std::string said = problem(
      "over = 3\n"
      "\"heat_W.max\" = \"less than 5 W\"\n"
      "\"heat_W.mean\" = \"at most nan W\"\n"
      "\"planners.fast.distance_m\" = \"at most 5 parsnips\"\n"
      "error.winding_C.rmse_K = 3.5\n"
      "runaway = false\n");
  EXPECT_THAT(said, HasSubstr(":5:8: error: check[0].limits.over: is a number; expected a limit as text"));
  EXPECT_THAT(said, HasSubstr(":6:16: error: check[0].limits.heat_W.max: \"less than 5 W\" is not a limit"));
  EXPECT_THAT(said, HasSubstr("\"nan W\" is not a finite number"));
  EXPECT_THAT(said, HasSubstr("'parsnips' is no unit of planners.fast.distance_m; expected one of m, mm"));
  EXPECT_THAT(said, HasSubstr("error.winding_C.rmse_K: is a number"));
  EXPECT_THAT(said, HasSubstr("check[0].limits.runaway: is "));
  EXPECT_THAT(problem(""), HasSubstr("check[0].limits: is empty"));
}

TEST_F(CommandChecks, UpdateKeepsDirectionUnitAndQuotes) {
  std::vector<Outcome> all = outcomes(
      "\"planners.fast.distance_m\" = 'at least 1 km' # far\n"
      "over = \"at most 9\"\n"
      "planners.fast.peaks_C.p05 = \"at most 30 degC\"\n"
      "cold_C = \"at most 5 degC\"\n"
      "room_C = \"at least 50 degC\"\n"
      "idle_s = \"at most 3 s\"\n"
      "shortfall_ratio = \"at most 1\"\n"
      "allowed_A = \"at least 0.1 A\"\n"
      "\"wheels.1.damping_V_s_per_rad.value\" = \"at most 1 V s/rad\"\n"
      "\"drift_K.value\" = \"at most 1 K\"\n");
  const std::string after = with_new_limits(text_, all, 0.05);
  EXPECT_THAT(after, HasSubstr("\"planners.fast.distance_m\" = 'at least 0.855 km' # far\n"));
  EXPECT_THAT(after, HasSubstr("over = \"at most 3\"\n"));
  EXPECT_THAT(after, HasSubstr("planners.fast.peaks_C.p05 = \"at most 41 degC\"\n")) << "5 % of at least 20 K";
  EXPECT_THAT(after, HasSubstr("cold_C = \"at most 11.6 degC\"\n")) << "below 25 degC";
  EXPECT_THAT(after, HasSubstr("room_C = \"at least 24 degC\"\n")) << "no rise at all";
  EXPECT_THAT(after, HasSubstr("idle_s = \"at most 0 s\"\n")) << "a value without a scale of its own";
  EXPECT_THAT(after, HasSubstr("shortfall_ratio = \"at most 0.00205\"\n")) << "5 % of at least 0.02";
  EXPECT_THAT(after, HasSubstr("allowed_A = \"at least 0.35 A\"\n")) << "5 % of at least 1 A";
  EXPECT_THAT(after, HasSubstr("value\" = \"at most 0.0315 V s/rad\"\n")) << "5 % of the end of the interval, which is more than its width";
  EXPECT_THAT(after, HasSubstr("\"drift_K.value\" = \"at most 0.293 K\"\n")) << "5 % of the width of the interval";
  EXPECT_TRUE(std::ranges::all_of(all, &Outcome::passed));
}

// Such a limit would look like a check and check nothing.
TEST_F(CommandChecks, UpdateWritesNoLimitThatCannotFail) {
  std::vector<Outcome> all = outcomes(
      "coverage_90.winding_C = \"at most 95 %\"\n"
      "probability_over_limit = \"at least 0.1 %\"\n"
      "idle_s = \"at least 0 s\"\n"
      "over = \"at least 1\"\n"
      "\"limited_s.voltage\" = \"at least 1 s\"\n"
      "\"drift_K.value\" = \"at least -9 K\"\n");
  const std::string after = with_new_limits(text_, all, 2.0);
  for (const std::size_t i : {0U, 1U, 2U, 3U, 4U}) {
    EXPECT_TRUE(std::holds_alternative<Looseness>(all[i].not_rewritten.value())) << all[i].limit.type->name;
  }
  EXPECT_THAT(after, HasSubstr("coverage_90.winding_C = \"at most 95 %\"\n"));
  EXPECT_THAT(after, HasSubstr("idle_s = \"at least 0 s\"\n"));
  EXPECT_EQ(words_of(std::get<Looseness>(*all[0].not_rewritten), *all[0].limit.type),
            "\"at most 100 %\" is looser than the largest share that a limit may permit, 99.9 %; expected that or a tighter limit");
  EXPECT_EQ(words_of(std::get<Looseness>(*all[4].not_rewritten), *all[4].limit.type),
            "\"at least 0 s\" holds always: the smallest possible value is 0 s; expected a tighter limit");
  EXPECT_FALSE(all[5].not_rewritten) << "a difference of temperatures may be negative";
  all = outcomes("coverage_90.winding_C = \"at most 95 %\"\n\"limited_s.voltage\" = \"at least 1 s\"\n");
  EXPECT_THAT(with_new_limits(text_, all, 0.05), testing::AllOf(HasSubstr("at most 97.7 %"), HasSubstr("at least 2.85 s")));
}

TEST(CommandWords, AreSplitAtSpacesOutsideQuotes) {
  EXPECT_THAT(command_words(" heatsoak derate  --ambient \"40 degC\" --out=''x ").words,
              ElementsAre("derate", "--ambient", "40 degC", "--out=x"));
  EXPECT_THAT(command_words("evaluate ''").words, ElementsAre("evaluate", ""));
  for (const char* wrong : {"", " ", "heatsoak", "check other.toml", "--version"}) {
    EXPECT_THAT(command_words(wrong).problem, HasSubstr("expected a command with a JSON answer")) << wrong;
  }
  EXPECT_THAT(command_words("derate \"--x").problem, HasSubstr("not closed"));
  // Their exit code would get lost.
  EXPECT_THAT(command_words("derate --robot r --check guard.h").problem, HasSubstr("--check has no place in a check"));
  EXPECT_THAT(command_words("evaluate --fail-on=marginal").problem, HasSubstr("--fail-on has no place in a check"));
}

}  // namespace
}  // namespace heatsoak::check
