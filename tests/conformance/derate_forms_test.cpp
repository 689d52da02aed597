// All output forms of `heatsoak derate`, with inputs from which no file can be made. Each must give a clear error and write nothing.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const Words kDerate{"derate", "--robot", "roboteam_twente_v2024", "--samples", "59"};

std::vector<std::string> forms() {
  std::vector<std::string> names;
  const nlohmann::json listed = run({"list", "formats", "--json", "-"}).json();
  for (const auto& item : listed.at("items")) {
    if (item.at("summary").get<std::string>().starts_with("derating: ")) {
      names.push_back(item.at("id"));
    }
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"c_header", "csv", "json", "vesc", "fmi2_motor", "fmi3_guard"}));
  return names;
}

TEST(DerateForms, RefuseALimitThatIsNotAboveTheAir) {
  for (const std::string& form : forms()) {
    const TemporaryFolder folder;
    RunOptions here;
    here.folder = folder.path();
    const ProgramRun done = run(kDerate + Words{"--motor", "maxon_dcx19s_24v", "--ambient", "100degC", "--to", form, "--out", "x"}, here);
    EXPECT_EQ(done.exit_code, 2) << form;
    EXPECT_THAT(done.err, AllOf(HasSubstr("the winding limit of 90.0 °C is not above the hottest air of 100.0 °C"), HasSubstr("--ambient")))
        << form;
    EXPECT_THAT(folder.names(), IsEmpty()) << form;
  }
}

// At every useful speed the motor's own drag heats it over its limit without any current.
TEST(DerateForms, RefuseAMotorThatCannotBearItsOwnFriction) {
  const std::string shipped = content_of(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml");
  for (const std::string& form : forms()) {
    const TemporaryFolder folder;
    RunOptions here;
    here.folder = folder.path();
    write(folder.path() / "motor.toml", shipped +
                                            "\n[effects.jammed_bearing]\ntype = \"bearing_friction\"\n"
                                            "loss = { value = \"300 W\", origin = \"estimated\", derivation = \"a test\" }\n"
                                            "viscous_share = { value = \"0\", origin = \"estimated\", derivation = \"a test\" }\n"
                                            "thinning = { value = \"0 1/K\", origin = \"estimated\", derivation = \"a test\" }\n");
    const ProgramRun done = run(kDerate + Words{"--motor", "motor.toml", "--to", form, "--out", "x"}, here);
    EXPECT_EQ(done.exit_code, 1) << form << done.err;
    EXPECT_THAT(done.err, AllOf(HasSubstr("however little current is allowed"), HasSubstr("calibrate the motor"))) << form;
    EXPECT_THAT(folder.names(), testing::ElementsAre("motor.toml")) << form;
  }
}

// The guard would allow less current than the motor needs to turn.
TEST(DerateForms, RefuseAMotorWhoseLastingCurrentDoesNotTurnIt) {
  const std::string shipped = content_of(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml");
  for (const std::string& form : forms()) {
    const TemporaryFolder folder;
    RunOptions here;
    here.folder = folder.path();
    write(folder.path() / "motor.toml", std::regex_replace(shipped, std::regex("(winding_limit = \\{ value = \")155"), "$0145"));
    const ProgramRun done = run(kDerate + Words{"--motor", "motor.toml", "--to", form, "--out", "x"}, here);
    EXPECT_EQ(done.exit_code, 1) << form << done.err;
    EXPECT_THAT(done.err, AllOf(HasSubstr("cannot hold its own friction"), HasSubstr("no-load current of 0.25 A"))) << form;
    EXPECT_THAT(folder.names(), testing::ElementsAre("motor.toml")) << form;
  }
}

TEST(DerateForms, RefuseANumberThatIsNone) {
  const std::string shipped = content_of(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml");
  for (const std::string& form : forms()) {
    const TemporaryFolder folder;
    RunOptions here;
    here.folder = folder.path();
    write(folder.path() / "motor.toml",
          std::regex_replace(shipped, std::regex("(thermal_resistance_stator_ambient = \\{ value = \")[^\"]*"), "$1nan K/W"));
    const ProgramRun done = run(kDerate + Words{"--motor", "motor.toml", "--to", form, "--out", "x"}, here);
    EXPECT_EQ(done.exit_code, 2) << form;
    EXPECT_THAT(done.err, testing::ContainsRegex("motor.toml:[0-9]+:[0-9]+: error: .*thermal_resistance_stator_ambient")) << form;
    EXPECT_THAT(folder.names(), testing::ElementsAre("motor.toml")) << form;
  }
}

// root may write to every folder, so the target is one that no user can write to.
TEST(DerateForms, LeaveNothingWhereTheTargetCannotBeWritten) {
  for (const std::string form : {"c_header", "json", "fmi3_guard"}) {
    const TemporaryFolder folder;
    RunOptions here;
    here.folder = folder.path();
    const ProgramRun done = run(kDerate + Words{"--motor", "maxon_ecx_flat_42m_24v", "--to", form, "--out", "/proc/heatsoak_guard"}, here);
    EXPECT_EQ(done.exit_code, 2) << form << done.err;
    EXPECT_THAT(done.err, HasSubstr("/proc/heatsoak_guard")) << form;
    EXPECT_THAT(done.err, Not(HasSubstr("terminate"))) << form;
    EXPECT_THAT(folder.names(), IsEmpty()) << form;
  }
}

TEST(DerateForms, FollowTheEndingOfTheFile) {
  const TemporaryFolder folder;
  RunOptions here;
  here.folder = folder.path();
  const Words motor{"--motor", "maxon_ecx_flat_42m_24v"};
  for (const auto& [out, begin] : {std::pair("a.json", "{"), {"a.csv", "# "}, {"a.h", "/*"}, {"plain", "/*"}}) {
    ASSERT_EQ(run(kDerate + motor + Words{"--out", out}, here).exit_code, 0) << out;
    EXPECT_THAT(content_of(folder.path() / out), testing::StartsWith(begin)) << out;
  }
  ASSERT_EQ(run(kDerate + motor + Words{"--to", "csv", "--out", "b.json"}, here).exit_code, 0);
  EXPECT_THAT(content_of(folder.path() / "b.json"), testing::StartsWith("# "));
  const ProgramRun refused = run(kDerate + motor + Words{"--out", "a.fmu"}, here);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("--out a.fmu: its ending gives no format; expected .h, .csv, .json, or --to FORM"),
                                 HasSubstr("heatsoak list formats")));
}

TEST(DerateForms, CompilerIsForUnitsOnly) {
  const TemporaryFolder folder;
  RunOptions here;
  here.folder = folder.path();
  const ProgramRun other =
      run(kDerate + Words{"--motor", "maxon_ecx_flat_42m_24v", "--to", "json", "--compiler", "cc", "--out", "x"}, here);
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("json has no binary"));
  const ProgramRun none =
      run(kDerate + Words{"--motor", "maxon_ecx_flat_42m_24v", "--to", "fmi3_motor", "--compiler", "no_such_compiler", "--out", "x"}, here);
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("--compiler no_such_compiler: cannot be run"));
  EXPECT_THAT(folder.names(), IsEmpty());
}

}  // namespace
}  // namespace heatsoak
