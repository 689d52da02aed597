// The scorer on answers written by hand.
#include "score.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "run_program.h"

namespace heatsoak::suite {
namespace {

using Json = nlohmann::json;

/// An array; braces around one element would copy the element.
template <typename... Elements>
Json list(const Elements&... elements) {
  Json all = Json::array();
  (all.push_back(elements), ...);
  return all;
}

Json true_effect(const std::string& id, const std::string& node, const Json& family, const Json& signals, bool is_visible = true) {
  return {{"id", id}, {"node", node}, {"family", family}, {"signals", signals}, {"visible", is_visible}};
}

Json stirring() { return true_effect("air_gap_stirring", "winding", list("air_gap_stirring"), list("speed")); }
Json eddy() { return true_effect("iron_loss_eddy", "stator", list("iron_loss_eddy", "windage"), list("speed")); }

Json truth(const std::string& group, const Json& effects, const Json& present = Json::array()) {
  return {{"group", group}, {"effects", effects}, {"present", present}};
}

Json named(const std::string& id, const std::string& node, const Json& confusable = Json::array(), const Json& drivers = Json::array()) {
  return {{"id", id}, {"node", node}, {"confusable_with", confusable}, {"drivers", drivers}};
}

Json found(const Json& effects) { return {{"verdict", "effect_found"}, {"effects", effects}}; }
Json nothing() { return {{"verdict", "nothing_missing"}, {"effects", Json::array()}}; }

Answer answer_of(const Json& truth_json, const Json& answer_json, int exit_code = 0) {
  return {.motor = "x", .truth = truth_json, .answer = answer_json, .exit_code = exit_code, .wall_s = 1.0};
}

TEST(Score, NullsCountNamesAndCurvesAsFalseAlarms) {
  const Json null = truth("null", Json::array());
  const Json silent{
      {"verdict", "unexplained"}, {"effects", Json::array()}, {"unexplained", {{"node", "stator"}, {"drivers", Json::array()}}}};
  Json curve = silent;
  curve["unexplained"]["drivers"] = list("speed");
  const Score score = score_of({answer_of(null, nothing()), answer_of(null, found(list(named("windage", "stator")))),
                                answer_of(null, silent), answer_of(null, curve), answer_of(null, nullptr, 139)});
  EXPECT_EQ(score.nulls, 5);
  EXPECT_EQ(score.nulls_false_alarm, 2);
  EXPECT_EQ(score.nulls_unexplained, 2);
  EXPECT_EQ(score.failures, 1);
  EXPECT_EQ(score.refusals, 0);
  EXPECT_EQ(score.failed_cases.size(), 3U);
}

TEST(Score, SinglesDistinguishNameFamilyClassCurveAndWrongName) {
  const Json single = truth("single", list(eddy()));
  const Score score = score_of({
      answer_of(single, found(list(named("iron_loss_eddy", "stator")))),                                   // exact
      answer_of(single, found(list(named("windage", "stator")))),                                          // family
      answer_of(single, found(list(named("driver_heat", "stator", list("windage"))))),                     // class
      answer_of(single, found(list(named("tabulated", "stator", Json::array(), list("speed"))))),          // curve
      answer_of(single, found(list(named("load_friction", "stator"), named("third_node", "stator")))),     // wrong
      answer_of(single, found(list(named("windage", "stator"), named("sensor_lag_winding", "winding")))),  // right and wrong
      answer_of(single, nothing()),
      answer_of(single, nullptr, 70),
  });
  EXPECT_EQ(score.singles, 8);
  EXPECT_EQ(score.singles_named, 6);
  EXPECT_EQ(score.singles_right, 4);
  EXPECT_EQ(score.singles_exact, 1);
  EXPECT_EQ(score.singles_by_class, 1);
  EXPECT_EQ(score.singles_by_curve, 1);
  EXPECT_EQ(score.single_terms, 8);
  EXPECT_EQ(score.single_wrong_terms, 3);
  EXPECT_EQ(score.classes, 1);
  EXPECT_EQ(score.failures, 1);
}

TEST(Score, ACurveNeedsNodeAndSignal) {
  const Json single = truth("single", list(eddy()));
  const Score score = score_of({answer_of(single, found(list(named("tabulated", "winding", Json::array(), list("speed"))))),
                                answer_of(single, found(list(named("tabulated", "stator", Json::array(), list("current")))))});
  EXPECT_EQ(score.singles_by_curve, 0);
  EXPECT_EQ(score.single_wrong_terms, 2);
}

TEST(Score, HiddenSinglesDoNotCountAsMissed) {
  const Json hidden = truth("single", list(true_effect("radiation", "stator", list("radiation"), list("stator"), false)));
  const Score score = score_of({answer_of(hidden, nothing()), answer_of(hidden, found(list(named("third_node", "stator"))))});
  EXPECT_EQ(score.singles, 0);
  EXPECT_EQ(score.hidden_singles, 2);
  EXPECT_EQ(score.hidden_single_wrong_terms, 1);
  EXPECT_EQ(score.failed_cases.size(), 1U);
}

TEST(Score, PairsCountOneAndBoth) {
  const Json pair = truth("pair", list(eddy(), stirring()));
  const Json half_hidden = truth("pair", list(eddy(), true_effect("radiation", "stator", list("radiation"), {}, false)));
  const Score score = score_of({answer_of(pair, found(list(named("windage", "stator"), named("air_gap_stirring", "winding")))),
                                answer_of(pair, found(list(named("windage", "stator"), named("iron_loss_eddy", "stator")))),
                                answer_of(pair, found(list(named("saturation", "winding")))), answer_of(half_hidden, nothing())});
  EXPECT_EQ(score.pairs, 3);
  EXPECT_EQ(score.hidden_pairs, 1);
  EXPECT_EQ(score.pairs_one_right, 2);
  EXPECT_EQ(score.pairs_both_right, 1);
  EXPECT_EQ(score.pair_terms, 5);
  EXPECT_EQ(score.pair_wrong_terms, 1);
}

TEST(Score, OutsideNeedsVerdictNodeAndSignal) {
  const Json outside = truth("outside", list(true_effect("floor_friction", "stator", Json::array(), list("vehicle_speed"))));
  const auto unexplained = [](const std::string& node, const Json& drivers) {
    return Json{{"verdict", "unexplained"}, {"effects", Json::array()}, {"unexplained", {{"node", node}, {"drivers", drivers}}}};
  };
  const Score score = score_of({answer_of(outside, unexplained("stator", list("vehicle_speed_m_per_s"))),
                                answer_of(outside, unexplained("stator", list("speed"))),  // the motor's speed
                                answer_of(outside, unexplained("winding", list("vehicle_speed_m_per_s"))),
                                answer_of(outside, found(list(named("load_friction", "stator")))), answer_of(outside, nothing())});
  EXPECT_EQ(score.outsides, 5);
  EXPECT_EQ(score.outside_unexplained, 3);
  EXPECT_EQ(score.outside_node, 2);
  EXPECT_EQ(score.outside_signal, 2);
  EXPECT_EQ(score.outside_all, 1);
  EXPECT_EQ(score.outside_named, 1);
}

TEST(Score, EightBodiesAllowBodiesAndTheirOwnEffect) {
  const Json present = list("third_node", "enclosure_warm_up", "uneven_winding");
  const Json with_eddy = list("third_node", "enclosure_warm_up", "uneven_winding", "iron_loss_eddy");
  const Json plain = truth("eight", Json::array(), present);
  const Score score =
      score_of({answer_of(plain, found(list(named("third_node", "stator")))),
                answer_of(plain, found(list(named("connection_resistance", "stator")))),
                answer_of(plain, found(list(named("connection_resistance", "stator", list("uneven_winding"))))),
                answer_of(plain, found(list(named("third_node", "stator"), named("windage", "stator")))),
                answer_of(plain, found(list(named("third_node", "stator"), named("tabulated", "stator", Json::array(), list("current"))))),
                answer_of(truth("eight", list(eddy()), with_eddy), found(list(named("iron_loss_eddy", "stator"))))});
  EXPECT_EQ(score.eights, 6);
  EXPECT_EQ(score.eight_first_absent, 1);
  EXPECT_EQ(score.eight_name_absent, 2);
  EXPECT_EQ(score.eight_term_absent, 3);
  EXPECT_EQ(score.eights_with_effect, 1);
  EXPECT_EQ(score.eight_effect_named, 1);
}

Json errors(double winding_K, double stator_K) {
  return {{"holdout", {{"winding_C", {{"rmse_K", winding_K}}}, {"stator_C", {{"rmse_K", stator_K}}}}}};
}

TEST(Score, ErrorsGrowOnlyByATenthOfAKelvinAndFivePercent) {
  const auto grows = [](double winding_K, double stator_K) {
    Json json = nothing();
    json["before"] = errors(5.0, 5.0);
    json["refitted"] = errors(1.0, 10.0);
    json["after"] = errors(winding_K, stator_K);
    return error_grows(answer_of(Json::object(), json), "refitted");
  };
  EXPECT_EQ(grows(1.09, 10.0), false);
  EXPECT_EQ(grows(1.11, 10.0), true);
  EXPECT_EQ(grows(0.5, 10.4), false);  // 0.4 K but 4 %
  EXPECT_EQ(grows(0.5, 10.6), true);
  EXPECT_EQ(error_grows(answer_of(Json::object(), nothing()), "refitted"), std::nullopt);
}

TEST(Score, SignalsOfAnswersAreRecognised) {
  EXPECT_EQ(signal_word("|speed|"), "speed");
  EXPECT_EQ(signal_word("speed_rad_per_s"), "speed");
  EXPECT_EQ(signal_word("velocity"), "speed");
  EXPECT_EQ(signal_word("acceleration"), "acceleration");
  EXPECT_EQ(signal_word("vehicle_speed_m_per_s"), "vehicle_speed");
  EXPECT_EQ(signal_word("|current|"), "current");
  EXPECT_EQ(signal_word("current times speed"), "power");
  EXPECT_EQ(signal_word("modulation_ratio"), "modulation");
  EXPECT_EQ(signal_word("fan_ratio"), "fan");
  EXPECT_EQ(signal_word("bus_V"), "bus");
  EXPECT_EQ(signal_word("stator temperature"), "stator");
}

TEST(Score, WilsonIntervalIsThatOfTheLiterature) {
  // 0 of 40 and 47 of 48, computed with another program from Wilson 1927.
  EXPECT_NEAR(wilson_interval(0, 40).second, 0.0876, 5e-4);
  EXPECT_NEAR(wilson_interval(47, 48).first, 0.8910, 5e-4);
  EXPECT_NEAR(wilson_interval(47, 48).second, 0.9963, 5e-4);
  EXPECT_EQ(wilson_interval(0, 40).first, 0.0);
}

TEST(Score, ReportHasTheCasesAndTheirTruth) {
  const std::string report = report_of({answer_of(truth("single", list(eddy())), found(list(named("load_friction", "stator"))))});
  EXPECT_NE(report.find("| x | wrong family | iron_loss_eddy at stator | effect_found: load_friction at stator |"), std::string::npos)
      << report;
  EXPECT_NE(report.find("visible singles: right family | 0/1 | 0 to 79 % |"), std::string::npos) << report;
}

/// Writes a program that answers as `script` says, and a folder with one motor.
class Program : public testing::Test {
 protected:
  Program() : folder_(std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ / "null_01");
    std::ofstream(folder_ / "null_01" / "truth.json") << truth("null", Json::array());
    for (const char* name : {"train_1.csv", "train_2.csv", "holdout_1.csv", "start.toml"}) {
      std::ofstream(folder_ / "null_01" / name) << "";
    }
  }
  ~Program() override { std::filesystem::remove_all(folder_); }

