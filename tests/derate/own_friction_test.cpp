// A motor that cannot turn itself continuously is refused; one that only a push would stop is not.
#include "derate/own_friction.h"

#include <gmock/gmock.h>

#include <regex>

#include "base/diagnostic.h"
#include "exported_motor.h"
#include "guarded_motor.h"

namespace heatsoak::derate {
namespace {

using testing::HasSubstr;

/// Returns a derating of a motor with this no-load current and the lasting currents √(9 − ω/50) A up to 440 rad/s.
Derating derating_with(double no_load_A, double most_speed_rad_per_s = 440.0) {
  Derating made = ecx_derating();
  made.nominal.no_load_current_A = no_load_A;
  made.reachable_speed_rad_per_s = 440.0;
  made.rules.most_speed_rad_per_s = most_speed_rad_per_s;
  made.uses.clear();
  for (const double share : {0.0, 0.3, 0.6, 0.98}) {
    const double square_A2 = 9.0 - share * most_speed_rad_per_s / 50.0;
    made.uses.push_back({.use = {share}, .intervals = {}, .time_s = {900.0}, .current_A = {std::sqrt(square_A2)}});
  }
  // Pulses state no lasting current.
  made.uses.push_back({.use = {0.6, 2.0, 4.0, 0.6}, .intervals = {}, .time_s = {900.0}, .current_A = {0.001}});
  return made;
}

TEST(OwnFriction, LastingCurrentIsComparedAtTheSpeedOfAFullBattery) {
  const OwnFriction found = own_friction(derating_with(0.5)).value();
  EXPECT_DOUBLE_EQ(found.speed_rad_per_s, 400.0);  // 440 rad/s include a push
  EXPECT_NEAR(found.lasting_A, 1.0, 1e-9);         // √(9 − 400/50)
  EXPECT_DOUBLE_EQ(found.at_standstill_A, 3.0);
  EXPECT_TRUE(found.holds());
  EXPECT_TRUE(own_friction(derating_with(0.99)).value().holds());
  EXPECT_FALSE(own_friction(derating_with(1.01)).value().holds());
}

TEST(OwnFriction, SpeedThatTheMotorHoldsIsWhereBothCurrentsAreEqual) {
  EXPECT_NEAR(own_friction(derating_with(2.0)).value().held_rad_per_s, 250.0, 1e-9);  // 9 − 250/50 = 2²
  EXPECT_EQ(own_friction(derating_with(3.5)).value().held_rad_per_s, 0.0);
}

TEST(OwnFriction, WorstHotCaseCounts) {
  Derating made = derating_with(0.5);
  UsePlayed hot = made.uses[3];
  hot.use.hot_case.current_sign = -1.0;
  hot.current_A = {0.1};
  made.uses.push_back(hot);
  EXPECT_NEAR(own_friction(made).value().lasting_A, 0.1, 1e-9);
}

TEST(OwnFriction, WithoutContinuousUsesThereIsNoAnswer) {
  Derating made = derating_with(0.5);
  made.uses.clear();
  EXPECT_FALSE(own_friction(made).has_value());
  require_own_friction(made);
}

TEST(OwnFriction, RefusalNamesBothCurrentsTheSpeedAndTheRemedy) {
  try {
    require_own_friction(derating_with(2.0));
    FAIL() << "accepted";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::limit_exceeded);
    EXPECT_THAT(failure.what(), HasSubstr("at 400 rad/s its continuous current is 1.00 A (3.00 A at standstill)"));
    EXPECT_THAT(failure.what(), HasSubstr("its no-load current of 2.00 A"));
    EXPECT_THAT(failure.what(), HasSubstr("250 rad/s with [drive] voltage_limit = \"8.2 V\""));  // 250 rad/s · 0.0328 N m/A
  }
  try {
    require_own_friction(derating_with(3.5));
    FAIL() << "accepted";
  } catch (const base::Failure& failure) {
    EXPECT_THAT(failure.what(), testing::Not(HasSubstr("voltage_limit")));
  }
}

/// Returns the ECX FLAT 32 L with another text in its file.
motor::Motor ecx_32_where(const char* pattern, const char* replacement) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_friction_{}.toml", static_cast<int>(getpid()));
  std::stringstream sheet;
  sheet << std::ifstream(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml").rdbuf();
  const std::string changed = std::regex_replace(sheet.str(), std::regex(pattern), replacement);
  EXPECT_NE(changed, sheet.str());
  std::ofstream(file) << changed;
  motor::Motor motor = motor::read_motor(file);
  std::filesystem::remove(file);
  return motor;
}

std::string refusal_of(const motor::Motor& motor, const robot::Robot& robot) {
  DerateOptions few;
  few.guarantee.samples = 60;
  try {
    static_cast<void>(derate(motor, robot, few));
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::limit_exceeded);
    return failure.what();
  }
  return "accepted";
}

TEST(OwnFriction, MotorWithMuchFrictionIsRefused) {
  const motor::Motor rough =
      ecx_32_where("(no_load_current = \\{ value = \")0.25 A(.*range = \\[\")0.15 A\", \"0.45 A", "$012.6 A$022.2 A\", \"3.3 A");
  EXPECT_THAT(refusal_of(rough, twente()), HasSubstr("its no-load current of 2.60 A"));
}

TEST(OwnFriction, MotorWithALowLimitIsRefusedUnlessItTurnsSlowlyEnough) {
  const motor::Motor cold = ecx_32_where("(winding_limit = \\{ value = \")155 degC", "$0145 degC");
  const std::string refused = refusal_of(cold, twente());
  EXPECT_THAT(refused, HasSubstr("its no-load current of 0.25 A"));
  std::smatch limit;
  ASSERT_TRUE(std::regex_search(refused, limit, std::regex("voltage_limit = \"([0-9.]+) V\""))) << refused;
  robot::Robot slow = twente();
  slow.drive.voltage_limit_V = std::stod(limit[1]);
  EXPECT_EQ(refusal_of(cold, slow), "accepted");
}

}  // namespace
}  // namespace heatsoak::derate
