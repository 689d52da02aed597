// Text and numbers of an evaluation.
#include "present/evaluation.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "base/binomial_bound.h"
#include "base/lanes.h"
#include "evaluation_answers.h"
#include "present/renderer.h"
#include "present/verdict_words.h"
#include "select/decision.h"

namespace heatsoak::present {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Both columns of limits have a unit, and no two columns the same name.
TEST(EvaluationDocument, columns_have_different_names) {
  const Document document = evaluation_document(answer_with({sampled(0.0, {0.0, 0.01}, 500)}));
  std::set<std::string> names;
  for (const Column& each : document.tables.front().columns) {
    EXPECT_TRUE(names.insert(each.name + each.unit).second || each.name.empty()) << each.name;
    if (each.name.ends_with("limit")) {
      EXPECT_EQ(each.unit, "°C");
    }
  }
}

TEST(EvaluationDocument, a_closed_loop_has_one_headline) {
  select::MotorEvaluation motor = sampled(0.03, {0.01, 0.11}, 600);
  motor.motor_id = "m";
  motor.games = 75;
  motor.samples_needed = 1200;
  motor.winding_p95_interval_C = select::Interval95{40.0, 50.0};
  simulate::EvaluationAnswer answer = answer_with({motor}, "division_b_match");
  answer.draw_count = 75;
  answer.closed_loop = simulate::ClosedLoopJob{.games = 1};
  simulate::ClosedLoopRank rank;
  rank.drives.motor_id = "m";
  rank.drives.games.resize(1);
  rank.verdict = select::Verdict::pass;
  answer.ranks = {rank};
  const Document document = evaluation_document(answer);
  const auto counts =
      std::ranges::count_if(document.headline, [](const Text& each) { return each.words.find("1 motor passes") != std::string::npos; });
  EXPECT_EQ(counts, 1);
  EXPECT_EQ(document.headline.front().tone, Tone::good);
  EXPECT_EQ(document.tables.size(), 2U);
  EXPECT_FALSE(document.tables.back().title.empty()) << "states which of both it is";
}

// Without the note a reader takes the peak of a motor whose current is cut for a temperature that occurs.
TEST(EvaluationDocument, a_closed_loop_states_the_difference_of_a_motor_whose_current_is_cut) {
  select::MotorEvaluation motor = sampled(0.9, {0.8, 1.0}, 600);
  motor.games = 75;
  motor.winding_peak_C.nominal = 450.0;
  motor.winding_p95_interval_C = select::Interval95{400.0, 500.0};
  motor.verdict = select::Verdict::infeasible;
  simulate::EvaluationAnswer answer = answer_with({motor}, "division_a_match");
  answer.closed_loop = simulate::ClosedLoopJob{.games = 1};
  answer.ranks.resize(1);
  answer.ranks[0].drives.games.resize(1);
  answer.ranks[0].drives.games[0].winding_peak_C = 202.0;
  const Document document = evaluation_document(answer);
  EXPECT_TRUE(std::ranges::any_of(document.notes, [](const Note& each) {
    return each.severity == Severity::scope && each.words.find("202 °C") != std::string::npos &&
           each.words.find("450 °C") != std::string::npos && each.words.find("248 K less") != std::string::npos;
  }));
  for (const Note& each : document.notes) {
    EXPECT_THAT(each.words, Not(HasSubstr("--closed-loop"))) << "advice that was followed already";
  }
}

/// Returns the sentences about the rest of a hot motor "m" after plays of 60 s, 5 min and 20 min.
std::vector<std::string> rest_notes(const std::vector<std::optional<double>>& rests_s) {
  select::MotorEvaluation motor = sampled(0.0, {0.0, 0.01}, 500);
  motor.motor_id = "m";
  simulate::EvaluationAnswer answer = answer_with({motor});
  for (std::size_t i = 0; i < rests_s.size(); ++i) {
    answer.rests["m"].push_back({.play_s = select::kPlays_s.at(i), .half_s = {}, .all_s = rests_s[i], .starts = 4, .starts_never = 3});
  }
  answer.rests["other"] = answer.rests["m"];
  std::vector<std::string> rests;
  for (const Note& each : evaluation_document(answer).notes) {
    if (each.words.find("temperature limit must rest") != std::string::npos) {
      EXPECT_EQ(each.severity, Severity::background);
      rests.push_back(each.words);
    }
  }
  return rests;
}

TEST(EvaluationDocument, states_the_rest_of_a_hot_motor_in_the_background) {
  EXPECT_THAT(
      rest_notes({13.0, 40.0, {}}),
      testing::ElementsAre("A m at its temperature limit must rest before it can play on within its limits (nominal values): 13 s "
                           "for 60 s of play; 40 s for 5 min of play; more than 60 min for 20 min of play, at 3 of 4 moments of the "
                           "duty."));
}

TEST(EvaluationDocument, states_equal_rests_once_and_no_rest_of_0_s) {
  EXPECT_THAT(rest_notes({0.0, 2.0, 2.0}), testing::ElementsAre(testing::EndsWith("(nominal values): 2 s for 20 min of play.")));
  EXPECT_THAT(rest_notes({2.0, 2.0, 9.0}),
              testing::ElementsAre(testing::EndsWith("(nominal values): 2 s for 5 min of play; 9 s for 20 min of play.")));
  EXPECT_THAT(rest_notes({0.0, 0.0, 0.0}), testing::IsEmpty());
}

TEST(EvaluationDocument, states_that_no_rest_helps_a_motor_that_is_over_its_limit_without_current) {
  select::MotorEvaluation motor = sampled(0.0, {0.0, 0.01}, 500);
  motor.motor_id = "m";
  simulate::EvaluationAnswer answer = answer_with({motor});
  answer.duty.ambient_C.value = 160.0;
  answer.rests["m"] = {{.play_s = 60.0, .half_s = {}, .all_s = {}, .starts = 4, .starts_never = 4, .over_without_current = true}};
  const Document document = evaluation_document(answer);
  EXPECT_TRUE(std::ranges::any_of(document.notes, [](const Note& each) {
    return each.words.starts_with("A hot m never cools enough to play") && each.words.find("160 °C") != std::string::npos;
  }));
  const nlohmann::ordered_json rest = evaluation_json(answer).at("motors").at(0).at("rest_of_hot_motor").at(0);
  EXPECT_EQ(rest.at("over_without_current"), true);
  EXPECT_TRUE(rest.at("rest_all_s").is_null());
  EXPECT_EQ(rest.at("never"), nlohmann::ordered_json::array({"rest_half_s", "rest_all_s"}));
}

// A longer rest may suffice: it was not computed.
TEST(EvaluationJson, RestAboveTheLongestOneIsNotCalledNever) {
  select::MotorEvaluation motor = sampled(0.0, {0.0, 0.01}, 500);
  motor.motor_id = "m";
  simulate::EvaluationAnswer answer = answer_with({motor});
  answer.rests["m"] = {{.play_s = 60.0, .half_s = 20.0, .all_s = {}, .starts = 4, .starts_never = 1, .over_without_current = false}};
  const nlohmann::ordered_json rest = evaluation_json(answer).at("motors").at(0).at("rest_of_hot_motor").at(0);
  EXPECT_TRUE(rest.at("rest_all_s").is_null());
  EXPECT_EQ(rest.at("never"), nlohmann::ordered_json::array());
  EXPECT_EQ(rest.at("longest_rest_s"), select::kLongestRest_s);
}

select::MotorEvaluation undecided(const std::string& id, int over_of_75_games) {
  const double share = over_of_75_games / 75.0;
  const base::ShareInterval interval = base::share_interval(share, 75, select::error_share(75, true));
  select::MotorEvaluation motor = sampled(share, {interval.low, interval.high}, 600);
  motor.motor_id = id;
  motor.games = 75;
  motor.verdict = select::Verdict::marginal;
  motor.short_probability = 0.0;
  motor.short_interval = select::Interval95{0.0, 0.048};
  motor.samples_needed = select::samples_needed(motor, true);
  return motor;
}

// One note for all undecided motors leaves room for the other notes.
TEST(EvaluationDocument, has_one_note_for_all_undecided_motors) {
  for (const std::size_t count : {1U, 3U}) {
    std::vector<select::MotorEvaluation> motors{undecided("a", 3), undecided("b", 1), undecided("c", 2)};
    motors.resize(count);
    simulate::EvaluationAnswer answer = answer_with(motors, "division_a_match");
    answer.draw_count = 75;
    std::vector<std::string> notes;
    for (const Note& each : evaluation_document(answer).notes) {
      if (each.words.find("--samples") != std::string::npos) {
        notes.push_back(each.words);
      }
    }
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_THAT(notes.front(), HasSubstr("probability of 50 %"));
    for (std::size_t i = 0; count > 1 && i < count; ++i) {
      const select::DecidingSamples deciding = select::deciding_samples(motors.at(i));
      EXPECT_THAT(notes.front(), testing::ContainsRegex(std::to_string(*deciding.half) + " to [a-z0-9 ]+ for " + motors.at(i).motor_id));
    }
    EXPECT_FALSE(evaluation_json(answer).at("motors").at(0).at("decided").get<bool>());
  }
}

TEST(EvaluationDocument, headline_of_an_undecided_motor_says_how_many_games_are_needed) {
  const select::MotorEvaluation motor = undecided("a", 3);
  const int more = *select::deciding_samples(motor).half / base::kLanes - motor.games;
  ASSERT_GT(more, 0);
  const Document document = evaluation_document(answer_with({motor}, "division_a_match"));
  EXPECT_THAT(document.headline.at(1).words, HasSubstr(fmt::format("a is undecided, about {} more games needed: ", more)));
}

// A sentence per motor would fill a screen when the whole database is compared.
TEST(EvaluationDocument, undecided_motors_with_equal_needs_stand_together) {
  const std::vector<select::MotorEvaluation> motors{undecided("a", 3), undecided("b", 1), undecided("c", 3), undecided("d", 1)};
  const std::vector<Note> notes = evaluation_document(answer_with(motors, "division_a_match")).notes;
  EXPECT_EQ(std::ranges::count_if(
                notes,
                [](const Note& each) { return each.words.find(" for b, d; ") != std::string::npos && each.words.ends_with(" for a, c."); }),
            1);
}

// A program that reads the JSON must be able to reproduce the ranking, whichever temperature decides it.
TEST(EvaluationJson, its_keys_give_the_order_and_the_margins_of_the_table) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> peak_C(40.0, 160.0);
  for (const int games : {0, 75}) {
    std::vector<select::MotorEvaluation> motors;
    for (int i = 0; i < 40; ++i) {
      select::MotorEvaluation motor = sampled(0.0, {0.0, 0.01}, 600);
      motor.motor_id = std::to_string(i);
      motor.games = games;
      motor.verdict = static_cast<select::Verdict>(i % 4);
      motor.winding_limit_C = 155.0;
      motor.winding_peak_C = {.nominal = peak_C(engine), .p05 = 40.0, .p50 = 65.0, .p95 = peak_C(engine)};
      motor.margin_K = motor.winding_limit_C - motor.winding_peak_C.nominal;
      if (i % 3 == 0) {
        motor.stator_limit_C = 110.0;
        motor.stator_peak_C = {.nominal = peak_C(engine), .p05 = 40.0, .p50 = 65.0, .p95 = peak_C(engine)};
      }
      motors.push_back(motor);
    }
    select::sort_by_verdict(motors);
    simulate::EvaluationAnswer answer = answer_with(motors, "division_a_match");
    answer.draw_count = static_cast<std::size_t>(games);
    std::vector<Json> of_json = evaluation_json(answer).at("motors");
    std::ranges::reverse(of_json);
    const std::vector<std::string> verdicts{"pass", "marginal", "fail", "infeasible"};
    std::ranges::sort(of_json, {}, [&](const Json& each) {
      return std::pair(std::ranges::find(verdicts, each.at("verdict").get<std::string>()), -each.at("ranking_margin_K").get<double>());
    });
    const Table table = evaluation_document(answer).tables.front();
    const auto margin = static_cast<std::size_t>(std::ranges::find(table.columns, "margin", &Column::name) - table.columns.begin());
    ASSERT_EQ(table.rows.size(), of_json.size());
    for (std::size_t i = 0; i < of_json.size(); ++i) {
      EXPECT_EQ(table.rows[i][1].words, of_json[i].at("id").get<std::string>());
      EXPECT_NEAR(std::stod(table.rows[i][margin].words), of_json[i].at("ranking_margin_K").get<double>(), 0.51);
    }
  }
}

