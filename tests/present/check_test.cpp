// The answer of `check` on terminals of several widths.
#include "present/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <sstream>

#include "present/renderer.h"
#include "present/wrap.h"

namespace heatsoak::present {
namespace {

using testing::HasSubstr;

class CheckAnswer : public testing::Test {
 protected:
  CheckAnswer() {
    checks_[0].name = "robot at the tournament";
    checks_[1].name = "second";
    add(0, "winding_peak_p95", 100.0, 90.0, true, "");
    outcomes_.back().measured->detail =
        "nominal 47.0 °C, median 47.2 °C, 500 samples of all declared tolerances and the wheel front_left of it, 10 A";
    add(0, "current_margin", 1.0, 0.5, true, "0.5 A is below the limit of 1 A");
    outcomes_.back().measured->detail = "hottest wheel";
    add(1, "derating_excess", 0.0, std::numeric_limits<double>::quiet_NaN(), false, "guard.h:3:1: has no table");
  }

  void add(std::size_t check, std::string_view threshold, double limit, double value, bool is_evaluated, std::string reason) {
    check::Outcome outcome;
    outcome.check = &checks_.at(check);
    outcome.limit = {check::find_threshold(threshold), limit, "", "", {"/repository/robot.toml", 10, 5}};
    outcome.measured = is_evaluated ? std::optional(check::Measured{value, 0.0, ""}) : std::nullopt;
    outcome.passed = reason.empty();
    outcome.reason = std::move(reason);
    outcomes_.push_back(std::move(outcome));
  }

  std::array<check::Check, 2> checks_;
  std::vector<check::Outcome> outcomes_;
};

TEST_F(CheckAnswer, fits_the_terminal) {
  for (const std::size_t width : {60U, 80U, 140U}) {
    std::istringstream lines(terminal_text(check_document(outcomes_, false), {.width = width}));
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(width_of(line), width) << line;
    }
  }
}

TEST_F(CheckAnswer, says_what_failed_and_why) {
  const std::string text = terminal_text(check_document(outcomes_, false), {.width = 80});
  EXPECT_TRUE(text.starts_with("1 limit of 3 does not hold; 1 limit of 3 cannot be evaluated")) << text;
  for (const char* said : {"ok    winding_peak_p95", "FAIL  current_margin", "ERROR  derating_excess",
                           "/repository/robot.toml:10:5: 0.5 A is below", "guard.h:3:1: has no table"}) {
    EXPECT_THAT(text, HasSubstr(said));
  }
}

TEST_F(CheckAnswer, is_one_line_if_quiet) {
  EXPECT_EQ(terminal_text(check_document(outcomes_, false), {.width = 100, .is_quiet = true}),
            "1 limit of 3 does not hold; 1 limit of 3 cannot be evaluated and counts as failed\n");
}

}  // namespace
}  // namespace heatsoak::present
