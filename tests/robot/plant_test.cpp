#include "robot/plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "robot/inverse_dynamics.h"
#include "robots_for_tests.h"

namespace heatsoak::robot {
namespace {

PlantConfig bare_plant(double period_s = 0.001) { return make_plant(bare_robot(), bare_motor(), period_s); }

PlantState moving(const PlantConfig& plant, const BodyVelocity& velocity) {
  PlantState state = plant_at_rest(plant);
  state.velocity = velocity;
  state.wheel_speed_rad_per_s = wheel_speeds_rad_per_s(plant.body.kinematics, velocity);
  return state;
}

PlantInput all(MotorCommand::Kind kind, double value = 0.0) {
  PlantInput input;
  input.command.fill({kind, value});
  return input;
}

/// Smooth voltages that drive ahead, on a circle, and push sideways.
PlantInput lively(double t_s) {
  PlantInput input;
  for (int i = 0; i < kMostWheels; ++i) {
    const double sign = i == 0 || i == 3 ? 1.0 : -1.0;
    input.command[i] = {MotorCommand::Kind::voltage, sign * 4.0 * std::sin(9.0 * t_s) + 1.5 * std::cos(5.0 * t_s) + 0.3 * i};
    input.winding_C[i] = 40.0 + 20.0 * i;
    input.magnet_C[i] = 60.0;
  }
  input.external = {2.0 * std::sin(4.0 * t_s), 1.0, 0.02 * std::cos(3.0 * t_s)};
  input.external_height_m = 0.09;
  return input;
}

struct Balance {
  double battery_J = 0.0;
  double heat_J = 0.0;
  double kinetic_J = 0.0;
  double external_J = 0.0;
  [[nodiscard]] double residual_J() const { return battery_J + external_J - heat_J - kinetic_J; }
};

/// Simulates one second of lively(). The input is held over each coarse step, so that a finer period has the same input.
Balance balance_of_a_second(const Robot& robot, const motor::MotorValues& motor, int steps_per_hold) {
  constexpr double kHold_s = 0.002;
  PlantConfig plant = make_plant(robot, motor, kHold_s / steps_per_hold);
  plant.motor.torque_constant_fall_per_K = 0.001;
  PlantState state = moving(plant, {0.5, -0.2, 1.0});
  const PlantState before = state;
  Balance balance;
  for (int hold = 0; hold < 500; ++hold) {
    const PlantInput input = lively(hold * kHold_s);
    for (int i = 0; i < steps_per_hold; ++i) {
      const PlantOutput out = step(plant, state, input);
      balance.heat_J += (heat_W(out) + out.battery_loss_W) * plant.period_s;
      balance.external_J += out.external_W * plant.period_s;
    }
  }
  balance.battery_J = stored_energy_J(plant.battery, before.battery_charge_A_s) - stored_energy_J(plant.battery, state.battery_charge_A_s);
  balance.kinetic_J = kinetic_energy_J(plant.body, state.velocity, state.wheel_speed_rad_per_s) -
                      kinetic_energy_J(plant.body, before.velocity, before.wheel_speed_rad_per_s);
  return balance;
}

/// The battery's energy becomes heat, motion or external work, with an error of the method's order.
TEST(Plant, energy_is_conserved_to_second_order) {
  const Robot robot = lossy_robot();
  const Balance coarse = balance_of_a_second(robot, lossy_motor(), 4);
  const Balance fine = balance_of_a_second(robot, lossy_motor(), 8);
  const Balance finer = balance_of_a_second(robot, lossy_motor(), 16);
  std::cout << "out of the battery " << finer.battery_J << " J, heat " << finer.heat_J << " J, motion " << finer.kinetic_J
            << " J; residual " << balance_of_a_second(robot, lossy_motor(), 2).residual_J() << " J at 1 kHz, " << coarse.residual_J()
            << " J at 2 kHz, " << fine.residual_J() << " J at 4 kHz, " << finer.residual_J() << " J at 8 kHz\n";
  EXPECT_GT(finer.heat_J, 5.0);
  EXPECT_LT(std::abs(finer.residual_J()), 1e-4 * finer.heat_J);
  EXPECT_GT(std::log2(std::abs(coarse.residual_J() / fine.residual_J())), 1.8);
  EXPECT_GT(std::log2(std::abs(fine.residual_J() / finer.residual_J())), 1.8);
}

TEST(Plant, every_loss_is_a_loss) {
  const PlantConfig plant = make_plant(lossy_robot(), lossy_motor(), 0.001);
  PlantState state = plant_at_rest(plant);
  for (int i = 0; i < 3000; ++i) {
    PlantInput input = lively(0.001 * i);
    input.command[1].kind = i % 700 < 350 ? MotorCommand::Kind::voltage : MotorCommand::Kind::open;
    input.command[2] = {MotorCommand::Kind::current, 6.0 * std::sin(0.004 * i)};
    const PlantOutput out = step(plant, state, input);
    for (const PerWheel* const each :
         {&out.copper_W, &out.driver_W, &out.motor_drag_W, &out.gear_W, &out.rolling_W, &out.friction_W, &out.slip_W, &out.roller_W}) {
      for (const double power_W : *each) {
        ASSERT_GE(power_W, 0.0);
      }
    }
  }
}

/// Self-convergence of ROS2: the error of the final state is proportional to the square of the period.
TEST(Plant, converges_with_second_order) {
  const auto end = [](int steps_per_hold) {
    constexpr double kHold_s = 0.002;
    const PlantConfig plant = make_plant(lossy_robot(), lossy_motor(), kHold_s / steps_per_hold);
    PlantState state = moving(plant, {0.5, -0.2, 1.0});
    for (int hold = 0; hold < 200; ++hold) {
      const PlantInput input = lively(hold * kHold_s);
      for (int i = 0; i < steps_per_hold; ++i) {
        step(plant, state, input);
      }
    }
    return state;
  };
  const PlantState reference = end(256);
  const auto error_m = [&](int steps) {
    const PlantState state = end(steps);
    return std::hypot(state.pose.x_m - reference.pose.x_m, state.pose.y_m - reference.pose.y_m);
  };
  const double coarse_m = error_m(8);
  const double fine_m = error_m(16);
  std::cout << "position after 0.4 s, error " << error_m(2) << " m at 1 kHz, " << coarse_m << " m at 4 kHz, " << fine_m << " m at 8 kHz\n";
  EXPECT_NEAR(std::log2(coarse_m / fine_m), 2.0, 0.4);
  EXPECT_LT(error_m(2), 2e-3);
}

TEST(Plant, without_friction_it_coasts_for_ever) {
  const PlantConfig plant = bare_plant();
  PlantState state = moving(plant, {1.0, 0.5, 0.0});
  state.pose.yaw_rad = 0.3;
  for (int i = 0; i < 60'000; ++i) {
    step(plant, state, all(MotorCommand::Kind::open));
  }
  EXPECT_NEAR(state.velocity.x_m_per_s, 1.0, 1e-12);
  EXPECT_NEAR(state.velocity.y_m_per_s, 0.5, 1e-12);
  EXPECT_NEAR(std::hypot(state.pose.x_m, state.pose.y_m), 60.0 * std::hypot(1.0, 0.5), 1e-8);
}

/// Coasting with a spin: the wheels' momentum turns with the robot, m_w = Σ J·t·tᵀ/r² = 2·J/r². The local velocity therefore turns back by
/// only m/(m + m_w) of the yaw, and the path bends by m_w/(m + m_w) of 4 rad.
TEST(Plant, a_spinning_robot_coasts_on_a_wide_curve) {
  const PlantConfig plant = bare_plant();
  PlantState state = moving(plant, {1.0, 0.0, 2.0});
  for (int i = 0; i < 2000; ++i) {
    step(plant, state, all(MotorCommand::Kind::open));
  }
  const BodyVelocity global = to_global(state.velocity, state.pose.yaw_rad);
  const double wheels_kg = 2.0 * 4e-5 / 9e-4;
  EXPECT_NEAR(state.pose.yaw_rad, 4.0, 1e-3);
  EXPECT_NEAR(std::hypot(global.x_m_per_s, global.y_m_per_s), 1.0, 1e-3);
  EXPECT_NEAR(std::atan2(global.y_m_per_s, global.x_m_per_s), 4.0 * wheels_kg / (2.5 + wheels_kg), 1e-3);
}

/// With much grip and little slip, wheels and body are one mass: m + Σ J·(t·x/r)².
TEST(Plant, much_grip_is_a_rigid_coupling) {
  Robot robot = bare_robot();
  robot.traction.coefficient_ratio = 50.0;
  robot.traction.slip_speed_m_per_s = 0.05;
  robot.body.center_of_gravity_height_m = 0.0;
  const PlantConfig plant = make_plant(robot, bare_motor(), 0.001);
  PlantState state = plant_at_rest(plant);
  PlantInput input;
  for (int i = 0; i < kMostWheels; ++i) {
    input.command[i] = {MotorCommand::Kind::current, i == 0 || i == 3 ? 2.0 : -2.0};
  }
  for (int i = 0; i < 500; ++i) {
    step(plant, state, input);
  }
  // Four wheels with 0.07 N m at 45°: 4·0.07·0.7071/0.03 = 6.5997 N on 2.5 kg + 4·4e-5·0.5/9e-4 = 2.58889 kg.
  const double acceleration_m_per_s2 = 4.0 * 0.07 * std::sqrt(0.5) / 0.03 / (2.5 + 4.0 * 4e-5 * 0.5 / 9e-4);
  EXPECT_NEAR(state.velocity.x_m_per_s, 0.5 * acceleration_m_per_s2, 2e-4);
  EXPECT_NEAR(state.wheel_speed_rad_per_s[0] * 0.03, std::sqrt(0.5) * state.velocity.x_m_per_s, 1e-3);
}

/// 0 V at the terminals is a short circuit. K_t²/R brakes exponentially with τ = m_eff·(R + R_d)·r²/(ΣK_t²·½).
TEST(Plant, zero_voltage_brakes_exponentially) {
  Robot robot = bare_robot();
  robot.traction.coefficient_ratio = 50.0;
  robot.body.center_of_gravity_height_m = 0.0;
  const PlantConfig plant = make_plant(robot, bare_motor(), 0.001);
  PlantState state = moving(plant, {1.0, 0.0, 0.0});
  double copper_J = 0.0;
  const double before_J = kinetic_energy_J(plant.body, state.velocity, state.wheel_speed_rad_per_s);
  for (int i = 0; i < 400; ++i) {
    const PlantOutput out = step(plant, state, all(MotorCommand::Kind::voltage));
    for (int w = 0; w < 4; ++w) {
      copper_J += (out.copper_W[w] + out.driver_W[w] - 0.5) * 0.001;
    }
  }
  const double mass_kg = 2.5 + 4.0 * 4e-5 * 0.5 / 9e-4;
  const double tau_s = mass_kg * 0.61 * 9e-4 / (4.0 * 0.5 * 0.035 * 0.035);
  EXPECT_NEAR(state.velocity.x_m_per_s, std::exp(-0.4 / tau_s), 1e-3);
  EXPECT_NEAR(copper_J, before_J - kinetic_energy_J(plant.body, state.velocity, state.wheel_speed_rad_per_s), 1e-3 * before_J);
}

/// Pushing against a rigid wall: no speed, currents U/R, and all power becomes heat.
TEST(Plant, stall_push_turns_all_power_into_heat) {
  const PlantConfig plant = bare_plant();
  PlantState state = plant_at_rest(plant);
  PlantInput input;
  for (int i = 0; i < kMostWheels; ++i) {
    input.command[i] = {MotorCommand::Kind::voltage, i == 0 || i == 3 ? 1.0 : -1.0};
    input.winding_C[i] = 125.0;
  }
  PlantOutput out;
  for (int i = 0; i < 4000; ++i) {
    // A stiff spring with a damper represents the wall.
    input.external = {-20'000.0 * state.pose.x_m - 300.0 * state.velocity.x_m_per_s, 0.0, 0.0};
    input.external_height_m = 0.05;
    out = step(plant, state, input);
  }
  const double winding_ohm = 0.6 * 1.39;
  for (int i = 0; i < kMostWheels; ++i) {
    // Creep turns the wheels slowly: U = I·R + K_t·ω.
    EXPECT_NEAR(std::abs(out.current_A[i]), (1.0 - 0.035 * std::abs(out.motor_speed_rad_per_s[i])) / (winding_ohm + 0.01), 1e-9);
    EXPECT_NEAR(out.copper_W[i], winding_ohm * out.current_A[i] * out.current_A[i], 1e-9);
    EXPECT_LT(std::abs(out.motor_speed_rad_per_s[i]), 1.0);
  }
  EXPECT_NEAR(state.velocity.x_m_per_s, 0.0, 1e-9);
  EXPECT_NEAR(out.battery_source_W, heat_W(out) + out.battery_loss_W, 1e-6);
  EXPECT_NEAR(-input.external.x_N, wrench_of_rolling_forces(plant.body.kinematics, out.rolling_force_N).x_N, 1e-6);
}

/// Full voltage on a slippery floor: the wheels spin, the force stays at μ·N, and the remaining power heats the contact.
TEST(Plant, too_much_torque_slips) {
  Robot robot = bare_robot();
  robot.traction.coefficient_ratio = 0.1;
  const PlantConfig plant = make_plant(robot, bare_motor(), 0.001);
  PlantState state = plant_at_rest(plant);
  PlantInput input;
  for (int i = 0; i < kMostWheels; ++i) {
    input.command[i] = {MotorCommand::Kind::voltage, i == 0 || i == 3 ? 12.0 : -12.0};
  }
  PlantOutput out;
  for (int i = 0; i < 300; ++i) {
    out = step(plant, state, input);
  }
  // All contacts transmit μ·N along 45°. Load moves between them, but its sum is constant.
  EXPECT_NEAR(state.velocity.x_m_per_s / 0.3, 0.1 * kGravity_m_per_s2 * std::sqrt(0.5), 0.01);
  EXPECT_GT(out.slip_m_per_s[0], 2.0);
  EXPECT_NEAR(out.slip_W[0], out.rolling_force_N[0] * out.slip_m_per_s[0], 1e-3);
}

/// An empty battery gives no power: the robot rolls out, and the energy balance still closes.
TEST(Plant, an_empty_battery_gives_nothing) {
  Robot robot = lossy_robot();
  robot.battery.capacity_A_s = 0.3;
  const PlantConfig plant = make_plant(robot, lossy_motor(), 0.0002);
  PlantState state = moving(plant, {0.5, -0.2, 1.0});
  const double before_J =
      kinetic_energy_J(plant.body, state.velocity, state.wheel_speed_rad_per_s) + stored_energy_J(plant.battery, state.battery_charge_A_s);
  double heat_J = 0.0;
  PlantOutput out;
  for (int i = 0; i < 20'000; ++i) {
    PlantInput input = lively(0.0002 * i);
    input.external = {};
    out = step(plant, state, input);
    heat_J += (heat_W(out) + out.battery_loss_W) * plant.period_s;
  }
  EXPECT_TRUE(out.undervoltage);
  EXPECT_EQ(out.battery_current_A, 0.0);
  EXPECT_NEAR(state.battery_charge_A_s, 0.0, 0.01);
  EXPECT_LT(std::hypot(state.velocity.x_m_per_s, state.velocity.y_m_per_s), 0.02);
  const double after_J =
      kinetic_energy_J(plant.body, state.velocity, state.wheel_speed_rad_per_s) + stored_energy_J(plant.battery, state.battery_charge_A_s);
  EXPECT_NEAR(heat_J, before_J - after_J, 2e-3 * before_J);
}

TEST(Plant, a_robot_that_falls_over_is_refused) {
  Robot robot = bare_robot();
  robot.wheels.axis_rad = {-0.2, 0.0, 0.2};
  EXPECT_THROW(make_plant(robot, bare_motor(), 0.001), base::Failure);
  robot.wheels.axis_rad = {-2.0, 0.0, 2.0};
  EXPECT_NO_THROW(make_plant(robot, bare_motor(), 0.001));
  robot.body.center_of_gravity_x_m = -0.05;
  EXPECT_THROW(make_plant(robot, bare_motor(), 0.001), base::Failure);
  robot = bare_robot();
  robot.body.center_of_gravity_x_m = 0.03;  // one wheel of four may lift off, three carry the load
  EXPECT_NO_THROW(make_plant(robot, bare_motor(), 0.001));
}

TEST(Plant, contacts_sum_up_to_the_weight_in_motion) {
  const PlantConfig plant = make_plant(lossy_robot(), lossy_motor(), 0.001);
  PlantState state = plant_at_rest(plant);
  for (int i = 0; i < 1000; ++i) {
    const PlantOutput out = step(plant, state, lively(0.001 * i));
    EXPECT_NEAR(out.normal_force_N[0] + out.normal_force_N[1] + out.normal_force_N[2] + out.normal_force_N[3], 2.5 * kGravity_m_per_s2,
                1e-9);
  }
}

TEST(Plant, limits_of_current_voltage_and_battery_hold) {
  Robot robot = lossy_robot();
  robot.drive.current_limit_A = 5.0;
  robot.drive.voltage_limit_V = 12.0;
  const PlantConfig plant = make_plant(robot, lossy_motor(), 0.001);
  PlantState state = plant_at_rest(plant);
  for (int i = 0; i < 1000; ++i) {
    const PlantOutput out =
        step(plant, state, all(i < 500 ? MotorCommand::Kind::current : MotorCommand::Kind::voltage, i < 500 ? 50.0 : -50.0));
    EXPECT_TRUE(out.limited);
    EXPECT_LT(out.battery_V, 25.0 + 0.05 * 20.0);
    for (int w = 0; w < kMostWheels; ++w) {
      EXPECT_LE(std::abs(out.current_A[w]), 5.0 + 1e-9);
      EXPECT_LE(std::abs(out.terminal_V[w]), 12.0 + 5.0 * 0.01 + 1e-9);
    }
  }
}

TEST(Plant, the_bus_clamps_where_the_battery_sags) {
  Robot robot = bare_robot();
  robot.battery.resistance_ohm = 0.1;
  const PlantConfig plant = make_plant(robot, bare_motor(), 0.001);
  PlantState state = plant_at_rest(plant);
  // At rest the battery sees four windings in parallel, 0.61/4 Ω, because the motor controllers apply the full bus voltage.
  const PlantOutput out = step(plant, state, all(MotorCommand::Kind::voltage, 100.0));
  EXPECT_LT(out.battery_V, 17.0);
  EXPECT_NEAR(out.battery_source_W, out.battery_loss_W + out.battery_V * out.battery_current_A, 1.0);
  EXPECT_TRUE(out.limited);
}

/// A symmetric robot with mirrored commands drives the mirrored path.
TEST(Plant, mirrored_commands_have_the_mirrored_path) {
  Robot robot = lossy_robot();
  robot.body.center_of_gravity_y_m = 0.0;
  const PlantConfig plant = make_plant(robot, lossy_motor(), 0.001);
  PlantState there = plant_at_rest(plant);
  PlantState mirrored = plant_at_rest(plant);
  for (int i = 0; i < 800; ++i) {
    PlantInput input = lively(0.001 * i);
    input.winding_C.fill(50.0);
    PlantInput swapped = input;
    for (const auto& [a, b] : {std::pair{0, 1}, std::pair{1, 0}, std::pair{2, 3}, std::pair{3, 2}}) {
      swapped.command[a] = {input.command[b].kind, -input.command[b].value};
    }
    swapped.external = {input.external.x_N, -input.external.y_N, -input.external.yaw_Nm};
    step(plant, there, input);
    step(plant, mirrored, swapped);
  }
  EXPECT_NEAR(there.pose.x_m, mirrored.pose.x_m, 1e-10);
  EXPECT_NEAR(there.pose.y_m, -mirrored.pose.y_m, 1e-10);
  EXPECT_NEAR(there.pose.yaw_rad, -mirrored.pose.yaw_rad, 1e-10);
  EXPECT_NEAR(there.battery_charge_A_s, mirrored.battery_charge_A_s, 1e-9);
}

/// With the torques of the inverse dynamics the plant must follow the demanded motion except for slip.
TEST(Plant, follows_the_inverse_dynamics) {
  Robot robot = lossy_robot();
  robot.traction.slip_speed_m_per_s = 0.005;
  const motor::MotorValues motor = bare_motor();
  const PlantConfig plant = make_plant(robot, motor, 0.00025);
  const BodyConfig& body = plant.body;
  PlantState state = plant_at_rest(plant);
  for (int i = 0; i < 2000; ++i) {
    const double t_s = 0.00025 * i;
    const BodyVelocity v{1.5 * t_s, -0.5 * t_s, 2.0 * t_s};
    const WheelDemands out = inverse_dynamics(body, {v, acceleration_from_rates(v, {1.5, -0.5, 2.0}), {}, 0.0});
    PlantInput input;
    for (int w = 0; w < kMostWheels; ++w) {
      const double drives = out.torque_Nm[w] * out.speed_rad_per_s[w] >= 0.0 ? 1.0 / 0.9 : 0.9;
      input.command[w] = {MotorCommand::Kind::current, out.torque_Nm[w] * drives / 1.5 / motor.torque_constant_Nm_per_A};
    }
    step(plant, state, input);
  }
  EXPECT_NEAR(state.velocity.x_m_per_s, 0.75, 0.02);
  EXPECT_NEAR(state.velocity.y_m_per_s, -0.25, 0.02);
  EXPECT_NEAR(state.velocity.yaw_rad_per_s, 1.0, 0.04);
}

TEST(Battery, gives_what_its_stored_energy_loses) {
  const BatteryConfig battery{25.2, 19.8, 0.05, 4680.0};
  EXPECT_NEAR(stored_energy_J(battery, 4680.0), 22.5 * 4680.0, 1e-9);
  EXPECT_NEAR(open_circuit_V(battery, 2340.0), 22.5, 1e-12);
  const double charge_A_s = 3000.0;
  EXPECT_NEAR((stored_energy_J(battery, charge_A_s + 0.01) - stored_energy_J(battery, charge_A_s - 0.01)) / 0.02,
              open_circuit_V(battery, charge_A_s), 1e-7);
  const BatteryLoad load = battery_load(battery, 4680.0, 500.0);
  EXPECT_NEAR(load.terminal_V * load.current_A, 500.0, 1e-9);
  EXPECT_NEAR(load.terminal_V, 25.2 - 0.05 * load.current_A, 1e-12);
  EXPECT_TRUE(battery_load(battery, 4680.0, 4000.0).collapsed);
}

TEST(Driver, sinusoidal_current_heats_less_for_the_same_torque) {
  Robot robot = bare_robot();
  const MotorPoint block =
      motor_point(make_electrics(robot, bare_motor()), make_driver(robot), {MotorCommand::Kind::current, 4.0}, 0.0, 25.0, 25.0, 22.0);
  robot.drive.commutation = Commutation::sinusoidal;
  const MotorPoint sinusoidal =
      motor_point(make_electrics(robot, bare_motor()), make_driver(robot), {MotorCommand::Kind::current, 4.0}, 0.0, 25.0, 25.0, 22.0);
  EXPECT_NEAR(block.copper_W, 9.6, 1e-12);
  EXPECT_NEAR(sinusoidal.copper_W / block.copper_W, 0.912, 5e-4);
  EXPECT_NEAR(sinusoidal.input_W, sinusoidal.copper_W + sinusoidal.driver_W, 1e-12);
}

TEST(Robots, that_are_shipped_can_be_simulated_and_drawn) {
  for (const auto& entry : std::filesystem::directory_iterator(kSource / "robot_core/robots")) {
    if (entry.path().extension() != ".toml") {
      continue;
    }
    const Robot robot = read_robot(entry.path());
    EXPECT_GT(robot.limits.speed_m_per_s.value(), 1.0);
    EXPECT_GT(robot.limits.yaw_acceleration_rad_per_s2.value(), 1.0);
    const motor::MotorValues motor =
        shipped_motor(robot.drive.motor).nominal.rotor_inertia_kg_m2 ? shipped_motor(robot.drive.motor).nominal : lossy_motor();
    base::Random random(1, 2);
    const Robot drawn = draw_sample(robot, random);
    EXPECT_NE(drawn.body.yaw_inertia_kg_m2.value(), robot.body.yaw_inertia_kg_m2.value());
    const PlantConfig plant = make_plant(drawn, motor, 0.001);
    PlantState state = plant_at_rest(plant);
    for (int i = 0; i < 500; ++i) {
      PlantInput input;
      for (int w = 0; w < kMostWheels; ++w) {
        input.command[w] = {MotorCommand::Kind::voltage, w == 0 || w == 3 ? 6.0 : -6.0};
      }
      step(plant, state, input);
    }
    EXPECT_GT(state.velocity.x_m_per_s, 0.3) << robot.id;
    EXPECT_LT(state.velocity.x_m_per_s, 8.0) << robot.id;
  }
}

}  // namespace
}  // namespace heatsoak::robot
