// Configuration of the drive core from a robot file: compared with hand calculations, and with the guarantees of the guard.
#include "firmware/core_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "base/diagnostic.h"
#include "firmware/core_files.h"
#include "motor/datasheet_network.h"
#include "robot/inverse_dynamics.h"
#include "support/shipped.h"

namespace heatsoak::firmware {
namespace {

using testing::HasSubstr;

robot_core::Config twente_config() { return make_core_config(twente(), ecx_32().nominal, with_tolerance({}, ecx_32())); }

TEST(CoreConfig, OfEveryShippedRobotStartsTheCore) {
  for (const char* const id : {"roboteam_twente_v2024", "roboteam_twente_v2025", "tigers_v2020"}) {
    const robot::Robot robot = shipped_robot(id);
    const motor::Motor motor = shipped_motor(robot.drive.motor);
    const robot_core::Config config = make_core_config(robot, motor.nominal, with_tolerance({}, motor));
    robot_core::State state;
    EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F})) << id;
    EXPECT_EQ(config.check_sum, robot_core::config_check_sum(config)) << id;
  }
}

TEST(CoreConfig, CheckSumIsTheCommonCrc32) {
  const robot_core::Config config = twente_config();
  const auto* const bytes = reinterpret_cast<const unsigned char*>(&config);
  const std::size_t first = sizeof(config.check_sum);
  boost::crc_32_type sum;
  sum.process_bytes(bytes + first, offsetof(robot_core::Config, unused) + sizeof(config.unused) - first);
  EXPECT_EQ(config.check_sum, sum.checksum());
}

// 1.07 ohm with a tolerance of 10 %, 10 mohm of the motor controller, 25.2 V, 32.8 mN m/A, J = 220 g cm² + 9.47 g cm².
TEST(CoreConfig, HandCalculationOfTheMotor) {
  const robot_core::Config config = twente_config();
  const double lowest_ohm = 1.07 * 0.9 * (1.0 - 0.0039 * 25.0) + 0.01;
  EXPECT_NEAR(config.resistance_ohm, 1.08, 1e-6);
  EXPECT_NEAR(config.lowest_resistance_ohm, lowest_ohm, 1e-6);
  EXPECT_NEAR(config.fastest_wheel_rad_per_s, 1.1 * 25.2 / 0.0328, 1e-3);
  EXPECT_NEAR(config.current_limit_A, (12.5 + 1.1 * 25.2) / lowest_ohm, 1e-4);
  EXPECT_NEAR(config.largest_acceleration_rad_per_s2, 0.0328 * (12.5 + 1.1 * 25.2) / lowest_ohm / 229.47e-7, 1.0);
  // Half of the heat that warms the winding from 40 to 155 degC through 3.8 and 2.8 K/W.
  EXPECT_NEAR(config.limp_current_A, std::sqrt(0.5 * 115.0 / (6.6 * 1.07 * (1.0 + 0.0039 * 130.0))), 1e-4);
  EXPECT_FLOAT_EQ(config.voltage_limit_V, 12.5F);
  EXPECT_FLOAT_EQ(config.battery_lowest_V, 19.8F);
  EXPECT_FLOAT_EQ(config.traction_ratio, 0.7F);
  EXPECT_FLOAT_EQ(config.command_timeout_s, 0.2F);
  EXPECT_FLOAT_EQ(config.speed_limit_m_per_s, 2.0F);
}

TEST(CoreConfig, SlipFactorsAreThoseOfTheRobotFile) {
  robot::Robot robot = twente();
  const auto slip_factor = [&](int wheel) {
    return make_core_config(robot, ecx_32().nominal, with_tolerance({}, ecx_32())).wheel[wheel].slip_factor;
  };
  EXPECT_EQ(slip_factor(3), 1.0F);
  robot.wheels.slip_factor = {1.01, 1.02, 1.03, 1.04};
  EXPECT_EQ(slip_factor(0), 1.01F);
  EXPECT_EQ(slip_factor(3), 1.04F);
}

TEST(CoreConfig, DriverWithACurrentLimitKeepsIt) {
  const robot::Robot robot = shipped_robot("tigers_v2020");
  const motor::Motor motor = shipped_motor(robot.drive.motor);
  const robot_core::Config config = make_core_config(robot, motor.nominal, with_tolerance({}, motor));
  EXPECT_FLOAT_EQ(config.current_limit_A, 8.16F);
  EXPECT_FLOAT_EQ(config.gear_efficiency, 0.72F);
  // Rollers use a part of the grip: √(0.7² − 0.11²).
  EXPECT_NEAR(config.traction_ratio, 0.6913, 1e-4);
}

