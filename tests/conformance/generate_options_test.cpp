// Options of `generate core` that change the generated folder: every accepted one compiles and passes its self-test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program_run.h"
#include "support/skip_reasons.h"

namespace heatsoak {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Words generate(const TemporaryFolder& folder, const Words& more) {
  return Words{"generate",  "core", "--robot", "roboteam_twente_v2024",          "--motor", "maxon_ecx_flat_32l_48v",
               "--samples", "60",   "--out",   (folder.path() / "core").string()} +
         more;
}

/// Returns the output of a build in the generated folder.
std::string make(const TemporaryFolder& folder, const std::string& target) {
  RunOptions options;
  options.folder = folder.path() / "core";
  options.time_limit_s = 600;
  const ProgramRun done = run_line("make " + target, options);
  EXPECT_EQ(done.exit_code, 0) << done.out << done.err;
  return done.out;
}

void expect_period_builds(const std::string& period) {
  SCOPED_TRACE(period);
  const TemporaryFolder folder;
  ASSERT_EQ(run(generate(folder, {"--period", period})).exit_code, 0);
  EXPECT_THAT(make(folder, "host"), HasSubstr("passes its self-test"));
  if (run_line("arm-none-eabi-g++ -ffreestanding -include cstdint -x c++ -fsyntax-only /dev/null").exit_code != 0) {
    GTEST_SKIP() << HEATSOAK_FAILS_CI "no arm-none-eabi-g++ with its headers";
  }
  make(folder, "firmware");
}

TEST(GenerateCorePeriod, ShortestCompilesForHostAndController) { expect_period_builds("100us"); }
TEST(GenerateCorePeriod, LongestCompilesForHostAndController) { expect_period_builds("3.57 ms"); }

TEST(GenerateCorePeriod, OneThatItsWatchdogCannotServeIsRefused) {
  for (const char* const period : {"3.571 ms", "5 ms", "12 ms", "1 s"}) {
    const TemporaryFolder folder;
    const ProgramRun done = run(generate(folder, {"--period", period}));
    EXPECT_EQ(done.exit_code, 2) << period;
    EXPECT_THAT(done.err, AllOf(HasSubstr("watchdog"), HasSubstr("expected at most 3.57 ms"))) << period;
    EXPECT_TRUE(folder.names().empty()) << period;
  }
}

TEST(GenerateCoreShadow, CountsAndLimitsNothing) {
  const TemporaryFolder plain;
  const TemporaryFolder shadow;
  const ProgramRun usual = run(generate(plain, {"--json", "-"}));
  const ProgramRun done = run(generate(shadow, {"--shadow", "--json", "-"}));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(usual.json()["shadow_mode"], false);
  EXPECT_EQ(done.json()["shadow_mode"], true);
  EXPECT_NE(usual.json()["config_check_sum"], done.json()["config_check_sum"]);
  EXPECT_THAT(done.json()["notes"][0].get<std::string>(), HasSubstr("limits no current"));
  EXPECT_EQ(done.json()["warnings"], done.json()["notes"]);
  EXPECT_TRUE(usual.json()["warnings"].empty());
  const auto text = [](const TemporaryFolder& folder, const char* path) { return content_of(folder.path() / "core" / path); };
  EXPECT_THAT(text(shadow, "README.md"), HasSubstr("**Shadow mode: the thermal guard limits no current"));
  EXPECT_THAT(text(plain, "README.md"), Not(HasSubstr("Shadow mode")));
  EXPECT_THAT(text(shadow, "core_config.h"), AllOf(HasSubstr(" --shadow"), HasSubstr(".shadow_mode = true,")));
  // The self-test drives with a guard at its limit.
  EXPECT_THAT(make(shadow, "host"), HasSubstr("passes its self-test"));
}

}  // namespace
}  // namespace heatsoak
