// Exit codes, JSON and random numbers of answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program_run.h"
#include "short_runs.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

using nlohmann::json;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::Not;
using testing::UnorderedElementsAre;

TEST(ExitCode, says_whether_a_limit_is_exceeded) {
  EXPECT_EQ(run(kShortSteady).exit_code, 0);
  EXPECT_EQ(run({"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "30", "--time-on", "1", "--time-off", "0"}).exit_code, 1);
  EXPECT_EQ(run(kShortEvaluate + Words{"--samples", "0"}).exit_code, 1);  // the paper's motor exceeds its limit
}

void expect_number_or_null(const json& value, const std::string& key) {
  EXPECT_TRUE(value.at(key).is_number() || value.at(key).is_null()) << key;
}

void expect_evaluate_contract(const json& answer, bool sampled) {
  EXPECT_EQ(answer.at("schema"), "heatsoak.evaluate/1");
  EXPECT_TRUE(answer.at("robot").is_string());
  EXPECT_TRUE(answer.at("duty").is_string());
  EXPECT_TRUE(answer.at("seed").is_number_unsigned());
  ASSERT_TRUE(answer.at("motors").is_array());
  for (const json& motor : answer["motors"]) {
    EXPECT_TRUE(motor.at("id").is_string());
    EXPECT_TRUE(motor.at("winding_limit_C").is_number());
    for (const char* peak : {"winding_peak_C", "stator_peak_C"}) {
      EXPECT_TRUE(motor.at(peak).at("nominal").is_number());
      for (const char* percentile : {"p05", "p50", "p95"}) {
        EXPECT_EQ(motor[peak].at(percentile).is_number(), sampled) << peak << " " << percentile;
      }
    }
    EXPECT_EQ(motor.at("probability_over_limit").is_number(), sampled);
    expect_number_or_null(motor, "time_to_limit_s");
    EXPECT_TRUE(motor.at("current_rms_A").is_number());
    EXPECT_THAT(motor.at("verdict").get<std::string>(), MatchesRegex("pass|marginal|fail|infeasible"));
    EXPECT_THAT(motor.at("limiting_factor").get<std::string>(),
                MatchesRegex("winding_temperature|stator_temperature|voltage|current|none"));
    EXPECT_THAT(motor.at("data_quality").get<std::string>(), MatchesRegex("datasheet|mixed|estimated"));
  }
}

TEST(Json, of_evaluate_keeps_the_contract) {
  const json answer = run(kShortEvaluate + Words{"--samples", "40", "--seed", "7", "--json", "-"}).json();
  expect_evaluate_contract(answer, true);
  EXPECT_EQ(answer.at("seed"), 7);
  EXPECT_EQ(answer.at("motors").size(), 2U);
}

TEST(Json, of_evaluate_without_samples_has_null_for_values_that_need_samples) {
  expect_evaluate_contract(run(kShortEvaluate + Words{"--samples", "0", "--json", "-"}).json(), false);
}

TEST(Json, goes_to_stdout_alone_or_to_its_file) {
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  const std::vector<Words> lines{kShortSteady,
                                 kShortEvaluate + Words{"--samples", "0"},
                                 kShortSimulate,
                                 {"list", "robots"},
                                 {"describe", "tigers_v2020"},
                                 {"lint", (kSource / "duty_profiles" / "paper_intermittent.toml").string()}};
  for (const Words& words : lines) {
    const ProgramRun on_stdout = run(words + Words{"--json", "-"}, inside);
    const ProgramRun in_file = run(words + Words{"--json=answer.json"}, inside);
    const ProgramRun none = run(words, inside);
    EXPECT_EQ(on_stdout.out, content_of(folder.path() / "answer.json"));
    EXPECT_TRUE(on_stdout.json().at("schema").is_string()) << words[0];
    EXPECT_EQ(on_stdout.err, none.out);
    EXPECT_EQ(in_file.out, none.out + "written: answer.json\n");
    EXPECT_EQ(in_file.err, "");
    EXPECT_EQ(on_stdout.exit_code, none.exit_code);
    EXPECT_EQ(in_file.exit_code, none.exit_code);
  }
  EXPECT_THAT(folder.names(), UnorderedElementsAre("answer.json"));
}

TEST(Json, is_also_a_report) {
  const TemporaryFolder folder;
  const std::string report = (folder.path() / "report.json").string();
  const std::string file = (folder.path() / "answer.json").string();
  EXPECT_EQ(run(kShortSteady + Words{"--report", report, "--json", file}).exit_code, 0);
  EXPECT_EQ(content_of(report), content_of(file));
  EXPECT_EQ(content_of(report), run(kShortSteady + Words{"--json", "-"}).out);
}

TEST(Json, reports_errors_of_usage_too) {
  const TemporaryFolder folder;
  RunOptions inside;
  inside.folder = folder.path();
  for (const Words& wrong :
       {Words{"evaluate"}, Words{"evaluate", "--robt", "x"}, Words{"steady", "--motor", "x", "--current-on", "6V"}, Words{"evalute"},
        Words{"steady", "--motor", "nosuch", "--current-on", "1", "--time-on", "1", "--time-off", "1"}, Words{"list", "\xff"}}) {
    const ProgramRun result = run(wrong + Words{"--json", "-"}, inside);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.json().at("error").at("code"), 2);
    EXPECT_TRUE(result.json().at("error").at("diagnostics").is_array());
    EXPECT_THAT(result.json().at("error").at("message").get<std::string>(), Not(IsEmpty()));
    EXPECT_EQ(run(wrong + Words{"--json", "error.json"}, inside).out, "");
    EXPECT_EQ(json::parse(content_of(folder.path() / "error.json")), result.json());
  }
}

// Random numbers.

TEST(Seed, gives_the_same_bytes_for_any_number_of_threads) {
  const Words sampled = kShortEvaluate + Words{"--samples", "100", "--seed", "42", "--json", "-"};
  const ProgramRun one = run(sampled + Words{"--threads", "1"});
  for (const char* threads : {"2", "5", "0", "1024"}) {
    const ProgramRun other = run(sampled + Words{"--threads", threads});
    EXPECT_EQ(other.out, one.out) << threads;
    EXPECT_EQ(other.err, one.err) << threads;
  }
  EXPECT_NE(run(kShortEvaluate + Words{"--samples", "100", "--seed", "43", "--json", "-"}).out, one.out);
}

TEST(Seed, gives_a_motor_the_same_values_beside_any_others) {
  const auto of = [](const std::string& motors) {
    const json answer = run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--samples", "60", "--json",
                             "-", "--motors", motors})
                            .json();
    for (const json& motor : answer.at("motors")) {
      if (motor.at("id") == "maxon_ec45_flat_70w_24v") {
        return motor;
      }
    }
    return json();
  };
  const json alone = of("maxon_ec45_flat_70w_24v");
  EXPECT_EQ(of("maxon_ecx_flat_32l_48v,maxon_ec45_flat_70w_24v"), alone);
  EXPECT_EQ(of("maxon_ec45_flat_70w_24v,nanotec_df45l024048_a2"), alone);
}

}  // namespace
}  // namespace heatsoak
