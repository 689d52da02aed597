#include "robot/inverse_dynamics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "motor/datasheet_network.h"
#include "robot/plant.h"
#include "robots_for_tests.h"
#include "support/wheel_friction.h"

namespace heatsoak::robot {
namespace {

constexpr double kWeight_N = 2.5 * kGravity_m_per_s2;

BodyConfig bare_body() { return make_body(bare_robot(), bare_motor()); }

double sum(const PerWheel& values) { return values[0] + values[1] + values[2] + values[3]; }

// 2.5 kg at 2 m/s² need 5 N. Each of four wheels at 45° transmits 5/(4·0.7071) = 1.7678 N, which is 53.033 mN m at 30 mm. Accelerating the
// wheels, J = 3e-5 + 1e-5 = 4e-5 kg m², needs another 4e-5·2·0.7071/0.03 = 1.8856 mN m.
TEST(InverseDynamics, square_robot_ahead_by_hand) {
  const WheelDemands out = inverse_dynamics(bare_body(), {{1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {}, 0.0});
  const PerWheel sign{1.0, -1.0, -1.0, 1.0};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(out.rolling_force_N[i], sign[i] * 1.76777, 1e-5);
    EXPECT_NEAR(out.torque_Nm[i], sign[i] * (0.0530330 + 0.0018856), 1e-7);
    EXPECT_NEAR(out.speed_rad_per_s[i], sign[i] * 0.70711 / 0.03, 1e-3);
  }
  EXPECT_EQ(out.transmitted_share, 1.0);
  EXPECT_EQ(magnitude(out.untransmitted), 0.0);
}

TEST(InverseDynamics, turning_on_a_circle_needs_the_centripetal_force_and_no_spin_up) {
  const BodyConfig body = bare_body();
  const BodyMotion motion{{2.0, 0.0, 1.5}, acceleration_from_rates({2.0, 0.0, 1.5}, {}), {}, 0.0};
  const WheelDemands out = inverse_dynamics(body, motion);
  EXPECT_NEAR(wrench_of_rolling_forces(body.kinematics, out.rolling_force_N).y_N, 2.5 * 3.0, 1e-12);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(out.torque_Nm[i], out.rolling_force_N[i] * 0.03, 1e-14);
  }
}

TEST(InverseDynamics, the_global_trajectory_is_the_local_one_turned) {
  const BodyConfig body = make_body(lossy_robot(), bare_motor());
  const BodyVelocity velocity{1.0, -0.5, 2.0};
  const BodyAcceleration acceleration{0.7, 1.1, -3.0};
  const WheelDemands local = inverse_dynamics(body, {velocity, acceleration, {}, 0.0});
  const WheelDemands global =
      inverse_dynamics(body, local_motion(body, {3.0, -1.0, 2.1}, to_global(velocity, 2.1), to_global(acceleration, 2.1)));
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(global.torque_Nm[i], local.torque_Nm[i], 1e-14);
  }
}

/// Energy balance: Σ torque·speed = change of kinetic energy + losses by friction, drag and rolling.
TEST(InverseDynamics, power_of_the_wheels_is_accounted_for) {
  const BodyConfig body = make_body(lossy_robot(), bare_motor());
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int round = 0; round < 200; ++round) {
    const BodyVelocity v{any(engine), any(engine), any(engine)};
    const BodyAcceleration rates{0.5 * any(engine), 0.5 * any(engine), 5.0 * any(engine)};
    const WheelDemands out = inverse_dynamics(body, {v, acceleration_from_rates(v, rates), {}, 0.0});
    ASSERT_EQ(out.transmitted_share, 1.0);
    const PerWheel friction_Nm = friction_torques_Nm(body.friction, body.kinematics, v, out.speed_rad_per_s);
    const PerWheel lateral_m_per_s = lateral_speeds_m_per_s(body.kinematics, v);
    double wheels_W = 0.0;
    double losses_W = 0.0;
    for (int i = 0; i < 4; ++i) {
      wheels_W += out.torque_Nm[i] * out.speed_rad_per_s[i];
      losses_W += friction_Nm[i] * out.speed_rad_per_s[i] -
                  contact_ratios(body.traction, 0.0, lateral_m_per_s[i]).lateral_ratio * out.normal_force_N[i] * lateral_m_per_s[i] +
                  loss_torque_Nm(1.0 / body.rolling_efficiency - 1.0, 1.0 - body.rolling_efficiency, out.rolling_force_N[i] * 0.03,
                                 smooth_sign(out.speed_rad_per_s[i], body.friction.smoothing_rad_per_s)) *
                      out.speed_rad_per_s[i];
    }
    const double h_s = 1e-5;
    const auto energy_J = [&](double t_s) {
      const BodyVelocity at{v.x_m_per_s + t_s * rates.x_m_per_s2, v.y_m_per_s + t_s * rates.y_m_per_s2,
                            v.yaw_rad_per_s + t_s * rates.yaw_rad_per_s2};
      return kinetic_energy_J(body, at, wheel_speeds_rad_per_s(body.kinematics, at));
    };
    EXPECT_NEAR(wheels_W, losses_W + (energy_J(h_s) - energy_J(-h_s)) / (2.0 * h_s), 1e-7);
  }
}

