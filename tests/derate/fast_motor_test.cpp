// Speeds beyond the battery's no-load speed: the current decreases continuously, and the allowed current is safe.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "derate/barrier.h"
#include "derate/plausible_range.h"
#include "guarded_motor.h"
#include "thermal/transient.h"

namespace heatsoak::derate {
namespace {

using motor::states::winding;

/// Returns the no-load speed at the command's limit.
double fastest_driven_rad_per_s(const motor::Motor& motor, const robot::Robot& robot) {
  return robot.drive.limited_V(robot.battery.full_V.value()) / motor.nominal.torque_constant_Nm_per_A;
}

struct FastMotor {
  FastMotor(const motor::Motor& of, const robot::Robot& in)
      : motor(of),
        robot(in),
        rules(barrier_rules(motor, robot, {})),
        network(motor::datasheet_network(motor, motor::nominal_sample(motor))),
        observer(network, motor.nominal, robot, 1.5),
        table(current_table(observer, rules)) {}

  motor::Motor motor;
  robot::Robot robot;
  BarrierRules rules;
  thermal::Network network;
  Observer observer;
  CurrentTable table;
};

TEST(FastMotor, IsInTheTableOnAFullBatteryAndWhenPushed) {
  for (const char* const robot : {"roboteam_twente_v2024", "tigers_v2020"}) {
    for (const char* const id : {"maxon_ecx_flat_32l_48v", "maxon_ec45_flat_70w_24v"}) {
      const FastMotor fast(shipped_motor(id), shipped_robot(robot));
      const double driven_rad_per_s = fastest_driven_rad_per_s(fast.motor, fast.robot);
      EXPECT_GE(fast.rules.most_speed_rad_per_s, 1.0999 * driven_rad_per_s) << robot << ", " << id;
      EXPECT_GT(fast.table.allowed_A(driven_rad_per_s, 60.0, 60.0), 0.5 * fast.table.allowed_A(0.0, 60.0, 60.0)) << robot << ", " << id;
      // Independent of the command's limit: the drive core accepts speeds up to this value.
      EXPECT_GE(fast.table.no_current_speed_rad_per_s,
                1.0999 * fast.robot.battery.full_V.value() / fast.motor.nominal.torque_constant_Nm_per_A);
    }
  }
}

TEST(FastMotor, HasACurrentThatFallsToNoneWithoutAJump) {
  for (const char* const robot : {"roboteam_twente_v2024", "tigers_v2020"}) {
    const FastMotor fast(ecx_32(), shipped_robot(robot));
    const double most_rad_per_s = fast.rules.most_speed_rad_per_s;
    const double last_rad_per_s = fast.table.no_current_speed_rad_per_s;
    for (const double winding_C : {40.0, 100.0, 150.0}) {
      const double at_most_A = fast.table.allowed_A(most_rad_per_s, 60.0, winding_C);
      ASSERT_GT(at_most_A, 0.0);
      double before_A = at_most_A;
      constexpr int kSteps = 1000;
      for (int i = 1; i <= kSteps; ++i) {
        const double now_A =
            fast.table.allowed_A(std::lerp(most_rad_per_s, last_rad_per_s, static_cast<double>(i) / kSteps), 60.0, winding_C);
        EXPECT_LE(now_A, before_A);
        EXPECT_NEAR(now_A, before_A, 1.01 * at_most_A / kSteps);
        before_A = now_A;
      }
      EXPECT_EQ(before_A, 0.0);
      EXPECT_GE(fast.table.allowed_A(1.05 * most_rad_per_s, 60.0, winding_C), 0.45 * at_most_A) << "it cannot brake any more";
    }
  }
}

TEST(FastMotor, IsAllowedNoMoreThanTheBarrierWhereTheCurrentFalls) {
  // Heat in the winding that grows with the speed squared is the hardest case for linear interpolation.
  const motor::Motor lossy = ecx_32_with(R"([effects.eddy]
type = "ac_copper_loss"
share = { value = "0.2", origin = "estimated", derivation = "a test" }
)");
  const FastMotor fast(lossy, twente());
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 1000; ++i) {
    const double speed_rad_per_s = std::lerp(fast.rules.most_speed_rad_per_s, fast.table.no_current_speed_rad_per_s, uniform(engine));
    const double stator_C = 40.0 + 110.0 * uniform(engine);
    const double winding_C = 40.0 + 114.0 * uniform(engine);
    EXPECT_LE(fast.table.allowed_A(speed_rad_per_s, stator_C, winding_C),
              barrier_current_A(fast.observer, fast.rules, speed_rad_per_s, stator_C, winding_C) * 1.001 + 1e-6);
  }
}

// Half an hour at imposed speeds beyond the table's last full row with all allowed current, simulated by the network's own solver.
TEST(FastMotor, KeepsItsLimitInTheNetworkWhereverItIsPushed) {
  const FastMotor fast(ecx_32(), twente());
  const Observer nominal(fast.network, fast.motor.nominal, fast.robot, 1.0);
  const CurrentTable table = current_table(nominal, fast.rules);
  ObserverRun<float> run(nominal, 0.01F, 40.0F);
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> uniform;
  std::vector<thermal::Interval> intervals;
  float most_C = 0.0F;
  for (int piece = 0; piece < 900; ++piece) {
    const auto speed_rad_per_s = static_cast<float>(std::lerp(0.7, 1.0, uniform(engine)) * table.no_current_speed_rad_per_s);
    double squares_A2 = 0.0;
    constexpr int kPeriods = 200;
    for (int i = 0; i < kPeriods; ++i) {
      const float allowed_A = table.allowed_A(speed_rad_per_s, run.hottest_body_C(), run.state_C()[winding]);
      squares_A2 += static_cast<double>(allowed_A) * allowed_A / kPeriods;
      run.step(std::array<float, observed::kSignalCount>{allowed_A, speed_rad_per_s, 40.0F, 0.0F, 40.0F, 0.0F, 0.0F});
      most_C = std::max(most_C, run.state_C()[winding]);
    }
    const Signals signals{std::sqrt(squares_A2), speed_rad_per_s, 40.0, 0.0, 40.0, 0.0, 0.0};
    intervals.push_back({0.01 * kPeriods, operating_point<double>(fast.motor.nominal, fast.robot, signals)});
  }
  EXPECT_LE(most_C, 155.01F);
  EXPECT_GT(most_C, 120.0F) << "nothing was tested";
  EXPECT_LE(thermal::run_transient(fast.network, fast.network.values(), intervals, {}).peak_C[winding], 155.5);
}

}  // namespace
}  // namespace heatsoak::derate