TEST(EvaluationJson, a_verdict_without_samples_is_not_decided) {
  for (const int samples : {0, 500}) {
    const Json motor = evaluation_json(answer_with({sampled(0.0, {0.0, 0.01}, samples)})).at("motors").at(0);
    EXPECT_EQ(motor.at("decided").get<bool>(), samples > 0);
    EXPECT_EQ(motor.at("verdict"), samples > 0 ? "pass" : "marginal");
  }
}

// Few samples predict little, so the note says only what the program does by itself.
TEST(EvaluationDocument, after_few_games_the_note_predicts_no_number) {
  const base::ShareInterval interval = base::share_interval(0.0, 20, select::error_share(20, true));
  select::MotorEvaluation motor = sampled(0.0, {interval.low, interval.high}, 160);
  motor.motor_id = "a";
  motor.games = 20;
  motor.short_interval = select::Interval95{0.0, interval.high};
  select::decide_by_samples(motor, true);
  const std::vector<Note> notes = evaluation_document(answer_with({motor}, "division_a_match")).notes;
  const auto found = std::ranges::find_if(notes, [](const Note& each) { return each.words.find("a counts as") != std::string::npos; });
  ASSERT_NE(found, notes.end());
  EXPECT_THAT(found->words,
              AllOf(HasSubstr("a counts as marginal"), HasSubstr("Without --samples, 600 are drawn (55 more games), and more if needed"),
                    Not(HasSubstr("probability of 50 %"))));
}

