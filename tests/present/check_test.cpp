// The answer of `check` on terminals of several widths.
#include "present/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
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
    add(0, "winding_peak_p95", 100.0).measured = {
        .value = 90.0,
        .basis =
            check::PeakBasis{.p95_C = 80.0, .bound_C = 90.0, .nominal_C = 47.0, .median_C = 47.2, .samples = 500, .wheel = "front_left"}};
    add(0, "current_margin", 1.0).measured = {.value = 0.5, .basis = check::MarginBasis{3.0}};
    add(1, "derating_excess", 0.0).reason =
        check::Failed{base::Failure(base::ExitCode::bad_input, "", {{{"guard.h", 3, 1}, {}, "has no table"}})};
  }

  check::Outcome& add(std::size_t check, std::string_view threshold, double limit) {
    outcomes_.push_back(
        {.check = &checks_.at(check), .limit = {check::find_threshold(threshold), limit, "", "", {"/repository/robot.toml", 10, 5}}});
    return outcomes_.back();
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
