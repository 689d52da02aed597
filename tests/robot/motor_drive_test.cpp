#include "robot/motor_drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "motor/datasheet_network.h"
#include "thermal/network.h"

namespace heatsoak::robot {
namespace {

/// Motor with K_t = 0.03 N m/A, R = 0.5 Ω, drag 0.006 N m.
motor::MotorValues motor() {
  motor::MotorValues values;
  values.terminal_resistance_ohm = 0.5;
  values.torque_constant_Nm_per_A = 0.03;
  values.no_load_current_A = 0.2;
  values.temperature_coefficient_per_K = 0.004;
  return values;
}

Robot robot() {
  Robot made;
  made.battery.nominal_V = 24.0;
  return made;
}

// Acceleration must overcome the drag, (0.09 + 0.006)/0.03 = 3.2 A. In braking the drag helps, (0.09 − 0.006)/0.03 = 2.8 A.
TEST(DrivePoint, signs_in_all_four_quadrants) {
  EXPECT_NEAR(drive_point(motor(), robot(), {0.09, 100.0}).current_A, 3.2, 1e-13);
  EXPECT_NEAR(drive_point(motor(), robot(), {-0.09, 100.0}).current_A, -2.8, 1e-13);
  EXPECT_NEAR(drive_point(motor(), robot(), {-0.09, -100.0}).current_A, -3.2, 1e-13);
  EXPECT_NEAR(drive_point(motor(), robot(), {0.09, -100.0}).current_A, 2.8, 1e-13);
}

TEST(DrivePoint, at_standstill_there_is_no_drag) {
  EXPECT_NEAR(drive_point(motor(), robot(), {0.09, 0.0}).current_A, 3.0, 1e-13);
  EXPECT_NEAR(drive_point(motor(), robot(), {-0.09, 0.0}).current_A, -3.0, 1e-13);
  EXPECT_EQ(drive_point(motor(), robot(), {0.0, 0.0}).current_A, 0.0);
}

TEST(DrivePoint, idling_takes_the_no_load_current) {
  EXPECT_NEAR(drive_point(motor(), robot(), {0.0, 100.0}).current_A, 0.2, 1e-14);
  EXPECT_NEAR(drive_point(motor(), robot(), {0.0, -100.0}).current_A, -0.2, 1e-14);
}

TEST(DrivePoint, turning_everything_round_turns_the_current_round) {
  std::mt19937_64 engine(1100);
  std::uniform_real_distribution<double> torque_Nm(-0.5, 0.5);
  std::uniform_real_distribution<double> speed_rad_per_s(-900.0, 900.0);
  Robot limited = robot();
  limited.drive.current_limit_A = 9.0;
  for (int i = 0; i < 500; ++i) {
    const WheelLoad load{torque_Nm(engine), speed_rad_per_s(engine)};
    const DrivePoint there = drive_point(motor(), limited, load);
    const DrivePoint back = drive_point(motor(), limited, {-load.torque_Nm, -load.speed_rad_per_s});
    EXPECT_EQ(there.current_A, -back.current_A);
    EXPECT_EQ(there.motor_torque_Nm, -back.motor_torque_Nm);
    EXPECT_EQ(there.limit, back.limit);
  }
}

TEST(DrivePoint, torque_at_the_shaft_is_what_was_asked_where_nothing_limits) {
  for (const double torque_Nm : {-0.1, 0.0, 0.1}) {
    for (const double speed_rad_per_s : {-200.0, 0.0, 200.0}) {
      const DrivePoint point = drive_point(motor(), robot(), {torque_Nm, speed_rad_per_s});
      EXPECT_EQ(point.limit, DriveLimit::none);
      EXPECT_NEAR(point.motor_torque_Nm, torque_Nm, 1e-15);
      EXPECT_EQ(point.current_A, point.current_wanted_A);
    }
  }
}

// --- limits -----------------------------------------------------------------------------------------------

TEST(DrivePoint, current_is_clamped_to_the_limit_of_the_driver) {
  Robot limited = robot();
  limited.drive.current_limit_A = 2.0;
  const DrivePoint driving = drive_point(motor(), limited, {0.09, 100.0});
  EXPECT_EQ(driving.current_A, 2.0);
  EXPECT_NEAR(driving.current_wanted_A, 3.2, 1e-13);
  EXPECT_EQ(driving.limit, DriveLimit::current);
  EXPECT_NEAR(driving.motor_torque_Nm, 0.03 * 2.0 - 0.006, 1e-15);
  EXPECT_EQ(drive_point(motor(), limited, {-0.3, 100.0}).current_A, -2.0);
}

// 24 V − 0.03 · 700 V = 3 V across 0.5 Ω: 6 A; braking −24 V − 21 V = −45 V: −90 A
TEST(DrivePoint, current_is_clamped_to_what_the_voltage_lets_through) {
  const DrivePoint fast = drive_point(motor(), robot(), {0.3, 700.0});
  EXPECT_NEAR(fast.current_A, 6.0, 1e-12);
  EXPECT_NEAR(fast.current_wanted_A, 10.2, 1e-12);
  EXPECT_EQ(fast.limit, DriveLimit::voltage);
  EXPECT_NEAR(drive_point(motor(), robot(), {-10.0, 700.0}).current_A, -90.0, 1e-11);
  EXPECT_NEAR(drive_point(motor(), robot(), {-10.0, -700.0}).current_A, -6.0, 1e-12);
}

TEST(DrivePoint, the_smaller_of_battery_and_command_is_available) {
  Robot limited = robot();
  limited.drive.voltage_limit_V = 12.5;
  EXPECT_EQ(limited.available_V(), 12.5);
  limited.drive.voltage_limit_V = 40.0;
  EXPECT_EQ(limited.available_V(), 24.0);
}

TEST(DrivePoint, no_clamped_point_needs_more_than_is_available) {
  std::mt19937_64 engine(1101);
  std::uniform_real_distribution<double> torque_Nm(-3.0, 3.0);
  std::uniform_real_distribution<double> speed_rad_per_s(-790.0, 790.0);
  Robot limited = robot();
  limited.drive.current_limit_A = 20.0;
  for (int i = 0; i < 1000; ++i) {
    const DrivePoint point = drive_point(motor(), limited, {torque_Nm(engine), speed_rad_per_s(engine)});
    const double back_emf_V = std::abs(0.03 * point.motor_speed_rad_per_s);
    EXPECT_LE(std::abs(terminal_voltage_V(motor(), point, 25.0)), std::max(24.0, back_emf_V) * (1.0 + 1e-12));
    EXPECT_LE(std::abs(point.current_A), 20.0);
    EXPECT_EQ(point.limit == DriveLimit::none, point.current_A == point.current_wanted_A);
  }
}

TEST(DrivePoint, of_a_current_is_that_current_within_the_same_limits) {
  Robot limited = robot();
  limited.drive.current_limit_A = 5.0;
  limited.drive.gear_ratio = 2.0;
  const DrivePoint point = drive_point_of_current(motor(), limited, 4.0, 100.0);
  EXPECT_EQ(point.current_A, 4.0);
  EXPECT_EQ(point.motor_speed_rad_per_s, 200.0);
  EXPECT_NEAR(point.motor_torque_Nm, 0.03 * 4.0 - 0.006, 1e-15);
  EXPECT_EQ(drive_point_of_current(motor(), limited, -7.0, 100.0).current_A, -5.0);
  EXPECT_NEAR(drive_point_of_current(motor(), limited, 5.0, 375.0).current_A, 3.0, 1e-12);  // 24 − 22.5 V across 0.5 Ω
}

// 3.2 A · 0.5 Ω · (1 + 0.004 · 100) + 0.03 · 100 V = 2.24 V + 3 V
TEST(TerminalVoltage, rises_with_the_winding) {
  const DrivePoint point = drive_point(motor(), robot(), {0.09, 100.0});
  EXPECT_NEAR(terminal_voltage_V(motor(), point, 125.0), 5.24, 1e-13);
  EXPECT_NEAR(terminal_voltage_V(motor(), point, 25.0), 4.6, 1e-13);
}

// --- gear -------------------------------------------------------------------------------------------------

// Driving, 0.3 N m at 50 rad/s are 0.3/(3 · 0.8) = 0.125 N m at 150 rad/s. Braking returns 0.3/3 · 0.8 = 0.08 N m.
TEST(Gear, numbers_computed_by_hand) {
  Robot geared = robot();
  geared.drive.gear_ratio = 3.0;
  geared.drive.gear_efficiency = 0.8;
  const DrivePoint driving = drive_point(motor(), geared, {0.3, 50.0});
  EXPECT_EQ(driving.motor_speed_rad_per_s, 150.0);
  EXPECT_NEAR(driving.motor_torque_Nm, 0.125, 1e-15);
  EXPECT_NEAR(driving.current_A, 0.131 / 0.03, 1e-13);
  const DrivePoint braking = drive_point(motor(), geared, {-0.3, 50.0});
  EXPECT_NEAR(braking.motor_torque_Nm, -0.08, 1e-15);
  EXPECT_NEAR(braking.current_A, -0.074 / 0.03, 1e-13);
}

TEST(Gear, makes_no_power) {
  std::mt19937_64 engine(1102);
  std::uniform_real_distribution<double> torque_Nm(-0.2, 0.2);
  std::uniform_real_distribution<double> speed_rad_per_s(-100.0, 100.0);
  Robot geared = robot();
  for (int i = 0; i < 500; ++i) {
    geared.drive.gear_ratio = 1.0 + static_cast<double>(i % 7);
    geared.drive.gear_efficiency = 0.5 + 0.1 * static_cast<double>(i % 6);
    const WheelLoad load{torque_Nm(engine), speed_rad_per_s(engine)};
    const DrivePoint point = drive_point(motor(), geared, load);
    const double wheel_W = load.torque_Nm * load.speed_rad_per_s;
    const double shaft_W = point.motor_torque_Nm * point.motor_speed_rad_per_s;
    if (point.limit == DriveLimit::none) {
      EXPECT_LE(wheel_W, shaft_W + 1e-12);
      EXPECT_NEAR(wheel_W > 0.0 ? wheel_W / shaft_W : shaft_W / wheel_W, geared.drive.gear_efficiency, 1e-9);
    }
  }
}

/// Energy balance: electrical input power = copper loss + drag loss + shaft power.
TEST(Motor, power_at_the_terminals_is_loss_and_shaft) {
  std::mt19937_64 engine(1103);
  std::uniform_real_distribution<double> torque_Nm(-0.4, 0.4);
  std::uniform_real_distribution<double> speed_rad_per_s(-700.0, 700.0);
  for (int i = 0; i < 500; ++i) {
    const DrivePoint point = drive_point(motor(), robot(), {torque_Nm(engine), speed_rad_per_s(engine)});
    const double in_W = terminal_voltage_V(motor(), point, 25.0) * point.current_A;
    const double copper_W = 0.5 * point.current_A * point.current_A;
    const double drag_W = 0.006 * std::abs(point.motor_speed_rad_per_s);
    EXPECT_NEAR(in_W, copper_W + drag_W + point.motor_torque_Nm * point.motor_speed_rad_per_s, 1e-9);
  }
}

// --- operating point --------------------------------------------------------------------------------------

TEST(OperatingPoint, has_no_signs) {
  const thermal::OperatingPoint<double> at = operating_point(drive_point(motor(), robot(), {-0.09, -100.0}), motor(), robot(), 31.0);
  EXPECT_NEAR(at.current_rms_A, 3.2, 1e-13);
  EXPECT_EQ(at.speed_mean_rad_per_s, 100.0);
  EXPECT_EQ(at.speed_rms_rad_per_s, 100.0);
  EXPECT_EQ(at.ambient_C, 31.0);
}

// Driving: I = (0.09 + 0.006)/0.03 = 3.2 A; shaft 0.09·100 = 9 W; terminals 3.2·0.5 + 0.03·100 = 4.6 V, input 4.6·3.2 = 14.72 W.
TEST(OperatingPoint, has_powers_voltage_and_the_vehicle_of_a_driving_wheel) {
  Robot wheeled = robot();
  wheeled.wheels.radius_m = 0.03;
  const thermal::OperatingPoint<double> at = operating_point(drive_point(motor(), wheeled, {0.09, 100.0}), motor(), wheeled, 25.0);
  EXPECT_NEAR(at.shaft_power_W, 9.0, 1e-12);
  EXPECT_NEAR(at.input_power_W, 14.72, 1e-12);
  EXPECT_EQ(at.bus_V, 24.0);
  EXPECT_NEAR(at.modulation_ratio, 4.6 / 24.0, 1e-13);
  EXPECT_NEAR(at.vehicle_speed_m_per_s, 3.0, 1e-13);
  EXPECT_EQ(at.velocity_rad_per_s, 100.0);
  EXPECT_FALSE(at.knows(thermal::kNeighbour));
}

// Braking, turning backwards: I = (0.09 − 0.006)/0.03 = 2.8 A, −9 W at the shaft, 2.8·0.5 − 3 = −1.6 V, −4.48 W, which is regenerated.
TEST(OperatingPoint, has_negative_powers_where_the_motor_brakes) {
  const thermal::OperatingPoint<double> at = operating_point(drive_point(motor(), robot(), {0.09, -100.0}), motor(), robot(), 25.0);
  EXPECT_NEAR(at.shaft_power_W, -9.0, 1e-12);
  EXPECT_NEAR(at.input_power_W, -4.48, 1e-12);
  EXPECT_NEAR(at.modulation_ratio, 1.6 / 24.0, 1e-13);
  EXPECT_EQ(at.velocity_rad_per_s, -100.0);
}

// A gear of 4 and a wheel at 50 rad/s: the motor turns at 200 rad/s, and the robot rolls at the wheel's speed.
TEST(OperatingPoint, has_the_wheels_speed_behind_a_gear_and_never_more_modulation_than_the_supply) {
  Robot geared = robot();
  geared.drive.gear_ratio = 4.0;
  geared.wheels.radius_m = 0.03;
  const thermal::OperatingPoint<double> at = operating_point(drive_point(motor(), geared, {0.1, 50.0}), motor(), geared, 25.0);
  EXPECT_NEAR(at.vehicle_speed_m_per_s, 1.5, 1e-13);
  EXPECT_EQ(at.velocity_rad_per_s, 200.0);
  EXPECT_EQ(operating_point(drive_point(motor(), geared, {9.0, 100.0}), motor(), geared, 25.0).modulation_ratio, 1.0);
}

// Block commutation: a current I and a back-EMF between two terminals with crest E, whose mean over the 60° around the crest is (3/π)·E.
// Sinusoidal: an amplitude Î and phase amplitudes E/√3, 1.5·Î·E/√3. Ratio of heats: I²·R to 3·(Î²/2)·(R/2).
TEST(OperatingPoint, sinusoidal_commutation_heats_0_912_of_block) {
  Robot sinusoidal = robot();
  sinusoidal.drive.commutation = Commutation::sinusoidal;
  const DrivePoint point = drive_point(motor(), robot(), {0.09, 100.0});
  const double block_A = operating_point(point, motor(), robot(), 25.0).current_rms_A;
  const double sinusoidal_A = operating_point(point, motor(), sinusoidal, 25.0).current_rms_A;
  const double emf_V = 1.0;
  const double current_A = 1.0;
  const double mean_power_W = 3.0 / std::numbers::pi * emf_V * current_A;
  const double peak_A = mean_power_W / (1.5 * emf_V / std::numbers::sqrt3);
  const double heat_share = 3.0 * (peak_A * peak_A / 2.0) * 0.5 / (current_A * current_A);
  EXPECT_NEAR(heat_share, 0.912, 5e-4);
  EXPECT_NEAR(sinusoidal_A * sinusoidal_A / (block_A * block_A), heat_share, 1e-12);
}

}  // namespace
}  // namespace heatsoak::robot
