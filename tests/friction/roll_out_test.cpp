// Roll-outs of the plant with open motors, and of a lifted wheel by its closed-form solution.
#include "friction/roll_out.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "base/diagnostic.h"
#include "friction/read_friction_log.h"
#include "robot/plant.h"
#include "robot/robots_for_tests.h"
#include "support/seed_rate.h"

namespace heatsoak::friction {
namespace {

robot::PlantConfig rolling_robot() {
  robot::Robot robot = robot::bare_robot();
  robot.friction.wheel_torque_Nm = 0.012;
  robot.friction.wheel_damping_Nm_s_per_rad = 4e-4;
  motor::MotorValues motor;
  motor.terminal_resistance_ohm = 0.85;
  motor.torque_constant_Nm_per_A = 0.033;
  motor.no_load_current_A = 0.2;  // drag of 6.6 mN m
  motor.temperature_coefficient_per_K = 0.0;
  motor.rotor_inertia_kg_m2 = 7.2e-6;
  return robot::make_plant(robot, motor, 0.001);
}

/// Simulates a roll-out to standstill; a fifth of the rows is lost or wrong.
FrictionLog rolled(const robot::PlantConfig& plant, const robot::BodyVelocity& from, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> any(0.0, 1.0);
  robot::PlantState state = robot::plant_at_rest(plant);
  state.velocity = from;
  state.wheel_speed_rad_per_s = robot::wheel_speeds_rad_per_s(plant.body.kinematics, from);
  FrictionLog log;
  log.run_begins = {0};
  for (int row = 0; row < 200; ++row) {
    log.time_s.push_back(0.01 * row);
    const double fate = any(engine);
    for (std::size_t i = 0; i < 4; ++i) {
      const double speed = state.wheel_speed_rad_per_s[i] + 0.05 * normal(engine);
      log.wheel_speed_rad_per_s[i].push_back(fate < 0.1 ? std::nan("") : fate < 0.2 ? 200.0 * any(engine) : speed);
    }
    for (int n = 0; n < 10; ++n) {
      robot::step(plant, state, {});  // open motors
    }
  }
  return log;
}

// A fifth of the rows is lost or wrong, so that single roll-outs are not recognised or give a torque that is off by more.
TEST(RollOut, of_the_plant_gives_its_damping_and_friction) {
  const robot::PlantConfig plant = rolling_robot();
  constexpr int kSeeds = 10;
  constexpr int kRollOuts = 9;
  std::vector<RollOutResult> results;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    std::vector<FrictionLog> logs;
    for (std::uint64_t n = 0; n + 1 < kRollOuts; ++n) {
      const double heading_rad = 0.2 + static_cast<double>(n) * std::numbers::pi / 4.0;
      logs.push_back(rolled(plant, {2.0 * std::cos(heading_rad), 2.0 * std::sin(heading_rad), 0.0}, kRollOuts * seed + n));
    }
    logs.push_back(rolled(plant, {0.0, 0.0, 20.0}, kRollOuts * seed + kRollOuts - 1));
    const RollOutResult& found = results.emplace_back(roll_out(logs, plant.body, false));
    EXPECT_EQ(found.runs.back().kind, RollOut::rotation) << seed;
    EXPECT_NEAR(found.wheel_damping_Nm_s_per_rad[0]->value, 4e-4, 2e-5) << seed;
    for (const RollOutRun& run : found.runs) {
      EXPECT_GT(run.r2_ratio, 0.999) << seed;
    }
  }
  EXPECT_TRUE(holds_for_share(0.95, kSeeds * kRollOuts, [&](std::uint64_t roll_out) {
    const std::vector<RollOutRun>& runs = results[(roll_out - 1) / kRollOuts].runs;
    const std::uint64_t place = (roll_out - 1) % kRollOuts;
    return place < runs.size() && std::abs(runs[place].wheel_torque_Nm - (0.012 + 0.0066)) < 0.001;
  }));
  EXPECT_TRUE(holds_for_share(0.95, kSeeds, [&](std::uint64_t seed) {
    const Estimate& damping = *results[seed - 1].wheel_damping_Nm_s_per_rad[0];
    return damping.interval->low <= 4e-4 && 4e-4 <= damping.interval->high;
  }));
}

/// Closed-form solution of J·dω/dt = −τ − D·ω:  ω = (ω_0 + τ/D)·exp(−D·t/J) − τ/D.
TEST(RollOut, of_lifted_wheels_gives_each_its_own) {
  const robot::PlantConfig plant = rolling_robot();
  const double inertia_kg_m2 = plant.body.wheel_inertia_kg_m2;
  const std::array<double, 4> damping{3e-5, 5e-5, 8e-5, 2e-5};
  const std::array<double, 4> torque{2e-3, 3e-3, 2.5e-3, 4e-3};
  std::vector<FrictionLog> logs;
  for (int n = 0; n < 4; ++n) {
    std::mt19937_64 engine(static_cast<std::uint64_t>(n));
    std::normal_distribution<double> normal;
    FrictionLog& log = logs.emplace_back();
    log.run_begins = {0};
    for (int row = 0; row < 300; ++row) {
      const double time_s = 0.005 * row - 0.3;
      log.time_s.push_back(0.005 * row);
      for (std::size_t i = 0; i < 4; ++i) {
        const double dry = torque[i] / damping[i];
        const double rolling = (150.0 + dry) * std::exp(-damping[i] * time_s / inertia_kg_m2) - dry;
        log.wheel_speed_rad_per_s[i].push_back((time_s < 0.0 ? 150.0 : std::max(0.0, rolling)) + 0.1 * normal(engine));
        log.voltage_V[i].push_back(time_s < 0.0 ? 6.0 : 0.0);
      }
    }
  }
  const RollOutResult found = roll_out(logs, plant.body, true);
  EXPECT_EQ(found.runs.size(), 16U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(found.wheel_damping_Nm_s_per_rad[i]->value, damping[i], 0.03 * damping[i] + 1e-6);
    EXPECT_NEAR(found.wheel_torque_Nm[i]->value, torque[i], 0.03 * torque[i]);
  }
}

TEST(RollOut, of_one_lifted_wheel_needs_only_its_speed) {
  const robot::PlantConfig plant = rolling_robot();
  recording::Recording recording;
  recording.run_begins = {0};
  std::vector<double> speed_rad_per_s;
  for (int row = 0; row < 300; ++row) {
    recording.time_s.push_back(0.005 * row);
    speed_rad_per_s.push_back(std::max(0.0, 150.0 - 0.8 * row));
  }
  const auto channel = [](const char* key, std::vector<double> values) {
    recording::Channel made;
    made.quantity.key = key;
    made.values = std::move(values);
    return made;
  };
  recording.channels = {channel("wheel_speed_rad_per_s_2", speed_rad_per_s), channel("wheel_current_A_1", std::vector<double>(300, 0.0)),
                        channel("heading_field_rad", std::vector<double>(300, 0.0))};
  FrictionLogNeeds needs{.all_wheels = false, .voltage = false, .direction = std::nullopt, .drive = robot::DriveConstants{}};
  FrictionFindings findings;
  const FrictionLog log = friction_log(recording, robot::bare_robot(), needs, findings);
  EXPECT_TRUE(findings.empty());
  const RollOutResult found = roll_out({log}, plant.body, true);
  ASSERT_EQ(found.runs.size(), 1U);
  EXPECT_EQ(found.runs[0].wheel, 1);
  EXPECT_FALSE(found.wheel_damping_Nm_s_per_rad[0]);
  recording.channels.erase(recording.channels.begin());
  EXPECT_THROW(friction_log(recording, robot::bare_robot(), needs, findings), base::Failure);
}

TEST(RollOut, a_robot_that_is_driven_all_the_time_does_not_roll_out) {
  const robot::PlantConfig plant = rolling_robot();
  FrictionLog log = rolled(plant, {2.0, 0.0, 0.0}, 1);
  for (std::size_t i = 0; i < 4; ++i) {
    log.voltage_V[i].assign(log.rows(), 3.0);
  }
  EXPECT_TRUE(roll_out({log}, plant.body, false).runs.empty());
}

}  // namespace
}  // namespace heatsoak::friction