TEST(InverseDynamics, mirrored_motion_has_mirrored_wheels) {
  for (const char* id : {"roboteam_twente_v2025", "tigers_v2020"}) {
    const Robot robot = shipped_robot(id);
    const BodyConfig body = make_body(robot, shipped_motor("nanotec_df45l024048_a2").nominal);
    const WheelDemands there = inverse_dynamics(body, {{1.0, 0.4, 2.0}, {1.5, -0.6, 4.0}, {}, 0.0});
    const WheelDemands mirrored = inverse_dynamics(body, {{1.0, -0.4, -2.0}, {1.5, 0.6, -4.0}, {}, 0.0});
    EXPECT_NEAR(there.torque_Nm[0], -mirrored.torque_Nm[1], 1e-13);
    EXPECT_NEAR(there.torque_Nm[2], -mirrored.torque_Nm[3], 1e-13);
    EXPECT_NEAR(there.normal_force_N[0], mirrored.normal_force_N[1], 1e-12);
  }
}

TEST(InverseDynamics, a_square_robot_may_be_turned_by_a_quarter) {
  Robot robot = bare_robot();
  robot.friction.roller_drag_ratio = 0.1;
  robot.friction.wheel_torque_Nm = 0.004;
  const BodyConfig body = make_body(robot, bare_motor());
  const WheelDemands ahead = inverse_dynamics(body, {{1.0, 0.2, 1.0}, {2.0, 0.5, 3.0}, {}, 0.0});
  const WheelDemands left = inverse_dynamics(body, {{-0.2, 1.0, 1.0}, {-0.5, 2.0, 3.0}, {}, 0.0});
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(left.torque_Nm[(i + 1) % 4], ahead.torque_Nm[i], 1e-13);
    EXPECT_NEAR(left.normal_force_N[(i + 1) % 4], ahead.normal_force_N[i], 1e-12);
  }
}

// At 3 m/s² ahead, h = 50 mm: S_x = −0.05·7.5 = −0.375 N m over contact points at ±56.57 mm. The front wheels lose and the rear wheels gain
// 0.375/(4·0.05657) = 1.6573 N of 6.1292 N each.
TEST(NormalLoads, move_to_the_rear_by_hand) {
  const WheelDemands out = inverse_dynamics(bare_body(), {{}, {3.0, 0.0, 0.0}, {}, 0.0});
  EXPECT_NEAR(out.normal_force_N[0], 6.12916 - 1.65728, 1e-4);
  EXPECT_NEAR(out.normal_force_N[2], 6.12916 + 1.65728, 1e-4);
}

TEST(NormalLoads, add_up_to_the_weight_and_hold_the_moment) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int lifted = 0;
  for (int round = 0; round < 2000; ++round) {
    Robot robot = bare_robot();
    robot.wheels.axis_rad = {-0.6, 0.5, 2.3, -2.4};
    if (round % 2 == 0) {
      robot.wheels.axis_rad.resize(3);
    }
    const Kinematics kinematics = make_kinematics(robot);
    const WeightConfig weight = make_weight(kinematics, 2.5, 0.05, 0.01 * any(engine), 0.01 * any(engine));
    const LoadMoment moment = load_moment(weight, {10.0 * any(engine), 10.0 * any(engine), 0.0}, {5.0 * any(engine), 0.0, 0.0}, 0.1);
    const NormalLoads loads = normal_loads(weight, moment);
    EXPECT_NEAR(sum(loads.force_N), kWeight_N, 1e-10);
    double x_Nm = 0.0;
    for (int i = 0; i < weight.wheel_count; ++i) {
      EXPECT_GE(loads.force_N[i], 0.0);
      x_Nm += loads.force_N[i] * weight.contact_x_m[i];
    }
    lifted += loads.lifted ? 1 : 0;
    if (!loads.lifted) {
      EXPECT_NEAR(x_Nm, moment.x_Nm, 1e-10);
    }
  }
  EXPECT_GT(lifted, 0);
  EXPECT_LT(lifted, 1500);
}

