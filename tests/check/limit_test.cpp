// Limits as text, and the values that --update writes.
#include "check/limit.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "check/limit_words.h"

namespace heatsoak::check {
namespace {

using testing::HasSubstr;

const ThresholdType& threshold(std::string_view name) { return *find_threshold(name); }

TEST(Limit, IsReadInTheUnitOfItsThreshold) {
  EXPECT_DOUBLE_EQ(parse_limit("at most 150 degC", threshold("winding_peak_p95")).value, 150.0);
  EXPECT_NEAR(parse_limit("  at most   302 degF ", threshold("winding_peak_p95")).value, 150.0, 1e-9);
  EXPECT_DOUBLE_EQ(parse_limit("at most 5 %", threshold("probability_over_limit")).value, 0.05);
  EXPECT_DOUBLE_EQ(parse_limit("at most 2 min", threshold("time_above")).value, 120.0);
  EXPECT_DOUBLE_EQ(parse_limit("at least -500 mA", threshold("current_margin")).value, -0.5);
  EXPECT_DOUBLE_EQ(parse_limit("at most 400 kbyte", threshold("core_size")).value, 4e5);
  EXPECT_EQ(parse_limit("at most 302 degF", threshold("winding_peak_p95")).unit, "degF");
  EXPECT_EQ(parse_limit("at most 1", threshold("rank")).unit, "");
}

TEST(Limit, ThatIsNoneSaysWhatWasExpected) {
  const auto problem = [](std::string_view text, std::string_view name) {
    const std::optional<LimitProblem> found = parse_limit(text, threshold(name)).problem;
    return found ? words_of(*found, threshold(name)) : "";
  };
  EXPECT_THAT(problem("150 degC", "winding_peak_p95"), HasSubstr("expected \"at most 150 degC\""));
  EXPECT_THAT(problem("below 150 degC", "winding_peak_p95"), HasSubstr("expected at most and a value"));
  EXPECT_THAT(problem("at most 70 K", "winding_peak_p95"), HasSubstr("-203 °C; expected \"at most 70 degC\""));
  EXPECT_THAT(problem("at mostly 150 degC", "winding_peak_p95"), HasSubstr("is not a limit"));
  EXPECT_THAT(problem("at most", "winding_peak_p95"), HasSubstr("does not begin with a number"));
  EXPECT_THAT(problem("at least 150 degC", "winding_peak_p95"), HasSubstr("the wrong side"));
  EXPECT_THAT(problem("at most 150", "winding_peak_p95"), HasSubstr("has no unit"));
  EXPECT_EQ(problem("at most 150 A", "winding_peak_p95"), "'A' is no unit of winding_peak_p95; expected degC");
  EXPECT_EQ(problem("at most 1.5 bananas", "winding_peak_p95"), "'bananas' is no unit of winding_peak_p95; expected degC");
  EXPECT_EQ(problem("at most 3 bananas", "time_above"), "'bananas' is no unit of time_above; expected one of s, h, min, ms, us");
  EXPECT_EQ(problem("at most 3 s", "core_size"), "'s' is no unit of core_size; expected byte");
  EXPECT_THAT(problem("at most 1 A", "rank"),
              HasSubstr("'A' is no unit of rank, which is a pure number; expected a limit such as \"at most"));
  EXPECT_THAT(problem("at most 400 K", "winding_peak_p95"), HasSubstr("an absolute temperature, 127 °C; expected \"at most 126.85 degC\""));
  EXPECT_THAT(problem("at most nan degC", "winding_peak_p95"), HasSubstr("not a finite number"));
  EXPECT_THAT(problem("at most inf degC", "winding_peak_p95"), HasSubstr("not a finite number"));
  EXPECT_THAT(problem("at most 1e999 degC", "winding_peak_p95"), HasSubstr("too large"));
  EXPECT_THAT(problem("at most 150 %", "probability_over_limit"), HasSubstr("\"at most 150 %\" is 150 %; expected 0 to 100 %"));
  EXPECT_THAT(problem("at most 5", "probability_over_limit"), HasSubstr("\"at most 5\" is 500 %; expected 0 to 100 %, such as \"at most"));
  EXPECT_THAT(problem("", "rank"), HasSubstr("is not a limit"));
}

TEST(Limit, BothSidesOfAValue) {
  EXPECT_TRUE(keeps(Bound::at_most, 150.0, 150.0));
  EXPECT_FALSE(keeps(Bound::at_most, std::nextafter(150.0, 151.0), 150.0));
  EXPECT_TRUE(keeps(Bound::at_least, 0.5, 0.5));
  EXPECT_FALSE(keeps(Bound::at_least, std::nextafter(0.5, 0.0), 0.5));
  EXPECT_FALSE(keeps(Bound::at_most, std::numeric_limits<double>::quiet_NaN(), 150.0));
  EXPECT_FALSE(keeps(Bound::at_least, std::numeric_limits<double>::quiet_NaN(), 0.5));
}

TEST(UpdatedLimit, GivesATemperatureASharesOfItsRise) {
  // Air of 25 °C and a rise of 100 K: the new limit has a margin of 5 K.
  EXPECT_EQ(updated_limit({125.0, 25.0}, threshold("winding_peak_p95"), "degC", 0.05), "at most 130 degC");
  EXPECT_EQ(updated_limit({125.0, 25.0}, threshold("winding_peak_p95"), "degF", 0.05), "at most 266 degF");
  // Without a rise the margin is that of 20 K.
  EXPECT_EQ(updated_limit({25.0, 25.0}, threshold("winding_peak_p95"), "degC", 0.05), "at most 26 degC");
  EXPECT_EQ(updated_limit({10.0, 25.0}, threshold("stator_peak_p95"), "degC", 0.05), "at most 11 degC");
  EXPECT_EQ(updated_limit({4.0, 0.0}, threshold("current_margin"), "A", 0.1), "at least 3.6 A");
  EXPECT_EQ(updated_limit({-4.0, 0.0}, threshold("current_margin"), "A", 0.1), "at least -4.4 A");
  EXPECT_EQ(updated_limit({3.0, 0.0}, threshold("rank"), "", 0.05), "at most 3");
  EXPECT_EQ(updated_limit({0.0, 0.0}, threshold("derating_excess"), "A", 0.05), "at most 0.05 A");
  EXPECT_EQ(updated_limit({0.3, 0.0}, threshold("current_margin"), "A", 0.05), "at least 0.25 A");
  EXPECT_EQ(updated_limit({0.002, 0.0}, threshold("guard_active_share"), "%", 0.05), "at most 0.3 %");
  EXPECT_EQ(updated_limit({1.0, 0.0}, threshold("probability_over_limit"), "%", 0.05), "at most 100 %");
}

// For every measured value the new limit must be valid and met.
TEST(UpdatedLimit, IsKeptByTheValueItWasMadeFrom) {
  for (const ThresholdType& type : all_thresholds()) {
    const std::string_view unit = type.is_share ? "%" : type.unit;
    for (const double margin_share : {0.0, 0.05, 1.0}) {
      for (double value = 1e-4; value < 1e6; value *= 1.37) {
        const double measured = type.is_share ? std::min(1.0, value) : type.room == Room::none ? std::ceil(value) : value;
        if (!type.range.contains(measured)) {
          continue;
        }
        const std::string text = updated_limit({measured, 0.0}, type, unit, margin_share);
        const ParsedLimit parsed = parse_limit(text, type);
        EXPECT_FALSE(parsed.problem) << type.name << " " << text;
        EXPECT_TRUE(keeps(type.direction, measured, parsed.value)) << type.name << " " << measured << " " << text;
      }
    }
  }
}

}  // namespace
}  // namespace heatsoak::check
