// Benefit of a sensor: gains that follow its accuracy, a lower safety factor, and limits that drawn motors keep.
#include "derate/sensed/sensor_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "base/diagnostic.h"
#include "derate/sensed/kalman_design.h"
#include "sensed_motor.h"

namespace heatsoak::derate {
namespace {

SensorGain gain_of(const SensorOptions& options) {
  return sensor_gain(ecx_32(), twente(), rules_for(ecx_32()), options, 0.01, 2.0, 100, 1);
}

TEST(SensorGain, FollowsTheAccuracy) {
  double last = 1.0;
  for (const double accuracy_K : {0.01, 0.5, 2.0, 8.0, 1000.0}) {
    const SensorGain gain = gain_of({.accuracy_K = accuracy_K});
    EXPECT_GT(gain.gain[motor::states::stator], 0.0);
    EXPECT_LT(gain.gain[motor::states::stator], last) << accuracy_K;
    last = gain.gain[motor::states::stator];
  }
  EXPECT_LT(last, 1e-5);
}

TEST(SensorGain, CorrectsTheSensedNodeAndTheSensorItself) {
  const SensorGain at_winding = gain_of({.node = motor::states::winding});
  EXPECT_GT(at_winding.gain[motor::states::winding], at_winding.gain[motor::states::stator]);
  const SensorGain lagging = gain_of({.lag_s = 5.0});
  EXPECT_GT(lagging.lag_gain_ratio, 0.0);
  EXPECT_EQ(gain_of({}).lag_gain_ratio, 0.0);
}

TEST(SensorGain, NoNodeCoolsWhenTheSensorReadsMore) {
  for (const int node : {motor::states::winding, motor::states::stator}) {
    for (const double accuracy_K : {0.5, 2.0, 8.0}) {
      for (const double gain : gain_of({.node = node, .accuracy_K = accuracy_K}).gain) {
        EXPECT_GE(gain, 0.0) << node << ", " << accuracy_K;
      }
    }
  }
}

TEST(SensorPlan, ALessAccurateSensorPermitsNoMore) {
  DerateOptions options = quick_options({});
  options.sensor->accuracy_K = 20.0;
  const Derating coarse = derate(ecx_32(), twente(), options);
  ASSERT_TRUE(coarse.sensor);
  // Both searches end on grids of their own, up to 1 % above the smallest factor that holds (FactorGrid).
  constexpr double kGrid_ratio = 1.01;
  EXPECT_GE(kGrid_ratio * coarse.sensor->observer.heat_safety_factor(), thermistor_derating().sensor->observer.heat_safety_factor());
  for (std::size_t i = 0; i < coarse.sensor->lasting.size(); ++i) {
    EXPECT_LE(coarse.sensor->lasting[i].with_A, thermistor_derating().sensor->lasting[i].with_A) << i;
  }
}

TEST(SensorPlan, ThermistorLowersTheSafetyFactor) {
  const Derating& derating = thermistor_derating();
  ASSERT_TRUE(derating.sensor);
  const SensorPlan& plan = *derating.sensor;
  EXPECT_LT(plan.observer.heat_safety_factor(), 0.9 * derating.observer.heat_safety_factor());
  EXPECT_GT(plan.observer.heat_safety_factor(), 1.0);
  EXPECT_GT(plan.lasting[0].with_A, plan.lasting[0].without_A);
  EXPECT_GT(plan.most_gain_A, 0.1);
  EXPECT_LE(plan.sensor_fault_nominal_C, derating.rules.limits.winding_C);
  // A motor that starts at its limit gets the gain at once.
  EXPECT_GT(plan.sensor_fault_warm_C, derating.rules.limits.winding_C);
  EXPECT_LT(plan.sensor_fault_warm_C, derating.rules.limits.winding_C + 10.0);
  EXPECT_LE(plan.guarantee.over, most_over(derating.options.guarantee));
  RecordProperty("safety_factor_without", fmt::format("{:.3f}", derating.observer.heat_safety_factor()));
  RecordProperty("safety_factor_with", fmt::format("{:.3f}", plan.observer.heat_safety_factor()));
  RecordProperty("sensor_fault_warm_C", fmt::format("{:.1f}", plan.sensor_fault_warm_C));
  RecordProperty("most_gain_A", fmt::format("{:.2f}", plan.most_gain_A));
  RecordProperty("honest_dropped", std::to_string(plan.dropped));
}

// The table for the lower safety factor is steeper than that of the guard without the sensor, so the header states the slopes of both.
TEST(SensorPlan, HeaderStatesTheSlopesOfBothTables) {
  const Derating& derating = thermistor_derating();
  const std::string text = std::ranges::find(all_exporters(), "c_header", &ExporterType::name)->write(derating);
  const std::regex stated(R"(changes by at most ([0-9.e-]+) A per K of\s+the winding, ([0-9.e-]+) A per K of the stator)");
  std::sregex_iterator found(text.begin(), text.end(), stated);
  double last_A_per_K = 0.0;
  for (const CurrentTable* const table : {&derating.table, &derating.sensor->table}) {
    ASSERT_NE(found, std::sregex_iterator());
    double most_A_per_K = 0.0;
    constexpr double kApart_K = 0.01;
    for (double stator_C = 0.0; stator_C < 160.0; stator_C += 20.0) {
      for (double winding_C = 0.0; winding_C < 165.0; winding_C += kApart_K) {
        most_A_per_K = std::max(
            most_A_per_K, (table->allowed_A(0.0, stator_C, winding_C) - table->allowed_A(0.0, stator_C, winding_C + kApart_K)) / kApart_K);
      }
    }
    EXPECT_LE(most_A_per_K, std::stod((*found)[1]));
    EXPECT_GE(most_A_per_K, 0.9 * std::stod((*found)[1])) << "the stated slope is reached";
    EXPECT_GT(std::stod((*found)[1]), last_A_per_K);
    last_A_per_K = std::stod((*found)[1]);
    ++found;
  }
}

TEST(SensorPlan, RefusesWhatIsNoSensor) {
  const Derating& derating = thermistor_derating();
  EXPECT_THROW(plan_sensor(ecx_32(), twente(), derating, {.accuracy_K = 0.0}), base::Failure);
  EXPECT_THROW(plan_sensor(ecx_32(), twente(), derating, {.accuracy_K = std::nan("")}), base::Failure);
  EXPECT_THROW(plan_sensor(ecx_32(), twente(), derating, {.node = 7}), base::Failure);
}

// Motors that the search has not used, with the generated code and another integrator. All sensors read too little by their whole accuracy.
TEST(SensorPlan, DrawnMotorsKeepTheirLimitWithTheLowestPermittedReading) {
  const Derating& derating = thermistor_derating();
  const CompiledGuard guard(derating);
  ASSERT_TRUE(guard);
  constexpr int kMotors = 60;
  int over = 0;
  int dropped = 0;
  for (int i = 0; i < kMotors; ++i) {
    base::Random random(90210, static_cast<std::uint64_t>(i));
    const motor::MotorSample sample = motor::draw_sample(ecx_32(), random);
    Plant plant(ecx_32(), sample, 40.0);
    const SensedRun run = run_sensed(
        guard, derating, plant,
        [&](double, double true_C, double) { return static_cast<float>(true_C - derating.sensor->options.accuracy_K); }, 100'000,
        static_cast<unsigned>(i), i % 2 == 0);
    over += run.winding_peak_C > derating.rules.limits.winding_C ? 1 : 0;
    dropped += run.dropped_at_s >= 0.0 ? 1 : 0;
  }
  // Five in a hundred of 60 would be three; nine or more have a probability of 1/400. One in a hundred may lose its sensor; 5 or more have
  // a probability of 1/1000.
  EXPECT_LE(over, 8);
  EXPECT_LE(dropped, 4);
}

}  // namespace
}  // namespace heatsoak::derate