// At 45° each newton along a wheel contributes 0.7071 N. If all load is used, μ·m·g·0.7071 = 12.135 N are available for any load transfer,
// 4.8540 m/s² for 2.5 kg. The rear wheels must then provide the force that the front wheels cannot. The loads are those of the demand: at 6
// m/s² front 6.1292 − 3.3146 N, rear 6.1292 + 3.3146 N.
TEST(InverseDynamics, traction_limits_the_acceleration) {
  const BodyConfig body = bare_body();
  const WheelDemands four = inverse_dynamics(body, {{}, {4.0, 0.0, 0.0}, {}, 0.0});
  EXPECT_EQ(four.transmitted_share, 1.0);
  // By least squares each wheel would give 10/(4·0.7071) = 3.536 N, but the front wheels can transmit only 0.7·(6.1292 − 2.2097) = 2.7436
  // N.
  EXPECT_NEAR(four.rolling_force_N[0], 2.74362, 1e-4);
  EXPECT_NEAR(four.rolling_force_N[3], 2.0 * 3.53553 - 2.74362, 1e-4);
  EXPECT_NEAR(four.traction_use_ratio[0], 1.0, 1e-12);
  EXPECT_NEAR(wrench_of_rolling_forces(body.kinematics, four.rolling_force_N).x_N, 10.0, 1e-12);

  const WheelDemands six = inverse_dynamics(body, {{}, {6.0, 0.0, 0.0}, {}, 0.0});
  EXPECT_NEAR(six.achievable.x_m_per_s2, 0.7 * kGravity_m_per_s2 * std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(six.transmitted_share, six.achievable.x_m_per_s2 / 6.0, 1e-12);
  EXPECT_NEAR(six.untransmitted.x_N, 2.5 * (6.0 - six.achievable.x_m_per_s2), 1e-9);
  EXPECT_GT(six.traction_use_ratio[0], 1.0);

  const WheelDemands twelve = inverse_dynamics(body, {{}, {12.0, 0.0, 0.0}, {}, 0.0});
  EXPECT_TRUE(twelve.lifted);
  EXPECT_NEAR(twelve.achievable.x_m_per_s2, 0.7 * kGravity_m_per_s2 * std::sqrt(0.5), 1e-6);
}

// With three wheels the distribution is unique, and the wheel with the least grip limits it.
TEST(InverseDynamics, three_wheels_cannot_take_over) {
  Robot robot = bare_robot();
  robot.wheels.axis_rad = {std::numbers::pi / 3.0, std::numbers::pi, -std::numbers::pi / 3.0};
  robot.body.center_of_gravity_height_m = 0.0;
  const WheelDemands out = inverse_dynamics(make_body(robot, bare_motor()), {{}, {12.0, 0.0, 0.0}, {}, 0.0});
  // Wheels 1 and 3 share 30 N, each 30° off the direction: 30/(2·0.8660) of 0.7·24.517/3.
  EXPECT_NEAR(out.transmitted_share, 0.7 * kWeight_N / 3.0 / (30.0 / std::sqrt(3.0)), 1e-9);
}

TEST(InverseDynamics, delivered_forces_never_exceed_the_grip) {
  const BodyConfig body = make_body(lossy_robot(), bare_motor());
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int round = 0; round < 5000; ++round) {
    const BodyMotion motion{{any(engine), any(engine), 10.0 * any(engine)},
                            {10.0 * any(engine), 10.0 * any(engine), 100.0 * any(engine)},
                            {15.0 * any(engine), 15.0 * any(engine), any(engine)},
                            0.06};
    const WheelDemands out = inverse_dynamics(body, motion);
    const double grip_ratio = std::sqrt(0.7 * 0.7 - 0.12 * 0.12);
    for (int i = 0; i < 4; ++i) {
      EXPECT_LE(std::abs(out.rolling_force_N[i]), grip_ratio * out.normal_force_N[i] + 1e-8);
    }
    EXPECT_GE(out.transmitted_share, 0.0);
    EXPECT_LE(out.transmitted_share, 1.0);
    // The achievable acceleration must need exactly the transmitted wrench.
    BodyMotion less = motion;
    less.acceleration = out.achievable;
    const Wrench missing = wrench_of_acceleration(body, motion.velocity.yaw_rad_per_s, motion.acceleration);
    const Wrench got = wrench_of_acceleration(body, motion.velocity.yaw_rad_per_s, less.acceleration);
    EXPECT_NEAR(missing.x_N - got.x_N, out.untransmitted.x_N, 1e-10);
    EXPECT_NEAR(missing.yaw_Nm - got.yaw_Nm, out.untransmitted.yaw_Nm, 1e-10);
  }
}