// A team must not see green before a motor certainly passes, nor red before all certainly do not.
TEST(EvaluationDocument, the_colour_of_the_headline_is_that_of_the_best_shown_verdict) {
  select::MotorEvaluation fails = sampled(0.9, {0.8, 0.95}, 600);
  fails.verdict = select::Verdict::fail;
  const select::MotorEvaluation passes = sampled(0.0, {0.0, 0.01}, 600);
  const auto tone = [](std::vector<select::MotorEvaluation> motors) {
    return evaluation_document(answer_with(std::move(motors), "division_a_match")).headline.front().tone;
  };
  EXPECT_EQ(tone({fails}), Tone::bad);
  EXPECT_EQ(tone({undecided("a", 3), fails}), Tone::undecided);
  EXPECT_EQ(tone({passes, undecided("a", 3), fails}), Tone::good);
}

// The reason why `simulate` gives another temperature must be among the three notes that are shown.
TEST(EvaluationDocument, states_first_that_simulate_gives_other_temperatures) {
  const Document document = evaluation_document(answer_with({undecided("a", 3), undecided("b", 1)}, "division_a_match"));
  EXPECT_THAT(by_urgency(document.notes).front().words, AllOf(HasSubstr("`heatsoak simulate`"), HasSubstr("slip")));
}

