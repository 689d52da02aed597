// Sensors and radio link, compared with their analytic statistics.
#include "simulate/sensing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/unknown.h"
#include "simulate/radio.h"
#include "support/shipped.h"

namespace heatsoak::simulate {
namespace {

constexpr double kPeriod_s = SimulatedRobot::kPeriod_s;

struct Statistics {
  double mean = 0.0;
  double sd = 0.0;
};

Statistics statistics_of(const std::vector<double>& values) {
  Statistics made;
  for (const double value : values) {
    made.mean += value / static_cast<double>(values.size());
  }
  for (const double value : values) {
    made.sd += (value - made.mean) * (value - made.mean) / static_cast<double>(values.size());
  }
  made.sd = std::sqrt(made.sd);
  return made;
}

/// Configuration without errors, to which each test adds its own.
SensingConfig silent() {
  SensingConfig config = ideal_sensing();
  config.has_motor_current = config.has_stator = config.has_ambient = false;
  return config;
}

TEST(Noise, is_normal_to_the_fourth_moment) {
  constexpr int kSeeds = 400, kDrawsOfSeed = 1000, kDraws = kSeeds * kDrawsOfSeed;
  double sum = 0.0, square = 0.0, fourth = 0.0, largest = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    base::Random random(seed, 0);
    for (int i = 0; i < kDrawsOfSeed; ++i) {
      const double x = noise(random);
      sum += x;
      square += x * x;
      fourth += x * x * x * x;
      largest = std::max(largest, std::abs(x));
    }
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 4.0 / std::sqrt(kDraws));
  EXPECT_NEAR(square / kDraws, 1.0, 4.0 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(fourth / kDraws, 2.7, 0.03);  // 3 − 6/5/4 for the sum of four uniform numbers
  EXPECT_LE(largest, 2.0 * std::sqrt(3.0) + 1e-9);
}

// The error of a period's count is the difference of two rounding errors. At n + f counts per period the count is n or n + 1, with standard
// deviation q·√(f·(1 − f)) and resolution q = 2π/(N·T). Averaged over all speeds, ∫f·(1 − f)df = 1/6 gives q/√6.
TEST(Sensing, encoder_noise_is_that_of_quantisation) {
  for (const double gear_ratio : {1.0, 3.0}) {
    robot::Robot robot = twente();
    robot.drive.gear_ratio = gear_ratio;
    SimulatedRobot simulated(robot, ecx_32(), 25.0);
    SensingConfig config = silent();
    config.encoder_turn_count = 8192.0;
    Sensing sensing(config, simulated, kPeriod_s, 3);
    std::array<robot::MotorCommand, robot::kMostWheels> command{};
    std::vector<double> errors_rad_per_s;
    robot::PerWheel before = simulated.state().wheel_speed_rad_per_s;
    for (int i = 0; i < 4000; ++i) {
      command.fill({robot::MotorCommand::Kind::voltage, 2.0 + 0.002 * i});
      const robot::PlantOutput& out = simulated.advance(command, {});
      sensing.follow(simulated, out);
      robot_core::Input input;
      sensing.sample(simulated, 25.0, input);
      const robot::PerWheel& now = simulated.state().wheel_speed_rad_per_s;
      for (int wheel = 0; wheel < 4; ++wheel) {
        errors_rad_per_s.push_back(static_cast<double>(input.wheel_speed_rad_per_s[wheel]) - 0.5 * (before[wheel] + now[wheel]));
      }
      before = now;
    }
    const double resolution_rad_per_s = 2.0 * std::numbers::pi / (8192.0 * gear_ratio * kPeriod_s);
    const Statistics errors = statistics_of(errors_rad_per_s);
    EXPECT_NEAR(errors.sd, resolution_rad_per_s / std::sqrt(6.0), 0.03 * resolution_rad_per_s) << gear_ratio;
    EXPECT_NEAR(errors.mean, 0.0, 1e-3 * resolution_rad_per_s);  // no count is ever lost
    EXPECT_LE(std::ranges::max(errors_rad_per_s), resolution_rad_per_s * (1.0 + 1e-4));
  }
}

TEST(Sensing, ideal_sensors_show_the_truth) {
  SimulatedRobot simulated(twente(), ecx_32(), 31.0, 47.0);
  Sensing sensing(ideal_sensing(), simulated, kPeriod_s, 3);
  const std::array<robot::MotorCommand, robot::kMostWheels> command{
      {{robot::MotorCommand::Kind::voltage, 2.0}, {robot::MotorCommand::Kind::voltage, 4.0}, {robot::MotorCommand::Kind::voltage, -1.0}}};
  for (int i = 0; i < 50; ++i) {
    const robot::PlantOutput& out = simulated.advance(command, {});
    sensing.follow(simulated, out);
    robot_core::Input input;
    sensing.sample(simulated, 31.0, input);
    for (int wheel = 0; wheel < 4; ++wheel) {
      EXPECT_FLOAT_EQ(input.wheel_speed_rad_per_s[wheel], static_cast<float>(simulated.state().wheel_speed_rad_per_s[wheel]));
      EXPECT_FLOAT_EQ(input.motor_current_A[wheel], static_cast<float>(out.current_A[wheel]));
      EXPECT_FLOAT_EQ(input.stator_C[wheel], static_cast<float>(simulated.stator_C(wheel)));
    }
    EXPECT_FLOAT_EQ(input.yaw_rate_rad_per_s, static_cast<float>(simulated.state().velocity.yaw_rad_per_s));
    EXPECT_FLOAT_EQ(input.battery_V, static_cast<float>(out.battery_V));
    EXPECT_FLOAT_EQ(input.ambient_C, 31.0F);
  }
  EXPECT_GT(simulated.stator_C(3), 46.0);
}

/// Returns yaw rates of a standing robot.
std::vector<double> gyro_at_rest(const SensingConfig& config, std::uint64_t seed, int samples) {
  const SimulatedRobot simulated(twente(), ecx_32(), 25.0);
  Sensing sensing(config, simulated, kPeriod_s, seed);
  std::vector<double> seen_rad_per_s;
  for (int i = 0; i < samples; ++i) {
    robot_core::Input input;
    sensing.sample(simulated, 25.0, input);
    seen_rad_per_s.push_back(static_cast<double>(input.yaw_rate_rad_per_s));
  }
  return seen_rad_per_s;
}

TEST(Sensing, gyro_noise_bias_and_drift) {
  SensingConfig config = silent();
  config.gyro_noise_rad_per_s = 0.003;
  const auto over_seeds = [&config] {
    std::vector<double> all_rad_per_s;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const std::vector<double> seen_rad_per_s = gyro_at_rest(config, seed, 1000);
      all_rad_per_s.insert(all_rad_per_s.end(), seen_rad_per_s.begin(), seen_rad_per_s.end());
    }
    return statistics_of(all_rad_per_s);
  };
  const Statistics noisy = over_seeds();
  EXPECT_NEAR(noisy.sd, 0.003, 0.03 * 0.003);
  EXPECT_NEAR(noisy.mean, 0.0, 4.0 * 0.003 / std::sqrt(20'000.0));
  config.gyro_step_rad_per_s = 0.002;  // white noise and the uniform rounding errors add up
  EXPECT_NEAR(over_seeds().sd, std::sqrt(0.003 * 0.003 + 0.002 * 0.002 / 12.0), 1e-4);
  SensingConfig slow = silent();
  slow.gyro_bias_rad_per_s = 0.002;
  slow.gyro_drift_rad_per_s_per_root_s = 0.01;
  std::vector<double> first, walked;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const std::vector<double> seen_rad_per_s = gyro_at_rest(slow, seed, 2000);
    first.push_back(seen_rad_per_s.front());
    walked.push_back(seen_rad_per_s.back() - seen_rad_per_s.front());
  }
  EXPECT_NEAR(statistics_of(first).sd, 0.002, 4.0 * 0.002 / std::sqrt(600.0));
  EXPECT_NEAR(statistics_of(walked).sd, 0.01 * std::sqrt(2.0), 4.0 * 0.01 * std::sqrt(2.0) / std::sqrt(600.0));
}

TEST(Sensing, what_is_not_fitted_has_no_sample) {
  const SimulatedRobot simulated(twente(), ecx_32(), 25.0);
  Sensing sensing(sensing_of(twente()), simulated, kPeriod_s, 1);
  robot_core::Input input;
  sensing.sample(simulated, 25.0, input);
  for (int wheel = 0; wheel < 4; ++wheel) {
    EXPECT_TRUE(std::isnan(input.motor_current_A[wheel]));  // Twente's motor controllers have no current sensor
    EXPECT_TRUE(std::isnan(input.stator_C[wheel]));
  }
  EXPECT_TRUE(std::isnan(input.ambient_C));
  EXPECT_TRUE(sensing_of(shipped_robot("tigers_v2020")).has_motor_current);
}

TEST(Sensing, defaults_are_plausible_and_ranges_are_kept) {
  for (const DeclaredNumber<SensingConfig>& each : sensing_numbers()) {
    const double value = SensingConfig{}.*each.value;
    EXPECT_TRUE(each.plausible.contains(value)) << each.spec.key;
    EXPECT_FALSE(each.derivation.empty()) << each.spec.key;
  }
  for (const DeclaredNumber<RadioConfig>& each : radio_numbers()) {
    EXPECT_TRUE(each.plausible.contains(RadioConfig{}.*each.value)) << each.spec.key;
    EXPECT_FALSE(each.derivation.empty()) << each.spec.key;
  }
  SensingConfig config;
  config.encoder_turn_count = -1.0;
  config.gyro_noise_rad_per_s = base::kUnknown;
  try {
    require_declared_ranges(config, sensing_numbers());
    FAIL();
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_EQ(failure.diagnostics().size(), 2U);
  }
}

TEST(PacketLoss, has_its_share_and_its_bursts) {
  for (const auto& [share, burst_count] : {std::pair(0.01, 2.0), std::pair(0.2, 1.5), std::pair(0.3, 10.0)}) {
    constexpr int kSeeds = 20, kPacketsOfSeed = 50'000, kPackets = kSeeds * kPacketsOfSeed;
    int lost = 0, bursts = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      PacketLoss loss(share, burst_count);
      base::Random random(seed, 0);
      bool arrived = true;
      for (int i = 0; i < kPacketsOfSeed; ++i) {
        const bool arrives = loss.arrives(random);
        lost += arrives ? 0 : 1;
        bursts += !arrives && arrived ? 1 : 0;
        arrived = arrives;
      }
    }
    // Burst lengths are geometric. The tolerance is four standard deviations of a sum over independent bursts.
    const double expected_bursts = kPackets * share / burst_count;
    const double share_sd = share * std::sqrt(2.0 / expected_bursts);
    EXPECT_NEAR(static_cast<double>(lost) / kPackets, share, 4.0 * share_sd);
    EXPECT_NEAR(static_cast<double>(lost) / bursts, burst_count, 4.0 * burst_count / std::sqrt(expected_bursts));
  }
}

/// A plan with constant velocity and yaw rate.
class Even final : public duty::Follower {
 public:
  void take(const duty::MotionCommand& command) override { static_cast<void>(command); }
  void advance(double step_s) override { time_s_ += step_s; }
  [[nodiscard]] robot::Pose pose() const override {
    return {velocity.x_m_per_s * time_s_, velocity.y_m_per_s * time_s_, velocity.yaw_rad_per_s * time_s_};
  }
  [[nodiscard]] robot::BodyVelocity velocity_global() const override { return velocity; }
  [[nodiscard]] robot::BodyAcceleration acceleration_global() const override { return {}; }
  [[nodiscard]] bool at_rest() const override { return false; }

