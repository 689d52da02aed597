// Fitted friction is written to a robot file and read back as the same voltages.
#include "friction/robot_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/files.h"
#include "input/toml_text.h"
#include "robot/body.h"
#include "support/longest_line.h"
#include "support/source_folder.h"
#include "support/wheel_friction.h"

namespace heatsoak::friction {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::filesystem::path kFile = kSource / "robot_core/robots/roboteam_twente_v2024.toml";

std::string file_text() { return base::read_file(kFile, 1'000'000); }
motor::MotorValues motor() { return motor::read_motor(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml").nominal; }

FrictionFit any_fit(const robot::Robot& robot) {
  FrictionFit fit;
  for (std::size_t i = 0; i < robot.wheels.axis_rad.size(); ++i) {
    WheelFriction& wheel = fit.wheels.emplace_back();
    const auto n = static_cast<double>(i);
    wheel.damping_V_s_per_rad = estimate_around(0.0375, 0.0004);
    wheel.sine_V = estimate_around(0.30 - 0.2 * n, 0.05);
    wheel.constant_V = estimate_around(1.1 + 0.05 * n, 0.03);
    wheel.phase_rad = estimate_around(std::remainder(-robot.wheels.axis_rad[i] + 0.03 * n, 2.0 * std::numbers::pi), 0.05);
  }
  return fit;
}

TEST(RobotFile, has_the_measured_voltages_again) {
  const robot::Robot before = robot::read_robot(kFile);
  const robot::DriveConstants drive = robot::drive_constants(before, motor());
  const FrictionFit fit = any_fit(before);
  std::vector<WrittenAsZero> notes;
  const std::string text = with_measured_friction(file_text(), before, drive, fit, "friction test, drive.csv", notes);
  EXPECT_TRUE(notes.empty());
  const robot::Robot after = robot::parse_robot(text, kFile);
  const robot::BodyConfig body = robot::make_body(after, motor());
  for (int degrees = 1; degrees < 360; degrees += 7) {
    const double heading_rad = degrees * std::numbers::pi / 180.0;
    const robot::BodyVelocity velocity{1.5 * std::cos(heading_rad), 1.5 * std::sin(heading_rad), 0.0};
    const robot::PerWheel speed_rad_per_s = robot::wheel_speeds_rad_per_s(body.kinematics, velocity);
    const robot::PerWheel torque_Nm = robot::friction_torques_Nm(body.friction, body.kinematics, velocity, speed_rad_per_s);
    for (std::size_t i = 0; i < 4; ++i) {
      if (std::abs(speed_rad_per_s[i]) > 8.0) {
        const double measured_V = fit.wheels[i].voltage_V(heading_rad, speed_rad_per_s[i]);
        EXPECT_NEAR(robot::steady_voltage_V(drive, torque_Nm[i], speed_rad_per_s[i]), measured_V, 0.004) << degrees << " wheel " << i + 1;
      }
    }
  }
}

TEST(RobotFile, keeps_everything_else_as_it_stands) {
  const robot::Robot before = robot::read_robot(kFile);
  std::vector<WrittenAsZero> notes;
  const std::string text =
      with_measured_friction(file_text(), before, robot::drive_constants(before, motor()), any_fit(before), "drive.csv", notes);
  EXPECT_THAT(text, HasSubstr("# 1 front right, 2 front left"));
  EXPECT_THAT(text, HasSubstr("\n[traction]\ncoefficient"));
  EXPECT_THAT(text, HasSubstr("rotation = { value = \"1 mN m\", origin = \"derived\""));
  EXPECT_THAT(text, Not(HasSubstr("double_angle")));
  const robot::Robot after = robot::parse_robot(text, kFile);
  for (const auto& [key, parameter] : before.parameters) {
    if (key != "friction.wheel_damping" && !key.starts_with("friction.heading")) {
      ASSERT_TRUE(after.parameters.contains(key)) << key;
      EXPECT_EQ(after.parameters.at(key).printed, parameter.printed) << key;
    }
  }
  EXPECT_EQ(after.parameters.at("friction.wheel_damping").origin, base::Origin::measured);
  const base::ParameterValue& constant = after.parameters.at("friction.heading.wheel[1].constant");
  EXPECT_EQ(constant.origin, base::Origin::measured);
  ASSERT_TRUE(constant.spread.has_value());
  EXPECT_LT(constant.spread->low, constant.value);
  // A second write must replace the entry instead of adding it again.
  EXPECT_EQ(with_measured_friction(text, after, robot::drive_constants(after, motor()), any_fit(after), "drive.csv", notes), text);
}

// The source names all logs, so it can be long.
TEST(RobotFile, has_no_long_lines) {
  const robot::Robot before = robot::read_robot(kFile);
  std::vector<WrittenAsZero> notes;
  const std::string source = "friction test on the carpet of the hall, with a full battery, of 216 logs \\ \"exp00.csv\" to \"exp215.csv\"";
  std::string text = file_text();
  for (int write = 0; write < 2; ++write) {
    const robot::Robot robot = robot::parse_robot(text, kFile);
    text = with_measured_friction(text, robot, robot::drive_constants(robot, motor()), any_fit(robot), source, notes);
    EXPECT_THAT(text, HasSubstr("wheel_damping = { value"));
    EXPECT_LE(longest_line(text), input::kLongestTomlLine);
  }
  const robot::Robot after = robot::parse_robot(text, kFile);
  EXPECT_EQ(after.parameters.at("friction.wheel_damping").source, source);
  EXPECT_THAT(after.parameters.at("friction.heading.wheel[1].constant").derivation, HasSubstr("mN m/A, less the motor's drag"));
}

TEST(RobotFile, of_a_robot_without_friction_gets_its_tables) {
  const std::string bare =
      "name = \"bare\"\nsource = \"test\"\nmass = \"2 kg\"\n[wheels]\nradius = \"28 mm\"\ncontact_radius = \"80 mm\"\n"
      "axis_angles = [\"-30 deg\", \"30 deg\", \"135 deg\", \"-135 deg\"]\n[drive]\nmotor = \"maxon_ecx_flat_32l_48v\"\ngear_ratio = "
      "\"1\"\n"
      "commutation = \"block\"\n[battery]\nnominal_voltage = \"22.2 V\"\n";
  const robot::Robot before = robot::parse_robot(bare, "bare.toml");
  std::vector<WrittenAsZero> notes;
  const robot::Robot after = robot::parse_robot(
      with_measured_friction(bare, before, robot::drive_constants(before, motor()), any_fit(before), "drive.csv", notes), "bare.toml");
  EXPECT_EQ(after.friction.heading.wheels.size(), 4U);
  EXPECT_GT(after.friction.wheel_damping_Nm_s_per_rad.value(), 0.0);
}

TEST(RobotFile, says_where_the_motor_alone_is_more_than_what_was_measured) {
  const robot::Robot robot = robot::read_robot(kFile);
  FrictionFit fit = any_fit(robot);
  fit.wheels[2].constant_V = estimate_around(0.1, 0.05);
  fit.wheels[2].sine_V = estimate_around(0.0, 0.05);
  fit.wheels[3].damping_V_s_per_rad = estimate_around(0.03, 0.001);
  std::vector<WrittenAsZero> notes;
  const robot::Robot after = robot::parse_robot(
      with_measured_friction(file_text(), robot, robot::drive_constants(robot, motor()), fit, "drive.csv", notes), kFile);
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_THAT(notes[0], testing::VariantWith<DragExceedsOffset>(testing::Field(&DragExceedsOffset::wheel, 3U)));
  EXPECT_THAT(notes[1], testing::VariantWith<BackEmfExceedsDamping>(testing::Field(&BackEmfExceedsDamping::wheel, 4U)));
  EXPECT_EQ(after.friction.heading.wheels[2].constant_Nm, 0.0);
}

TEST(RobotFile, is_not_written_with_a_wheel_that_was_not_learned) {
  const robot::Robot robot = robot::read_robot(kFile);
  FrictionFit fit = any_fit(robot);
  fit.wheels[1].problem = WheelProblem::hardly_turns;
  std::vector<WrittenAsZero> notes;
  try {
    with_measured_friction(file_text(), robot, robot::drive_constants(robot, motor()), fit, "drive.csv", notes);
    FAIL();
  } catch (const WheelNotIdentifiable& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::cannot_answer);
    EXPECT_EQ(failure.problem(), WheelProblem::hardly_turns);
    EXPECT_THAT(failure.what(), HasSubstr("the friction of wheel 2 over the directions is not identifiable"));
  }
}

// The motors drove the wheels. A damping of 0 in the file would look measured.
TEST(RobotFile, is_not_written_with_a_damping_that_is_certainly_negative) {
  const robot::Robot robot = robot::read_robot(kFile);
  const auto written = [&](const Estimate& estimate) {
    return with_measured_damping(file_text(), robot, std::vector<std::optional<Estimate>>(4, estimate), "roll-outs");
  };
  EXPECT_THROW(written({-0.016, {}}), DampingNegative);
  EXPECT_THROW(written({-0.016, Interval{-0.02, -0.001}}), DampingNegative);
  EXPECT_THAT(written({-0.001, Interval{-0.02, 0.01}}), testing::HasSubstr("wheel_damping"));
}

TEST(RobotFile, friction_in_another_form_is_refused_by_name) {
  std::string text = file_text();
  text.replace(text.find("[friction.heading]"), 18, "[friction.'heading']");
  const robot::Robot robot = robot::parse_robot(text, "mine.toml");
  std::vector<WrittenAsZero> notes;
  EXPECT_THROW(with_measured_friction(text, robot, robot::drive_constants(robot, motor()), any_fit(robot), "drive.csv", notes),
               base::Failure);
}

}  // namespace
}  // namespace heatsoak::friction
