// Friction of a robot file as voltages, compared with the steady state of the plant's equations.
#include "firmware/friction_voltage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/diagnostic.h"
#include "robot/assumed_friction.h"
#include "robot/inverse_dynamics.h"
#include "support/shipped.h"

namespace heatsoak::firmware {
namespace {

/// A friction curve in the form of equation 3, with separate a and b for each wheel.
robot::Robot with_measured_curve(double phase_offset_rad = 0.0) {
  robot::Robot robot = twente();
  robot.friction.heading.constant_Nm.reset();
  robot.friction.heading.sine_Nm.reset();
  robot.friction.heading.double_angle_Nm.reset();
  robot.friction.heading.double_angle_phase_rad.clear();
  const robot::Kinematics kinematics = robot::make_kinematics(robot);
  for (int i = 0; i < 4; ++i) {
    robot.friction.heading.wheels.push_back(
        {0.020 + 0.002 * i, 0.005 - 0.003 * i, robot::rolling_phase_rad(kinematics.wheels[i]) + phase_offset_rad});
  }
  return robot;
}

double form_V(const FrictionVoltage& friction, int wheel, double heading_rad) {
  const double sine = std::sin(heading_rad + friction.phase_rad[wheel]);
  return friction.sine_V[wheel] * sine + std::copysign(friction.sign_V[wheel], sine);
}

/// Returns the voltage that keeps the wheel turning at that heading and speed, from the plant's friction.
double steady_V(const robot::Robot& robot, const motor::MotorValues& motor, int wheel, double heading_rad, double speed_m_per_s) {
  const robot::BodyConfig body = robot::make_body(robot, motor);
  robot::BodyMotion motion;
  motion.velocity = {speed_m_per_s * std::cos(heading_rad), speed_m_per_s * std::sin(heading_rad), 0.0};
  const robot::WheelDemands wheels = robot::inverse_dynamics(body, motion);
  return robot::steady_voltage_V(robot::drive_constants(robot, motor), wheels.torque_Nm[wheel], wheels.speed_rad_per_s[wheel]);
}

TEST(FrictionVoltage, RepresentsACurveOfItsFormExactly) {
  const motor::MotorValues motor = ecx_32().nominal;
  const robot::Robot robot = with_measured_curve();
  const FrictionVoltage friction = friction_voltage(robot, motor);
  ASSERT_TRUE(friction.is_known);
  const robot::Kinematics kinematics = robot::make_kinematics(robot);
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT(friction.residual_rms_V[i], 1e-9) << i;
    for (const double heading_rad : {0.0, 1.3, 1.6, 3.1, 4.7}) {
      // At 1 m/s and away from headings at which a wheel stands, the smoothed sign changes the friction by less than 1 %.
      ASSERT_GT(std::abs(std::sin(heading_rad + friction.phase_rad[i])), 0.15) << i << ", " << heading_rad;
      const double speed_rad_per_s = robot::wheel_speeds_rad_per_s(kinematics, {std::cos(heading_rad), std::sin(heading_rad), 0.0})[i];
      const double expected_V = steady_V(robot, motor, i, heading_rad, 1.0) - friction.damping_V_s_per_rad * speed_rad_per_s;
      EXPECT_NEAR(form_V(friction, i, heading_rad), expected_V, 0.01) << i << ", " << heading_rad;
    }
  }
}

TEST(FrictionVoltage, FitFindsACurveOfItsForm) {
  // A negligible double-angle term forces the code to use the fit.
  const motor::MotorValues motor = ecx_32().nominal;
  const FrictionVoltage direct = friction_voltage(with_measured_curve(), motor);
  robot::Robot robot = with_measured_curve();
  robot.friction.heading.double_angle_Nm = 1e-12;
  robot.friction.heading.double_angle_phase_rad = {0.0, 0.0, 0.0, 0.0};
  const FrictionVoltage fitted = friction_voltage(robot, motor);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(fitted.sine_V[i], direct.sine_V[i], 1e-8) << i;
    EXPECT_NEAR(fitted.sign_V[i], direct.sign_V[i], 1e-8) << i;
    EXPECT_NEAR(fitted.phase_rad[i], direct.phase_rad[i], 1e-12) << i;
  }
}

// Values of the team's firmware: 1.23 V in translation, 0.3 V in rotation, 0.0375 V s/rad. The robot file rounds them.
TEST(FrictionVoltage, GivesBackTheVoltagesOfTheTeam) {
  robot::Robot robot = twente();
  robot.friction.heading.double_angle_Nm.reset();
  robot.friction.heading.double_angle_phase_rad.clear();
  // The team neglected the motor controller's 10 mohm.
  robot.drive.driver_resistance_ohm = 0.0;
  const FrictionVoltage friction = friction_voltage(robot, ecx_32().nominal);
  EXPECT_NEAR(friction.damping_V_s_per_rad, 0.0375, 5e-5);
  EXPECT_NEAR(friction.rotation_V, 0.3, 0.005);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(friction.sign_V[i], 1.23, 0.005) << i;
    EXPECT_NEAR(friction.sine_V[i], 0.0, 1e-9) << i;
  }
}