TEST(CoreConfig, RangeCountsByItsLowerEnd) {
  motor::Motor motor = ecx_32();
  base::ParameterValue& resistance = *motor::find_parameter(motor, "terminal_resistance");
  resistance.spread = base::Spread{.kind = base::Spread::Kind::range, .low = 0.8, .high = 1.3};
  EXPECT_NEAR(with_tolerance({}, motor).lowest_resistance_ratio, 0.8 / 1.07, 1e-12);
  // A resistance without a stated tolerance gets the default for its origin, and the lower end of that range counts.
  resistance.spread.reset();
  EXPECT_NEAR(with_tolerance({}, motor).lowest_resistance_ratio, 0.9, 1e-12);
}

/// The core's feed-forward must equal the voltage that the plant's inverse dynamics needs for a steady drive.
TEST(CoreConfig, FeedForwardIsWhatThePlantNeeds) {
  robot::Robot robot = twente();
  robot.friction.heading.double_angle_Nm.reset();  // the core's friction law has no such term
  robot.friction.heading.double_angle_phase_rad.clear();
  const motor::MotorValues motor = ecx_32().nominal;
  const robot_core::Config config = make_core_config(robot, motor, {});
  const robot::BodyConfig body = robot::make_body(robot, motor);
  const robot::DriveConstants drive = robot::drive_constants(robot, motor);
  robot::BodyMotion motion;
  motion.velocity = {1.2, 0.3, 0.0};
  motion.acceleration = {1.0, -0.5, 3.0};
  const robot::WheelDemands wheels = robot::inverse_dynamics(body, motion);
  for (int i = 0; i < 4; ++i) {
    const robot_core::WheelConfig& wheel = config.wheel[i];
    const double rim_m_per_s = wheel.rolling_x_share * 1.2 + wheel.rolling_y_share * 0.3;
    const double force_N = wheel.inverse_x_factor * config.mass_kg * 1.0 + wheel.inverse_y_factor * config.mass_kg * -0.5 +
                           wheel.inverse_yaw_per_m * config.yaw_inertia_kg_m2 * 3.0;
    const double per_s2 =
        (wheel.rolling_x_share * 1.0 + wheel.rolling_y_share * -0.5 + config.contact_radius_m * 3.0) / config.wheel_radius_m;
    const double sine = (0.3 * wheel.phase_cosine_ratio + 1.2 * wheel.phase_sine_ratio) / std::hypot(1.2, 0.3);
    const double planned_V = wheel.damping_V_s_per_rad * rim_m_per_s / config.wheel_radius_m + wheel.sine_V * sine +
                             std::copysign(wheel.sign_V, sine) +
                             config.resistance_ohm / (config.torque_constant_Nm_per_A * config.gear_ratio * config.gear_efficiency) *
                                 (config.wheel_radius_m * force_N + config.wheel_inertia_kg_m2 * per_s2);
    EXPECT_NEAR(planned_V, robot::steady_voltage_V(drive, wheels.torque_Nm[i], wheels.speed_rad_per_s[i]), 0.01) << i;
  }
}

TEST(CoreConfig, NamesEveryMissingParameter) {
  robot::Robot robot = twente();
  robot.body.yaw_inertia_kg_m2.reset();
  robot.traction.coefficient_ratio.reset();
  robot.battery.full_V.reset();
  motor::MotorValues motor = ecx_32().nominal;
  motor.rotor_inertia_kg_m2 = {};
  try {
    make_core_config(robot, motor, {});
    FAIL() << "no failure";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    std::string keys;
    for (const base::Diagnostic& each : failure.diagnostics()) {
      keys += each.key + " ";
    }
    for (const char* const key : {"body.yaw_inertia", "traction.coefficient", "battery.full_voltage", "figures.rotor_inertia"}) {
      EXPECT_THAT(keys, HasSubstr(key));
    }
  }
}

