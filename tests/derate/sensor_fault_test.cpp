// Sensor faults of a generated guard: no fault gains more current than stated, and the nominal motor survives all of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "sensed_motor.h"

namespace heatsoak::derate {
namespace {

struct Attack {
  const char* name;
  bool is_noticed;  ///< true if the cross-check must drop the sensor within the run
  Sensor sensor;
};

std::vector<Attack> attacks() {
  return {
      {"stuck at the cold air", true, [](double, double, double) { return 20.0F; }},
      {"stuck where it was after 100 s", false,
       [held = 40.0F](double time_s, double true_C, double) mutable {
         held = time_s < 100.0 ? static_cast<float>(true_C) : held;
         return held;
       }},
      {"stuck at a plausible value", true, [](double, double, double) { return 75.0F; }},
      {"slow drift to cold", false, [](double time_s, double true_C, double) { return static_cast<float>(true_C - 0.03 * time_s); }},
      {"very slow drift to cold", false, [](double time_s, double true_C, double) { return static_cast<float>(true_C - 0.01 * time_s); }},
      {"as cold as the cross-check permits", false,
       [](double, double true_C, double ambient_C) {
         const auto& check = thermistor_derating().sensor->check;
         const double least_C = ambient_C + check.cold_share * (true_C - ambient_C) - check.cold_margin_K;
         return static_cast<float>(std::max(0.0, least_C - thermistor_derating().sensor->options.accuracy_K + 0.3));
       }},
      {"half of the rise", false,
       [](double, double true_C, double ambient_C) { return static_cast<float>(ambient_C + 0.5 * (true_C - ambient_C)); }},
      {"0.7 of the reading", false, [](double, double true_C, double) { return static_cast<float>(0.7 * true_C); }},
      {"noise of 20 K", false,
       [engine = std::mt19937(3)](double, double true_C, double) mutable {
         return static_cast<float>(true_C + std::normal_distribution<double>(0.0, 20.0)(engine));
       }},
      {"shows the air", true,
       [engine = std::mt19937(4)](double, double, double ambient_C) mutable {
         return static_cast<float>(ambient_C + std::normal_distribution<double>(0.0, 0.3)(engine));
       }},
      {"comes and goes, cold", false,
       [](double time_s, double, double) { return std::fmod(time_s, 2.0) < 1.0 ? 30.0F : std::numeric_limits<float>::quiet_NaN(); }},
      {"open circuit", false, [](double, double, double) { return -273.0F; }},
      {"short circuit", false, [](double, double, double) { return 1000.0F; }},
      {"not a number", false, [](double, double, double) { return std::numeric_limits<float>::quiet_NaN(); }},
      {"infinite", false, [](double, double, double) { return -std::numeric_limits<float>::infinity(); }},
  };
}

/// Rounding of single precision that the header states with SENSOR_MOST_GAIN_A.
constexpr double kRounding_A = 1e-6;

class LyingSensor : public testing::Test {
 protected:
  static const CompiledGuard& guard() {
    static const CompiledGuard made(thermistor_derating(), "lying");
    return made;
  }
};

// At least 10⁵ steps each, with the full allowed current and with random driving.
TEST_F(LyingSensor, GainsNoMoreThanStatedAndSparesTheNominalMotor) {
  const Derating& derating = thermistor_derating();
  ASSERT_TRUE(guard());
  for (const Attack& attack : attacks()) {
    for (const bool is_all : {true, false}) {
      Plant plant(ecx_32(), motor::nominal_sample(ecx_32()), 40.0);
      const SensedRun run = run_sensed(guard(), derating, plant, attack.sensor, 120'000, 11, is_all);
      EXPECT_LE(run.most_excess_A, derating.sensor->most_gain_A + kRounding_A) << attack.name;
      EXPECT_LE(run.winding_peak_C, derating.rules.limits.winding_C + 0.1) << attack.name;
      if (attack.is_noticed && is_all) {
        EXPECT_GE(run.dropped_at_s, 0.0) << attack.name;
      }
      std::cout << fmt::format("{} ({}): {:.2f} A more, winding {:.0f} °C, dropped at {:.0f} s\n", attack.name, is_all ? "all" : "random",
                               run.most_excess_A, run.winding_peak_C, run.dropped_at_s);
    }
  }
}

// 30 s at the full allowed current, 10 s off, with the coldest reading that the cross-check does not drop: the stated gain is reached.
TEST_F(LyingSensor, GainsNoMoreThanStatedInPulses) {
  const SensorPlan& plan = *thermistor_derating().sensor;
  ASSERT_TRUE(guard());
  SensedGuard sensed(guard());
  ModelGuard same_load(guard());
  sensed.start(40.0F);
  same_load.start(40.0F);
  const Observer nominal_observer(motor::datasheet_network(ecx_32(), motor::nominal_sample(ecx_32())), ecx_32().nominal, twente(), 1.0);
  ObserverRun<float> nominal(nominal_observer, 0.01F, 40.0F);
  CompiledGuard::Input in{0.0F, 0.0F, 39.9F};
  float capped_A = 0.0F;
  double most_excess_A = 0.0;
  for (int i = 0; i < 120'000; ++i) {
    // The guard judges the reading by the nominal temperatures of the same step.
    nominal.step(std::array<float, observed::kSignalCount>{in.current_A, in.speed_rad_per_s, in.ambient_C, 0.0F, 0.0F, 0.0F, 0.0F});
    const double least_C = 40.0 + plan.check.cold_share * (static_cast<double>(nominal.state_C()[1]) - 40.0) - plan.options.accuracy_K;
    const CompiledGuard::Output out = sensed.step(in, static_cast<float>(least_C - plan.check.cold_margin_K + 0.1));
    ASSERT_EQ(out.sensor, CompiledGuard::used) << i;
    in.current_A = std::min(in.current_A, capped_A);
    capped_A = same_load.step(in).allowed_A;
    ASSERT_LE(out.allowed_A, static_cast<double>(capped_A) + plan.most_gain_A + kRounding_A) << i;
    ASSERT_LE(out.allowed_A, static_cast<double>(out.model_only_A) + plan.most_gain_A + kRounding_A) << i;
    most_excess_A = std::max(most_excess_A, static_cast<double>(out.allowed_A) - static_cast<double>(capped_A));
    in.current_A = i % 4000 < 3000 ? out.allowed_A : 0.0F;
  }
  EXPECT_GT(most_excess_A, 0.99 * plan.most_gain_A);
}

// A driver that exceeds the allowed current by a constant share. The header states the hottest winding of the nominal motor.
TEST_F(LyingSensor, SparesTheNominalMotorOfADriverThatExceedsTheAllowedCurrent) {
  const Derating& derating = thermistor_derating();
  ASSERT_TRUE(guard());
  const double stated_C = derating.sensor->sensor_fault_nominal_C;
  for (const Attack& attack : attacks()) {
    for (const double over_share : {0.0, 0.02, 0.05, 0.09, 0.11, 0.2}) {
      Plant plant(ecx_32(), motor::nominal_sample(ecx_32()), 40.0);
      const SensedRun run = run_sensed(guard(), derating, plant, attack.sensor, 120'000, 11, true, {.over_share = over_share});
      EXPECT_LE(run.winding_peak_C, stated_C + 1.0) << attack.name << ", " << 100.0 * over_share << " % more current than allowed";
    }
  }
}

// The ripple of a current control is no excess: it must not take away what a correct sensor gains.
TEST_F(LyingSensor, ARippleAroundTheAllowedCurrentCostsACorrectSensorLittle) {
  const Derating& derating = thermistor_derating();
  const Sensor correct = [](double, double true_C, double) { return static_cast<float>(true_C); };
  double smooth_A = 0.0;
  for (const double ripple_share : {0.0, 0.05}) {
    Plant plant(ecx_32(), motor::nominal_sample(ecx_32()), 40.0);
    const SensedRun run = run_sensed(guard(), derating, plant, correct, 120'000, 11, true, {.ripple_share = ripple_share});
    EXPECT_EQ(run.status, CompiledGuard::used);
    std::cout << fmt::format("ripple of {:.0f} %: {:.3f} A lasting, winding {:.1f} °C\n", 100.0 * ripple_share, run.last_allowed_A,
                             run.winding_peak_C);
    smooth_A = ripple_share == 0.0 ? run.last_allowed_A : smooth_A;
    EXPECT_GE(run.last_allowed_A, 0.99 * smooth_A);
  }
}

TEST_F(LyingSensor, OfDrawnMotorsGainsNoMoreThanStated) {
  const Derating& derating = thermistor_derating();
  for (int i = 0; i < 12; ++i) {
    base::Random random(31, static_cast<std::uint64_t>(i));
    const motor::MotorSample sample = motor::draw_sample(ecx_32(), random);
    for (const Attack& attack : attacks()) {
      Plant plant(ecx_32(), sample, 40.0);
      const SensedRun run = run_sensed(guard(), derating, plant, attack.sensor, 20'000, static_cast<unsigned>(i), i % 2 == 0);
      EXPECT_LE(run.most_excess_A, derating.sensor->most_gain_A + kRounding_A) << attack.name << " " << i;
    }
  }
}

// Without readings it must be bit-identical to the guard without a sensor.
TEST_F(LyingSensor, WithoutAReadingItIsTheGuardWithoutASensor) {
  SensedGuard sensed(guard());
  ModelGuard model(guard());
  sensed.start(30.0F);
  model.start(30.0F);
  RandomLoad driver(5);
  float allowed_A = 0.0F;
  for (int i = 0; i < 100'000; ++i) {
    const RandomLoad::Wish wish = driver.after(0.01);
    const CompiledGuard::Input in{static_cast<float>(wish.current_share) * allowed_A,
                                  static_cast<float>(wish.speed_share * thermistor_derating().rules.most_speed_rad_per_s), 30.0F};
    const CompiledGuard::Output out = sensed.step(in, std::numeric_limits<float>::quiet_NaN());
    const CompiledGuard::Output alone = model.step(in);
    ASSERT_EQ(out.allowed_A, alone.allowed_A) << i;
    ASSERT_EQ(out.guarded_C, alone.guarded_C) << i;
    ASSERT_EQ(out.sensor, CompiledGuard::silent);
    allowed_A = alone.allowed_A;
  }
}

TEST_F(LyingSensor, AJumpIsNotUsedAndOneThatLastsEndsTheSensor) {
  SensedGuard sensed(guard());
  sensed.start(60.0F);
  const CompiledGuard::Input in{1.0F, 0.0F, 40.0F};
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(sensed.step(in, 60.0F).sensor, CompiledGuard::used);
  }
  EXPECT_EQ(sensed.step(in, 30.0F).sensor, CompiledGuard::jumped);
  EXPECT_EQ(sensed.step(in, 60.0F).sensor, CompiledGuard::used);
  int status = CompiledGuard::used;
  for (int i = 0; i < 60'000 && status != CompiledGuard::frozen && status != CompiledGuard::too_cold; ++i) {
    status = sensed.step(in, i % 2 == 0 ? 200.0F : -3.0F).sensor;
  }
  EXPECT_NE(status, CompiledGuard::used);
}

// In a cold room without an air sensor the guard assumes 40 °C. A correct sensor that shows the cold motor must not count as faulty.
TEST_F(LyingSensor, ACorrectSensorInAColdRoomIsKept) {
  SensedGuard sensed(guard());
  sensed.start(15.0F);
  Plant plant(ecx_32(), motor::nominal_sample(ecx_32()), 15.0);
  for (int i = 0; i < 100'000; ++i) {
    const double current_A = i / 20'000 % 2 == 0 ? 0.0 : 2.0;
    plant.step(current_A, 100.0, 15.0, 0.01);
    const CompiledGuard::Output out =
        sensed.step({static_cast<float>(current_A), 100.0F, 40.0F}, static_cast<float>(plant.true_C(motor::states::stator)));
    ASSERT_EQ(out.sensor, CompiledGuard::used) << i;
  }
}

// A hot reading is always accepted, because it only reduces the current.
TEST_F(LyingSensor, AHotReadingTakesCurrentAway) {
  SensedGuard sensed(guard());
  ModelGuard model(guard());
  sensed.start(40.0F);
  model.start(40.0F);
  const CompiledGuard::Input in{0.5F, 0.0F, 40.0F};
  float reading_C = 40.0F;
  CompiledGuard::Output out;
  for (int i = 0; i < 20'000; ++i) {
    reading_C = std::min(reading_C + 0.01F, 150.0F);
    out = sensed.step(in, reading_C);
    model.step(in);
  }
  EXPECT_LT(out.allowed_A, 0.5F * model.step(in).allowed_A);
}

// The same load with an exact sensor and with one that drifts up.
TEST_F(LyingSensor, ADriftToHotNeverAddsCurrent) {
  for (const float drift_K_per_s : {0.1F, 1.0F, 3.3F}) {
    SensedGuard exact(guard());
    SensedGuard hot(guard());
    exact.start(15.0F);
    hot.start(15.0F);
    RandomLoad driver(9);
    Plant plant(ecx_32(), motor::nominal_sample(ecx_32()), 15.0);
    double allowed_A = 0.0;
    for (int i = 0; i < 30'000; ++i) {
      const RandomLoad::Wish wish = driver.after(0.01);
      const double current_A = wish.current_share * allowed_A;
      const double speed_rad_per_s = wish.speed_share * thermistor_derating().rules.most_speed_rad_per_s;
      plant.step(current_A, speed_rad_per_s, 15.0, 0.01);
      const CompiledGuard::Input in{static_cast<float>(current_A), static_cast<float>(speed_rad_per_s), 15.0F};
      const auto true_C = static_cast<float>(plant.true_C(motor::states::stator));
      const float of_exact_A = exact.step(in, true_C).allowed_A;
      const CompiledGuard::Output of_hot = hot.step(in, std::min(true_C + drift_K_per_s * 0.01F * static_cast<float>(i), 250.0F));
      if (of_hot.sensor == CompiledGuard::used) {
        ASSERT_LE(of_hot.allowed_A, of_exact_A + 1e-4F) << drift_K_per_s << " K/s, step " << i;
      }
      allowed_A = std::min(of_exact_A, of_hot.allowed_A);
    }
  }
}

// A driver that ignores the limit for a moment heats the winding beyond it. An unknown input must not erase that heat.
TEST_F(LyingSensor, KeepsTheHeatOfAnOvercurrentThroughUnknownInputs) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  for (const bool is_current_unknown : {false, true}) {
    for (const bool is_air_unknown : {false, true}) {
      for (const bool is_read : {false, true}) {
        SensedGuard sensed(guard());
        ModelGuard model(guard());
        sensed.start(40.0F);
        model.start(40.0F);
        Plant plant(ecx_32(), motor::nominal_sample(ecx_32()), 40.0);
        float allowed_A = 0.0F;
        float model_A = 0.0F;
        for (int i = 0; i < 12'000; ++i) {
          const bool is_burst = i >= 6000 && i < 6080;
          const float current_A = is_burst ? 15.0F : std::min(allowed_A, model_A);
          plant.step(static_cast<double>(current_A), 0.0, 40.0, 0.01);
          const CompiledGuard::Input in{is_burst && is_current_unknown ? kUnknown : current_A, 0.0F,
                                        i == 6080 && is_air_unknown ? kUnknown : 39.5F};
          allowed_A = sensed.step(in, is_read ? static_cast<float>(plant.true_C(motor::states::stator)) : kUnknown).allowed_A;
          model_A = model.step(in).allowed_A;
          ASSERT_LE(allowed_A, model_A + static_cast<float>(thermistor_derating().sensor->most_gain_A) + 1e-4F)
              << i << (is_current_unknown ? ", current unknown" : "") << (is_air_unknown ? ", air unknown" : "")
              << (is_read ? ", read" : "");
        }
        EXPECT_LE(plant.true_C(motor::states::winding), thermistor_derating().rules.limits.winding_C);
      }
    }
  }
}

// After a reset the guard is as warm as before. The header with a sensor saves the guard without it, which is at least as hot as the motor.
TEST_F(LyingSensor, AResetForgetsNoHeat) {
  SensedGuard before(guard());
  before.start(40.0F);
  Plant plant(ecx_32(), motor::nominal_sample(ecx_32()), 40.0);
  CompiledGuard::Output out;
  for (int i = 0; i < 120'000; ++i) {
    plant.step(static_cast<double>(out.allowed_A), 100.0, 40.0, 0.01);
    out = before.step({out.allowed_A, 100.0F, 39.5F}, static_cast<float>(plant.true_C(motor::states::stator)));
  }
  const float lasting_A = out.allowed_A;
  SensedGuard after(guard());
  ASSERT_EQ(after.restore(before.saved(2), 2.0F, 0.0F, 25.0F), CompiledGuard::restored);
  float current_A = 0.0F;
  for (int i = 0; i < 200; ++i) {
    plant.step(0.0, 0.0, 40.0, 0.01);
  }
  double hottest_C = 0.0;
  for (int i = 0; i < 60'000; ++i) {
    plant.step(static_cast<double>(current_A), 100.0, 40.0, 0.01);
    hottest_C = std::max(hottest_C, plant.true_C(motor::states::winding));
    current_A = after.step({current_A, 100.0F, 39.5F}, static_cast<float>(plant.true_C(motor::states::stator))).allowed_A;
  }
  EXPECT_LE(hottest_C, 125.0) << "the continuous load keeps the nominal winding at 112 °C";
  EXPECT_NEAR(current_A, lasting_A, 0.05F);
  SensedGuard damaged(guard());
  std::vector<unsigned char> buffer = before.saved(2);
  buffer[5] ^= 1U;
  EXPECT_EQ(damaged.restore(buffer, 2.0F, 0.0F, 25.0F), CompiledGuard::nothing_restored);
  EXPECT_LT(damaged.step({0.0F, 100.0F, 39.5F}, 40.0F).allowed_A, lasting_A);
}

// A state corrupted by radiation or a wild pointer must not allow more than the guard without a sensor at its limit.
TEST_F(LyingSensor, ACorruptStateCountsAsAtItsLimit) {
  ModelGuard at_limit(guard());
  at_limit.start(155.0F);
  const float most_A = at_limit.step({0.0F, 0.0F, 40.0F}).allowed_A;
  ASSERT_LT(most_A, 0.01F);
  std::mt19937 engine(8);
  for (int trial = 0; trial < 2000; ++trial) {
    SensedGuard sensed(guard());
    for (unsigned char& byte : sensed.state()) {
      byte = static_cast<unsigned char>(engine());
    }
    const CompiledGuard::Output out = sensed.step({0.0F, 0.0F, 40.0F}, 30.0F);
    EXPECT_LE(out.allowed_A, most_A);
    EXPECT_TRUE(std::isfinite(out.guarded_C));
  }
}

}  // namespace
}  // namespace heatsoak::derate