// The form cannot represent sin(2θ + ψ)·sign. The residual is at most its RMS, and other values of a or b do not reduce it.
TEST(FrictionVoltage, ReportsWhatADoubleAngleLeaves) {
  const motor::MotorValues motor = ecx_32().nominal;
  const robot::Robot robot = twente();
  const FrictionVoltage friction = friction_voltage(robot, motor);
  const robot::DriveConstants drive = robot::drive_constants(robot, motor);
  const double amplitude_V = 0.0141 * drive.resistance_ohm / drive.torque_constant_Nm_per_A;
  for (int i = 0; i < 4; ++i) {
    EXPECT_GT(friction.residual_rms_V[i], 0.3 * amplitude_V) << i;
    EXPECT_LE(friction.residual_rms_V[i], amplitude_V / std::sqrt(2.0) + 1e-9) << i;
  }
}

// Rollers: by symmetry the mirrored wheels have the same curve, and the fit's residual is less than half of the friction's RMS.
TEST(FrictionVoltage, FitsTheDragOfRollers) {
  const robot::Robot robot = shipped_robot("tigers_v2020");
  const motor::MotorValues motor = shipped_motor("nanotec_df45l024048_a2").nominal;
  const FrictionVoltage friction = friction_voltage(robot, motor);
  EXPECT_NEAR(friction.sine_V[0], friction.sine_V[1], 1e-9);
  EXPECT_NEAR(friction.sign_V[2], friction.sign_V[3], 1e-9);
  // In rotation the rollers stand still. The remaining friction is 4.2 mN m at the wheel and the motor's drag.
  const robot::DriveConstants drive = robot::drive_constants(robot, motor);
  EXPECT_NEAR(friction.rotation_V, robot::steady_voltage_V(drive, 0.0042, 1e-9), 1e-6);
  for (int i = 0; i < 4; ++i) {
    double squares_V2 = 0.0;
    for (int h = 0; h < 72; ++h) {
      squares_V2 += std::pow(form_V(friction, i, 2.0 * std::numbers::pi * (h + 0.5) / 72), 2.0) / 72.0;
    }
    EXPECT_LT(friction.residual_rms_V[i], 0.5 * std::sqrt(squares_V2)) << i;
    EXPECT_GT(friction.residual_rms_V[i], 0.0) << i;
  }
}

// The sum of squares must have its minimum at the fitted values.
TEST(FrictionVoltage, FitIsALeastSquaresOne) {
  const robot::Robot robot = shipped_robot("tigers_v2020");
  const motor::MotorValues motor = shipped_motor("nanotec_df45l024048_a2").nominal;
  const FrictionVoltage friction = friction_voltage(robot, motor);
  robot::Robot undamped = robot;
  undamped.friction.wheel_damping_Nm_s_per_rad = 0.0;
  const robot::Kinematics kinematics = robot::make_kinematics(robot);
  const auto misfit_V2 = [&](int wheel, double more_sine_V, double more_sign_V) {
    FrictionVoltage other = friction;
    other.sine_V[wheel] += more_sine_V;
    other.sign_V[wheel] += more_sign_V;
    double squares_V2 = 0.0;
    for (int h = 0; h < 72; ++h) {
      const double heading_rad = 2.0 * std::numbers::pi * (h + 0.5) / 72;
      const double speed_rad_per_s =
          robot::wheel_speeds_rad_per_s(kinematics, {2.0 * std::cos(heading_rad), 2.0 * std::sin(heading_rad), 0.0})[wheel];
      const double target_V = steady_V(undamped, motor, wheel, heading_rad, 2.0) -
                              robot::drive_constants(robot, motor).torque_constant_Nm_per_A * speed_rad_per_s;
      squares_V2 += std::pow(target_V - form_V(other, wheel, heading_rad), 2.0);
    }
    return squares_V2;
  };
  for (const double step_V : {-0.02, 0.02}) {
    EXPECT_GT(misfit_V2(0, step_V, 0.0), misfit_V2(0, 0.0, 0.0));
    EXPECT_GT(misfit_V2(2, 0.0, step_V), misfit_V2(2, 0.0, 0.0));
  }
}

TEST(FrictionVoltage, RobotWithoutFrictionHasItsBackEmfAlone) {
  robot::Robot robot = twente();
  for (const robot::RobotParameterSpec& each : robot::robot_parameter_specs()) {
    if (each.table.starts_with("friction")) {
      each.value.of(robot).reset();
    }
  }
  robot.friction.heading.double_angle_phase_rad.clear();
  const FrictionVoltage friction = friction_voltage(robot, ecx_32().nominal);
  EXPECT_FALSE(friction.is_known);
  EXPECT_NEAR(friction.damping_V_s_per_rad, 0.0328, 1e-12);
  EXPECT_EQ(friction.rotation_V, 0.0);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(friction.sine_V[i], 0.0);
    EXPECT_EQ(friction.sign_V[i], 0.0);
  }
  // Friction that is assumed for the simulated robot must not reach the core.
  const robot::Robot assumed = robot::with_assumed_friction(robot);
  EXPECT_GT(assumed.friction.roller_drag_ratio.value(), 0.0);
  const FrictionVoltage unknown = friction_voltage(assumed, ecx_32().nominal);
  EXPECT_FALSE(unknown.is_known);
  EXPECT_EQ(unknown.damping_V_s_per_rad, friction.damping_V_s_per_rad);
  EXPECT_EQ(unknown.rotation_V, 0.0);
}

TEST(FrictionVoltage, NamesWhatHalfAFrictionTableLacks) {
  robot::Robot robot = twente();
  robot.friction.roller_drag_ratio.reset();
  robot.friction.wheel_damping_Nm_s_per_rad.reset();
  try {
    friction_voltage(robot, ecx_32().nominal);
    FAIL() << "no failure";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_EQ(failure.diagnostics().size(), 2U);
  }
}

}  // namespace
}  // namespace heatsoak::firmware
