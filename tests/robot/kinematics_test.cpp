#include "robot/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "robots_for_tests.h"

namespace heatsoak::robot {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

const std::vector<std::string> kShipped{"roboteam_twente_v2024", "roboteam_twente_v2025", "tigers_v2020"};

// Wheel 1 is at the front right with its axle at −30°, so it rolls along (0.5, 0.866). At 1 m/s and a radius of 28 mm it turns at 0.5/0.028
// = 17.857 rad/s ahead and 0.8660/0.028 = 30.929 rad/s to the left. The rear wheels turn at 0.7071/0.028 = 25.254 rad/s. Turning at 1 rad/s
// needs 0.0804/0.028 = 2.8714 rad/s at every wheel.
TEST(Kinematics, roboteam_twente_by_hand) {
  const Kinematics kinematics = make_kinematics(shipped_robot("roboteam_twente_v2024"));
  const PerWheel ahead = wheel_speeds_rad_per_s(kinematics, {1.0, 0.0, 0.0});
  const PerWheel left = wheel_speeds_rad_per_s(kinematics, {0.0, 1.0, 0.0});
  const PerWheel turn = wheel_speeds_rad_per_s(kinematics, {0.0, 0.0, 1.0});
  const PerWheel ahead_rad_per_s{17.857, -17.857, -25.254, 25.254};
  const PerWheel left_rad_per_s{30.929, 30.929, -25.254, -25.254};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(ahead[i], ahead_rad_per_s[i], 1e-3);
    EXPECT_NEAR(left[i], left_rad_per_s[i], 1e-3);
    EXPECT_NEAR(turn[i], 2.8714, 1e-4);
  }
}

// The recorded commands are (−34.641, 0, 34.641) rad/s at the motors (gear 16) for 0.1 m/s ahead, and (20, −40, 20) to the left.
TEST(Kinematics, robotino_as_its_own_commands) {
  const Kinematics kinematics = make_kinematics(read_robot(kSource / "tests/data/robots/festo_robotino.toml"));
  const PerWheel ahead = wheel_speeds_rad_per_s(kinematics, {0.1, 0.0, 0.0});
  const PerWheel left = wheel_speeds_rad_per_s(kinematics, {0.0, 0.1, 0.0});
  const PerWheel ahead_rad_per_s{-34.641, 0.0, 34.641, 0.0};
  const PerWheel left_rad_per_s{20.0, -40.0, 20.0, 0.0};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(16.0 * ahead[i], ahead_rad_per_s[i], 1e-3);
    EXPECT_NEAR(16.0 * left[i], left_rad_per_s[i], 1e-3);
  }
}

TEST(Kinematics, there_and_back_is_where_it_was) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> any(-5.0, 5.0);
  for (int round = 0; round < 300; ++round) {
    Robot robot = bare_robot();
    robot.wheels.axis_rad.resize(round % 2 == 0 ? 3 : 4);
    for (std::size_t i = 0; i < robot.wheels.axis_rad.size(); ++i) {
      robot.wheels.axis_rad[i] = (0.6 * any(engine) / 5.0 + 1.5 * static_cast<double>(i));
    }
    const Kinematics kinematics = make_kinematics(robot);
    const BodyVelocity velocity{any(engine), any(engine), 4.0 * any(engine)};
    const BodyVelocity again = body_velocity(kinematics, wheel_speeds_rad_per_s(kinematics, velocity));
    EXPECT_NEAR(again.x_m_per_s, velocity.x_m_per_s, 1e-12);
    EXPECT_NEAR(again.y_m_per_s, velocity.y_m_per_s, 1e-12);
    EXPECT_NEAR(again.yaw_rad_per_s, velocity.yaw_rad_per_s, 1e-11);
    const Wrench wrench{any(engine), any(engine), any(engine)};
    const Wrench made = wrench_of_rolling_forces(kinematics, rolling_forces_N(kinematics, wrench));
    EXPECT_NEAR(made.x_N, wrench.x_N, 1e-12);
    EXPECT_NEAR(made.y_N, wrench.y_N, 1e-12);
    EXPECT_NEAR(made.yaw_Nm, wrench.yaw_Nm, 1e-12);
  }
}

/// Forces and speeds are dual: the power at the wheels equals the power at the body.
TEST(Kinematics, power_at_the_rims_is_power_at_the_body) {
  std::mt19937_64 engine(2);
  std::uniform_real_distribution<double> any(-3.0, 3.0);
  for (const std::string& id : kShipped) {
    const Kinematics kinematics = make_kinematics(shipped_robot(id));
    for (int round = 0; round < 100; ++round) {
      const BodyVelocity v{any(engine), any(engine), any(engine)};
      const PerWheel force_N{any(engine), any(engine), any(engine), any(engine)};
      const Wrench rolling = wrench_of_rolling_forces(kinematics, force_N);
      const Wrench lateral = wrench_of_lateral_forces(kinematics, force_N);
      const PerWheel along = rolling_speeds_m_per_s(kinematics, v);
      const PerWheel across = lateral_speeds_m_per_s(kinematics, v);
      double rims_W = 0.0;
      for (int i = 0; i < 4; ++i) {
        rims_W += force_N[i] * (along[i] + across[i]);
      }
      const double body_W = (rolling.x_N + lateral.x_N) * v.x_m_per_s + (rolling.y_N + lateral.y_N) * v.y_m_per_s +
                            (rolling.yaw_Nm + lateral.yaw_Nm) * v.yaw_rad_per_s;
      EXPECT_NEAR(rims_W, body_W, 1e-12);
    }
  }
}

