// Limits that --update writes into the text of a check file.
#include "check/rewrite.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>

#include "base/files.h"
#include "support/shipped.h"

namespace heatsoak::check {
namespace {

using testing::HasSubstr;

/// Returns the check file's text after --update, if `value` was measured.
std::string updated(const std::string& limit, double value) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_rewrite_{}.check.toml", static_cast<int>(getpid()));
  const char* const basis = limit.starts_with("derating") ? "table = \"guard.h\"" : "duty = \"paper_intermittent\"";
  const std::string text = fmt::format(
      "[[check]]\nname = \"x\"\nrobot = \"roboteam_twente_v2024\"\nmotor = \"maxon_ecx_flat_42m_24v\"\n{}\n[check.limits]\n{}\n", basis,
      limit);
  base::write_file(path, text);
  const CheckFile file = read_check_file(path, {kSource / "motor_db", kSource / "robot_core/robots", kSource / "duty_profiles", kSource});
  std::filesystem::remove(path);
  const Check& check = file.checks.front();
  std::vector<Outcome> outcomes{{.check = &check, .limit = check.limits.front(), .measured = Measured{.value = value, .basis = {}}}};
  std::string after = with_new_limits(text, outcomes, 0.05);
  EXPECT_EQ(after == text, outcomes.front().before.empty()) << limit;
  return after;
}

// "No excess at all" must not become "a little" without anybody deciding it.
TEST(Rewrite, LimitOfZeroThatHoldsIsNotLoosened) {
  EXPECT_THAT(updated("derating_excess = \"at most 0 A\"", 0.0), HasSubstr("\"at most 0 A\""));
  EXPECT_THAT(updated("derating_excess = \"at most 0 mA\"", 0.0), HasSubstr("\"at most 0 mA\""));
  EXPECT_THAT(updated("current_margin = \"at least 0 A\"", 0.0), HasSubstr("\"at least 0 A\""));
}

TEST(Rewrite, OtherLimitsFollowTheValue) {
  EXPECT_THAT(updated("derating_excess = \"at most 0 A\"", 0.2), HasSubstr("\"at most 0.25 A\"")) << "it does not hold";
  EXPECT_THAT(updated("derating_excess = \"at most 1 A\"", 0.0), HasSubstr("\"at most 0.05 A\"")) << "it permitted something before";
  EXPECT_THAT(updated("current_margin = \"at least 0 A\"", 4.0), HasSubstr("\"at least 3.8 A\"")) << "tighter";
}

}  // namespace
}  // namespace heatsoak::check
