// The way that was unsafe: a motor's file without tolerances must not be allowed more current than the same file with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "derate/derating.h"
#include "support/shipped.h"

namespace heatsoak {
namespace {

using testing::IsEmpty;
using testing::Not;

DerateOptions few_samples() {
  DerateOptions options;
  options.guarantee.samples = 100;
  return options;
}

/// Without all of its spreads, or a random half of them.
Motor stripped(Motor motor, unsigned seed) {
  std::mt19937 engine(seed);
  for (auto& [key, figure] : motor.figures) {
    if (seed == 0 || engine() % 2 == 0) {
      figure.spread.reset();
    }
  }
  return motor;
}

TEST(DerateWithoutSpreads, AllowsNoMoreThanTheHonestFile) {
  // One motor of each kind of origin: estimates, a sheet, third parties, a brushed one with derived values.
  for (const char* const id : {"maxon_ecx_flat_32l_48v", "maxon_ec45_flat_70w_24v", "maxon_eci40_70w_36v_496655", "maxon_dcx19s_24v"}) {
    const Motor honest = shipped_motor(id);
    const Derating with = derate(honest, twente(), few_samples());
    for (const unsigned seed : {0U, 1U}) {
      const Derating without = derate(stripped(honest, seed), twente(), few_samples());
      EXPECT_THAT(without.default_spreads, Not(IsEmpty())) << id;
      // The search finds the reserve within 1 %.
      EXPECT_GE(without.observer.heat_reserve_ratio(), 0.99 * with.observer.heat_reserve_ratio()) << id << ", " << seed;
      EXPECT_LE(limp_current_A(without), 1.005 * limp_current_A(with)) << id << ", " << seed;
      for (std::size_t i = 0; i < with.table.current_A.size(); ++i) {
        EXPECT_LE(without.table.current_A[i], 1.01 * with.table.current_A[i] + 1e-3) << id << ", " << seed << ", place " << i;
      }
    }
    EXPECT_THAT(with.default_spreads, IsEmpty()) << id;
  }
}

TEST(DerateWithoutSpreads, TakesAZeroToleranceForAMissingOne) {
  Motor exact = ecx_32();
  for (auto& [key, figure] : exact.figures) {
    if (needs_spread(key)) {
      figure.spread = Spread{Spread::Kind::tolerance, figure.value, figure.value, true};
    }
  }
  Motor missing = ecx_32();
  for (auto& [key, figure] : missing.figures) {
    if (needs_spread(key)) {
      figure.spread.reset();
    }
  }
  const Derating one = derate(exact, twente(), few_samples());
  const Derating other = derate(missing, twente(), few_samples());
  EXPECT_EQ(one.table.current_A, other.table.current_A);
  EXPECT_GT(one.observer.heat_reserve_ratio(), 1.5);
}

TEST(DerateWithoutSpreads, CountsAnEffectWithoutOneToo) {
  // Cooling that somebody guessed and gave no range for.
  const auto with_plate = [](const char* range) {
    Motor motor = ecx_32();
    const auto type = std::ranges::find(all_effects(), "conduction", &EffectType::name);
    Figure resistance;
    resistance.value = 6.0;
    if (*range != 0) {
      resistance.spread = Spread{Spread::Kind::tolerance, 5.9, 6.1, true};
    }
    motor.effects.push_back({"plate", &*type, {"stator", "ambient"}, {resistance}});
    return motor;
  };
  const Derating known = derate(with_plate("narrow"), twente(), few_samples());
  const Derating guessed = derate(with_plate(""), twente(), few_samples());
  EXPECT_GE(guessed.observer.heat_reserve_ratio(), known.observer.heat_reserve_ratio());
  ASSERT_EQ(guessed.default_spreads.size(), 1U);
  EXPECT_EQ(guessed.default_spreads[0].key, "effects.plate.thermal_resistance");
}

}  // namespace
}  // namespace heatsoak
