#include "duty/duty_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace heatsoak::duty {
namespace {

using testing::ElementsAre;

struct Written {
  std::vector<std::string> lines;
  DutyRows::Put put() {
    return [this](std::string_view text) { lines.emplace_back(text); };
  }
};

// Two moments make one row. Torques of 1 and −7 have the RMS 5 and the sign of their mean. The mean speeds are 2 and −3.
TEST(DutyRows, are_put_out_as_soon_as_they_are_whole) {
  Written written;
  DutyRows rows(2, DutyKind::torque, 0.02, written.put());
  rows.add(0.01, std::vector{1.0, -7.0}, std::vector{1.0, -2.0});
  EXPECT_EQ(written.lines.size(), 1U);
  rows.add(0.01, std::vector{-7.0, 1.0}, std::vector{3.0, -4.0});
  EXPECT_EQ(written.lines.size(), 2U);
  rows.add(0.01, std::vector{0.5, 0.25}, std::vector{1.0, 1.0});
  EXPECT_EQ(written.lines.size(), 2U);
  rows.finish();
  EXPECT_THAT(written.lines, ElementsAre("time_s,torque_1_Nm,speed_1_rad_per_s,torque_2_Nm,speed_2_rad_per_s\n", "0,-5,2,-5,-3\n",
                                         "0.02,0.5,1,0.25,1\n", "0.03,0,0,0,0\n"));
}

TEST(DutyRows, of_a_current_name_a_current) {
  Written written;
  DutyRows rows(1, DutyKind::current, 0.02, written.put());
  rows.add(std::vector{constant_bin(4.0, 0.0, 62.0, 6.0)});
  rows.add(std::vector{constant_bin(1.0, 0.0, 62.0, -3.0)});
  rows.finish();
  EXPECT_THAT(written.lines, ElementsAre("time_s,current_1_A,speed_1_rad_per_s\n", "0,6,62\n", "4,-3,62\n", "5,0,0\n"));
}

}  // namespace
}  // namespace heatsoak::duty
