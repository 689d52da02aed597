// Wording of the findings of friction tests: one sentence for every kind of finding.
#include "present/measured/friction_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "friction/friction_job.h"
#include "friction/robot_file.h"
#include "sentences_of_kinds.h"

namespace heatsoak::present {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(WordsOfFriction, Suspicions) {
  using namespace friction;
  expect_words<FrictionSuspicion>({
      {recording::AngleSpansDegrees{"yaw_rad", 359.0},
       "yaw_rad spans 359 rad: is it in degrees? If so, state unit = \"deg\" in a mapping (--map)"},
      {DirectionDiffers{90.2},
       "the direction of travel is 90° off the direction that follows from the wheels' speeds: are the wheels in another order than in the "
       "robot's file, or is an angle in degrees or in another frame?"},
      {SpeedsContradict{0.31},
       "31 % of the wheels' speeds fit no motion of the robot: do their order or signs differ from the robot's file?"},
      {VoltageFallsWithSpeed{}, "voltage falls as the wheels turn faster: does one of them have the wrong sign?"},
      {DampingDiffersFromBackEmf{9.5},
       "d (voltage per speed) is 9.5 times the motor's back-EMF, expected 1 to 2 times: is a speed in rpm or of the wheel, a modulation in "
       "percent, a voltage in millivolts, or is it another motor?"},
      {MoreWheelsThanRobot{4, 3}, "the log has values of wheel 4, but the robot's file has 3 wheels: is it the log of another robot?"},
      {WheelWithoutVoltage{2}, "wheel 2 turns with hardly any voltage: is its modulation missing from the log?"},
      {WheelVoltageFallsWithSpeed{2}, "voltage of wheel 2 falls as it turns faster: does its speed or its modulation have the wrong sign?"},
      {FrictionDrivesWheel{2, -0.5, -1.25},
       "friction of wheel 2 would drive it (a = -0.5 V, b = -1.2 V): is its modulation that of another wheel, or of the wrong sign?"},
      {WheelVoltageUnexplained{2, 0.456},
       "voltage of wheel 2 hardly follows its speed and direction (R² 0.46): is its modulation that of another wheel?"},
      {WheelDampingDiffers{2, 4.0},
       "the fitted voltage per speed (d) of wheel 2 is 4 times the back-EMF of the motor, expected 1 to 2 times: is its speed or "
       "modulation in another unit?"},
  });
  EXPECT_THAT(words_of(std::vector<SuspicionOfTest>{{"run1", recording::PowerOppositeToBus{}}, {"", VoltageFallsWithSpeed{}}}),
              ElementsAre("run1: power_in_W and bus_V × bus_A have opposite signs: is the sign of one of them wrong? If so, state sign = "
                          "\"-\" in a mapping (--map)",
                          "voltage falls as the wheels turn faster: does one of them have the wrong sign?"));
}

TEST(WordsOfFriction, ProblemsOfWheels) {
  using enum friction::WheelProblem;
  EXPECT_EQ(words_of(hardly_turns), "it hardly turns in any steady leg");
  EXPECT_EQ(words_of(constant_voltage), "its voltage is the same in all legs");
  EXPECT_THAT(words_of(one_speed), HasSubstr("drive at two speeds or more"));
  EXPECT_THAT(words_of(too_few_headings), HasSubstr("drive at least six directions all around"));
  EXPECT_EQ(words_of(too_few_legs), "it has too few steady legs");
  EXPECT_EQ(words_of(friction::Repeats::legs_on_one_heading), "legs on one heading");
  EXPECT_EQ(words_of(friction::Repeats::speeds_of_one_leg), "speeds of one leg");
  EXPECT_EQ(words_of(friction::Repeats::neighbouring_headings), "neighbouring headings");
  EXPECT_EQ(words_of(friction::ExpectedFrom::robot_file), "the robot's file");
  EXPECT_EQ(words_of(friction::ExpectedFrom::motor_data_sheet), "the motor's data sheet");
}

}  // namespace
}  // namespace heatsoak::present