  Answer answer_of_script(const std::string& script) {
    const std::filesystem::path program = folder_ / "program's.sh";
    std::ofstream(program) << "#!/bin/sh\n" << script;
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    failures_ = run_motors({.data = folder_, .answers = folder_ / "answers", .program = program.string(), .only = "null", .jobs = 2});
    return load_answers(folder_, folder_ / "answers", "").at(0);
  }

  std::filesystem::path folder_;
  int failures_ = 0;
};

TEST_F(Program, GetsItsLogsAndItsAnswerIsRead) {
  const Answer answer = answer_of_script(
      "echo \"$@\"\nwhile [ $# -gt 0 ]; do [ \"$1\" = --json ] && echo '{\"verdict\":\"nothing_missing\",\"effects\":[]}' > \"$2\"; shift; "
      "done\nexit 3\n");
  EXPECT_EQ(failures_, 0);
  EXPECT_EQ(answer.verdict(), "nothing_missing");
  EXPECT_EQ(answer.exit_code, 3);
  std::ifstream text(folder_ / "answers" / "null_01.txt");
  const std::string words((std::istreambuf_iterator<char>(text)), {});
  const std::string data = (folder_ / "null_01").string();
  EXPECT_TRUE(words.starts_with("diagnose --model " + data + "/start.toml --train " + data + "/train_1.csv " + data +
                                "/train_2.csv --holdout " + data + "/holdout_1.csv --out "))
      << words;
}

TEST_F(Program, ThatCrashesIsAFailure) {
  const Answer answer = answer_of_script("kill -9 $$\n");
  EXPECT_EQ(failures_, 1);
  EXPECT_EQ(answer.exit_code, 137);  // 128 + 9
  EXPECT_EQ(answer.verdict(), "no answer");
  EXPECT_EQ(score_of({answer}).failures, 1);
}

TEST_F(Program, ThatRefusesTheInputIsNoFailureButHasNoDiagnosis) {
  const Answer answer = answer_of_script("exit 2\n");
  EXPECT_EQ(failures_, 0);
  EXPECT_EQ(score_of({answer}).refusals, 1);
}

constexpr const char* kWriteAnswer =
    "while [ $# -gt 0 ]; do [ \"$1\" = --json ] && echo '{\"verdict\":\"nothing_missing\"}' > \"$2\"; shift; done\n";

TEST_F(Program, ThatWritesAnAnswerAndFailsHasNoAnswer) {
  const Answer answer = answer_of_script(std::string(kWriteAnswer) + "exit 70\n");
  EXPECT_EQ(failures_, 1);
  EXPECT_EQ(answer.exit_code, 70);
  EXPECT_EQ(answer.verdict(), "no answer");
}

TEST_F(Program, DoesNotInheritTheAnswerOfAnEarlierRun) {
  EXPECT_EQ(answer_of_script(kWriteAnswer).verdict(), "nothing_missing");
  EXPECT_EQ(answer_of_script("exit 3\n").verdict(), "no answer");
}

}  // namespace
}  // namespace heatsoak::suite