TEST(CoreConfig, RobotWithoutFrictionIsDrivenWithoutItsFeedForward) {
  robot::Robot robot = twente();
  for (const robot::RobotParameterSpec& each : robot::robot_parameter_specs()) {
    if (each.table.starts_with("friction")) {
      each.value.of(robot).reset();
    }
  }
  robot.friction.heading.double_angle_phase_rad.clear();
  const robot_core::Config config = make_core_config(robot, ecx_32().nominal, {});
  EXPECT_FALSE(config.has_friction);
  EXPECT_FLOAT_EQ(config.wheel[2].damping_V_s_per_rad, 0.0328F);
  robot_core::State state;
  EXPECT_TRUE(robot_core::start(config, state, {}));
}

TEST(CoreConfig, CheckSumCoversShadowMode) {
  const robot_core::Config usual = make_core_config(twente(), ecx_32().nominal, {});
  const robot_core::Config shadow = make_core_config(twente(), ecx_32().nominal, {.shadow_mode = true});
  EXPECT_FALSE(usual.shadow_mode);
  EXPECT_TRUE(shadow.shadow_mode);
  EXPECT_NE(usual.check_sum, shadow.check_sum);
}

TEST(CoreConfig, RefusesAPeriodThatItsWheelLoopCannotUse) {
  EXPECT_THROW(make_core_config(twente(), ecx_32().nominal, {.period_s = 0.02}), base::Failure);
}

/// Shared derating with few samples, because these tests do not check the share of motors that keep their limit.
const derate::Derating& derating() {
  static const derate::Derating made = [] {
    derate::DerateOptions options;
    options.guarantee.required_share = 0.9;
    options.guarantee.samples = 32;
    return derate::derate(ecx_32(), twente(), options);
  }();
  return made;
}

TEST(CoreConfig, OriginOfTheSlipFactorsStandsInTheHeader) {
  robot::Robot robot = twente();
  const motor::Motor motor = ecx_32();
  const auto header = [&] {
    return core_config_header({.robot = robot,
                               .motor = motor,
                               .derating = derating(),
                               .options = {},
                               .config = make_core_config(robot, motor.nominal, with_tolerance({}, motor)),
                               .guard = {},
                               .version = {},
                               .options_text = {},
                               .hash = {}});
  };
  robot.wheels.slip_factor = {1.01, 1.02, 1.03, 1.04};
  EXPECT_THAT(header(), testing::Not(testing::HasSubstr("wheels.slip_factors (")));
  base::ParameterValue stated;
  stated.origin = base::Origin::measured;
  robot.parameters.emplace("wheels.slip_factors[0]", stated);
  EXPECT_THAT(header(), testing::HasSubstr("robot file: wheels.slip_factors (measured)"));
}

TEST(GuardedCoreConfig, StartsTheCoreAndCarriesTheGuard) {
  const HostGuard guard(derating());
  const robot_core::Config config = make_core_config(twente(), ecx_32(), {}, derating(), guard);
  EXPECT_EQ(config.guard, &guard.model());
  EXPECT_GT(config.limp_current_A, 0.0F);
  EXPECT_LT(config.limp_current_A, config.current_limit_A);
  EXPECT_GT(config.braking_reserve_K, 0.0F);
  EXPECT_LT(config.lowest_resistance_ohm, 0.9 * 1.07);
  robot_core::State state;
  EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
}

TEST(GuardedCoreConfig, GuardPeriodIsAWholeNumberOfControlPeriods) {
  const HostGuard guard(derating());
  EXPECT_NO_THROW(make_core_config(twente(), ecx_32(), {.period_s = 0.002}, derating(), guard));
  for (const double period_s : {0.0015, 0.0032}) {
    try {
      make_core_config(twente(), ecx_32(), {.period_s = period_s}, derating(), guard);
      ADD_FAILURE() << "no failure";
    } catch (const base::Failure& failure) {
      EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
      EXPECT_THAT(failure.message(), HasSubstr("whole number"));
    }
  }
}

/// Returns the highest temperature of the observer's winding if the current is held for hours at that speed.
double held_C(const derate::HotCase& around, double current_A, double speed_rad_per_s) {
  derate::ObserverRun<double> run(derating().observer, derating().options.period_s, derating().rules.hottest_ambient_C);
  const derate::Signals signals = around.signals(derating().rules, current_A, speed_rad_per_s);
  double most_C = 0.0;
  for (int i = 0; i < 200'000; ++i) {
    run.step(signals);
    most_C = std::max(most_C, run.state_C()[motor::states::winding]);
  }
  return most_C;
}

