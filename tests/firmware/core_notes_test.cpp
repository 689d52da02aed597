// Findings about a drive core, and one sentence for every kind of them.
#include "firmware/core_notes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "derate/guarded_motor.h"
#include "support/shipped.h"

namespace heatsoak::firmware {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;
using testing::Not;
using testing::VariantWith;

derate::Derating any_derating(const motor::Motor& motor) {
  return derate::derating_of(derate::GuardedMotor(motor, derate::rules_for(motor), 1.5));
}

TEST(CoreNotes, MissingFrictionIsNoted) {
  const motor::Motor motor = ecx_32();
  const derate::Derating derating = any_derating(motor);
  robot::Robot robot = twente();
  EXPECT_THAT(notes_on(robot, motor, derating, 0.0), IsEmpty());
  for (const robot::RobotParameterSpec& each : robot::robot_parameter_specs()) {
    if (each.table.starts_with("friction")) {
      each.value.of(robot).reset();
    }
  }
  robot.friction.heading.wheels.clear();
  EXPECT_THAT(notes_on(robot, motor, derating, 0.0),
              ElementsAre(VariantWith<FrictionUnknown>(Field(&FrictionUnknown::robot_file, robot.file.filename().string()))));
}

TEST(CoreNotes, AFullStopThatTakesMuchOfTheCurrentIsNoted) {
  const motor::Motor motor = ecx_32();
  const derate::Derating derating = any_derating(motor);
  const double room_K = derating.rules.limits.winding_C - derating.rules.hottest_ambient_C;
  EXPECT_THAT(notes_on(twente(), motor, derating, 0.24 * room_K), Not(Contains(VariantWith<StopTakesCurrent>(testing::_))));
  EXPECT_THAT(notes_on(twente(), motor, derating, 0.26 * room_K),
              Contains(VariantWith<StopTakesCurrent>(
                  testing::AllOf(Field(&StopTakesCurrent::stop_K, 0.26 * room_K), Field(&StopTakesCurrent::room_K, room_K)))));
}

TEST(CoreNotes, StatedConditionsAreNoted) {
  motor::Motor motor = ecx_32();
  const derate::Derating derating = any_derating(motor);
  motor.assumed["mounting"] = "flange";
  EXPECT_THAT(notes_on(twente(), motor, derating, 0.0),
              ElementsAre(VariantWith<ConditionStated>(
                  testing::AllOf(Field(&ConditionStated::key, "mounting"), Field(&ConditionStated::value, "flange")))));
}

TEST(CoreNotes, DoubtfulValuesAreNotedAndUnsafe) {
  const motor::Motor motor = ecx_32();
  derate::Derating derating = any_derating(motor);
  derating.measured_power = motor::HeatInput::power_balance;
  derating.unmodelled_heat_share = 0.08;
  derating.doubtful_values = {{}};
  const std::vector<CoreNote> notes = notes_on(twente(), motor, derating, 0.0);
  EXPECT_THAT(notes, ElementsAre(VariantWith<ValueDoubtful>(testing::_),
                                 VariantWith<FittedToPower>(Field(&FittedToPower::heat, motor::HeatInput::power_balance)),
                                 VariantWith<HeatUnmodelled>(Field(&HeatUnmodelled::share, 0.08))));
  EXPECT_THAT(notes, testing::Each(testing::Truly(is_unsafe)));
  EXPECT_FALSE(is_unsafe(FrictionUnknown{"mine.toml"}));
}

TEST(CoreNotes, EveryKindHasItsSentence) {
  using motor::LintFact;
  const std::vector<std::pair<CoreNote, const char*>> sentences{
      {FittedToPower{motor::HeatInput::input_power},
       "the guard may allow too much current, because the thermal values were fitted to heat from measured power (input_power), which the "
       "core does not measure: a loss that only the power showed is left out"},
      {ValueDoubtful{
           {{}, "density", {motor::LintWords::no_spread, {LintFact(std::string("mass")), LintFact(std::string("1 kg"))}}, {}, {}}},
       "the guard may allow too much current, because a value of the motor's file is doubtful: density: mass of 1 kg has neither tolerance "
       "nor range; expected one of the two (see motor_db/README.md). Until then a default by its origin is assumed"},
      {HeatUnmodelled{0.08},
       "the guard may allow too much current, because the calibration found heat that the model lacks, 8 % of the mean heat of its runs or "
       "more; `heatsoak diagnose` searches for the missing effect"},
      {FittedUnder{{"fan=on", "cover=off"}},
       "the guard may allow too much current without fan=on cover=off, because all runs that the motor's values were fitted to had it; if "
       "it "
       "always holds, state it (--condition fan=on --condition cover=off)"},
      {FrictionUnknown{"mine.toml"},
       "feed-forward of friction is off, so the wheels lag until their integrators have compensated it: mine.toml has no [friction]; "
       "measure it with `heatsoak friction`"},
      {InputNotMeasured{derate::observed::vehicle_speed, {"wind", "fan"}},
       "wind, fan depends on the robot's speed through the air, which the core does not know: it uses the speed with the most heating, "
       "still air if wind cools"},
      {InputNotMeasured{derate::observed::neighbour, {"next"}},
       "next depends on the neighbouring motors: the core uses the hottest of the other wheels' guards"},
      {InputNotMeasured{derate::observed::age, {}},
       "the motor's thermal law depends on operating hours, which the core does not know: it uses the age with the most "
       "heating"},
      {ColumnUnknown{"curve", "gripper_ratio"},
       "curve depends on gripper_ratio of the logs, which the core does not know: it uses the value with the most heating"},
      {SpreadsAssumed{{{"resistance", base::Origin::datasheet, 2.0, {base::Spread::Kind::range, 1.0, 3.0, false}}}},
       "the motor's file gives no tolerance for these values, defaults by origin are assumed: resistance -50 to +50 % (datasheet)"},
      {ConditionStated{"mounting", "flange"}, "the guard is valid only if mounting is flange, as stated with --condition"},
      {StopTakesCurrent{40.0, 115.0, 40.0},
       "the robot drives with less current than the motor could carry, because one full stop heats the winding by 40 K of the 115 K "
       "between air of 40 °C and its limit; a lower limits.speed or limits.braking in the robot file helps"},
      {ShadowModeChosen{},
       "the guard limits no current, so a motor can overheat: --shadow only counts what it would have limited; generate the core again "
       "without --shadow before a match"},
  };
  std::set<std::size_t> kinds;
  for (const auto& [note, words] : sentences) {
    EXPECT_EQ(to_string(note), words);
    kinds.insert(note.index());
  }
  EXPECT_EQ(kinds.size(), std::variant_size_v<CoreNote>);
}

}  // namespace
}  // namespace heatsoak::firmware