TEST(EvaluationDocument, without_samples_it_says_that_nothing_was_drawn) {
  select::MotorEvaluation motor;
  motor.probability_over_limit = {};
  const Document document = evaluation_document(answer_with({motor}));
  EXPECT_THAT(document.headline.front().words, AllOf(HasSubstr("No samples were drawn"), Not(HasSubstr("passes"))));
  EXPECT_EQ(document.headline.front().tone, Tone::undecided);
}

TEST(EvaluationDocument, nominal_values_are_named_whatever_the_verdict) {
  for (const select::Verdict verdict : {select::Verdict::pass, select::Verdict::fail, select::Verdict::infeasible}) {
    select::MotorEvaluation motor;
    motor.verdict = verdict;
    motor.probability_over_limit = {};
    EXPECT_NE(evaluation_document(answer_with({motor})).headline.at(1).words.find("nominal values"), std::string::npos);
  }
}

// An implausible value that is no error must reach the reader of every answer.
TEST(EvaluationDocument, warns_of_implausible_values_of_the_robot) {
  simulate::EvaluationAnswer answer = answer_with({sampled(0.0, {0.0, 0.01}, 500)});
  const auto warnings = [&] {
    const Document document = evaluation_document(answer);
    return std::ranges::count_if(document.notes, [](const Note& each) { return each.severity == Severity::warning; });
  };
  const auto before = warnings();
  answer.robot.drive.gear_ratio = 36.0;
  EXPECT_EQ(warnings(), before + 1);
}