// A duel at standstill: 10 N against another robot, wheels at rest. 10/(4·0.7071) N · 30 mm = 106.07 mN m each. The other robot pushes at
// ground level, so no load is transferred.
TEST(InverseDynamics, push_at_standstill_is_a_stall) {
  const WheelDemands out = inverse_dynamics(bare_body(), {{}, {}, {-10.0, 0.0, 0.0}, 0.0});
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(out.speed_rad_per_s[i], 0.0);
    EXPECT_NEAR(std::abs(out.torque_Nm[i]), 0.106066, 1e-6);
  }
  EXPECT_EQ(out.transmitted_share, 1.0);
  // 30 N exceed the grip: the robot is pushed back, and the untransmitted force is reported.
  const WheelDemands beyond = inverse_dynamics(bare_body(), {{}, {}, {-30.0, 0.0, 0.0}, 0.0});
  EXPECT_EQ(beyond.transmitted_share, 0.0);
  EXPECT_LT(beyond.achievable.x_m_per_s2, -1.0);
  EXPECT_NEAR(beyond.untransmitted.x_N, -2.5 * beyond.achievable.x_m_per_s2, 1e-12);
}

/// TIGERs measured 2.65 N in translation and 0.097 N m in rotation. Both include the drag of the motors.
TEST(Friction, of_tigers_is_what_they_measured) {
  const Robot robot = shipped_robot("tigers_v2020");
  const motor::MotorValues motor = shipped_motor("nanotec_df45l024048_a2").nominal;
  BodyConfig body = make_body(robot, motor);
  body.rolling_efficiency = 1.0;
  body.friction.wheel_torque_Nm += motor.torque_constant_Nm_per_A * motor.no_load_current_A;
  const auto power_W = [&](const BodyVelocity& velocity) {
    const WheelDemands out = inverse_dynamics(body, {velocity, {}, {}, 0.0});
    double sum_W = 0.0;
    for (int i = 0; i < 4; ++i) {
      sum_W += out.torque_Nm[i] * out.speed_rad_per_s[i];
    }
    return sum_W;
  };
  double mean_N = 0.0;
  for (int i = 0; i < 72; ++i) {
    const double heading_rad = (i + 0.5) * 5.0 * std::numbers::pi / 180.0;
    mean_N += power_W({std::cos(heading_rad), std::sin(heading_rad), 0.0}) / 72.0;
  }
  EXPECT_NEAR(mean_N, 2.65, 0.05);
  EXPECT_NEAR(power_W({0.0, 0.0, 10.0}) / 10.0, 0.097, 0.001);
}

/// Curve of Twente's firmware for wheel 1, with θ_f measured from left to ahead: 1.23 V + 0.46 V·sin(2θ_f − 0.987).
TEST(Friction, of_twente_is_their_curve) {
  const Robot robot = shipped_robot("roboteam_twente_v2024");
  const motor::MotorValues motor = shipped_motor("maxon_ecx_flat_32l_48v").nominal;
  // The team divides its voltages by the winding's resistance without the motor controller's.
  const DriveConstants drive{motor.terminal_resistance_ohm, motor.torque_constant_Nm_per_A, motor::drag_torque_Nm(motor)};
  BodyConfig body = make_body(robot, motor);
  EXPECT_EQ(body.traction.roller_drag_ratio, 0.0);
  body.friction.wheel_damping_Nm_s_per_rad = 0.0;
  for (int i = 0; i < 36; ++i) {
    const double heading_rad = (10.0 * i + 2.5) * std::numbers::pi / 180.0;
    const WheelDemands out = inverse_dynamics(body, {{2.0 * std::cos(heading_rad), 2.0 * std::sin(heading_rad), 0.0}, {}, {}, 0.0});
    const double firmware_rad = std::numbers::pi / 2.0 - heading_rad;
    const double side = std::sin(firmware_rad + std::numbers::pi / 3.0);
    const double voltage_V = 1.23 + 0.46 * std::sin(2.0 * firmware_rad - 0.987);
    if (std::abs(side) > 0.1) {
      EXPECT_NEAR(out.torque_Nm[0], std::copysign(friction_torque_of_voltage_Nm(drive, voltage_V), side), 3e-4) << heading_rad;
    }
  }
  const WheelDemands turning = inverse_dynamics(body, {{0.0, 0.0, 6.0}, {}, {}, 0.0});
  EXPECT_NEAR(turning.torque_Nm[0], friction_torque_of_voltage_Nm(drive, 0.3), 1e-4);
}