/// The distribution must not contain the pattern of forces that moves nothing; otherwise Σf² could be smaller.
TEST(Kinematics, four_wheels_do_not_work_against_each_other) {
  const Kinematics kinematics = make_kinematics(shipped_robot("tigers_v2020"));
  // Axles at 31° and 45°: the pattern (1, 1, −1, −1) has no yaw moment; the sideways forces cos 31° and −k·cos 45° cancel.
  const PerWheel force_N = rolling_forces_N(kinematics, {3.0, -2.0, 0.1});
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto squares = [](const PerWheel& f) { return f[0] * f[0] + f[1] * f[1] + f[2] * f[2] + f[3] * f[3]; };
  for (int round = 0; round < 100; ++round) {
    PerWheel other{any(engine), any(engine), any(engine), any(engine)};
    const PerWheel effective = rolling_forces_N(kinematics, wrench_of_rolling_forces(kinematics, other));
    for (int i = 0; i < 4; ++i) {
      other[i] = force_N[i] + other[i] - effective[i];  // keeps the wrench
    }
    EXPECT_NEAR(magnitude(wrench_of_rolling_forces(kinematics, other)), magnitude({3.0, -2.0, 0.1}), 1e-12);
    EXPECT_GE(squares(other), squares(force_N) - 1e-12);
  }
}

TEST(Kinematics, the_mirrored_robot_swaps_its_wheels) {
  for (const std::string& id : kShipped) {
    const Kinematics kinematics = make_kinematics(shipped_robot(id));
    const PerWheel there = wheel_speeds_rad_per_s(kinematics, {1.2, 0.7, 2.0});
    const PerWheel mirrored = wheel_speeds_rad_per_s(kinematics, {1.2, -0.7, -2.0});
    EXPECT_NEAR(there[0], -mirrored[1], 1e-12);
    EXPECT_NEAR(there[3], -mirrored[2], 1e-12);
  }
}

TEST(Kinematics, a_quarter_turn_of_a_square_robot_moves_the_wheels_on) {
  const Kinematics kinematics = make_kinematics(bare_robot());
  const PerWheel ahead = wheel_speeds_rad_per_s(kinematics, {1.0, 0.3, 2.0});
  const PerWheel left = wheel_speeds_rad_per_s(kinematics, {-0.3, 1.0, 2.0});
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(left[(i + 1) % 4], ahead[i], 1e-12);
  }
}

/// On a circle at constant speed the local velocity is constant, but the body accelerates to its left.
TEST(Kinematics, local_rates_are_not_the_acceleration) {
  const BodyVelocity velocity{2.0, 0.0, 3.0};
  const BodyAcceleration acceleration = acceleration_from_rates(velocity, {});
  EXPECT_EQ(acceleration.x_m_per_s2, 0.0);
  EXPECT_EQ(acceleration.y_m_per_s2, 6.0);
  const BodyAcceleration rates = rates_from_acceleration(velocity, acceleration);
  EXPECT_EQ(rates.x_m_per_s2, 0.0);
  EXPECT_EQ(rates.y_m_per_s2, 0.0);
}

TEST(Kinematics, frames_turn_with_the_yaw) {
  const BodyVelocity global = to_global(BodyVelocity{1.0, 0.0, 0.5}, 90.0 * kDeg);
  EXPECT_NEAR(global.x_m_per_s, 0.0, 1e-15);
  EXPECT_NEAR(global.y_m_per_s, 1.0, 1e-15);
  const BodyVelocity local = to_local(global, 90.0 * kDeg);
  EXPECT_NEAR(local.x_m_per_s, 1.0, 1e-15);
  EXPECT_EQ(local.yaw_rad_per_s, 0.5);
  EXPECT_NEAR(to_local(Wrench{0.0, 2.0, 1.0}, 90.0 * kDeg).x_N, 2.0, 1e-15);
  EXPECT_NEAR(to_local(BodyAcceleration{0.0, 2.0, 1.0}, 90.0 * kDeg).x_m_per_s2, 2.0, 1e-15);
}

TEST(Kinematics, robots_that_cannot_be_driven_are_refused) {
  Robot five = bare_robot();
  five.wheels.axis_rad.push_back(0.0);
  EXPECT_THROW(make_kinematics(five), base::Failure);
  Robot parallel = bare_robot();
  parallel.wheels.axis_rad = {0.3, 0.3, 0.3};
  EXPECT_THROW(make_kinematics(parallel), base::Failure);
}

// Two pairs of axles with an angle ε between them: ahead the wheels roll at about ε/2 per unit of speed, to the left at 1.
TEST(Kinematics, axles_that_are_next_to_parallel_are_refused) {
  Robot robot = bare_robot();
  const auto with_angle = [&](double angle_rad) {
    robot.wheels.axis_rad = {0.0, angle_rad, std::numbers::pi, std::numbers::pi + angle_rad};
    return make_kinematics(robot);
  };
  for (const double angle_deg : {0.0, 1e-9, 1e-7, 1e-3, 0.03}) {
    EXPECT_THROW((void)with_angle(angle_deg * kDeg), base::Failure) << angle_deg;
  }
  for (const double radius_m : {0.02, 0.08, 1.5}) {
    robot.wheels.contact_radius_m = radius_m;
    const PerWheel ahead = wheel_speeds_rad_per_s(with_angle(5.0 * kDeg), {1.0, 0.0, 0.0});
    EXPECT_NEAR(ahead[1], -std::sin(5.0 * kDeg) / robot.wheels.radius_m, 1e-9);
  }
  for (const std::string& shipped : kShipped) {
    EXPECT_NO_THROW((void)make_kinematics(shipped_robot(shipped)));
  }
}

}  // namespace
}  // namespace heatsoak::robot
