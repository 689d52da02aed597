#include "base/diagnostic.h"

#include <gtest/gtest.h>

#include "base/parameter.h"

namespace heatsoak::base {
namespace {

const std::vector<std::string> kKeys{"torque_constant", "speed_constant", "terminal_resistance", "mass", "length"};

TEST(DidYouMean, names_the_nearest) {
  EXPECT_EQ(did_you_mean("torque_constnat", kKeys), "; did you mean 'torque_constant'?");
  EXPECT_EQ(did_you_mean("torqueconstant", kKeys), "; did you mean 'torque_constant'?");
  EXPECT_EQ(did_you_mean("masss", kKeys), "; did you mean 'mass'?");
  EXPECT_EQ(did_you_mean("lenght", kKeys), "; did you mean 'length'?");
}

TEST(DidYouMean, looks_past_capitals_and_what_was_left_out) {
  EXPECT_EQ(did_you_mean("TORQUE_CONSTANT", kKeys), "; did you mean 'torque_constant'?");
  const std::vector<std::string> ids{"roboteam_twente_v2022", "roboteam_twente_v2024", "tigers_v2020"};
  EXPECT_EQ(did_you_mean("roboteam_v2024", ids), "; did you mean 'roboteam_twente_v2024'?");
}

TEST(DidYouMean, is_silent_where_nothing_is_near) {
  EXPECT_EQ(did_you_mean("colour", kKeys), "");
  EXPECT_EQ(did_you_mean("winding_limit_of_the_neighbour", kKeys), "");
  EXPECT_EQ(did_you_mean("", kKeys), "");
  EXPECT_EQ(did_you_mean("torque_constant", std::vector<std::string>{}), "");
}

TEST(DidYouMean, takes_the_nearer_of_two) {
  EXPECT_EQ(did_you_mean("speed_constnt", std::vector<std::string>{"speed_constants", "speed_constant"}),
            "; did you mean 'speed_constant'?");
}

TEST(Diagnostic, is_written_so_that_editors_jump) {
  EXPECT_EQ(to_string(Diagnostic{{"a.toml", 3, 7}, "figures.mass", "is missing"}), "a.toml:3:7: error: figures.mass: is missing");
  EXPECT_EQ(to_string(Diagnostic{{"a.toml"}, "", "cannot be read"}), "a.toml: error: cannot be read");
  EXPECT_EQ(to_string(Location{"a.toml", 3}), "a.toml:3");
  EXPECT_EQ(to_string(Diagnostic{{}, "", "no place"}), "error: no place");
}

TEST(Diagnostics, throws_all_of_them_in_the_order_of_the_file) {
  Diagnostics diagnostics;
  EXPECT_NO_THROW(diagnostics.throw_if_any());
  EXPECT_TRUE(diagnostics.empty());
  diagnostics.add({"a.toml", 9, 1}, "late", "b");
  diagnostics.add({"a.toml", 2, 5}, "early", "a");
  diagnostics.add({"a.toml", 2, 5}, "same place, later", "c");
  try {
    diagnostics.throw_if_any();
    FAIL() << "nothing was thrown";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_input);
    ASSERT_EQ(failure.diagnostics().size(), 3U);
    EXPECT_EQ(failure.diagnostics()[0].key, "early");
    EXPECT_EQ(failure.diagnostics()[1].key, "same place, later");
    EXPECT_EQ(failure.diagnostics()[2].key, "late");
    EXPECT_NE(std::string(failure.what()).find("a.toml:9:1: error: late: b"), std::string::npos);
  }
}

TEST(Range, contains_what_it_says) {
  EXPECT_FALSE(Range::positive().contains(0.0));
  EXPECT_TRUE(Range::non_negative().contains(0.0));
  EXPECT_TRUE(Range::between(1.0, 2.0).contains(2.0));
  EXPECT_FALSE(Range::between(1.0, 2.0).contains(2.0000001));
  for (const Range& range : {Range::positive(), Range::non_negative(), Range::between(0.0, 1.0), Range::any()}) {
    EXPECT_FALSE(range.contains(std::numeric_limits<double>::quiet_NaN())) << to_string(range, "A");
  }
}

TEST(Range, is_written_for_people) {
  EXPECT_EQ(to_string(Range::positive(), "A"), "more than 0 A");
  EXPECT_EQ(to_string(Range::non_negative(), ""), "at least 0");
  EXPECT_EQ(to_string(Range::between(-60.0, 400.0), "degC"), "-60 °C to 400 °C");
  EXPECT_EQ(to_string(Range::between(0.0, 1e9), "s"), "0 s to 1e+09 s") << "zeros cannot be counted";
  EXPECT_EQ(to_string(Range::any(), "A"), "any value");
}

}  // namespace
}  // namespace heatsoak::base
