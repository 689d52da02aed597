// `heatsoak check` and the exit codes of single verbs in a CI job.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <regex>
#include <set>

#include "program_run.h"
#include "soak_example.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string kCheck =
    "# our robot\n"
    "[[check]]\n"
    "name = \"paper\"\n"
    "robot = \"roboteam_twente_v2024\"\n"
    "duty = \"paper_intermittent\"\n"
    "motor = \"maxon_ecx_flat_42m_24v\"\n"
    "samples = \"80\"\n"
    "[check.limits]\n"
    "winding_peak_p95 = \"at most {} degC\"  # the winding\n"
    "current_margin = \"at least {} A\"\n";

std::string check_with(double peak_C, double margin_A) { return fmt::format(fmt::runtime(kCheck), peak_C, margin_A); }

class CheckCommand : public testing::Test {
 protected:
  CheckCommand() {
    options_.folder = folder_.path();
    options_.environment = {"GITHUB_ACTIONS", "GITHUB_STEP_SUMMARY", "GITHUB_WORKSPACE"};  // these tests may themselves run in a CI job
  }

  [[nodiscard]] ProgramRun check(const std::string& text, const Words& more = {}) const {
    write(folder_.path() / "robot.check.toml", text);
    return run(Words{"check", "robot.check.toml"} + more, options_);
  }

  TemporaryFolder folder_;
  RunOptions options_;
};

