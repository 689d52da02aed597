// User's view of a motor file with missing tolerances, on its way to a verdict or to firmware.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string kEcx = "maxon_ecx_flat_32l_48v";
const std::string kRobot = "roboteam_twente_v2024";

/// Returns all verbs that end in a verdict or in firmware, with the motor `motor.toml`.
std::vector<Words> verbs() {
  return {{"derate", "--robot", kRobot, "--motor", "motor.toml", "--out", "x.h"},
          {"derate", "--robot", kRobot, "--model", "motor.toml", "--out", "x.h"},
          {"generate", "core", "--robot", kRobot, "--motor", "motor.toml", "--out", "x"},
          {"evaluate", "--robot", kRobot, "--duty", "paper_intermittent", "--motors", "motor.toml", "--plot", "x.svg"},
          {"evaluate", "--robot", kRobot, "--duty", "paper_intermittent", "--model", "motor.toml", "--plot", "x.svg"},
          {"simulate", "--robot", kRobot, "--duty", "division_a_match", "--motor", "motor.toml", "--guard", "on", "--out", "x.csv"},
          {"simulate", "--robot", kRobot, "--duty", "paper_intermittent", "--motor", "motor.toml", "--out", "x.csv"},
          {"steady", "--motor", "motor.toml", "--current-on", "3A", "--time-on", "1s", "--time-off", "1s"}};
}

std::string shipped(const std::string& id) { return content_of(kSource / "motor_db" / (id + ".toml")); }

std::string without_spreads(const std::string& text) {
  return std::regex_replace(text, std::regex(R"re(, (tolerance = "[^"]*"|range = \[[^\]]*\]))re"), "");
}

TEST(UnsafeMotor, IsRefusedByEveryVerbWithPlaceAndAdvice) {
  for (const Words& verb : verbs()) {
    const TemporaryFolder folder;
    write(folder.path() / "motor.toml", content_of(kSource / "tests/data/lint_motors/lint_df45l_phase_resistance.toml"));
    RunOptions here;
    here.folder = folder.path();
    const ProgramRun done = run(verb, here);
    EXPECT_EQ(done.exit_code, 2) << verb[0] << done.err;
    EXPECT_THAT(done.err, AllOf(ContainsRegex("motor.toml:[0-9]+:[0-9]+: error: "), HasSubstr("expected"))) << verb[0];
    EXPECT_THAT(folder.names(), testing::ElementsAre("motor.toml")) << verb[0];
  }
}

TEST(UnsafeMotor, WithAToleranceOfZeroIsRefusedByEveryVerb) {
  for (const char* const zero : {R"(tolerance = "0 %")", R"(range = ["1.07 ohm", "1.07 ohm"])"}) {
    const std::string text = std::regex_replace(
        shipped(kEcx), std::regex(R"re((terminal_resistance = \{ value = "1.07 ohm".*)tolerance = "10 %")re"), fmt::format("$1{}", zero));
    for (const Words& verb : verbs()) {
      const TemporaryFolder folder;
      write(folder.path() / "motor.toml", text);
      RunOptions here;
      here.folder = folder.path();
      const ProgramRun done = run(verb, here);
      EXPECT_EQ(done.exit_code, 2) << verb[0] << done.err;
      EXPECT_THAT(done.err, AllOf(ContainsRegex("motor.toml:[0-9]+:[0-9]+: error: exact_values: terminal_resistance"))) << verb[0];
    }
  }
}

TEST(MotorWithoutSpreads, GetsDefaultsThatEveryAnswerStates) {
  const TemporaryFolder folder;
  write(folder.path() / "bare.toml", without_spreads(shipped(kEcx)));
  RunOptions here;
  here.folder = folder.path();
  here.time_limit_s = 300;
  const Words derate{"derate", "--robot", kRobot, "--json", "-", "--samples", "100"};
  const ProgramRun bare = run(derate + Words{"--motor", "bare.toml", "--out", "bare.h"}, here);
  const ProgramRun honest = run(derate + Words{"--motor", kEcx, "--out", "honest.h"}, here);
  ASSERT_EQ(bare.exit_code, 0) << bare.err;
  ASSERT_EQ(honest.exit_code, 0) << honest.err;
  EXPECT_THAT(bare.err, HasSubstr("thermal_resistance_stator_ambient -50 to +80 % (estimated)"));
  EXPECT_EQ(bare.json()["default_spreads"].size(), 7U);
  EXPECT_THAT(honest.json()["default_spreads"], IsEmpty());
  const std::string header = content_of(folder.path() / "bare.h");
  EXPECT_LT(header.find("DEFAULT TOLERANCES"), 400U);
  EXPECT_THAT(content_of(folder.path() / "honest.h"), Not(HasSubstr("DEFAULT TOLERANCES")));
  EXPECT_GE(bare.json()["heat_reserve_ratio"].get<double>(), honest.json()["heat_reserve_ratio"].get<double>());
  EXPECT_LE(bare.json()["limp_current_A"].get<double>(), honest.json()["limp_current_A"].get<double>());
  // The first entry of both tables is for a motor at air temperature.
  EXPECT_LE(bare.json()["table"]["current_A"][0].get<double>(), honest.json()["table"]["current_A"][0].get<double>());

  const ProgramRun verdict =
      run({"evaluate", "--robot", kRobot, "--duty", "paper_intermittent", "--motors", "bare.toml", "--json", "-"}, here);
  EXPECT_EQ(verdict.exit_code, 1) << verdict.err;
  EXPECT_THAT(verdict.err, HasSubstr("the file gives no tolerance for these values"));
  EXPECT_EQ(verdict.json()["default_spreads"].size(), 7U);
  EXPECT_GT(verdict.json()["motors"][0]["winding_peak_C"]["p95"].get<double>(), 235.0);

  const ProgramRun core =
      run({"generate", "core", "--robot", kRobot, "--motor", "bare.toml", "--out", "core", "--samples", "100", "--json", "-"}, here);
  ASSERT_EQ(core.exit_code, 0) << core.err;
  EXPECT_THAT(core.err, HasSubstr("- the motor's file gives no tolerance for these values"));
  EXPECT_EQ(core.json()["default_spreads"].size(), 7U);
  EXPECT_THAT(content_of(folder.path() / "core/motor_guard.h"), HasSubstr("gives no tolerance for these values"));
}

}  // namespace
}  // namespace heatsoak