/// Reference: f(θ) = a·sin(θ + φ_i) + b·sign(sin(θ + φ_i)), ETDP 2025, equation (3); φ_i is the wheel's rolling direction.
TEST(Friction, equation_3_of_the_paper) {
  FrictionConfig friction;
  friction.by_heading = true;
  friction.heading.constant_Nm.fill(0.02);
  friction.heading.sine_Nm.fill(0.01);
  friction.heading.rotation_Nm = 0.005;
  friction.smoothing_rad_per_s = 1e-9;
  const Kinematics kinematics = make_kinematics(shipped_robot("roboteam_twente_v2024"));
  for (int i = 0; i < 36; ++i) {
    const double heading_rad = (10.0 * i + 1.0) * std::numbers::pi / 180.0;
    const BodyVelocity v{std::cos(heading_rad), std::sin(heading_rad), 0.0};
    const PerWheel f = friction_torques_Nm(friction, kinematics, v, wheel_speeds_rad_per_s(kinematics, v));
    // Wheel 1 rolls along 60°: cos(θ − 60°) = sin(θ + 30°).
    const double s = std::sin(heading_rad + std::numbers::pi / 6.0);
    EXPECT_NEAR(f[0], 0.01 * s + std::copysign(0.02, s), 1e-12);
  }
}

/// The mean roller drag alone explains why Twente's wheels have more friction ahead than sideways.
TEST(Friction, roller_drag_costs_more_ahead_than_sideways) {
  Robot robot = shipped_robot("roboteam_twente_v2024");
  robot.friction.heading.constant_Nm.reset();
  const BodyConfig body = make_body(robot, bare_motor());
  const WheelDemands ahead = inverse_dynamics(body, {{1.0, 0.0, 0.0}, {}, {}, 0.0});
  const WheelDemands left = inverse_dynamics(body, {{0.0, 1.0, 0.0}, {}, {}, 0.0});
  for (int i = 0; i < 4; ++i) {
    EXPECT_GT(std::abs(ahead.torque_Nm[i]), std::abs(left.torque_Nm[i]));
  }
}

TEST(Friction, voltages_become_torques) {
  const DriveConstants drive{.resistance_ohm = 0.6, .torque_constant_Nm_per_A = 0.035, .drag_torque_Nm = 0.007, .gear_ratio = 2.0};
  EXPECT_NEAR(friction_torque_of_voltage_Nm(drive, 1.2), (2.0 * 0.035 - 0.007) * 2.0, 1e-15);
  EXPECT_EQ(friction_torque_of_voltage_Nm(drive, 0.05), 0.0);
  // 0.09 V s/rad at the wheel: 0.07 are back-EMF, the rest gives 0.02 V/(rad/s)/0.6 Ω·35 mN m/A·2.
  EXPECT_NEAR(damping_of_voltage_Nm_s_per_rad(drive, 0.09), 0.02 / 0.6 * 0.035 * 2.0, 1e-15);
}

TEST(Friction, torques_become_the_same_voltages_again) {
  const DriveConstants drive = drive_constants(lossy_robot(), lossy_motor());
  EXPECT_NEAR(drive.resistance_ohm, 0.61, 1e-15);  // sum of winding and motor controller
  for (const double speed_rad_per_s : {-40.0, -3.0, 5.0, 60.0}) {
    const double side = speed_rad_per_s > 0.0 ? 1.0 : -1.0;
    const double damping_V_s_per_rad = 0.08;
    const double constant_V = 1.1;
    const double torque_Nm = friction_torque_of_voltage_Nm(drive, constant_V) * side +
                             damping_of_voltage_Nm_s_per_rad(drive, damping_V_s_per_rad) * speed_rad_per_s;
    EXPECT_NEAR(steady_voltage_V(drive, torque_Nm, speed_rad_per_s), damping_V_s_per_rad * speed_rad_per_s + constant_V * side, 1e-12);
  }
}