// For a wheel with unknown speed the limp current must be safe at all speeds.
TEST(GuardedCoreConfig, LimpCurrentIsBorneForGoodAtEverySpeedInEveryHotCase) {
  const double limp_A = derate::limp_current_A(derating());
  const derate::BarrierRules& rules = derating().rules;
  double hottest_C = 0.0;
  for (const derate::HotCase& around : derate::hot_cases(derating().observer, rules)) {
    for (const double share : {0.0, 0.25, 0.5, 0.75, 0.98}) {
      hottest_C = std::max(hottest_C, held_C(around, limp_A, share * rules.most_speed_rad_per_s));
    }
  }
  EXPECT_LT(hottest_C, rules.limits.winding_C + 0.5);
  // It must also be close to the highest safe current.
  EXPECT_GT(hottest_C, rules.limits.winding_C - 5.0);
}

// Without effects the observer's heating is copper loss alone: I²·R(155 °C)·factor/C_w, C_w = 12 s/3.8 K/W.
TEST(GuardedCoreConfig, BrakingReserveIsTheHeatOfOneStop) {
  const double hot_ohm = 1.07 * (1.0 + 0.0039 * (155.0 - 25.0));
  const robot::BodyConfig body = robot::make_body(twente(), ecx_32().nominal);
  double most_A = 0.0;
  for (int h = 0; h < 360; ++h) {
    const robot::BodyAcceleration braking{2.0 * std::cos(h * 0.0174533), 2.0 * std::sin(h * 0.0174533), 0.0};
    const robot::PerWheel force_N = robot::rolling_forces_N(body.kinematics, robot::wrench_of_acceleration(body, 0.0, braking));
    const robot::PerWheel per_s2 = robot::wheel_speeds_rad_per_s(body.kinematics, {braking.x_m_per_s2, braking.y_m_per_s2, 0.0});
    for (int i = 0; i < 4; ++i) {
      most_A = std::max(most_A, std::abs(force_N[i] * 0.028 + body.wheel_inertia_kg_m2 * per_s2[i]) / 0.0328);
    }
  }
  const double duration_s = 2.0 / 2.0;
  const double expected_K = most_A * most_A * hot_ohm * duration_s * derating().observer.heat_safety_factor() / (12.0 / 3.8);
  EXPECT_NEAR(braking_reserve_K(twente(), ecx_32().nominal, derating()), expected_K, 0.01 * expected_K);
}

// A robot whose full stop overheats the motor would get a core that never drives.
TEST(GuardedCoreConfig, RefusesARobotThatOneStopOverheats) {
  const HostGuard guard(derating());
  robot::Robot robot = twente();
  robot.mass_kg = 40.0;
  EXPECT_GT(braking_reserve_K(robot, ecx_32().nominal, derating()), 155.0 - 40.0);
  EXPECT_NO_THROW(require_driving_current(twente(), ecx_32(), derating(), make_core_config(twente(), ecx_32(), {}, derating(), guard)));
  try {
    require_driving_current(robot, ecx_32(), derating(), make_core_config(robot, ecx_32(), {}, derating(), guard));
    ADD_FAILURE() << "no failure";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_THAT(failure.message(), HasSubstr("maxon_ecx_flat_32l_48v"));
    EXPECT_THAT(failure.message(), HasSubstr("one full stop from 2 m/s"));
    EXPECT_THAT(failure.message(), HasSubstr("limits.braking"));
  }
}

TEST(LimpCurrent, IsTheLeastOfTheHeldUses) {
  derate::Derating made = derating();
  made.uses = {{.use = {.speed_share = 0.3}, .intervals = {}, .time_s = {1.0, 2.0}, .current_A = {9.0, 4.0}},
               {.use = {.speed_share = 0.6}, .intervals = {}, .time_s = {1.0, 2.0}, .current_A = {8.0, 3.0}},
               {.use = {.speed_share = 0.6, .on_s = 2.0}, .intervals = {}, .time_s = {1.0}, .current_A = {1.0}}};
  EXPECT_EQ(derate::limp_current_A(made), 3.0);
  made.uses.clear();
  EXPECT_EQ(derate::limp_current_A(made), 0.0);
}

}  // namespace
}  // namespace heatsoak::firmware
