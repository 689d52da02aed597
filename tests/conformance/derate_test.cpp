// User's view of `heatsoak derate`: the shipped robot, a model that a diagnosis extended, and wrong command lines.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program_run.h"
#include "soak_example.h"

namespace heatsoak {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Words kDerateEcx{"derate", "--robot", "roboteam_twente_v2024"};

RunOptions here(const TemporaryFolder& folder) {
  RunOptions options;
  options.folder = folder.path();
  return options;
}

double lasting_A(const nlohmann::json& answer) { return answer["limp_current_A"].get<double>(); }

// The table of a data sheet is exact with 48 bytes. These effects are not linear in temperature and speed.
TEST(DerateCommand, TradesBytesForErrorAsAsked) {
  const TemporaryFolder folder;
  write(folder.path() / "lossy.toml", content_of(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml") + R"([effects.eddy]
type = "ac_copper_loss"
share = { value = "0.2", origin = "estimated", derivation = "a test" }

[effects.flow]
type = "winding_through_flow"
conductance = { value = "0.1 W/K", origin = "estimated", derivation = "a test" }
)");
  const auto table_with = [&](const Words& options, const testing::Matcher<std::string>& says) {
    const ProgramRun done = run(kDerateEcx + Words{"--motor", "lossy.toml", "--out", "guard.h", "--json", "-"} + options, here(folder));
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.err, testing::AllOf(HasSubstr("% lower, from"), says));
    return done.json()["table"];
  };
  const nlohmann::json fine = table_with({"--error", "0.5%"}, Not(HasSubstr("Some current is lost")));
  const nlohmann::json small = table_with({"--error", "0.5%", "--size", "80"}, HasSubstr("more than the 0.5 % of --error"));
  EXPECT_LE(fine["bound"]["shortfall_ratio"].get<double>(), 0.005);
  EXPECT_GT(small["bound"]["shortfall_ratio"].get<double>(), 0.005);
  const auto bytes = [](const nlohmann::json& table) {
    return 4 * (table["speed_rad_per_s"].size() + table["stator_C"].size() + table["winding_C"].size() + table["heat_per_ohm_A2"].size());
  };
  EXPECT_LE(bytes(small), 80U);
  EXPECT_GT(bytes(fine), 80U);
}

TEST(DerateCommand, StatesTheRangeInTheUnitOfTheOption) {
  const TemporaryFolder folder;
  const auto refusal = [&](const char* error) {
    return run(kDerateEcx + Words{"--motor", "maxon_ecx_flat_32l_48v", "--out", "guard.h", "--error", error}, here(folder)).err;
  };
  EXPECT_THAT(refusal("90%"), HasSubstr("expected 0.2 % to 50 %"));
  EXPECT_THAT(refusal("0.9"), HasSubstr("expected 0.002 to 0.5"));
}

// <dcmotor> has one thermal resistance and no loss at speed. That is unsafe, so it is printed even with --quiet.
TEST(DerateCommand, StatesTheHeatThatAFormatOmits) {
  const TemporaryFolder folder;
  const Words motor{"--motor", "maxon_ecx_flat_32l_48v", "--quiet"};
  const ProgramRun mujoco = run(kDerateEcx + motor + Words{"--to", "mujoco", "--out", "motor.xml"}, here(folder));
  EXPECT_EQ(mujoco.exit_code, 0) << mujoco.err;
  EXPECT_THAT(mujoco.out, HasSubstr("The winding in the mujoco file may be too cold"));
  // The value is tested by MujocoExporter.StatedRiseIsReachedWhenALastingCurrentHeatsTheTurningMotorToItsLimit.
  EXPECT_THAT(content_of(folder.path() / "motor.xml"), HasSubstr("K for no-load loss, which"));
  const ProgramRun header = run(kDerateEcx + motor + Words{"--out", "guard.h"}, here(folder));
  EXPECT_THAT(header.out, Not(HasSubstr("mujoco")));
}

TEST(DerateCommand, TellsWhatItGuarantees) {
  const TemporaryFolder folder;
  const ProgramRun done = run(kDerateEcx + Words{"--motor", "maxon_ecx_flat_32l_48v", "--out", "guard.h", "--json", "-"}, here(folder));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const nlohmann::json answer = done.json();
  EXPECT_EQ(answer["schema"], "heatsoak.derating/2");
  EXPECT_EQ(answer["winding_limit_C"], 155.0);
  EXPECT_GE(answer["heat_reserve_ratio"].get<double>(), 1.0);
  EXPECT_LE(answer["guarantee"]["over"].get<int>(), 0.05 * answer["guarantee"]["samples"].get<int>());
  const nlohmann::json& table = answer["table"];
  EXPECT_EQ(table["current_A"].size(), table["speed_rad_per_s"].size() * table["stator_C"].size() * table["winding_C"].size());
  EXPECT_THAT(done.err, HasSubstr("drawn motors, which determined"));
  EXPECT_THAT(content_of(folder.path() / "guard.h"), HasSubstr("maxon_ecx_flat_32l_48v_step"));
}

// Some motors of a sample exceed every limit, so the headline states the share that keeps it; and why the limit is lower than elsewhere.
TEST(DerateCommand, HeadlineIsTrueForTheGuaranteedShareAndExplainsTheLimit) {
  const TemporaryFolder folder;
  RunOptions options = here(folder);
  options.environment.emplace_back("COLUMNS=400");
  const ProgramRun done =
      run(kDerateEcx + Words{"--motor", "maxon_ecx_flat_42m_24v", "--out", "guard.h", "--quiet", "--samples", "60"}, options);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const std::string first = done.out.substr(0, done.out.find('\n'));
  EXPECT_THAT(first, testing::AllOf(HasSubstr("at least 95"), HasSubstr("125 °C"), HasSubstr("range around 155 °C")));
}

// Complete chain: logs, diagnosis of a missing effect, firmware that includes it.
TEST(DerateCommand, EffectThatADiagnosisFoundActsInTheFirmware) {
  const TemporaryFolder folder;
  const auto log = [](const char* name) { return (kSoak / name).string(); };
  ASSERT_EQ(run({"diagnose", "--model", kMotor, "--train", log("match_1.csv"), log("match_2.csv"), log("bench.csv"), "--holdout",
                 log("match_3.csv"), "--out", "found"},
                here(folder))
                .exit_code,
            0);
  const Words extended{"--motor", kMotor, "--model", fmt::format("found/{}.toml", kMotor)};
  const ProgramRun before = run(kDerateEcx + Words{"--motor", kMotor, "--out", "before.h", "--json", "-"}, here(folder));
  const ProgramRun after = run(kDerateEcx + extended + Words{"--out", "after.h", "--json", "-"}, here(folder));
  ASSERT_EQ(before.exit_code, 0) << before.err;
  ASSERT_EQ(after.exit_code, 0) << after.err;
  EXPECT_THAT(before.json()["nodes"], ElementsAre("winding", "stator"));
  EXPECT_THAT(after.json()["nodes"], ElementsAre("winding", "stator", "enclosure_warm_up"));
  EXPECT_THAT(after.err, HasSubstr("Active effects of the file: enclosure_warm_up"));
  EXPECT_THAT(content_of(folder.path() / "after.h"), HasSubstr("winding stator enclosure_warm_up"));
  // A calibrated motor needs a smaller safety factor than a data sheet, so more current is allowed.
  EXPECT_LT(after.json()["heat_reserve_ratio"].get<double>(), before.json()["heat_reserve_ratio"].get<double>());
  EXPECT_GT(lasting_A(after.json()), 1.02 * lasting_A(before.json()));
}

// Both have one schema. The answer of the command adds what the terminal shows: version, notes and warnings.
TEST(DerateCommand, WritesTheTableAlone) {
  const TemporaryFolder folder;
  ASSERT_EQ(run(kDerateEcx + Words{"--motor", kMotor, "--to", "csv", "--out", "table.csv"}, here(folder)).exit_code, 0);
  EXPECT_THAT(content_of(folder.path() / "table.csv"),
              AllOf(testing::StartsWith("# "), HasSubstr("\nspeed_rad_per_s,stator_C,winding_C,allowed_current_A\n")));
}

TEST(DerateCommand, JsonFileIsTheAnswerAndNamesItsInputs) {
  const TemporaryFolder folder;
  const ProgramRun done = run(kDerateEcx + Words{"--motor", kMotor, "--to", "json", "--out", "table.json", "--json", "-"}, here(folder));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  nlohmann::json answer = done.json();
  answer.erase("version");  // every answer on stdout has this key; the file has "program" instead
  for (const char* const of_answers : {"notes", "warnings"}) {
    EXPECT_EQ(answer.erase(of_answers), 1U) << of_answers;
  }
  EXPECT_EQ(nlohmann::json::parse(content_of(folder.path() / "table.json")), answer);
  EXPECT_EQ(done.json()["program"].get<std::string>(), "heatsoak " + done.json()["version"].get<std::string>());
  EXPECT_EQ(done.json()["input_hash"]["value"].get<std::string>().size(), 16U);
}

struct WrongLine {
  Words words;
  int exit_code;
  std::string message;
};

TEST(DerateCommand, SaysWhatIsWrongAndLeavesNothing) {
  const std::vector<WrongLine> wrong{
      {{"--out", "x.h"}, 2, "the motor is missing"},
      {{"--motor", kMotor}, 2, "--out"},
      {{"--motor", kMotor, "--to", "c_heder", "--out", "x.h"}, 2, "did you mean 'c_header'?"},
      {{"--motor", kMotor, "--out", "x.h", "--period", "1s"}, 2, "too long"},
      {{"--motor", kMotor, "--out", "x.h", "--samples", "0"}, 2, "--samples 59"},
      {{"--motor", kMotor, "--out", "x.h", "--confidence", "0.999"}, 2, "--samples 2995"},
      {{"--motor", "maxon_dcx19s_24v", "--to", "moteus", "--out", "x.cfg"}, 2, "moteus cannot drive maxon_dcx19s_24v"},
      {{"--motor", kMotor, "--to", "json", "--out", "missing/x.json"}, 2, "missing"},
      {{"--motor", "maxon_dcx19s_24v", "--out", "x.h", "--ambient", "110degC"}, 2, "is not above the hottest air"},
      {{"--motor", kMotor, "--out", "-"}, 2, "/dev/stdout"},
      {{"--motor", kMotor, "--out", "x.h", "--coldest", "50degC"}, 2, "is not above the coldest air"},
      {{"--motor", kMotor, "--model", "maxon_ecx_flat_32l_48v", "--out", "x.h"}, 2, "is not a model of"},
      {{"--motor", kMotor, "--out", "x.h", "--confidence", "95"}, 2, "--confidence"},
      {{"--motor", kMotor, "--out", "x.h", "--ambient", "120degC", "--condition", "fan=on"}, 2, "no effect of"},
      {{"--motor", kMotor, "--out", "missing/x.h"}, 2, "missing"},
  };
  for (const WrongLine& each : wrong) {
    const TemporaryFolder folder;
    const ProgramRun done = run(kDerateEcx + each.words, here(folder));
    EXPECT_EQ(done.exit_code, each.exit_code) << done.err;
    EXPECT_THAT(done.err, HasSubstr(each.message));
    EXPECT_THAT(folder.names(), IsEmpty());
  }
}

}  // namespace
}  // namespace heatsoak
