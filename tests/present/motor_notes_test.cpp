// Notes about the tolerances of a motor file, and about effects whose inputs a prediction does not know.
#include "present/motor_notes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "check/threshold.h"
#include "derate/guarded_motor.h"
#include "motor/read_motor.h"
#include "present/check.h"
#include "present/evaluation.h"
#include "present/match.h"
#include "present/steady.h"
#include "support/shipped.h"

namespace heatsoak::present {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// The user of a calibrated file cannot state better intervals than the calibration.
TEST(DefaultSpreadsText, AdviceForAFitAsksForNoChangeOfTheFile) {
  motor::Motor motor = motor::read_motor(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml");
  base::ParameterValue& fitted = motor.parameters.at("thermal_resistance_stator_ambient");
  fitted.origin = base::Origin::measured;
  fitted.spread = base::Spread{base::Spread::Kind::range, 0.999 * fitted.value, 1.001 * fitted.value, true};
  base::ParameterValue& stated = motor.parameters.at("terminal_resistance");
  stated.spread.reset();
  motor.fit = motor::MotorFit{};
  motor.fit->parameters = {"thermal_resistance_stator_ambient"};
  const std::string text = default_spreads_text({&motor, 1});
  const std::string of_file = text.substr(0, text.find('\n'));
  const std::string of_fit = text.substr(text.find('\n') + 1);
  EXPECT_THAT(of_file, AllOf(HasSubstr("terminal_resistance"), HasSubstr("state the real ones"), Not(HasSubstr("stator_ambient"))));
  EXPECT_THAT(of_fit, AllOf(HasSubstr("thermal_resistance_stator_ambient"), HasSubstr("the file needs no change")));
}

// A duty states current and speed; a fit to measured power may contain losses that these do not show.
TEST(DoubtfulFits, StateWhenThermalValuesHoldForMeasuredPower) {
  motor::Motor motor = motor::read_motor(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml");
  motor.fit = motor::MotorFit{};
  for (const motor::HeatInput heat : {motor::HeatInput::input_power, motor::HeatInput::power_balance}) {
    motor.fit->heat_input = heat;
    EXPECT_THAT(value_warnings({&motor, 1}), AllOf(HasSubstr(std::string(motor::name_of(heat))), HasSubstr("may be too low")));
  }
  for (const motor::HeatInput heat : {motor::HeatInput::current, motor::HeatInput::torque}) {
    motor.fit->heat_input = heat;
    EXPECT_EQ(value_warnings({&motor, 1}), "");
  }
  motor.fit->heat_input.reset();
  EXPECT_EQ(value_warnings({&motor, 1}), "");
}

// 0.15 K/W instead of 1.5 K/W: such a motor would pass everything.
TEST(DoubtfulValues, AreWarningsAboutThatMotor) {
  motor::Motor motor = motor::read_motor(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml");
  motor.parameters.at("thermal_resistance_stator_ambient").value *= 0.01;
  motor::refresh_values(motor);
  EXPECT_THAT(value_warnings({&motor, 1}), AllOf(HasSubstr(motor.id), HasSubstr("from stator to ambient"), HasSubstr("check both")));
}

// Programs read the JSON only.
TEST(DoubtfulFits, AreWarningsInTheJsonOfEveryPrediction) {
  motor::Motor motor = motor::read_motor(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml");
  motor.fit = motor::MotorFit{};
  motor.fit->heat_input = motor::HeatInput::input_power;
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml");
  const robot::Robot robot = shipped_robot("roboteam_twente_v2024");
  check::Check check;
  check.motor = motor;
  const std::vector<check::Outcome> outcomes(2, {.check = &check, .limit = {check::find_threshold("current_margin"), 1.0, "", "", {}}});
  simulate::EvaluationJob job;
  job.robot = robot;
  job.duty = duty;
  job.motors = {motor};
  job.samples = 0;
  for (const Document& document :
       {steady_document(motor::under_on_off_current(motor, {.current_on_A = 2.0, .time_on_s = 1.0, .time_off_s = 1.0, .ambient_C = 25.0})),
        evaluation_document(simulate::run_evaluation(job)),
        load_simulation_document(select::simulate_load({.robot = robot, .motor = motor, .duty = duty}), {}),
        check_document(outcomes, false)}) {
    EXPECT_EQ(std::ranges::count_if(
                  document.data.at("warnings"),
                  [](const Json& each) { return each.get<std::string>().find("fitted to heat from measured power") != std::string::npos; }),
              1)
        << document.data.at("schema");
  }
}

TEST(MotorNotes, TheNeighbourIsKnownOnlyWithAllMotorsOfARobot) {
  const motor::Motor motor = derate::ecx_32_with(
      "[effects.plate]\ntype = \"neighbour_coupling\"\n"
      "conductance = { value = \"0.05 W/K\", origin = \"estimated\", derivation = \"a test\" }\n");
  EXPECT_THAT(inactive_effects({&motor, 1}), HasSubstr("plate is left out"));
  EXPECT_EQ(inactive_effects({&motor, 1}, Neighbours::known), "");
  EXPECT_THAT(inactive_effects({&motor, 1}, Neighbours::known_in_closed_loop),
              HasSubstr("plate is left out of the table and the picture without a closed loop"));
}

// A duty has no age, and the law then takes the motor as new.
TEST(MotorNotes, AnAgeingEffectIsThatOfANewMotor) {
  const motor::Motor motor = derate::ecx_32_with(
      "[effects.c]\ntype = \"contact_ageing\"\nconductance = { value = \"0.1 W/K\", origin = \"estimated\", derivation = \"a test\" }\n"
      "time_constant = { value = \"2 h\", origin = \"estimated\", derivation = \"a test\" }\n"
      "fresh_share = { value = \"1\", origin = \"estimated\", derivation = \"a test\" }\n");
  EXPECT_THAT(inactive_effects({&motor, 1}), HasSubstr("c is that of a new motor"));
}

}  // namespace
}  // namespace heatsoak::present
