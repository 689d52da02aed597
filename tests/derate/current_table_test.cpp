// Table and observer: no allowed current takes the observer over its limit, and the table is not much stricter than needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "derate/barrier.h"
#include "guarded_motor.h"
#include "thermal/steady_state.h"
#include "thermal/transient.h"

namespace heatsoak::derate {
namespace {

using motor::states::stator;
using motor::states::winding;

struct Peaks {
  float winding_C = -1e9F;
  float stator_C = -1e9F;
};

/// One hour of the hardest driving, in the precision of the firmware.
Peaks drive(const GuardedMotor& guarded, unsigned seed, float period_s) {
  ObserverRun<float> run(guarded.observer, period_s, 40.0F);
  RandomLoad driver(seed);
  Peaks peaks;
  for (int i = 0; i < static_cast<int>(3600.0F / period_s); ++i) {
    const RandomLoad::Wish wish = driver.after(static_cast<double>(period_s));
    const auto speed_rad_per_s = static_cast<float>(wish.speed_share * guarded.rules.most_speed_rad_per_s);
    const float allowed_A = guarded.table.allowed_A(speed_rad_per_s, run.hottest_body_C(), run.state_C()[winding]);
    const std::array<float, observed::kSignalCount> signals{
        static_cast<float>(wish.current_share) * allowed_A, speed_rad_per_s, 40.0F, 0.0F, 40.0F, 0.0F, 0.0F};
    run.step(signals);
    peaks.winding_C = std::max(peaks.winding_C, run.state_C()[winding]);
    peaks.stator_C = std::max(peaks.stator_C, run.state_C()[stator]);
  }
  return peaks;
}

TEST(CurrentTable, ObserverNeverPassesItsLimit) {
  for (const char* id : {"maxon_ecx_flat_32l_48v", "maxon_ec45_flat_70w_24v", "maxon_dcx19s_24v"}) {
    const motor::Motor motor = shipped_motor(id);
    for (const double reserve : {1.0, 1.7}) {
      for (const double approach_s : {0.1, 0.5, 5.0}) {
        const GuardedMotor guarded(motor, rules_for(motor, approach_s), reserve);
        const Peaks peaks = drive(guarded, 5, 0.01F);
        EXPECT_LE(peaks.winding_C, guarded.rules.limits.winding_C + 1e-3) << id << ", reserve " << reserve << ", approach " << approach_s;
        EXPECT_GT(peaks.winding_C, guarded.rules.limits.winding_C - 3.0) << "what is allowed is not used: " << id;
      }
    }
  }
}

// Also close to the air temperature, where the table's axis is short.
TEST(CurrentTable, StatorWithALimitKeepsItAndUsesIt) {
  const motor::Motor motor = ecx_32();
  for (const double limit_C : {65.0, 73.0, 80.0}) {
    BarrierRules rules = rules_for(motor);
    rules.limits.stator_C = limit_C;
    const GuardedMotor guarded(motor, rules, 1.0);
    ObserverRun<float> run(guarded.observer, 0.01F, 40.0F);
    float peak_C = 0.0F;
    for (int i = 0; i < 360'000; ++i) {
      const float allowed_A = guarded.table.allowed_A(0.0F, run.hottest_body_C(), run.state_C()[winding]);
      run.step(std::array<float, observed::kSignalCount>{allowed_A, 0.0F, 40.0F, 0.0F, 40.0F, 0.0F, 0.0F});
      peak_C = std::max(peak_C, run.state_C()[stator]);
    }
    EXPECT_LE(peak_C, limit_C + 1e-2);
    // The table gives up the 2 K cell of the winding's axis in which the current reaches zero.
    EXPECT_GT(run.state_C()[stator], limit_C - 1.5);
    EXPECT_LE(drive(guarded, 6, 0.01F).stator_C, limit_C + 1e-2);
  }
}

// Reference without the table: the network's steady state at the current that is allowed permanently.
TEST(CurrentTable, LastingCurrentHoldsTheWindingAtItsLimit) {
  for (const double speed_share : {0.0, 0.5}) {
    const motor::Motor motor = ecx_32();
    const GuardedMotor guarded(motor, rules_for(motor), 1.0);
    ObserverRun<float> run(guarded.observer, 0.01F, 40.0F);
    const auto speed_rad_per_s = static_cast<float>(speed_share * guarded.rules.most_speed_rad_per_s);
    float allowed_A = 0.0F;
    for (int i = 0; i < 360'000; ++i) {
      allowed_A = guarded.table.allowed_A(speed_rad_per_s, run.hottest_body_C(), run.state_C()[winding]);
      run.step(std::array<float, observed::kSignalCount>{allowed_A, speed_rad_per_s, 40.0F, 0.0F, 40.0F, 0.0F, 0.0F});
    }
    thermal::OperatingPoint<double> at;
    at.current_rms_A = allowed_A;
    at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = speed_rad_per_s;
    at.ambient_C = 40.0;
    const std::optional<thermal::SteadyState> rest = thermal::steady_state(guarded.network, at);
    ASSERT_TRUE(rest);
    EXPECT_NEAR(rest->temperature_C[winding], 155.0, 0.3);
  }
}

TEST(CurrentTable, AllowsNoMoreThanTheBarrierBetweenItsPoints) {
  const motor::Motor motor = shipped_motor("maxon_ec45_flat_70w_24v");
  const GuardedMotor guarded(motor, rules_for(motor), 1.3);
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 2000; ++i) {
    const double speed_rad_per_s = guarded.rules.most_speed_rad_per_s * uniform(engine);
    const double stator_C = 30.0 + 95.0 * uniform(engine);
    const double winding_C = 30.0 + 95.0 * uniform(engine);
    const double allowed_A =
        barrier_current_A(guarded.observer, guarded.rules, speed_rad_per_s, std::max(40.0, stator_C), std::max(40.0, winding_C));
    EXPECT_LE(guarded.table.allowed_A(speed_rad_per_s, stator_C, winding_C), allowed_A * 1.001 + 1e-6)
        << speed_rad_per_s << " rad/s, stator " << stator_C << ", winding " << winding_C;
  }
}

TEST(CurrentTable, GivesNothingWhereItKnowsNothing) {
  const motor::Motor motor = ecx_32();
  const GuardedMotor guarded(motor, rules_for(motor), 1.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_GT(guarded.table.allowed_A(0.0, 40.0, 40.0), 10.0);
  EXPECT_EQ(guarded.table.allowed_A(1.001 * guarded.table.no_current_speed_rad_per_s, 40.0, 40.0), 0.0);
  EXPECT_EQ(guarded.table.allowed_A(0.0, 40.0, 158.1), 0.0);
  EXPECT_EQ(guarded.table.allowed_A(0.0, 155.1, 155.1), 0.0);
  EXPECT_EQ(guarded.table.allowed_A(0.0, 280.0, 40.0), 0.0);
  for (const auto& [speed, body, coil] : {std::array{nan, 40.0, 40.0}, std::array{0.0, nan, 40.0}, std::array{0.0, 40.0, nan}}) {
    EXPECT_EQ(guarded.table.allowed_A(speed, body, coil), 0.0);
  }
}

// In single precision a step of the stator is smaller than the last digit of its temperature. Without compensated rounding it would stand
// still.
TEST(Observer, FollowsTheReferenceInSinglePrecision) {
  const motor::Motor motor = ecx_32();
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  const Observer observer(network, motor.nominal, twente(), 1.0);
  constexpr float kPeriod_s = 1e-3F;
  ObserverRun<float> run(observer, kPeriod_s, 25.0F);
  std::vector<thermal::Interval> intervals;
  double worst_K = 0.0;
  std::mt19937_64 engine(8);
  for (int piece = 0; piece < 60; ++piece) {
    const auto current_A = static_cast<float>(piece % 3) * 1.7F;
    const auto speed_rad_per_s = static_cast<float>(engine() % 300);
    thermal::OperatingPoint<double> at;
    at.current_rms_A = current_A;
    at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = speed_rad_per_s;
    intervals.push_back({20.0, at});
    for (int i = 0; i < 20'000; ++i) {
      run.step(std::array<float, observed::kSignalCount>{current_A, speed_rad_per_s, 25.0F, 0.0F, 25.0F, 0.0F, 0.0F});
    }
    const thermal::TransientResult reference = thermal::run_transient(network, network.values(), intervals, {});
    for (std::size_t node = 0; node < 2; ++node) {
      worst_K = std::max(worst_K, std::abs(static_cast<double>(run.state_C()[node]) - reference.end_C[node]));
    }
  }
  EXPECT_LT(worst_K, 0.02);
}

TEST(Observer, ReserveMultipliesHeatAndNothingElse) {
  const motor::Motor motor = ecx_32();
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  const auto rate = [&](double reserve, double current_A, double winding_C) {
    const Observer observer(network, motor.nominal, twente(), reserve);
    thermal::FormulaRun<double> run(observer.formula(), observer.rate_steps());
    const std::array<double, observed::kSignalCount + 2> inputs{current_A, 0.0, 25.0, 0.0, 25.0, 0.0, 0.0, winding_C, 25.0};
    std::array<double, 2> rates{};
    run.run(inputs, rates);
    return rates[winding];
  };
  EXPECT_NEAR(rate(2.0, 3.0, 25.0), 2.0 * rate(1.0, 3.0, 25.0), 1e-12);
  EXPECT_NEAR(rate(2.0, 0.0, 90.0), rate(1.0, 0.0, 90.0), 1e-12);
}

}  // namespace
}  // namespace heatsoak::derate