  robot::BodyVelocity velocity{1.0, 0.5, 2.0};

 private:
  double time_s_ = 0.0;
};

// A robot that follows the plan at a fixed distance gets the plan's velocity plus gain times distance. Both are rotated to its heading when
// the packet arrives, so latencies cause no error. In a duel the component along the push is push_speed instead of the correction.
TEST(OffBoard, commands_the_plan_and_corrects_the_distance) {
  RadioConfig config = radio_of(twente());
  EXPECT_EQ(config.packet_rate_Hz, 60.0);
  EXPECT_EQ(radio_of(shipped_robot("tigers_v2020")).packet_rate_Hz, 100.0);
  config.loss_share = config.vision_noise_m = config.vision_noise_rad = 0.0;
  const robot::Pose behind{0.02, -0.01, 0.05};
  for (const double push_N : {0.0, 3.0}) {
    OffBoard off_board(config, 1);
    Even plan;
    const double x_m_per_s = push_N > 0.0 ? config.push_speed_m_per_s : config.position_gain_per_s * behind.x_m;
    int received = 0;
    for (int i = 0; i < 1000; ++i, plan.advance(kPeriod_s)) {
      const robot::Pose planned = plan.pose();
      const robot::Pose truth{planned.x_m - behind.x_m, planned.y_m - behind.y_m, planned.yaw_rad - behind.yaw_rad};
      const robot_core::Command* const command = off_board.advance(i * kPeriod_s, plan, truth, {push_N, 0.0, 0.0});
      if (command == nullptr || i < 100) {
        continue;
      }
      ++received;
      const robot::BodyVelocity expected =
          robot::to_local(robot::BodyVelocity{1.0 + x_m_per_s, 0.5 + config.position_gain_per_s * behind.y_m,
                                              2.0 + config.heading_gain_per_s * behind.yaw_rad},
                          truth.yaw_rad);
      EXPECT_NEAR(static_cast<double>(command->velocity.x), expected.x_m_per_s, 1e-4);
      EXPECT_NEAR(static_cast<double>(command->velocity.y), expected.y_m_per_s, 1e-4);
      EXPECT_NEAR(static_cast<double>(command->velocity.yaw), expected.yaw_rad_per_s, 1e-4);
      EXPECT_NEAR(static_cast<double>(command->push.x), push_N * std::cos(truth.yaw_rad), 1e-4);
    }
    EXPECT_NEAR(received, 54, 1);
    EXPECT_EQ(off_board.sent(), 60);
    EXPECT_EQ(off_board.lost(), 0);
  }
}

}  // namespace
}  // namespace heatsoak::simulate
