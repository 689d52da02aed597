// Wording of the findings about logs: one sentence for every kind of finding.
#include "present/measured/log_words.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>
#include <utility>

#include "present/measured/log.h"
#include "recording/inspect_log.h"
#include "sentences_of_kinds.h"

namespace heatsoak::present {
namespace {

using testing::HasSubstr;

TEST(WordsOfLogs, Suspicions) {
  using namespace recording;
  expect_words<Suspicion>({
      {CurrentTooLarge{"current_A", 8004.0},
       "current_A reaches 8000 A: is it in milliamperes? If so, state unit = \"mA\" in a mapping (--map)"},
      {PowerDiffersFromBus{0.001},
       "power_in_W is 0.001 times bus_V × bus_A: is one of them in another unit? If so, state unit = \"…\" in a mapping (--map)"},
      {PowerOppositeToBus{},
       "power_in_W and bus_V × bus_A have opposite signs: is the sign of one of them wrong? If so, state sign = \"-\" in a mapping "
       "(--map)"},
      {TorqueOppositeToCurrent{},
       "torque_Nm and current_A have opposite signs: is the sign of one of them wrong? If so, state sign = \"-\" in a mapping (--map)"},
      {SpeedTooLarge{"speed_rad_per_s", 5000.0},
       "speed_rad_per_s reaches 5000 rad/s: is it in rpm (524 rad/s) or degrees per second (87.3 rad/s)? If so, state unit = \"rpm\" in a "
       "mapping (--map)"},
      {ShaftPowerExceedsInput{7.64},
       "torque_Nm × speed_rad_per_s is 7.64 times power_in_W, more than the input: is the speed in rpm (÷ 9.55) or degrees per second (÷ "
       "57.3)? If so, state unit = \"rpm\" in a mapping (--map)"},
      {AngleSpansDegrees{"yaw_rad", 359.0}, "yaw_rad spans 359 rad: is it in degrees? If so, state unit = \"deg\" in a mapping (--map)"},
      {WheelRowsFarApart{20.0},
       "the speeds of wheels are 20 s apart: is the time in milliseconds? If so, state unit = \"ms\" in a mapping (--map)"},
      {ModulationAboveOne{"wheel_modulation_ratio_1", 97.0},
       "wheel_modulation_ratio_1 reaches 97: is it in percent or in counts of a timer? 1 is the whole battery voltage. If so, scale it "
       "with an expression in a mapping (--map)"},
      {VoltageTooLarge{"battery_V", 24000.0},
       "battery_V reaches 24000 V: is it in millivolts? If so, state unit = \"mV\" in a mapping (--map)"},
      {LastsForDays{8.64e5, 1000.0, TimeUnit::milliseconds},
       "the log lasts 10 days at 1000 s per row: is the time in milliseconds? If so, state unit = \"ms\" in a mapping (--map)"},
      {LastsForDays{8.64e8, 1e6, TimeUnit::microseconds},
       "the log lasts 10000 days at 1000000 s per row: is the time in microseconds? If so, state unit = \"us\" in a mapping (--map)"},
      {FallsTooFast{"stator_C", 1.0 / 60.0, 10.0, 2.5, TimeUnit::minutes},
       "the rows are 0.0167 s apart and stator_C falls by 10 K in 2.5 s: is the time in minutes? If so, state unit = \"min\" in a mapping "
       "(--map)"},
      {RespondsEarly{"winding_C", "current_A", -1.0, 0.2, true},
       "winding_C responds 1 s ± 0.2 s before current_A changes, so one of their clocks is off; in a mapping give current_A and all "
       "columns "
       "logged with it clock_offset = \"-1 s\", or inputs = \"previous_interval\" if a row's inputs describe the interval before it"},
      {RespondsEarly{"winding_C", "current_A", -4.0, 0.2, false},
       "winding_C responds 4 s ± 0.2 s before current_A changes, so one of their clocks is off; in a mapping give current_A and all "
       "columns "
       "logged with it clock_offset = \"-4 s\""},
      {RespondsEarly{"winding_C", "current_A", -980.0, 288.7, false},
       "winding_C responds 980 s ± 290 s before current_A changes, so one of their clocks is off; in a mapping give current_A and all "
       "columns logged with it clock_offset = \"-980 s\""},
      {ConstantSensor{"winding_C", 25.0, "stator_C", 31.2},
       "winding_C is constant, 25 °C, while stator_C changes by 31.2 K: is its sensor connected? If not, leave its column out of a mapping "
       "(--map)"},
      {ConstantHeatInput{"current_A", "A", 3.0, 10.0, 9},
       "current_A is constant, 3 A, while winding_C rises and falls 9 times by 10 K or more above stator_C: is its sensor connected? If "
       "not, leave its column out of a mapping (--map)"},
      {StaysAtLimit{"current_A", "A", 3.0, 250, 1000},
       "current_A stays at exactly 3 A in 25 % of its rows: is the sensor saturated? If so, state saturates_high or saturates_low in a "
       "mapping (--map)"},
      {AmbientAboveMotor{"stator_C", 12.0},
       "ambient_C is hotter than stator_C most of the time (by 12 K): are the channels swapped? If so, swap their columns in a mapping "
       "(--map)"},
      {FallsWhileHeated{"winding_C", "current_A"},
       "winding_C falls while current_A heats and rises while it rests: is the sign of the sensor wrong? If so, correct it with an "
       "expression in a mapping (--map)"},
      {StatorRespondsFaster{"current_A", 90.0, 30.0},
       "stator_C responds to current_A faster than winding_C and varies more (90 K against 30 K): are the two swapped? If so, swap their "
       "columns in a mapping (--map)"},
      {StatorHotterAtRest{8.0},
       "without heat, stator_C is hotter than winding_C (by 8 K) and falls by more: are the two swapped? If so, swap their columns in a "
       "mapping (--map)"},
      {StatorWarmsFirst{"current_A", 30.0, 20.0},
       "at standstill current_A heats stator_C by 30 K while winding_C is 20 K cooler: are the two swapped, or is a sensor elsewhere? If "
       "so, swap their columns in a mapping (--map)"},
      {StartsInOtherScale{"stator_C", 220.0, 22.0, TemperatureScale::tenths_of_degrees},
       "stator_C starts at 220 °C: is it in tenths of degrees (22 °C)? If so, divide it by 10 with an expression in a mapping (--map)"},
      {StartsInOtherScale{"stator_C", 295.2, 22.06, TemperatureScale::kelvin},
       "stator_C starts at 295.2 °C: is it in kelvin (22.1 °C)? If so, state unit = \"K\" in a mapping (--map)"},
      {StartsInOtherScale{"ambient_C", 71.6, 22.0, TemperatureScale::fahrenheit},
       "ambient_C starts at 71.6 °C: is it in degrees Fahrenheit (22 °C)? If so, state unit = \"degF\" in a mapping (--map)"},
      {MotorStartsInFahrenheit{"winding_C", 71.6, 22.0, 21.0},
       "winding_C and the motor's other temperatures start at 71.6 °C in air of 21 °C: are they in degrees Fahrenheit (22 °C)? If so, "
       "state unit = \"degF\" in a mapping (--map)"},
      {MotorCoolsInFahrenheit{"winding_C", 71.6, 22.0, 21.0},
       "winding_C reaches a steady state of 71.6 °C without heat, in air of 21 °C: are the motor's temperatures in degrees Fahrenheit (22 "
       "°C)? If so, state unit = \"degF\" in a mapping (--map)"},
  });
  EXPECT_EQ(words_of(SuspicionOfLog{"run1", PowerOppositeToBus{}}),
            "run1: power_in_W and bus_V × bus_A have opposite signs: is the sign of one of them wrong? If so, state sign = \"-\" in a "
            "mapping (--map)");
}

TEST(WordsOfLogs, LacksDelaysAndNotes) {
  using namespace recording;
  expect_words<Lack>({
      {TooFewRows{1, 20}, "it has 1 row; at least 20 are needed"},
      {NoTemperature{}, "it has no temperature of the motor (winding_C, stator_C, …)"},
      {NoHeatInput{}, "it has no heat input (current_A, power_in_W, torque_Nm, speed_rad_per_s, …)"},
      {TemperatureIsConstant{"winding_C", 25.0}, "winding_C is constant, 25 °C"},
      {TemperatureWithinNoise{"winding_C", 24.1, 25.3, 0.31},
       "no temperature changes by more than its noise: winding_C from 24.1 °C to 25.3 °C, noise 0.31 K"},
      {HeatInputIsZero{"current_A"}, "there is no heat input: current_A is 0 throughout"},
      {NoWheelSpeed{}, "it has no speeds of wheels (wheel_speed_rad_per_s_1, …)"},
      {WheelsKeepSpeed{}, "no wheel changes its speed beyond the noise"},
      {NoWheelEffort{}, "it has no effort of wheels (wheel_modulation_ratio_1, wheel_voltage_V_1 or wheel_current_A_1, …)"},
  });
  expect_words<NoDelayReason>({
      {IntervalsTooShort{}, "the intervals without a gap are too short"},
      {NoBestDelay{10.0}, "no delay within ± 10 s gives a best fit"},
      {PartsDisagree{3.21}, "parts of the log disagree by 3.2 s"},
  });
  expect_words<ReadingNote>({
      {ColumnWithoutUnit{5, "comment"}, "column 5 'comment' is not used: its name does not end in a unit"},
      {AdditionalSignal{"stator_F"},
       "stator_F is used as an additional signal; did you mean 'stator_C'? A column in another unit is read with a mapping "
       "(--map)"},
      {AdditionalSignal{"windin_C"}, "windin_C is used as an additional signal; did you mean 'winding_C'?"},
      {NotRecorded{"coolant_C", "T_cool"}, "coolant_C is not recorded: no column 'T_cool'"},
      {ChannelWithoutNumbers{"stator_C", 1800}, "stator_C is left out: not one number in 1800 rows"},
      {BlanksFilled{"power_in_W", 1}, "power_in_W: 1 blank samples are filled as the mapping states"},
  });
}

/// Delays of all sizes are printed in decimal notation, with their sign.
TEST(WordsOfLogs, DelaysOfClocks) {
  for (const auto& [delay_s, words] :
       {std::pair(-980.0, "by -980 s ± 290 s"), std::pair(30000.0, "by +30000 s ± 290 s"), std::pair(-0.036, "by -0.036 s ± 290 s")}) {
    recording::InspectedLog log;
    recording::ClockOffset& offset = log.quality.clock_offsets.emplace_back();
    offset.temperature = "winding_C";
    offset.heat_input = "current_A";
    offset.delay_s = delay_s;
    offset.delay_uncertainty_s = 288.7;
    const Document document = logs_document(std::span(&log, 1));
    ASSERT_FALSE(document.tables.empty());
    EXPECT_THAT(document.tables.front().rows.back().back().words, HasSubstr(fmt::format("winding_C follows current_A {}", words)));
  }
}

}  // namespace
}  // namespace heatsoak::present
