// Limits that a check file must not have, because they are mistakes or cannot fail.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

#include "check_files.h"

namespace heatsoak::check {
namespace {

using testing::HasSubstr;

using RefusedLimits = CheckFiles;

// A limit outside the possible range is a typing mistake and is rejected.
TEST_F(RefusedLimits, OfASenselessValueAreNamedAtTheirPlace) {
  const std::string said = message_of(kHead +
                                      "[check.limits]\n"                               // 6
                                      "winding_peak_p95 = \"at most 70 K\"\n"          // 7
                                      "stator_peak_p95 = \"at most -400 degC\"\n"      // 8
                                      "rank = \"at most 1.5\"\n"                       // 9
                                      "current_margin = \"at least 1e30 A\"\n"         // 10
                                      "lint_problems = \"at most 0.5\"\n"              // 11
                                      "time_above = \"at most 1e30 s\"\n"              // 12
                                      "derating_excess = \"at most 1e30 A\"\n"         // 13
                                      "core_size = \"at most 1e30 byte\"\n"            // 14
                                      "guard_missing_charge = \"at most 1e30 A s\"\n"  // 15
                                      "winding_peak_p95_ = \"at most 1\"\n");
  const int first = 1 + static_cast<int>(std::ranges::count(kHead, '\n'));
  const std::vector<std::string> expected{
      "winding_peak_p95: \"at most 70 K\" is an absolute temperature, -203 °C; expected \"at most 70 degC\"",
      "stator_peak_p95: \"at most -400 degC\" is out",
      "rank: \"at most 1.5\" is not a whole number",
      "current_margin: \"at least 1e30 A\" is out of range",
      "lint_problems: \"at most 0.5\" is not a whole number",
      "time_above: \"at most 1e30 s\" is out",
      "derating_excess: \"at most 1e30 A\" is out",
      "core_size: \"at most 1e30 byte\" is out",
      "guard_missing_charge: \"at most 1e30 A s\" is out"};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_THAT(said, testing::ContainsRegex(fmt::format("a.check.toml:{}:[0-9]+: error: ", first + 1 + static_cast<int>(i))));
    EXPECT_THAT(said, HasSubstr(expected[i]));
  }
}

// A limit that always holds, or that is above the motor's own, is useless as a threshold.
TEST_F(RefusedLimits, AreLooserThanTheMotorsOwn) {
  const std::string message = message_of(
      "[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"paper_intermittent\"\nmotor = \"maxon_ecx_flat_32l_48v\"\n"
      "against = [\"maxon_ecx_flat_42m_24v\", \"nanotec_df45l024048_a2\"]\n[check.limits]\nwinding_peak_p95 = \"at most 156 degC\"\n"
      "rank = \"at most 3\"\nprobability_over_limit = \"at most 100 %\"\ncurrent_margin = \"at least -0.1 A\"\n");
  EXPECT_THAT(message, HasSubstr("\"at most 156 degC\" is looser than the motor's own winding limit, 155.0 °C"));
  EXPECT_THAT(message, HasSubstr("\"at most 3\" is looser than the number of motors in 'against', 2"));
  EXPECT_THAT(message, HasSubstr("\"at most 100 %\" is looser than the largest share that a limit may permit, 99.9 %"));
  EXPECT_THAT(message, HasSubstr("\"at least -0.1 A\" is looser than the motor's own limits, 0 A"));
}

// A guard that limits nearly all the time is no harmless one. "at most 0 %" means not for one period.
TEST_F(RefusedLimits, AllowAGuardThatLimitsForMostOfTheMatch) {
  const auto message = [&](const std::string& limit) {
    return message_of(
        "[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\nduty = \"division_a_match\"\nmotor = \"maxon_ecx_flat_32l_48v\"\n"
        "[check.limits]\nguard_active_share = \"" +
        limit + "\"\n");
  };
  EXPECT_THAT(message("at most 99.9 %"), HasSubstr("\"at most 99.9 %\" is looser than half of the match, 50 %"));
  EXPECT_EQ(message("at most 50 %"), "nothing was wrong");
  EXPECT_EQ(message("at most 0 %"), "nothing was wrong");
}

TEST_F(RefusedLimits, AreLongerThanTheDuty) {
  const auto message = [&](const std::string& limit) {
    return message_of(kHead + "temperature = \"100 degC\"\n[check.limits]\ntime_above = \"at most " + limit + "\"\n");
  };
  EXPECT_THAT(message("2401 s"),
              HasSubstr(":8:14: error: check[0].limits.time_above: \"at most 2401 s\" holds always: the duration of the duty is 2400 s"));
  EXPECT_THAT(message("2400 s"), HasSubstr("\"at most 2400 s\" holds always"));
  EXPECT_THAT(message("40 min"), HasSubstr("\"at most 40 min\" holds always"));
  EXPECT_EQ(message("2399 s"), "nothing was wrong");
}

// Each bound follows from the motor, the duty or the program.
TEST_F(RefusedLimits, CannotFail) {
  const auto message = [&](const std::string& settings, const std::string& limit) {
    return message_of("[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\nmotor = \"maxon_ecx_flat_32l_48v\"\n" + settings +
                      "[check.limits]\n" + limit + "\n");
  };
  const std::string paper = "duty = \"paper_intermittent\"\n";
  EXPECT_THAT(message(paper, "stator_peak_p95 = \"at most 900 degC\""), HasSubstr("which the stator must not exceed either, 155.0 °C"));
  EXPECT_EQ(message(paper, "stator_peak_p95 = \"at most 155 degC\""), "nothing was wrong");
  EXPECT_THAT(message(paper + "temperature = \"156 degC\"\n", "time_above = \"at most 60 s\""),
              HasSubstr("'temperature' is 156.0 °C, the limit 155.0 °C; expected a 'temperature' up to that limit"));
  EXPECT_THAT(message(paper, "guard_missing_charge = \"at most 1e6 A s\""),
              HasSubstr("holds always: the largest current of all wheels during the whole duty is"));
  EXPECT_THAT(message("", "lint_problems = \"at most 10000\""), HasSubstr("holds always: the number of values in a complete motor file"));
  EXPECT_EQ(message("", "lint_problems = \"at most 3\""), "nothing was wrong");
  EXPECT_THAT(message("", "core_size = \"at most 900 kbyte\""),
              HasSubstr("is looser than twice the code of the drive core with the largest guard table"));
  EXPECT_EQ(message("", "core_size = \"at most 410 kbyte\""), "nothing was wrong");
}

TEST_F(RefusedLimits, OfABareNumberAreAnsweredWithTheLimit) {
  const std::string message = message_of(kHead + "[check.limits]\nwinding_peak_p95 = 70\nprobability_over_limit = 5\n");
  EXPECT_THAT(message, HasSubstr("winding_peak_p95: 70 is a bare number; expected a limit as text, such as \"at most 70 degC\""));
  EXPECT_THAT(message, HasSubstr("probability_over_limit: 5 is a bare number; expected a limit as text, such as \"at most 5 %\""));
}

}  // namespace
}  // namespace heatsoak::check
