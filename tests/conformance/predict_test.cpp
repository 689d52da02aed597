// User's view of `heatsoak predict`: the shipped logs, every heat input that a log may have, and the source of hold-out errors.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "program_run.h"
#include "soak_example.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(Predict, AnswersAsTheInterfaceSays) {
  const TemporaryFolder folder;
  const ProgramRun done =
      run({"predict", "--model", kMotor, log("match_1.csv"), log("bench.csv"), "--plot", "p.svg", "--json", "-"}, in(folder));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const nlohmann::json answer = done.json();
  EXPECT_EQ(answer["schema"], "heatsoak.prediction/1");
  ASSERT_EQ(answer["runs"].size(), 2U);
  EXPECT_EQ(answer["runs"][0]["name"], "match_1");
  for (const nlohmann::json& run : answer["runs"]) {
    for (const char* signal : {"winding_C", "stator_C"}) {
      const double rmse_K = run["error"][signal]["rmse_K"].get<double>();
      EXPECT_GT(rmse_K, 0.0);
      EXPECT_GE(run["error"][signal]["max_abs_K"].get<double>(), rmse_K);
      EXPECT_GE(run["coverage_90"][signal].get<double>(), 0.0);
      EXPECT_LE(run["coverage_90"][signal].get<double>(), 1.0);
    }
  }
  EXPECT_THAT(done.err, HasSubstr("in band"));
  EXPECT_THAT(content_of(folder.path() / "p.svg"), HasSubstr("</svg>"));
}

TEST(Predict, DrawsAPngWhereItsNameSaysSo) {
  const TemporaryFolder folder;
  const ProgramRun done = run({"predict", "--model", kMotor, log("match_1.csv"), "--plot", "p.png"}, in(folder));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_TRUE(content_of(folder.path() / "p.png").starts_with("\x89PNG"));
}

/// A calibrated model has a smaller hold-out error, which equals the value of `calibrate --holdout`.
TEST(Predict, IsWhereHoldoutErrorsComeFrom) {
  const TemporaryFolder folder;
  const nlohmann::json& fitted = example_calibration().answer;
  write(folder.path() / "model.toml", example_calibration().motor_file);
  const ProgramRun before = run({"predict", "--model", kMotor, log("match_3.csv"), "--json", "-"}, in(folder));
  const ProgramRun after = run({"predict", "--model", "model.toml", log("match_3.csv"), "--json", "-"}, in(folder));
  ASSERT_EQ(after.exit_code, 0) << after.err;
  constexpr double kRounding_K = 1e-3;  // a motor file rounds its values
  for (const char* signal : {"winding_C", "stator_C"}) {
    const auto rmse_K = [&](const ProgramRun& done) { return done.json()["runs"][0]["error"][signal]["rmse_K"].get<double>(); };
    EXPECT_LT(rmse_K(after), rmse_K(before)) << signal;
    EXPECT_NEAR(rmse_K(after), fitted["holdout"]["after"][0]["error"][signal]["rmse_K"].get<double>(), kRounding_K) << signal;
    EXPECT_NEAR(rmse_K(before), fitted["holdout"]["before"][0]["error"][signal]["rmse_K"].get<double>(), 1e-4) << signal;
  }
  const ProgramRun own = run({"predict", "--model", "model.toml", log("match_1.csv")}, in(folder));
  EXPECT_THAT(own.out, HasSubstr("the error of match_1 is not a forecast error"));
}

/// A log in which the motor never reverses does not show how its speed changes within rows in which it does.
TEST(Predict, RefitKeepsHowTheSpeedChangesWithinRows) {
  const TemporaryFolder folder;
  constexpr const char* kKey = "speed_within_rows = \"linear\"";
  ASSERT_THAT(example_calibration().motor_file, HasSubstr(kKey));
  write(folder.path() / "model.toml", example_calibration().motor_file);
  std::istringstream rows(content_of(log("match_3.csv")));
  std::string one_way;
  for (std::string row; std::getline(rows, row);) {
    const std::size_t speed = row.rfind(',') + 1;
    one_way += row.substr(0, speed) + row.substr(row[speed] == '-' ? speed + 1 : speed) + "\n";
  }
  write(folder.path() / "one_way.csv", one_way);
  const ProgramRun again = run({"calibrate", "--innovations", "--motor", "model.toml", "one_way.csv", "--out", "again.toml"}, in(folder));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(content_of(folder.path() / "again.toml"), HasSubstr(kKey));
}

std::string mapping_with(const std::string& fan) {
  return "[conditions]\nfan = \"" + fan +
         "\"\n[quantities]\ntime_s = { column = \"time_s\" }\nwinding_C = { column = \"winding_C\" }\nstator_C = { column = "
         "\"stator_C\" }\nambient_C = { column = \"ambient_C\" }\ncurrent_A = { column = \"current_A\" }\nspeed_rad_per_s = { column = "
         "\"speed_rad_per_s\" }\n";
}

