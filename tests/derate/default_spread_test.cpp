// Missing tolerances must be safe: a motor file without them must not be allowed more current than the same file with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>

#include "base/diagnostic.h"
#include "derate/derating.h"
#include "guarded_motor.h"
#include "input/data_folders.h"

namespace heatsoak::derate {
namespace {

using testing::IsEmpty;
using testing::Not;

DerateOptions few_samples() {
  DerateOptions options;
  options.guarantee.samples = 100;
  return options;
}

/// Removes all spreads that temperatures depend on (seed 0), or a random half of them. Other spreads stay, because each consumes a random
/// number and removing it would change the remaining draws.
motor::Motor stripped(motor::Motor motor, unsigned seed) {
  std::mt19937 engine(seed);
  for (auto& [key, parameter] : motor.parameters) {
    if (motor::needs_spread(key) && (seed == 0 || engine() % 2 == 0)) {
      parameter.spread.reset();
    }
  }
  return motor;
}

// For every shipped motor, with the same guard and draws, the 95th percentile without spreads is at least as hot. The search for the safety
// factor uses this percentile.
TEST(DerateWithoutSpreads, DrawsMotorsThatGetNoLessHot) {
  constexpr double kPeriod_s = 0.05;
  GuaranteeOptions options;
  options.samples = 200;
  for (const std::string& id : input::ids_in(kSource / "motor_db")) {
    const motor::Motor honest = shipped_motor(id);
    const GuardedMotor guarded(honest, rules_for(honest), 1.2);
    std::vector<UsePlayed> uses;
    for (const LoadPattern& use : hardest_patterns(guarded.observer, guarded.rules)) {
      if (uses.size() < 3) {
        uses.push_back(play(guarded.observer, guarded.table, guarded.rules, honest, twente(), std::span(&use, 1), kPeriod_s).front());
      }
    }
    const Guarantee with = check(honest, guarded.rules.limits, uses, options, 0);
    for (const unsigned seed : {0U, 1U, 2U}) {
      const Guarantee without = check(motor::with_default_spreads(stripped(honest, seed)), guarded.rules.limits, uses, options, 0);
      EXPECT_GE(without.winding_p95_C, with.winding_p95_C) << id << ", " << seed;
    }
  }
}

TEST(DerateWithoutSpreads, AllowsNoMoreThanTheHonestFile) {
  const motor::Motor honest = ecx_32();
  const Derating with = derate(honest, twente(), few_samples());
  const Derating without = derate(stripped(honest, 0), twente(), few_samples());
  EXPECT_THAT(with.default_spreads, IsEmpty());
  EXPECT_THAT(without.default_spreads, Not(IsEmpty()));
  EXPECT_GE(without.observer.heat_safety_factor(), with.observer.heat_safety_factor());
  EXPECT_LE(limp_current_A(without), limp_current_A(with));
  for (const double stator_C : {40.0, 80.0, 120.0, 154.0}) {
    for (double winding_C = 40.0; winding_C < 158.0; winding_C += 2.0) {
      EXPECT_LE(without.table.allowed_A(0.0, stator_C, winding_C), with.table.allowed_A(0.0, stator_C, winding_C) + 1e-3)
          << "stator " << stator_C << ", winding " << winding_C;
    }
  }
}

TEST(DerateWithoutSpreads, TakesAZeroToleranceForAMissingOne) {
  motor::Motor exact = ecx_32();
  for (auto& [key, parameter] : exact.parameters) {
    if (motor::needs_spread(key)) {
      parameter.spread = base::Spread{base::Spread::Kind::tolerance, parameter.value, parameter.value, true};
    }
  }
  motor::Motor missing = ecx_32();
  for (auto& [key, parameter] : missing.parameters) {
    if (motor::needs_spread(key)) {
      parameter.spread.reset();
    }
  }
  const Derating one = derate(exact, twente(), few_samples());
  const Derating other = derate(missing, twente(), few_samples());
  EXPECT_EQ(one.table.heat_per_ohm_A2, other.table.heat_per_ohm_A2);
  EXPECT_GT(one.observer.heat_safety_factor(), 1.5);
}

TEST(DerateWithoutSpreads, TakesATinyToleranceForAMissingOne) {
  motor::Motor tiny = ecx_32();
  motor::Motor missing = ecx_32();
  for (auto& [key, parameter] : tiny.parameters) {
    if (motor::needs_spread(key)) {
      parameter.spread = base::Spread{base::Spread::Kind::tolerance, parameter.value * (1.0 - 1e-5), parameter.value * (1.0 + 1e-5), true};
      missing.parameters.at(key).spread.reset();
    }
  }
  EXPECT_EQ(derate(tiny, twente(), few_samples()).table.heat_per_ohm_A2, derate(missing, twente(), few_samples()).table.heat_per_ohm_A2);
}

TEST(Derate, KeepsALimitThatIsARangeAtItsLowerEnd) {
  motor::Motor wide = ecx_32();
  base::ParameterValue& limit = wide.parameters.at("winding_limit");
  limit.spread = base::Spread{base::Spread::Kind::range, 135.0, 165.0, false};
  EXPECT_EQ(barrier_rules(wide, twente(), {}).limits.winding_C, 135.0);
  EXPECT_EQ(barrier_rules(ecx_32(), twente(), {}).limits.winding_C, 155.0);
}

TEST(Derate, RefusesALimitBelowTheAir) {
  DerateOptions hot;
  hot.hottest_ambient_C = 155.0;
  try {
    static_cast<void>(derate(ecx_32(), twente(), hot));
    ADD_FAILURE() << "was accepted";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), testing::HasSubstr("the winding limit of 155.0 °C is not above the hottest air of 155.0 °C"));
  }
}

TEST(DerateWithoutSpreads, CountsAnEffectWithoutOneToo) {
  // Cooling with an estimated value and no range.
  const auto with_plate = [](const char* range) {
    motor::Motor motor = ecx_32();
    const auto type = std::ranges::find(thermal::all_effects(), "conduction", &thermal::EffectType::name);
    base::ParameterValue resistance;
    resistance.value = 6.0;
    if (*range != 0) {
      resistance.spread = base::Spread{base::Spread::Kind::tolerance, 5.9, 6.1, true};
    }
    motor.effects.push_back({"plate", &*type, {"stator", "ambient"}, {resistance}});
    return motor;
  };
  const Derating known = derate(with_plate("narrow"), twente(), few_samples());
  const Derating guessed = derate(with_plate(""), twente(), few_samples());
  EXPECT_GE(guessed.observer.heat_safety_factor(), known.observer.heat_safety_factor());
  ASSERT_EQ(guessed.default_spreads.size(), 1U);
  EXPECT_EQ(guessed.default_spreads[0].key, "effects.plate.thermal_resistance");
}

}  // namespace
}  // namespace heatsoak::derate
