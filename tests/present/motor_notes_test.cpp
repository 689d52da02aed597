// Notes about the tolerances of a motor file.
#include "present/motor_notes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motor/read_motor.h"
#include "support/source_folder.h"

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

}  // namespace
}  // namespace heatsoak::present