// Another motor helps most of all. It must not take the place of one of the three changes of the robot.
TEST(EvaluationDocument, lists_three_changes_of_the_robot_and_another_motor) {
  simulate::EvaluationAnswer answer = answer_with({sampled(0.0, {0.0, 0.01}, 500)});
  answer.changes =
      simulate::SuggestedChanges{"m",
                                 false,
                                 {{.quantity = select::ChangedQuantity::jerk, .before = 20.0, .factor = 0.5, .saved_K = 15.0},
                                  {.quantity = select::ChangedQuantity::gear_ratio, .before = 1.0, .factor = 1.25, .saved_K = 20.0},
                                  {.quantity = select::ChangedQuantity::mass, .before = 2.5, .factor = 0.9, .saved_K = 5.0},
                                  {.quantity = select::ChangedQuantity::speed, .before = 3.0, .factor = 0.9, .saved_K = 2.0},
                                  {.quantity = select::ChangedQuantity::motor, .other_motor = "other", .saved_K = 100.0}}};
  const Document document = evaluation_document(answer);
  const Table& table = document.tables.back();
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows.front().front().words, select::name_of(select::ChangedQuantity::gear_ratio));
  EXPECT_EQ(table.rows.back().front().words, select::name_of(select::ChangedQuantity::mass));
  const std::size_t last = document.headline.size() - 1;
  EXPECT_THAT(document.headline.at(last - 1).words, HasSubstr("gear ratio from 1 to 1.25, 20 K cooler"));
  EXPECT_THAT(document.headline.at(last).words, HasSubstr("Another motor, other, is 100 K cooler"));
  EXPECT_EQ(table.columns.size(), 4U) << "one calculation has no standard error";
}

// The verdict is that of a plan which is followed exactly. Only the closed loop shows whether this robot can.
TEST(EvaluationDocument, says_first_that_the_plan_needs_more_grip) {
  simulate::EvaluationAnswer answer = answer_with({sampled(0.0, {0.0, 0.01}, 500)}, "division_a_match");
  answer.demand.slip_share = 0.15;
  const Document document = evaluation_document(answer);
  EXPECT_THAT(document.headline.at(1).words, AllOf(HasSubstr("15 % of the time"), HasSubstr("--closed-loop")));
  answer.demand.slip_share = 0.001;
  EXPECT_THAT(evaluation_document(answer).headline.at(1).words, Not(HasSubstr("grip")));
}

// The short form of an answer shows the headline only.
TEST(EvaluationDocument, names_implausible_values_of_the_robot_in_the_headline) {
  simulate::EvaluationAnswer answer = answer_with({sampled(0.0, {0.0, 0.01}, 500)});
  answer.robot.drive.gear_ratio = 36.0;
  EXPECT_THAT(evaluation_document(answer).headline.back().words, HasSubstr("drive.gear_ratio"));
}

TEST(EvaluationDocument, a_closed_loop_without_samples_names_nominal_values) {
  select::MotorEvaluation motor;
  simulate::EvaluationAnswer answer = answer_with({motor}, "division_b_match");
  answer.closed_loop = simulate::ClosedLoopJob{.games = 1};
  answer.ranks.resize(1);
  answer.ranks[0].drives.games.resize(1);
  const Document document = evaluation_document(answer);
  EXPECT_THAT(document.tables.back().title, HasSubstr("with nominal values"));
  EXPECT_THAT(document.paragraphs.front(), Not(HasSubstr("with all tolerances")));
}

}  // namespace
}  // namespace heatsoak::present