TEST(Predict, WarnsOfAConditionThatNoFittedRunHad) {
  const TemporaryFolder folder;
  write(folder.path() / "off.map.toml", mapping_with("off"));
  write(folder.path() / "on.map.toml", mapping_with("on"));
  ASSERT_EQ(run({"calibrate", "--motor", kMotor, log("bench.csv"), "--map", "off.map.toml", "--out", "model.toml"}, in(folder)).exit_code,
            0);
  EXPECT_THAT(content_of(folder.path() / "model.toml"), testing::AllOf(HasSubstr("trained_conditions = [\"fan=off\"]"),
                                                                       HasSubstr("trained_ambient = ["), HasSubstr("trained_speed = [")));
  const ProgramRun same = run({"predict", "--model", "model.toml", log("match_1.csv"), "--map", "off.map.toml"}, in(folder));
  ASSERT_EQ(same.exit_code, 0) << same.err;
  EXPECT_THAT(same.out, testing::Not(HasSubstr("may be far off")));
  const ProgramRun other = run({"predict", "--model", "model.toml", log("match_1.csv"), "--map", "on.map.toml"}, in(folder));
  ASSERT_EQ(other.exit_code, 0) << other.err;
  EXPECT_THAT(other.out, HasSubstr("warning: The forecast of match_1 may be far off: its run has fan=on"));
}

// Two values of a condition were fitted; the third is a guess.
TEST(Predict, EveryVerbWarnsOfAStatedConditionWithoutRuns) {
  const TemporaryFolder folder;
  std::string motor = content_of(kSoak / "../../motor_db" / fmt::format("{}.toml", kMotor));
  motor +=
      "[effects.wind]\ntype = \"airflow\"\nhot = \"stator\"\ncold = \"ambient\"\ncondition = { fan = \"on\" }\nconductance = { value = \"0.1 W/K\", "
      "origin = \"estimated\", derivation = \"guess\" }\n[fit]\nmotor = \"x\"\nfigures = [\"thermal_time_constant_winding\"]\ncorrelation "
      "= [\"1\"]\ntrained_conditions = [\"fan=on\", \"fan=fast\"]\n";
  write(folder.path() / "model.toml", motor);
  const Words steady{"steady", "--motor", "model.toml", "--current-on", "2A", "--time-on", "4", "--time-off", "10", "--condition"};
  const ProgramRun off = run(steady + Words{"fan=off"}, in(folder));
  EXPECT_THAT(off.out, HasSubstr("are guesses under fan=off: no run")) << off.err;
  EXPECT_THAT(run(steady + Words{"fan=on"}, in(folder)).out, testing::Not(HasSubstr("guesses under")));
}

// A motor that was only measured with a fan is too cool in every other verb, unless the fan always blows.
TEST(Predict, EveryVerbWarnsOfTheOneConditionOfAllFittedRuns) {
  const TemporaryFolder folder;
  write(folder.path() / "on.map.toml", mapping_with("on"));
  ASSERT_EQ(run({"calibrate", "--motor", kMotor, log("bench.csv"), "--map", "on.map.toml", "--out", "model.toml"}, in(folder)).exit_code,
            0);
  const std::string robot = "roboteam_twente_v2024";
  const std::vector<Words> verbs{{"evaluate", "--model", "model.toml", "--robot", robot, "--duty", "paper_intermittent", "--samples", "0"},
                                 {"steady", "--motor", "model.toml", "--current-on", "2A", "--time-on", "4", "--time-off", "10"},
                                 {"derate", "--model", "model.toml", "--robot", robot, "--to", "c_header", "--out", "table.h", "--explain",
                                  "--samples", "60", "--period", "0.001"}};
  for (const Words& verb : verbs) {
    const ProgramRun unstated = run(verb, in(folder));
    EXPECT_THAT(unstated.out + unstated.err, HasSubstr("warning: model: temperatures may be too low")) << verb.front();
    const ProgramRun stated = run(verb + Words{"--condition", "fan=on"}, in(folder));
    EXPECT_THAT(stated.out + stated.err,
                testing::AllOf(testing::Not(HasSubstr("temperatures may be too low")), HasSubstr("this result is valid only if fan is on")))
        << verb.front();
    const ProgramRun other = run(verb + Words{"--condition", "fan=off"}, in(folder));
    EXPECT_EQ(other.exit_code, 2) << verb.front();
    EXPECT_THAT(other.err, HasSubstr("expected one of model's: fan=on")) << verb.front();
  }
}

TEST(Predict, QuietIsTheVerdictAlone) {
  const TemporaryFolder folder;
  const ProgramRun done = run({"predict", "--model", kMotor, log("match_1.csv"), "--quiet"}, in(folder));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, testing::AllOf(HasSubstr("forecasts 1 run"), testing::Not(HasSubstr("max. error")), testing::Not(HasSubstr("- "))));
}

// The stator's band of the data sheet contains a tenth of its samples in this log.
TEST(Predict, TheVerdictWarnsOfABandThatContainsTooLittle) {
  const TemporaryFolder folder;
  const ProgramRun done = run({"predict", "--model", kMotor, log("match_3.csv"), "--quiet"}, in(folder));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("Do not rely on the band: of the stator in match_3, only 10 %")) << done.err;
}

TEST(Predict, SaysWhatALogLacks) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "cold.csv") << "time_s,winding_C,ambient_C\n0,25,25\n1,25.1,25\n2,25.2,25\n";
  const ProgramRun done = run({"predict", "--model", kMotor, "cold.csv"}, in(folder));
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_THAT(done.err, HasSubstr("current_A"));
}

TEST(Predict, IsTheSameEachTime) {
  const TemporaryFolder folder;
  const auto once = [&] { return run({"predict", "--model", kMotor, log("match_2.csv"), "--json", "-"}, in(folder)).out; };
  const std::string first = once();
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(once(), first);
}

}  // namespace
}  // namespace heatsoak
