// The winding temperature as a line of block characters.
#include <gtest/gtest.h>

#include "present/evaluation.h"

namespace heatsoak::present {
namespace {

select::MotorEvaluation heating_to(double peak_C) {
  select::MotorEvaluation motor;
  motor.winding_limit_C = 125.0;
  for (int i = 0; i <= 800; ++i) {
    motor.curves.time_s.push_back(i);
    motor.curves.winding_C.push_back(25.0 + (peak_C - 25.0) * i / 800.0);
  }
  return motor;
}

TEST(Sparkline, rises_with_the_winding_from_ambient_to_limit) {
  EXPECT_EQ(sparkline(heating_to(125.0), 25.0), "▁▂▃▄▅▆▇█");
  EXPECT_EQ(sparkline(heating_to(25.0), 25.0), "▁▁▁▁▁▁▁▁");
  EXPECT_EQ(sparkline(heating_to(1000.0), 25.0), "████████");
  EXPECT_EQ(sparkline(select::MotorEvaluation{}, 25.0), "");
}

}  // namespace
}  // namespace heatsoak::present