TEST_F(CheckCommand, AnswersByTheContract) {
  const ProgramRun done = check(check_with(120.0, 1.0), {"--json", "-"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const json answer = done.json();
  EXPECT_EQ(answer.at("schema"), "heatsoak.check/1");
  EXPECT_TRUE(answer.at("version").is_string());
  EXPECT_EQ(answer.at("passed"), true);
  ASSERT_EQ(answer.at("thresholds").size(), 2U);
  const json& first = answer.at("thresholds").at(0);
  EXPECT_EQ(first.at("limit"), 120.0);
  EXPECT_EQ(first.at("passed"), true);
  EXPECT_EQ(first.at("line"), 9);
  EXPECT_NEAR(first.at("margin").get<double>(), 120.0 - first.at("value").get<double>(), 1e-5);
  EXPECT_THAT(done.err, HasSubstr("2 limits hold"));
  // `evaluate` must give the same values.
  const json evaluated = run({"evaluate", "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--motors",
                              "maxon_ecx_flat_42m_24v,maxon_ecx_flat_32l_48v", "--samples", "80", "--json", "-"})
                             .json()
                             .at("motors")
                             .at(0);
  EXPECT_NEAR(evaluated.at("winding_p95_ci95_C").at(1).get<double>(), first.at("value").get<double>(), 0.006);
  EXPECT_NEAR(evaluated.at("margin_A").get<double>(), answer.at("thresholds").at(1).at("value").get<double>(), 6e-5);
}

TEST_F(CheckCommand, ExceededLimitIsExitOneAtItsLine) {
  options_.environment = {"GITHUB_ACTIONS=true", "GITHUB_STEP_SUMMARY=summary.md", "GITHUB_WORKSPACE"};
  write(folder_.path() / "summary.md", "before\n");
  const ProgramRun done = check(check_with(30.0, 1.0), {"--junit", "check.xml"});
  EXPECT_EQ(done.exit_code, 1) << done.err;
  EXPECT_THAT(done.out, HasSubstr("1 limit of 2 does not hold"));
  EXPECT_THAT(done.out, HasSubstr("::error file=robot.check.toml,line=9,col=20,title=paper%3A winding_peak_p95::"));
  EXPECT_THAT(done.out, Not(HasSubstr("\x1b")));
  EXPECT_THAT(content_of(folder_.path() / "check.xml"), HasSubstr("<failure type=\"limit_exceeded\""));
  EXPECT_THAT(content_of(folder_.path() / "summary.md"),
              testing::AllOf(testing::StartsWith("before\n"), HasSubstr("1 limit of 2 does not hold")));
  EXPECT_EQ(check(check_with(120.0, 99.0)).exit_code, 1);
}

// GitHub reads annotations from both streams, but a document on stdout must contain nothing else.
TEST_F(CheckCommand, AnnotationsStayOutOfAReportOnStdout) {
  options_.environment = {"GITHUB_ACTIONS=true", "GITHUB_STEP_SUMMARY", "GITHUB_WORKSPACE"};
  const ProgramRun done = check(check_with(30.0, 1.0), {"--report", "-"});
  EXPECT_EQ(done.exit_code, 1) << done.err;
  EXPECT_THAT(done.out, testing::AllOf(HasSubstr("1 limit of 2 does not hold"), Not(HasSubstr("::error"))));
  EXPECT_THAT(done.err, HasSubstr("::error file=robot.check.toml,line=9,col=20,title=paper%3A winding_peak_p95::"));
}

TEST_F(CheckCommand, UnknownMotorIsExitOneAndTheOtherLimitsAreEvaluated) {
  options_.environment = {"GITHUB_ACTIONS=true", "GITHUB_STEP_SUMMARY=summary.md", "GITHUB_WORKSPACE"};
  const ProgramRun done = check(
      check_with(120.0, 1.0) + "[[check]]\nname = \"gone\"\nmotor = \"no_such_motor\"\n[check.limits]\nlint_problems = \"at most 0\"\n",
      {"--junit", "check.xml"});
  EXPECT_EQ(done.exit_code, 1) << done.err;
  EXPECT_THAT(done.out, testing::AllOf(HasSubstr("1 limit of 3 cannot be evaluated"), HasSubstr("there is no motor 'no_such_motor'"),
                                       HasSubstr("::error file=robot.check.toml,line=13,col=9,title=gone%3A lint_problems::"),
                                       Not(HasSubstr("robot.check.toml:15"))))
      << "one place, which is that of the motor";
  EXPECT_THAT(content_of(folder_.path() / "check.xml"), HasSubstr("tests=\"3\" failures=\"0\" errors=\"1\""));
  EXPECT_THAT(content_of(folder_.path() / "summary.md"), HasSubstr("1 limit of 3 cannot be evaluated"));
}

TEST_F(CheckCommand, SummaryThatCannotBeWrittenIsNoFailure) {
  options_.environment = {"GITHUB_STEP_SUMMARY=missing/summary.md"};
  const ProgramRun done = check(check_with(120.0, 1.0));
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_THAT(done.err, HasSubstr("warning: the summary"));
}

TEST_F(CheckCommand, WrongFilesAreExitTwoAllAtOnceAndLeaveOnlyTheJunit) {
  write(folder_.path() / "other.toml", "[[check]]\nname = \"x\"\nrobot = \"nobody\"\n[check.limits]\nlint_problems = \"at most 0\"\n");
  options_.environment = {"GITHUB_ACTIONS=true", "GITHUB_WORKSPACE"};
  const ProgramRun done = check("[[check]]\nname = \"y\"\n[check.limits]\nwinding_paek_p95 = \"at most 1 degC\"\n",
                                {"other.toml", "missing.toml", "--junit", "check.xml", "--json", "-"});
  EXPECT_EQ(done.exit_code, 2);
  for (const char* each : {"robot.check.toml:4:20: error: check[0].limits.winding_paek_p95", "did you mean 'winding_peak_p95'?",
                           "other.toml:3:9: error: check[0].robot", "missing.toml: error: cannot be read",
                           "::error file=other.toml,line=3,col=9,title=check[0].robot::"}) {
    EXPECT_THAT(done.err, HasSubstr(each));
  }
  EXPECT_EQ(done.json().at("error").at("diagnostics").size(), 3U);
  EXPECT_TRUE(done.json().at("version").is_string());
  EXPECT_THAT(folder_.names(), ElementsAre("check.xml", "other.toml", "robot.check.toml"));
  EXPECT_THAT(content_of(folder_.path() / "check.xml"),
              testing::AllOf(HasSubstr("tests=\"1\" failures=\"0\" errors=\"1\""), HasSubstr("<error type=\"not_evaluated\""),
                             HasSubstr("missing.toml: error: cannot be read")));
}

TEST_F(CheckCommand, JunitHasTheLimitsOfTheGoodFileBesideABadOne) {
  const ProgramRun done = check(check_with(120.0, 1.0), {"missing.toml", "--junit", "check.xml", "--update"});
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_THAT(done.err, HasSubstr("missing.toml: error: cannot be read"));
  EXPECT_THAT(content_of(folder_.path() / "check.xml"),
              testing::AllOf(HasSubstr("tests=\"3\" failures=\"0\" errors=\"1\""), HasSubstr("<testcase name=\"winding_peak_p95\""),
                             HasSubstr("missing.toml: error: cannot be read")));
  EXPECT_EQ(content_of(folder_.path() / "robot.check.toml"), check_with(120.0, 1.0)) << "nothing is updated beside a bad file";
}

TEST_F(CheckCommand, JunitOnStdoutIsRefused) {
  const ProgramRun done = check(check_with(120.0, 1.0), {"--junit", "-"});
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_THAT(done.err, HasSubstr("expected the name of a file"));
  EXPECT_THAT(folder_.names(), ElementsAre("robot.check.toml"));
}

TEST_F(CheckCommand, MissingMotorFileIsAFailedLimitInEveryReport) {
  const ProgramRun done = check(
      "[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"paper_intermittent\"\nmotor = \"ours.toml\"\n"
      "[check.limits]\nwinding_peak_p95 = \"at most 100 degC\"\n",
      {"--junit", "check.xml", "--json", "-"});
  EXPECT_EQ(done.exit_code, 1) << done.err;
  const json threshold = done.json().at("thresholds").at(0);
  EXPECT_EQ(threshold.at("evaluated"), false);
  EXPECT_EQ(threshold.at("line"), 7);
  EXPECT_THAT(threshold.at("reason"), HasSubstr("ours.toml: cannot be read"));
  EXPECT_THAT(content_of(folder_.path() / "check.xml"),
              HasSubstr("<error type=\"not_evaluated\" message=\"robot.check.toml:5:9: motor: ours.toml: cannot be read"));
}

TEST_F(CheckCommand, UpdateRewritesTheLimitsInPlace) {
  EXPECT_EQ(check(check_with(30.0, 99.0), {"--margin", "10 %"}).exit_code, 2) << "without --update it would change nothing";
  const ProgramRun updated = check(check_with(30.0, 99.0), {"--update", "--margin", "10 %"});
  EXPECT_EQ(updated.exit_code, 0) << updated.err;
  EXPECT_THAT(updated.out, HasSubstr("limit at most 30 degC → at most "));
  EXPECT_THAT(updated.out, HasSubstr("2 limits rewritten"));
  const std::string after = content_of(folder_.path() / "robot.check.toml");
  EXPECT_THAT(after, testing::StartsWith("# our robot\n[[check]]\n"));
  EXPECT_THAT(after, HasSubstr(" degC\"  # the winding\n"));
  EXPECT_EQ(check(after).exit_code, 0);
  EXPECT_THAT(check(after, {"--update", "--margin", "10 %"}).out, HasSubstr("0 limits rewritten"));
  EXPECT_EQ(content_of(folder_.path() / "robot.check.toml"), after);
  EXPECT_THAT(folder_.names(), ElementsAre("robot.check.toml"));
}

TEST_F(CheckCommand, MarginAboveTheWholeValueIsRefused) {
  const std::string before = check_with(30.0, 99.0);
  for (const char* const margin : {"5", "1", "500 %", "101 %"}) {
    const ProgramRun refused = check(before, {"--update", "--margin", margin});
    EXPECT_EQ(refused.exit_code, 2) << margin;
    EXPECT_EQ(content_of(folder_.path() / "robot.check.toml"), before) << margin;
  }
  EXPECT_THAT(check(before, {"--update", "--margin", "5"}).err, HasSubstr("5 is 500 %; did you mean 5 %?"));
  EXPECT_EQ(check(before, {"--update", "--margin", "0.05"}).exit_code, 0);
  EXPECT_EQ(check(before, {"--update", "--margin", "100 %"}).exit_code, 0);
}

TEST_F(CheckCommand, UpdateOfAFileThatMayNotBeWrittenChangesNothing) {
  write(folder_.path() / "robot.check.toml", check_with(30.0, 1.0));
  fs::permissions(folder_.path(), fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
  // root may write to every folder, so the test runs as another user. It is skipped if that user cannot reach the program.
  const std::string check_line =
      fmt::format("{}heatsoak check robot.check.toml", ::geteuid() != 0 ? "" : "setpriv --reuid 65534 --regid 65534 --clear-groups ");
  const ProgramRun readable = run_line(check_line, options_);
  if (readable.exit_code != 1) {
    GTEST_SKIP() << readable.err;
  }
  const ProgramRun done = run_line(check_line + " --update", options_);
  fs::permissions(folder_.path(), fs::perms::owner_all);
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_THAT(done.err, HasSubstr("robot.check.toml: error: cannot be written: Permission denied"));
  EXPECT_EQ(content_of(folder_.path() / "robot.check.toml"), check_with(30.0, 1.0));
}

TEST_F(CheckCommand, OutputsNeverReplaceTheCheckFile) {
  const std::string text = check_with(120.0, 1.0);
  EXPECT_EQ(check(text, {"--junit", "robot.check.toml"}).exit_code, 2);
  EXPECT_EQ(check(text, {"--junit", "one.xml", "--json", "one.xml"}).exit_code, 2);
  EXPECT_EQ(content_of(folder_.path() / "robot.check.toml"), text);
}

// The model's error on a log equals the error that `calibrate` reports for its initial file.
TEST_F(CheckCommand, ForecastErrorIsThatOfCalibrate) {
  const std::string log = (kSoak / "bench.csv").string();
  const ProgramRun done =
      check(fmt::format("[[check]]\nname = \"logs\"\nmotor = \"{}\"\nlogs = [\"{}\", \"missing.csv\"]\n[check.limits]\n"
                        "forecast_error = \"at most 50 K\"\n[[check]]\nname = \"log\"\nmotor = \"{}\"\nlogs = [\"{}\"]\n"
                        "[check.limits]\nforecast_error = \"at most 50 K\"\n",
                        kMotor, log, kMotor, log),
            {"--json", "-"});
  const json thresholds = done.json().at("thresholds");
  EXPECT_EQ(thresholds.at(0).at("passed"), false);
  EXPECT_THAT(thresholds.at(0).at("reason"), HasSubstr("missing.csv: cannot be read"));
  const ProgramRun calibrated = run({"calibrate", "--motor", kMotor, log, "--out", "model.toml", "--json", "-"}, options_);
  ASSERT_EQ(calibrated.exit_code, 0) << calibrated.err;
  double worst_K = 0.0;
  const json before = calibrated.json().at("error_before");
  for (const auto& [signal, error] : before.items()) {
    worst_K = std::max(worst_K, error.at("rmse_K").get<double>());
  }
  EXPECT_NEAR(thresholds.at(1).at("value").get<double>(), worst_K, 1e-3);
}

TEST(Thresholds, AreListedAndDescribed) {
  const json items = run({"list", "thresholds", "--json", "-"}).json().at("items");
  EXPECT_THAT(items, Not(testing::IsEmpty()));
  for (const json& item : items) {
    const ProgramRun described = run({"describe", item.at("id"), "--json", "-"});
    EXPECT_EQ(described.exit_code, 0) << item;
    EXPECT_EQ(described.json().at("kind"), "threshold");
  }
}

// Exit codes of single verbs.

TEST(FailOn, ChangesTheExitCodeOnly) {
  const Words marginal{"evaluate",
                       "--robot",
                       "roboteam_twente_v2024",
                       "--duty",
                       "paper_intermittent",
                       "--motors",
                       "maxon_ec45_flat_70w_36v_402686",
                       "--samples",
                       "8",
                       "--json",
                       "-"};
  const ProgramRun usual = run(marginal);
  ASSERT_EQ(usual.json().at("motors").at(0).at("verdict"), "marginal");
  EXPECT_EQ(usual.exit_code, 0);
  const ProgramRun strict = run(marginal + Words{"--fail-on", "marginal"});
  EXPECT_EQ(strict.exit_code, 1);
  EXPECT_EQ(strict.out, usual.out);
  const Words fails{"evaluate",  "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--motors", "maxon_ecx_flat_32l_48v",
                    "--samples", "0"};
  EXPECT_EQ(run(fails).exit_code, 1);
  EXPECT_EQ(run(fails + Words{"--fail-on", "infeasible"}).exit_code, 0);
  EXPECT_EQ(run(fails + Words{"--fail-on", "margnal"}).exit_code, 2);
}

TEST(FailOn, MarginalRefusesWhatNoSamplesDecide) {
  const Words nominal{"evaluate",  "--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--motors", "maxon_ecx_flat_42m_24v",
                      "--samples", "0"};
  EXPECT_EQ(run(nominal + Words{"--fail-on", "marginal"}).exit_code, 1) << "nominal values decide nothing over tolerances";
  EXPECT_EQ(run(nominal).exit_code, 0);
}

TEST(DerateCheck, FindsATableThatNoLongerHolds) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  const Words derate{"derate", "--robot", "roboteam_twente_v2024", "--motor", "maxon_ecx_flat_42m_24v", "--samples", "60"};
  const ProgramRun wrote = run(derate + Words{"--to", "csv", "--out", "table.csv"}, options);
  ASSERT_EQ(wrote.exit_code, 0) << wrote.err;
  std::string table = content_of(folder.path() / "table.csv");
  // Replaces one current in the middle of the table.
  const std::size_t row = table.find('\n', table.size() / 3) + 1;
  const std::size_t comma = table.rfind(',', table.find('\n', row));
  write(folder.path() / "unsafe.csv", table.replace(comma + 1, table.find('\n', comma) - comma - 1, "70.25"));
  const ProgramRun unsafe = run(derate + Words{"--check", "unsafe.csv", "--json", "-"}, options);
  EXPECT_EQ(unsafe.exit_code, 1) << unsafe.err;
  EXPECT_THAT(unsafe.err, HasSubstr("unsafe.csv: no longer holds"));
  EXPECT_THAT(unsafe.err, HasSubstr("70.250 A, a fresh table"));
  EXPECT_EQ(unsafe.json().at("check").at("holds"), false);
  const std::string reason = "unsafe.csv: no longer holds: it allows up to ";
  EXPECT_THAT(unsafe.err, testing::StartsWith(reason));
  EXPECT_THAT(run(derate + Words{"--check", "unsafe.csv", "--quiet"}, options).out, testing::StartsWith(reason));
  const ProgramRun holds = run(derate + Words{"--check", "table.csv"}, options);
  EXPECT_EQ(holds.exit_code, 0) << holds.err;
  EXPECT_THAT(holds.out, HasSubstr("table.csv: still holds: no current is above a fresh table"));
  EXPECT_EQ(run(derate + Words{"--check", "missing.csv"}, options).exit_code, 2);
  EXPECT_THAT(folder.names(), ElementsAre("table.csv", "unsafe.csv"));
}

// A change of the motor's file: the law that changed comes before the constants that follow from it, also with --quiet.
TEST(DerateCheck, NamesTheLawThatChanged) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  const std::string sheet = content_of(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml");
  write(folder.path() / "motor.toml", sheet);
  const Words derate{"derate", "--robot", "roboteam_twente_v2024", "--motor", "motor.toml", "--samples", "60"};
  ASSERT_EQ(run(derate + Words{"--out", "guard.h"}, options).exit_code, 0);
  const std::string changed =
      std::regex_replace(sheet, std::regex("(\nthermal_resistance_winding_stator = \\{ value = \")[0-9.]+"), "$013.5");
  ASSERT_NE(changed, sheet);
  write(folder.path() / "motor.toml", changed);
  const ProgramRun found = run(derate + Words{"--check", "guard.h", "--json", "-"}, options);
  EXPECT_EQ(found.exit_code, 1) << found.err;
  const nlohmann::json lines = found.json().at("check").at("differing_lines");
  ASSERT_GE(lines.size(), 2U);
  EXPECT_THAT(lines[0].at("committed").get<std::string>(), HasSubstr("winding_to_stator_W"));
  EXPECT_EQ(found.json().at("check").at("differing_line"), lines[0].at("line"));
  EXPECT_THAT(found.err, HasSubstr("Differing lines"));
  EXPECT_THAT(run(derate + Words{"--check", "guard.h", "--quiet"}, options).out, HasSubstr("winding_to_stator_W"));
  // Currents of two observers cannot be compared, neither the excess nor the deficit.
  write(folder.path() / "a.check.toml",
        "[[check]]\nname = \"table\"\nrobot = \"roboteam_twente_v2024\"\nmotor = \"motor.toml\"\ntable = \"guard.h\"\n"
        "derate = { samples = \"60\" }\n[check.limits]\nderating_excess = \"at most 5 A\"\nderating_lost = \"at most 5 A\"\n");
  const ProgramRun checked = run({"check", "a.check.toml", "--json", "-"}, options);
  EXPECT_EQ(checked.exit_code, 1) << checked.err;
  for (const json& each : checked.json().at("thresholds")) {
    EXPECT_EQ(each.at("evaluated"), false) << each;
  }
}

// A header with a sensor cannot be compared with one without it, and this is no unsafe table.
TEST(DerateCheck, NamesTheOptionsOfTheSensor) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  const Words derate{"derate", "--robot", "roboteam_twente_v2024", "--motor", "maxon_ecx_flat_32l_48v", "--samples", "60"};
  const Words sensor{"--thermistor", "stator", "--thermistor-accuracy", "1.5K", "--thermistor-lag", "3s"};
  const ProgramRun sensed = run(derate + sensor + Words{"--out", "sensed.h"}, options);
  ASSERT_EQ(sensed.exit_code, 0);
  EXPECT_THAT(sensed.out, HasSubstr("Measure the air temperature at the motor as well"));
  ASSERT_EQ(run(derate + Words{"--out", "plain.h"}, options).exit_code, 0);
  const ProgramRun without = run(derate + Words{"--check", "sensed.h"}, options);
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_THAT(without.err, HasSubstr("--check sensed.h: the header has a temperature sensor"));
  EXPECT_THAT(without.err, HasSubstr("--thermistor stator --thermistor-accuracy 1.5K --thermistor-lag 3s"));
  const ProgramRun other = run(derate + Words{"--thermistor", "stator", "--thermistor-accuracy", "10K", "--check", "sensed.h"}, options);
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("--check sensed.h: the header was generated with --thermistor-accuracy 1.5K, not 10K; "
                                   "--thermistor-lag 3s, not 0s; use its options or generate the header again"));
  const std::string header = content_of(folder.path() / "sensed.h");
  const std::size_t flags = header.find("\n * --thermistor");
  ASSERT_NE(flags, std::string::npos);
  write(folder.path() / "older.h", header.substr(0, flags) + header.substr(header.find('\n', flags + 1)));
  const ProgramRun older = run(derate + sensor + Words{"--check", "older.h"}, options);
  EXPECT_EQ(older.exit_code, 2);
  EXPECT_THAT(older.err, HasSubstr("does not state its options; generate the header again"));
  const auto check = [&](const std::string& accuracy) {
    write(folder.path() / "a.check.toml", fmt::format("[[check]]\nname = \"a\"\nrobot = \"roboteam_twente_v2024\"\nmotor = "
                                                      "\"maxon_ecx_flat_32l_48v\"\ntable = \"sensed.h\"\nderate = {{ samples = \"60\", "
                                                      "thermistor = \"stator\", thermistor_accuracy = \"{}\", thermistor_lag = \"3 s\" }}\n"
                                                      "[check.limits]\nderating_excess = \"at most 0 A\"\n",
                                                      accuracy));
    return run({"check", "a.check.toml", "--json", "-"}, options).json().at("thresholds").at(0);
  };
  EXPECT_EQ(check("2 K").at("evaluated"), false);
  EXPECT_THAT(check("2 K").at("reason"), HasSubstr("generated with --thermistor-accuracy 1.5K, not 2K"));
  EXPECT_EQ(check("1.5 K").at("passed"), true);
  const ProgramRun with = run(derate + sensor + Words{"--check", "plain.h"}, options);
  EXPECT_EQ(with.exit_code, 2);
  EXPECT_THAT(with.err, HasSubstr("--check plain.h: the header has no temperature sensor"));
}

// A consumer can distinguish an upgrade of the program from a change of the numbers.
TEST(Version, StandsInEveryAnswer) {
  const std::string version = run({"--version"}).out;
  std::set<std::string> seen;
  for (const Words& each : {Words{"list", "motors"}, Words{"describe", "iron_loss_eddy"}, Words{"lint", "maxon_dcx19s_24v"},
                            Words{"steady", "--motor", "maxon_dcx19s_24v", "--current-on", "1A", "--time-on", "1s", "--time-off", "1s"},
                            Words{"evaluate", "--robot", "nobody", "--duty", "nothing"}}) {
    const json answer = run(each + Words{"--json", "-"}).json();
    ASSERT_TRUE(answer.contains("version")) << each.front();
    seen.insert(answer.at("version"));
  }
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_THAT(version, HasSubstr(*seen.begin()));
}

}  // namespace
}  // namespace heatsoak
