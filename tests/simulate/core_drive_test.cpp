// Influence of sensors, radio, friction parameters and guard on the drive core.
#include "simulate/core_drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <vector>

#include "simulate/game_drives.h"
#include "simulate/match_trace.h"
#include "simulate/test_drive.h"
#include "support/allocation_counter.h"
#include "support/shipped.h"

namespace heatsoak::simulate {
namespace {

using robot_core::Reason;

duty::ScheduledCommand drive_to(double time_s, double x_m, double y_m, double yaw_rad) {
  return {time_s, duty::Phase::running, {.duration_s = 0.0, .stand = false, .x_m = x_m, .y_m = y_m, .yaw_rad = yaw_rad}};
}
std::vector<duty::ScheduledCommand> there_and_back() { return {drive_to(0.0, 1.2, 0.5, 0.8), drive_to(2.5, 0.0, 0.0, 0.0)}; }
constexpr double kThereAndBack_s = 5.0;

struct CoreDriven {
  DriveScore score;
  std::string csv;
};

CoreDriven drive(const robot::Robot& robot, const motor::Motor& motor, const robot_core::Config& core, const DriveOptions& options,
                 double start_C = 25.0, const LoopObserver& observer = {}) {
  SimulatedRobot simulated(robot, motor, 25.0, start_C);
  CoreDrive core_drive(core, simulated, options);
  const std::unique_ptr<duty::Follower> plan = duty::ideal_tracking(robot, 1.0, duty::Planner::jerk_limited);
  CoreDriven driven;
  DriveScorer scorer;
  MatchRows rows(0.01, 25.0, {}, [&](const MatchRow& row) { append_csv(driven.csv, row, simulated.wheel_count(), 25.0, {}); });
  drive_script(simulated, core_drive, *plan, there_and_back(), kThereAndBack_s, [&](const LoopMoment& moment) {
    scorer.take(moment);
    rows.take(moment);
    if (observer) {
      observer(moment);
    }
  });
  driven.score = scorer.finish();
  return driven;
}

robot_core::Config core_of(const robot::Robot& robot, const motor::Motor& motor) {
  return firmware::make_core_config(robot, motor.nominal, {});
}

// de/dt = (v_command − v) − k·e limits the position error e to the largest velocity error divided by the gain k. With exact sensors slip
// dominates this error, because encoders do not measure creep of the wheels.
TEST(CoreDrive, follows_the_plan_with_exact_sensors) {
  const robot::Robot robot = twente();
  const robot_core::Config core = core_of(robot, ecx_32());
  double error_m_per_s = 0.0;
  double slip_m_per_s = 0.0;
  const auto see = [&](const LoopMoment& moment) {
    const robot::BodyVelocity& now = moment.robot->state().velocity;
    const robot::BodyVelocity rolled =
        robot::body_velocity(moment.robot->plant().body.kinematics, moment.robot->state().wheel_speed_rad_per_s);
    const robot_core::Vector3& asked = moment.drive->input().command.velocity;
    slip_m_per_s = std::max(slip_m_per_s, std::hypot(rolled.x_m_per_s - now.x_m_per_s, rolled.y_m_per_s - now.y_m_per_s));
    error_m_per_s =
        std::max(error_m_per_s, std::hypot(static_cast<double>(asked.x) - now.x_m_per_s, static_cast<double>(asked.y) - now.y_m_per_s));
  };
  const DriveScore exact = drive(robot, ecx_32(), core, ideal_drive(), 25.0, see).score;
  EXPECT_LT(exact.tracking_most_m, error_m_per_s / ideal_radio().position_gain_per_s);
  EXPECT_GT(slip_m_per_s, 0.5 * error_m_per_s);
  EXPECT_LT(exact.tracking_most_m, 0.01 * 1.3);  // share of the distance from stop to stop
  EXPECT_EQ(exact.fault_s, 0.0);
  const DriveScore real = drive(robot, ecx_32(), core, real_drive(robot, 1)).score;
  EXPECT_GT(real.tracking_rms_m, exact.tracking_rms_m);
  EXPECT_LT(real.tracking_rms_m, 4.0 * exact.tracking_rms_m);  // half the gain, and a delay of about half of its time constant
  EXPECT_EQ(real.fault_s, 0.0);
}

// Without feed-forward the wheels' integrators must find the friction. At low speed friction is most of the voltage.
TEST(CoreDrive, feed_forward_of_friction_helps_at_low_speed) {
  const robot_core::Config core = core_of(twente(), ecx_32());
  const DriveOptions options = without_position_feedback(real_drive(twente(), 3));
  for (const double direction_rad : {0.0, 0.5, std::numbers::pi / 2.0, 2.5}) {
    StraightDrive slow;
    slow.direction_rad = direction_rad;
    slow.speed_m_per_s = 0.2;
    slow.duration_s = 1.5;
    const DrivenLine with = drive_straight(twente(), ecx_32(), core, options, slow);
    const DrivenLine without = drive_straight(twente(), ecx_32(), with_friction_factor(core, 0.0), options, slow);
    EXPECT_LT(with.speed_error_rms_m_per_s, 0.7 * without.speed_error_rms_m_per_s) << direction_rad;
    EXPECT_LT(with.distance_error_m, without.distance_error_m) << direction_rad;
  }
}

// Straight ahead, additional friction at the front right wheel turns the robot to the right and pulls it there. The gyro restores the yaw
// rate but not the lost angle, until the wheel's integrator has found the friction.
TEST(CoreDrive, a_dirty_wheel_pulls_the_robot_to_its_side) {
  const robot_core::Config core = core_of(twente(), ecx_32());
  const DriveOptions options = without_position_feedback(ideal_drive());
  StraightDrive slow;
  slow.speed_m_per_s = 0.2;
  slow.duration_s = 1.5;
  const DrivenLine clean = drive_straight(twente(), ecx_32(), core, options, slow);
  const DrivenLine right = drive_straight(with_dirty_wheel(twente(), 0, 3.0), ecx_32(), core, options, slow);
  const DrivenLine left = drive_straight(with_dirty_wheel(twente(), 1, 3.0), ecx_32(), core, options, slow);
  const double clean_m = std::abs(clean.moments.back().pose.y_m);
  EXPECT_LT(right.moments.back().pose.y_m, -10.0 * clean_m);
  EXPECT_GT(left.moments.back().pose.y_m, 10.0 * clean_m);
  EXPECT_LT(right.yaw_error_rad, -10.0 * std::abs(clean.yaw_error_rad));
  EXPECT_GT(left.yaw_error_rad, 10.0 * std::abs(clean.yaw_error_rad));
  // One curve for all wheels and the same curve for each wheel must be equivalent.
  const DrivenLine same = drive_straight(with_dirty_wheel(twente(), 0, 1.0), ecx_32(), core, options, slow);
  EXPECT_NEAR(same.moments.back().pose.x_m, clean.moments.back().pose.x_m, 1e-9);
}

TEST(CoreDrive, same_seed_same_bytes) {
  const robot_core::Config core = core_of(twente(), ecx_32());
  const std::string once = drive(twente(), ecx_32(), core, real_drive(twente(), 5)).csv;
  EXPECT_EQ(once, drive(twente(), ecx_32(), core, real_drive(twente(), 5)).csv);
  EXPECT_NE(once, drive(twente(), ecx_32(), core, real_drive(twente(), 6)).csv);
}

// With one packet per second the robot drives for the command's timeout, brakes to standstill and opens its bridges.
TEST(CoreDrive, lost_packets_bring_the_robot_to_a_stand) {
  const robot_core::Config core = core_of(twente(), ecx_32());
  DriveOptions options = ideal_drive();
  options.radio.packet_rate_Hz = 1.0;
  StraightDrive line;
  line.speed_m_per_s = 0.6;
  line.duration_s = 2.0;
  const DrivenLine driven = drive_straight(twente(), ecx_32(), core, options, line);
  const auto speed_m_per_s = [&](double time_s) {
    const DriveMoment& moment = driven.moments.at(static_cast<std::size_t>(std::lround(1e3 * time_s)) - 1);
    return std::hypot(moment.velocity.x_m_per_s, moment.velocity.y_m_per_s);
  };
  // The first packet was sent at zero planned speed.
  EXPECT_LT(speed_m_per_s(0.9), 0.01);
  const double timeout_s = static_cast<double>(core.command_timeout_s);
  EXPECT_GT(speed_m_per_s(1.0 + 0.95 * timeout_s), 0.3);
  EXPECT_LT(speed_m_per_s(1.0 + timeout_s + 2.0 * line.speed_m_per_s / static_cast<double>(core.acceleration_limit_m_per_s2)), 0.01);
  const DriveMoment& last = driven.moments.back();
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(last.current_A[i], 0.0);
    EXPECT_NEAR(last.wheel_speed_rad_per_s[i], 0.0, 0.1);
  }
}

// The first packet has the plan's initial velocity. Voltages calculated from the samples of one period act in the next.
TEST(CoreDrive, voltages_act_one_period_late) {
  const robot_core::Config core = core_of(twente(), ecx_32());
  std::vector<double> starts_s;
  for (const double delay_periods_count : {0.0, 1.0}) {
    DriveOptions options = ideal_drive();
    options.sensing.delay_periods_count = delay_periods_count;
    const DrivenLine driven = drive_straight(twente(), ecx_32(), core, options, {});
    const auto first = std::ranges::find_if(driven.moments, [](const DriveMoment& moment) { return moment.current_A[0] != 0.0; });
    starts_s.push_back(first->time_s);
  }
  EXPECT_NEAR(starts_s[1] - starts_s[0], SimulatedRobot::kPeriod_s, 1e-9);
}

TEST(CoreDrive, asks_for_no_memory) {
  if (!allocations_are_counted()) {
    GTEST_SKIP() << "a sanitizer brings its own malloc";
  }
  SimulatedRobot simulated(twente(), ecx_32(), 25.0);
  CoreDrive core_drive(core_of(twente(), ecx_32()), simulated, real_drive(twente(), 1));
  const std::unique_ptr<duty::Follower> plan = duty::ideal_tracking(twente(), 1.0, duty::Planner::jerk_limited);
  const std::vector<duty::ScheduledCommand> script = there_and_back();
  DriveScorer scorer;
  const LoopObserver observer = [&](const LoopMoment& moment) { scorer.take(moment); };
  const long before = allocation_count();
  drive_script(simulated, core_drive, *plan, script, kThereAndBack_s, observer);
  EXPECT_EQ(allocation_count(), before);
}

// Shadow mode changes only the guard's counters. Active mode limits hot motors and keeps them within their limit.
TEST(GuardedCore, shadow_counts_and_on_limits) {
  const motor::Motor motor = ecx_32();
  const MotorGuard guard = make_guard(motor, twente(), 25.0, 2);
  ASSERT_TRUE(guard.guard) << (guard.why_none ? guard.why_none->what() : "");
  const double hot_C = motor.nominal.winding_limit_C - 10.0;
  const GuardedCore off(twente(), motor, GuardUse::off, guard);
  const GuardedCore shadow(twente(), motor, GuardUse::shadow, guard);
  const GuardedCore on(twente(), motor, GuardUse::on, guard);
  const DriveOptions options = real_drive(twente(), 1);
  const DriveScore without = drive(twente(), motor, off.config(), options, hot_C).score;
  const DriveScore counted = drive(twente(), motor, shadow.config(), options, hot_C).score;
  const DriveScore limited = drive(twente(), motor, on.config(), options, hot_C).score;
  EXPECT_EQ(without.guard_limited_s, 0.0);
  EXPECT_EQ(counted.winding_peak_C, without.winding_peak_C);
  EXPECT_EQ(counted.distance_m, without.distance_m);
  EXPECT_GT(counted.guard_limited_s, 0.5);
  EXPECT_GT(limited.guard_limited_s, 0.5);
  EXPECT_LT(limited.winding_peak_C, without.winding_peak_C);
  EXPECT_LT(limited.winding_peak_C, motor.nominal.winding_limit_C);
  EXPECT_LT(limited.distance_m, without.distance_m);
}

// Winding and stator are so poorly coupled that iron loss alone exceeds the limit. derate() refuses, and the core drives without guard.
TEST(GuardedCore, a_motor_that_cannot_be_guarded_says_why) {
  motor::Motor motor = ecx_32();
  base::ParameterValue& limit = motor.parameters.at("winding_limit");
  limit.value = 41.0;
  motor::refresh_values(motor);
  const MotorGuard guard = make_guard(motor, twente(), 25.0, 2);
  EXPECT_FALSE(guard.guard);
  EXPECT_TRUE(guard.why_none);
  const GuardedCore core(twente(), motor, GuardUse::on, guard);
  EXPECT_EQ(core.config().guard, nullptr);
}

motor::Motor with_light_rotor() {
  motor::Motor motor = shipped_motor("maxon_eci40_100w_48v_488607");
  *motor.nominal.rotor_inertia_kg_m2 *= 1e-3;
  motor.nominal.terminal_resistance_ohm *= 0.1;
  return motor;
}

TEST(GuardedCore, error_names_the_motor) {
  try {
    GuardedCore(twente(), with_light_rotor(), GuardUse::off, {});
    ADD_FAILURE() << "no failure";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_NE(failure.message().find("maxon_eci40_100w_48v_488607"), std::string::npos) << failure.message();
    EXPECT_NE(failure.message().find("--period"), std::string::npos) << failure.message();
  }
}

TEST(GameDrives, motor_that_cannot_be_driven_says_why_and_the_others_are_driven) {
  duty::Duty duty = duty::read_duty(kSource / "duty_profiles" / "division_a_match.toml");
  const auto& match = dynamic_cast<const duty::MatchDuty&>(*duty.shape_data);
  const std::vector<motor::Motor> motors{with_light_rotor(), ecx_32()};
  const GameDriveOptions options{.games = 1, .guard = GuardUse::off};
  const std::vector<GameDrives> drives = drive_games(twente(), match.inputs(), motors, options);
  ASSERT_EQ(drives.size(), 2U);
  EXPECT_TRUE(drives[0].games.empty());
  ASSERT_TRUE(drives[0].why_none);
  const auto* const failure = std::get_if<base::Failure>(&*drives[0].why_none);
  ASSERT_NE(failure, nullptr);
  EXPECT_NE(failure->message().find("too long for the wheel-speed loop"), std::string::npos) << failure->message();
  ASSERT_EQ(drives[1].games.size(), 1U);
  EXPECT_GT(drives[1].games[0].distance_m, 100.0);
}

TEST(GameDrives, motor_without_rotor_inertia_is_not_driven) {
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/division_b_match.toml");
  motor::Motor motor = ecx_32();
  motor.nominal.rotor_inertia_kg_m2.reset();
  const std::vector<GameDrives> drives = drive_games(twente(), dynamic_cast<const duty::MatchDuty&>(*duty.shape_data).inputs(),
                                                     std::vector{motor}, {.games = 1, .guard = GuardUse::off});
  ASSERT_TRUE(drives[0].why_none);
  EXPECT_TRUE(std::holds_alternative<NoRotorInertia>(*drives[0].why_none));
}

/// A game takes seconds, so a report at its end alone would leave the remaining time unknown until then.
TEST(GameDrives, report_while_a_game_is_driven) {
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/division_b_match.toml");
  std::atomic<int> reports = 0;
  const base::JobProgress progress([&reports] { return static_cast<double>(++reports); });  // asked for the time of each report
  drive_games(twente(), dynamic_cast<const duty::MatchDuty&>(*duty.shape_data).inputs(), std::vector{ecx_32()},
              {.games = 1, .guard = GuardUse::off}, progress);
  EXPECT_GT(reports, 100);
}

TEST(GameDrives, do_not_depend_on_threads) {
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/division_b_match.toml");
  const duty::MatchInputs& inputs = dynamic_cast<const duty::MatchDuty&>(*duty.shape_data).inputs();
  std::vector<motor::Motor> motors{ecx_32(), shipped_motor("nanotec_df45l024048_a2")};
  motors.push_back(ecx_32());
  motors.back().nominal.rotor_inertia_kg_m2 = {};
  GameDriveOptions options;
  options.games = 2;
  options.guard = GuardUse::off;
  options.threads = 1;
  const std::vector<GameDrives> one = drive_games(twente(), inputs, motors, options);
  options.threads = 2;
  const std::vector<GameDrives> two = drive_games(twente(), inputs, motors, options);
  ASSERT_EQ(one.size(), 3U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(one[i].motor_id, motors[i].id);
    ASSERT_EQ(one[i].games.size(), 2U);
    for (std::size_t game = 0; game < 2; ++game) {
      EXPECT_EQ(one[i].games[game].winding_peak_C, two[i].games[game].winding_peak_C);
      EXPECT_EQ(one[i].games[game].tracking_rms_m, two[i].games[game].tracking_rms_m);
    }
    const GameSpread spread = one[i].spread(&DriveScore::winding_peak_C);
    EXPECT_LT(spread.low, spread.high);
    EXPECT_EQ(spread.nominal, one[i].games.front().winding_peak_C);
  }
  EXPECT_TRUE(one[2].games.empty());
  EXPECT_TRUE(one[2].why_none);
}

}  // namespace
}  // namespace heatsoak::simulate