/// The plant must keep its speed at the voltage of the formula. Each wheel has its own curve with an offset.
TEST(Friction, of_each_wheel_keeps_the_plant_steady) {
  Robot robot = lossy_robot();
  robot.friction.rolling_efficiency = 1.0;
  robot.body.center_of_gravity_x_m = robot.body.center_of_gravity_y_m = 0.0;
  for (int i = 0; i < 4; ++i) {
    robot.friction.heading.wheels.push_back(
        {0.02 + 0.002 * i, 0.01 - 0.004 * i, -robot.wheels.axis_rad[static_cast<std::size_t>(i)] + 0.05 * i});
  }
  PlantConfig plant = make_plant(robot, lossy_motor(), 0.001);
  plant.body.friction.smoothing_rad_per_s = 1e-3;
  const DriveConstants drive = drive_constants(robot, lossy_motor());
  for (const double heading_rad : {0.3, 1.1, 2.6, 4.0}) {
    PlantState state = plant_at_rest(plant);
    state.velocity = {std::cos(heading_rad), std::sin(heading_rad), 0.0};
    state.wheel_speed_rad_per_s = wheel_speeds_rad_per_s(plant.body.kinematics, state.velocity);
    PlantInput input;
    for (int i = 0; i < 4; ++i) {
      const HeadingWheel& wheel = robot.friction.heading.wheels[static_cast<std::size_t>(i)];
      const double s = std::sin(heading_rad + wheel.phase_rad);
      const double speed_rad_per_s = state.wheel_speed_rad_per_s[i];
      const double torque_Nm =
          wheel.sine_Nm * s + std::copysign(wheel.constant_Nm, s) + robot.friction.wheel_damping_Nm_s_per_rad.value() * speed_rad_per_s;
      input.command[i] = {MotorCommand::Kind::voltage, steady_voltage_V(drive, torque_Nm, speed_rad_per_s)};
    }
    const PlantOutput output = step(plant, state, input);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(output.rolling_force_N[i], 0.0, 1e-5) << heading_rad << " wheel " << i + 1;
    }
    EXPECT_NEAR(state.velocity.x_m_per_s, std::cos(heading_rad), 1e-5);
  }
}

TEST(InverseDynamics, names_every_missing_value) {
  Robot robot = bare_robot();
  robot.body.yaw_inertia_kg_m2.reset();
  robot.traction.coefficient_ratio.reset();
  try {
    make_body(robot, bare_motor());
    FAIL();
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.diagnostics().size(), 2U);
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
  }
}

// The push acts at ground level, so no load is transferred. Four wheels at 45° transmit 4·μ·(m·g/4)·cos 45° along either axis.
TEST(LargestPush, of_a_square_robot_by_hand) {
  const BodyConfig body = bare_body();
  for (const double direction_rad : {0.0, 0.5 * std::numbers::pi, std::numbers::pi}) {
    EXPECT_NEAR(largest_push_N(body, direction_rad, 0.0), body.traction.traction_ratio * kWeight_N * std::numbers::sqrt2 / 2.0, 1e-6);
  }
}

TEST(LargestPush, is_where_the_first_force_is_left_untransmitted) {
  const BodyConfig body = make_body(lossy_robot(), bare_motor());
  for (int i = 0; i < 24; ++i) {
    const double direction_rad = std::numbers::pi / 12.0 * i;
    const double height_m = body.weight.center_of_gravity_height_m;
    const double most_N = largest_push_N(body, direction_rad, height_m);
    const auto missing_N = [&](double force_N) {
      const Wrench external{-force_N * std::cos(direction_rad), -force_N * std::sin(direction_rad), 0.0};
      return magnitude(inverse_dynamics(body, {{}, {}, external, height_m}).untransmitted);
    };
    EXPECT_GT(most_N, 0.2 * body.traction.traction_ratio * kWeight_N);
    EXPECT_LT(missing_N(0.9999 * most_N), 1e-6) << direction_rad;
    EXPECT_GT(missing_N(1.01 * most_N), 1e-3) << direction_rad;
  }
}

}  // namespace
}  // namespace heatsoak::robot
