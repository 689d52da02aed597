// Check files: results, the report of all mistakes in one pass, and limits that are rewritten in place.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "check/rewrite.h"
#include "check/typed_outcome.h"
#include "check_files.h"

namespace heatsoak::check {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST_F(CheckFiles, ReportEveryProblemAtItsPlace) {
  const std::string said = message_of(
      "[[check]]\n"                                // 1
      "name = \"a\"\n"                             // 2
      "robot = \"roboteam_twente_2024\"\n"         // 3
      "sampels = \"5\"\n"                          // 4
      "seed = 3\n"                                 // 5
      "samples = \"3.5\"\n"                        // 6
      "derate = { ambient = \"-10 degC\" }\n"      // 7
      "[check.limits]\n"                           // 8
      "winding_peak_p95 = \"at most nan degC\"\n"  // 9
      "  winding_peak = \"at most 5 degC\"\n"      // 10
      "rank = \"at most 1\"\n"                     // 11
      "[[check]]\n"                                // 12
      "name = \"a\"\n"                             // 13
      "[surprise]\n");                             // 14
  for (const char* each : {":3:9: error: check[0].robot: there is no robot 'roboteam_twente_2024'", "did you mean 'roboteam_twente_v2024'?",
                           ":4:11: error: check[0].sampels: is not a key of this table; did you mean 'samples'?",
                           ":5:8: error: check[0].seed: 3 is a bare number", ":6:11: error: check[0].samples: 3.5 is not a whole number",
                           ":7:10: error: check[0].derate.coldest", "is not used by any limit of this check",
                           ":9:20: error: check[0].limits.winding_peak_p95: \"nan degC\" is not a finite number",
                           ":10:18: error: check[0].limits.winding_peak: there is no such threshold; did you mean 'winding_peak_p95'?",
                           "rank needs 'against' in this check", ":12:1: error: check[1].limits: is missing",
                           ":13:8: error: check[1].name: \"a\" is the name of another", ":14:1: error: surprise: is not a key"}) {
    EXPECT_THAT(said, HasSubstr(each));
  }
}

TEST_F(CheckFiles, MistakesOfFormSayWhatIsExpected) {
  EXPECT_THAT(message_of(kHead + "winding_peak_p95 = \"at most 70 degC\"\n"),
              HasSubstr("is a threshold; expected it below [check.limits]"));
  EXPECT_THAT(message_of(kHead), HasSubstr("check[0].limits: is missing; expected [check.limits] with one limit or more"));
  EXPECT_THAT(message_of("[check]\nname = \"x\"\n"), HasSubstr("is a single table; expected [[check]], in two brackets"));
  EXPECT_THAT(message_of(kHead + "[check.limits]\nrank = { most = 1 }\n"),
              HasSubstr("is a table; expected a limit as text, such as \"at most"));
  EXPECT_THAT(message_of("[[check]]\nfiles = \"a.toml\"\n[check.limits]\nlint_problems = \"at most 0\"\n"),
              testing::AllOf(HasSubstr("check[0].name: is missing; expected what the check is for"),
                             HasSubstr("is a text, expected a list: [\"a.toml\"]")));
  EXPECT_THAT(message_of(kHead + "zzz = \"1\"\n[check.limits]\nrank = \"at most 1\"\n"),
              HasSubstr("zzz: is not a key of this table; expected one of against, air"));
}

// A percentile estimate is below the true value in half of all files. Its 97.5 % bound is below it in 2.5 % of them.
TEST_F(CheckFiles, APercentileIsComparedByItsBound) {
  const auto found = [&](int samples) {
    return outcomes(kHead + fmt::format("samples = \"{}\"\n[check.limits]\nwinding_peak_p95 = \"at most 120 degC\"\n", samples)).front();
  };
  const Outcome few = found(71);
  EXPECT_FALSE(few.passed());
  EXPECT_TRUE(reason_of<TooFewSamples>(few));
  const Outcome some = found(80);
  const Outcome many = found(2000);
  EXPECT_GT(some.measured->value, many.measured->value);
  EXPECT_EQ(basis_of<PeakBasis>(many).bound_C, many.measured->value);
  EXPECT_LT(basis_of<PeakBasis>(many).p95_C, many.measured->value);
}

TEST_F(CheckFiles, SettingThatNoLimitUsesIsAProblem) {
  EXPECT_THAT(message_of(kHead + "temperature = \"90 degC\"\n[check.limits]\nrank = \"at most 1\"\n"),
              testing::AllOf(HasSubstr("check[0].temperature: is not used by any limit"), HasSubstr("needs 'against'")));
}

TEST_F(CheckFiles, WithoutChecksAreRefused) {
  EXPECT_THAT(message_of("# nothing\n"), HasSubstr("has no [[check]] table"));
  const std::string empty = message_of(kHead + "[check.limits]\n");
  EXPECT_THAT(empty, HasSubstr("limits: is empty"));
  for (const ThresholdType& type : all_thresholds()) {
    EXPECT_THAT(empty, HasSubstr(std::string(type.name)));
  }
  EXPECT_THAT(message_of("[[check]\n"), HasSubstr("a.check.toml:1:"));
}

TEST_F(CheckFiles, MotorIsTheRobotsOwnUnlessNamed) {
  const CheckFile file = read(
      "[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"paper_intermittent\"\n[check.limits]\n"
      "winding_peak_p95 = \"at most 100 degC\"\n");
  EXPECT_EQ(file.checks.front().motor->id, "maxon_ecx_flat_32l_48v");
}

TEST_F(CheckFiles, PathsBeginAtTheFile) {
  fs::create_directory(folder_ / "motors");
  fs::copy_file(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml", folder_ / "motors/ours.toml");
  const CheckFile file = read(
      "[[check]]\nname = \"x\"\nmotor = \"motors/ours.toml\"\nlogs = [\"logs/a.csv\"]\n[check.limits]\n"
      "forecast_error = \"at most 5 K\"\n");
  EXPECT_EQ(file.checks.front().motor->id, "ours");
  EXPECT_EQ(file.checks.front().logs.front(), folder_ / "logs/a.csv");
}

TEST_F(CheckFiles, BrokenMotorFileIsReportedOnceAtItsOwnLine) {
  base::write_file(folder_ / "bad.toml", "manufacturer = \"x\"\n");
  const std::string check = "[[check]]\nname = \"{}\"\nmotor = \"./bad.toml\"\n[check.limits]\nlint_problems = \"at most 0\"\n";
  const std::string said = message_of(fmt::format(fmt::runtime(check), "a") + fmt::format(fmt::runtime(check), "b"));
  EXPECT_THAT(said, HasSubstr("bad.toml:1:1: error: "));
  const std::string first = said.substr(0, said.find('\n'));
  EXPECT_EQ(said.find(first), said.rfind(first));
}

TEST_F(CheckFiles, WhatCannotBeEvaluatedFailsAndTheRestIsEvaluated) {
  const std::vector<Outcome> found = outcomes(kHead +
                                              "samples = \"80\"\ntable = \"missing.h\"\n[check.limits]\n"
                                              "derating_excess = \"at most 0 A\"\n"
                                              "guard_active_share = \"at most 0 %\"\n"
                                              "winding_peak_p95 = \"at most 120 degC\"\n");
  ASSERT_EQ(found.size(), 3U);
  EXPECT_FALSE(found[0].passed());
  EXPECT_FALSE(found[0].measured);
  EXPECT_THAT(failure_of(found[0]), HasSubstr("missing.h: error: cannot be read: No such file"));
  EXPECT_TRUE(reason_of<DutyIsNoMatch>(found[1]));
  EXPECT_TRUE(found[2].passed());
}

TEST_F(CheckFiles, ForecastErrorNeedsTheAirOfALogWithoutIt) {
  std::string log = "time_s,current_A,speed_rad_per_s,winding_C\n";
  for (int second = 0; second < 300; ++second) {
    log += fmt::format("{},{},{},{}\n", second, second % 20 < 10 ? 3.0 : 0.5, 100.0, 25.0 + 0.05 * second);
  }
  base::write_file(folder_ / "no_air.csv", log);
  const std::string check = "[[check]]\nname = \"x\"\nmotor = \"maxon_ecx_flat_42m_24v\"\nlogs = [\"no_air.csv\"]\n";
  const std::string limits = "[check.limits]\nforecast_error = \"at most 90 K\"\n";
  const Outcome without = outcomes(check + limits).front();
  EXPECT_FALSE(without.measured);
  EXPECT_THAT(failure_of(without), HasSubstr("the log has no ambient temperature"));
  EXPECT_TRUE(outcomes(check + "air = \"25 degC\"\n" + limits).front().measured);
}

TEST_F(CheckFiles, FewSamplesCannotKeepATightProbability) {
  const auto with = [&](int samples, const std::string& limit) {
    return outcomes(kHead + fmt::format("samples = \"{}\"\n[check.limits]\nprobability_over_limit = \"{}\"\n", samples, limit)).front();
  };
  const Outcome few = with(32, "at most 5 %");
  EXPECT_FALSE(few.passed());
  EXPECT_TRUE(few.measured);
  EXPECT_NEAR(few.measured->value, 1.0 - std::pow(0.025, 1.0 / 32.0), 1e-9);
  EXPECT_EQ(basis_of<ShareBasis>(few).samples_needed, 72);
  EXPECT_FALSE(basis_of<ShareBasis>(few).games);
  EXPECT_TRUE(with(72, "at most 5 %").passed());
  EXPECT_FALSE(with(64, "at most 5 %").passed());
}

// All samples of one game share its load, so the number of games counts.
TEST_F(CheckFiles, ProbabilityOnAMatchCountsGames) {
  const auto with = [&](const std::string& limit) {
    return outcomes(
               "[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"division_a_match\"\nmotor = "
               "\"maxon_ecx_flat_42m_24v\"\nsamples = \"16\"\n[check.limits]\nprobability_over_limit = \"" +
               limit + "\"\n")
        .front();
  };
  const Outcome found = with("at most 5 %");
  EXPECT_NEAR(found.measured->value, 1.0 - std::sqrt(0.025), 1e-9);
  EXPECT_EQ(basis_of<ShareBasis>(found).games, 2);
  EXPECT_EQ(basis_of<ShareBasis>(found).samples_needed, 576);
  EXPECT_EQ(basis_of<ShareBasis>(with("at most 0.1 %")).samples_needed, 29504);
}

// The guard assumes the hottest air that it is designed for, whatever air temperature the match has.
TEST_F(CheckFiles, GuardMadeForHotAirEngages) {
  const std::vector<Outcome> found = outcomes(
      "[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"division_a_match\"\nmotor = "
      "\"maxon_ecx_flat_32l_48v\"\nderate = { samples = \"60\", ambient = \"105 degC\" }\n[check.limits]\nguard_active_share = \"at "
      "most 0 %\"\nguard_missing_charge = \"at most 0 A s\"\n");
  for (const Outcome& each : found) {
    EXPECT_TRUE(each.measured) << each.limit.text;
    EXPECT_GT(each.measured->value, 0.0);
    EXPECT_FALSE(each.passed());
  }
  EXPECT_LT(found[0].measured->value, 1.0);
}

TEST_F(CheckFiles, LintFindsWhatAFileOfAnyKindHolds) {
  const std::string data = (kSource / "tests/data/lint_motors").string();
  const std::vector<Outcome> found =
      outcomes("[[check]]\nname = \"x\"\nfiles = [\"" + data + "/lint_df45l_wiki.toml\", \"" +
               (kSource / "robot_core/robots/tigers_v2020.toml").string() + "\", \"" +
               (kSource / "duty_profiles/division_a_match.toml").string() + "\"]\n[check.limits]\nlint_problems = \"at most 0\"\n");
  EXPECT_GE(found.front().measured->value, 2.0);
  EXPECT_FALSE(found.front().passed());
  EXPECT_THAT(basis_of<LintBasis>(found.front()).first.at.file, HasSubstr("lint_df45l_wiki.toml"));
}

TEST_F(CheckFiles, MotorThatCannotDeliverFailsWithTheReason) {
  const std::vector<Outcome> found = outcomes(
      "[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"paper_intermittent\"\nmotor = \"maxon_dcx19s_24v\"\n"
      "samples = \"80\"\n[check.limits]\nwinding_peak_p95 = \"at most 100 degC\"\nlint_problems = \"at most 0\"\n");
  EXPECT_FALSE(found[0].passed());
  ASSERT_TRUE(reason_of<DemandNotDelivered>(found[0]));
  EXPECT_LT(reason_of<DemandNotDelivered>(found[0])->least_torque_share, 1.0);
  EXPECT_TRUE(found[1].passed());
}

TEST_F(CheckFiles, TimeAboveATemperatureFallsWithIt) {
  const auto time_s = [&](const std::string& temperature) {
    return outcomes(kHead +
                    fmt::format("samples = \"1\"\ntemperature = \"{}\"\n[check.limits]\ntime_above = \"at most 1 s\"\n", temperature))
        .front()
        .measured->value;
  };
  const double all_s = time_s("20 degC");
  EXPECT_NEAR(all_s, 2400.0, 1.0);
  const double some_s = time_s("45 degC");
  EXPECT_LT(some_s, all_s);
  EXPECT_GT(some_s, 0.0);
  EXPECT_EQ(time_s("60 degC"), 0.0);
}

TEST_F(CheckFiles, RankCountsThoseBeforeTheMotor) {
  const auto rank = [&](const std::string& motor, const std::string& others) {
    return outcomes("[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"paper_intermittent\"\nmotor = \"" + motor +
                    "\"\nagainst = [" + others + "]\nsamples = \"24\"\n[check.limits]\nrank = \"at most 1\"\n")
        .front();
  };
  const std::string best = "\"maxon_ecx_flat_42m_24v\"";
  const std::string worst = "\"maxon_ecx_flat_32l_48v\"";
  EXPECT_EQ(rank("maxon_ecx_flat_42m_24v", "\"nanotec_df45l024048_a2\", " + worst).measured->value, 1.0);
  EXPECT_EQ(rank("nanotec_df45l024048_a2", best + ", " + worst).measured->value, 2.0);
  const Outcome last = rank("maxon_ecx_flat_32l_48v", best + ", \"nanotec_df45l024048_a2\"");
  EXPECT_EQ(last.measured->value, 3.0);
  EXPECT_FALSE(last.passed());
  EXPECT_EQ(basis_of<RankBasis>(last).motors, 3U);
  EXPECT_THAT(basis_of<RankBasis>(last).better, testing::ElementsAre("maxon_ecx_flat_42m_24v", "nanotec_df45l024048_a2"));
}

TEST_F(CheckFiles, ResultsDoNotDependOnThreads) {
  const std::string text = kHead + "samples = \"80\"\n[check.limits]\nwinding_peak_p95 = \"at most 120 degC\"\n" +
                           "[[check]]\nname = \"b\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"paper_intermittent\"\nsamples = \"80\"\n"
                           "[check.limits]\nwinding_peak_p95 = \"at most 120 degC\"\n";
  const CheckAnswer one = run_check_job(job_of(text, 1), kShippedFolders);
  const CheckAnswer all = run_check_job(job_of(text, 0), kShippedFolders);
  ASSERT_EQ(one.outcomes.size(), 2U);
  ASSERT_EQ(all.outcomes.size(), 2U);
  for (std::size_t i = 0; i < one.outcomes.size(); ++i) {
    EXPECT_EQ(one.outcomes[i].measured->value, all.outcomes[i].measured->value);
  }
}

// Comments, spaces, quotes, line ends and limits that cannot be evaluated stay unchanged.
TEST_F(CheckFiles, NewLimitsChangeNothingElse) {
  std::string text = "# été\r\n" + kHead +
                     "samples = \"80\"\r\n[check.limits] # limits\r\n"
                     "  probability_over_limit   =   'at most 90 %' # ° generous\r\n"
                     "winding_peak_p95=\"at most 30 degC\"# too tight\r\n"
                     "guard_active_share = \"at most 1 %\"\r\n";
  std::vector<Outcome> found = outcomes(text);
  EXPECT_FALSE(found[1].passed());
  const std::string after = with_new_limits(text, found, 0.05);
  EXPECT_TRUE(found[0].passed());
  EXPECT_TRUE(found[1].passed());
  EXPECT_FALSE(found[2].passed());
  EXPECT_EQ(found[1].before, "at most 30 degC");
  std::string expected = text;
  for (const Outcome& each : {found[0], found[1]}) {
    expected.replace(expected.find(each.before), each.before.size(), each.limit.text);
  }
  EXPECT_EQ(after, expected);
  EXPECT_NE(after, text);
  // A second run writes the same file, and all its limits hold.
  std::vector<Outcome> again = outcomes(after);
  EXPECT_TRUE(again[0].passed());
  EXPECT_TRUE(again[1].passed());
  EXPECT_EQ(with_new_limits(after, again, 0.05), after);
}

TEST_F(CheckFiles, RankOfAMotorAgainstItselfIsRefused) {
  const auto message = [&](const std::string& others) {
    return message_of(kHead + "against = [" + others + "]\n[check.limits]\nrank = \"at most 1\"\n");
  };
  fs::copy_file(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml", folder_ / "maxon_ecx_flat_42m_24v.toml");
  const std::string own = "\"maxon_ecx_flat_42m_24v\"";
  const std::string other = "\"nanotec_df45l024048_a2\"";
  EXPECT_THAT(message(own), HasSubstr("a.check.toml:6:11: error: check[0].against: maxon_ecx_flat_42m_24v is the motor of this check"));
  EXPECT_THAT(message(other + ", " + own), HasSubstr("is the motor of this check"));
  EXPECT_THAT(message(other + ", " + other), HasSubstr("check[0].against: names nanotec_df45l024048_a2 twice"));
  EXPECT_EQ(message(other), "nothing was wrong");
  // A team's own file of a motor may be ranked with the one of the database.
  EXPECT_EQ(message("\"./maxon_ecx_flat_42m_24v.toml\""), "nothing was wrong");
  EXPECT_EQ(message("\"all\""), "nothing was wrong");
}

// A file or id that does not exist makes its own thresholds fail, like a missing log, so that the others are still evaluated and reported.
TEST_F(CheckFiles, MissingFileFailsItsThresholdsOnly) {
  const auto found = [&](const std::string& things, const std::string& limit) {
    return outcomes("[[check]]\nname = \"gone\"\n" + things + "samples = \"80\"\n[check.limits]\n" + limit + "\n" +
                    "[[check]]\nname = \"here\"\nmotor = \"maxon_ecx_flat_42m_24v\"\n[check.limits]\nlint_problems = \"at most 0\"\n");
  };
  const std::string robot = "robot = \"roboteam_twente_v2024\"\n";
  const std::string duty = "duty = \"paper_intermittent\"\n";
  const std::string peak = "winding_peak_p95 = \"at most 120 degC\"";
  const std::vector<std::vector<Outcome>> all{
      found(robot + duty + "motor = \"./gone.toml\"\n", peak), found("robot = \"gone.toml\"\n" + duty, peak),
      found(robot + "duty = \"./gone.toml\"\n", peak),
      found(robot + duty + "against = [\"nanotec_df45l024048_a2\", \"./gone.toml\"]\n", "rank = \"at most 1\"")};
  for (const std::vector<Outcome>& each : all) {
    ASSERT_EQ(each.size(), 2U);
    EXPECT_FALSE(each[0].measured);
    EXPECT_FALSE(each[0].passed());
    EXPECT_THAT(failure_of(each[0]), testing::EndsWith("gone.toml: cannot be read: No such file or directory"));
    EXPECT_THAT(failure_of(each[0]), testing::ContainsRegex("a.check.toml:[0-9]:[0-9]+: ")) << "place of the name";
    EXPECT_TRUE(each[1].passed());
  }
  const std::vector<std::vector<Outcome>> unknown{found(robot + duty + "motor = \"maxon_ecx_flat_42m_24w\"\n", peak),
                                                  found("robot = \"roboteam_twente_v2023\"\n" + duty, peak),
                                                  found(robot + "duty = \"paper_intermitent\"\n", peak),
                                                  found(robot + duty + "against = [\"nanotec_df45l024048_a3\"]\n", "rank = \"at most 1\"")};
  const std::vector<std::string> meant{"maxon_ecx_flat_42m_24v", "roboteam_twente_v2024", "paper_intermittent", "nanotec_df45l024048_a2"};
  for (std::size_t i = 0; i < meant.size(); ++i) {
    ASSERT_EQ(unknown[i].size(), 2U);
    EXPECT_FALSE(unknown[i][0].passed());
    EXPECT_THAT(failure_of(unknown[i][0]),
                testing::AllOf(HasSubstr("there is no "), HasSubstr(fmt::format("did you mean '{}'?", meant[i]))));
    EXPECT_TRUE(unknown[i][1].passed());
  }
}

TEST_F(CheckFiles, SensorOfACommittedHeaderIsReadFromDerate) {
  const auto text = [](const std::string& derate) {
    return "[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\ntable = \"x.h\"\nderate = { " + derate +
           " }\n[check.limits]\nderating_excess = \"at most 0 A\"\n";
  };
  const CheckFile file = read(text("thermistor = \"stator\", thermistor_accuracy = \"1.5 K\", thermistor_lag = \"3 s\""));
  EXPECT_EQ(derate::sensor_flags(*file.checks.front().derate.sensor), "--thermistor stator --thermistor-accuracy 1.5K --thermistor-lag 3s");
  EXPECT_EQ(derate::sensor_flags(*read(text("winding_resistance = true")).checks.front().derate.sensor),
            "--winding-resistance --resistance-accuracy 10K --voltage-error 0.02V --current-error 0.01A");
  EXPECT_THAT(message_of(text("thermistor = \"rotor\"")), HasSubstr("stator"));
  EXPECT_THAT(message_of(text("thermistor_accuracy = \"2 K\"")), HasSubstr("thermistor_accuracy: is not a key"));
  EXPECT_THAT(message_of(text("winding_resistance = true, thermistor = \"stator\"")), HasSubstr("expected one sensor"));
}

TEST_F(CheckFiles, FolderInPlaceOfAMotorIsReportedAtItsLine) {
  fs::create_directory(folder_ / "motors");
  const std::string said = message_of(
      "[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"paper_intermittent\"\nmotor = \"motors/\"\n"
      "[check.limits]\nwinding_peak_p95 = \"at most 100 degC\"\n");
  EXPECT_THAT(said, testing::ContainsRegex("a.check.toml:5:9: error: check.0..motor: .*motors.*it is a folder"));
}

TEST_F(CheckFiles, UpdateDoesNotPassAMotorAboveItsLimit) {
  const std::string text =
      "[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"paper_intermittent\"\nmotor = \"maxon_ecx_flat_32l_48v\"\n"
      "samples = \"80\"\n[check.limits]\nwinding_peak_p95 = \"at most 120 degC\"\n";
  std::vector<Outcome> found = outcomes(text);
  ASSERT_GT(found[0].measured->value, 155.0);
  EXPECT_EQ(with_new_limits(text, found, 0.05), text);
  EXPECT_FALSE(found[0].passed());
  EXPECT_TRUE(std::holds_alternative<Looseness>(found[0].not_rewritten.value()));
}

TEST_F(CheckFiles, LimitWithAnEscapeIsNotRewritten) {
  std::vector<Outcome> found = outcomes(kHead + "samples = \"80\"\n[check.limits]\nwinding_peak_p95 = \"at most 30\\u0020degC\"\n");
  EXPECT_THROW(with_new_limits(base::read_file(folder_ / "a.check.toml", 100000), found, 0.05), base::Failure);
}

}  // namespace
}  // namespace heatsoak::check
