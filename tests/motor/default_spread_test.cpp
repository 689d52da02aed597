// A missing tolerance must never make a motor look better than its stated tolerance would.
#include "motor/default_spread.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

#include "base/files.h"
#include "input/data_folders.h"
#include "motor/lint.h"
#include "support/shipped.h"

namespace heatsoak::motor {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<Motor> all_shipped() {
  std::vector<Motor> motors;
  for (const std::string& id : input::ids_in(kSource / "motor_db")) {
    motors.push_back(shipped_motor(id));
  }
  return motors;
}

const DefaultSpread* find(const std::vector<DefaultSpread>& all, std::string_view key) {
  const auto found = std::ranges::find(all, key, &DefaultSpread::key);
  return found == all.end() ? nullptr : &*found;
}

std::string message_of_refusal(const Motor& motor) {
  try {
    require_sound(motor);
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    return failure.what();
  }
  return {};
}

TEST(DefaultSpread, ShippedMotorsNeedNoneAndAreSound) {
  for (const Motor& motor : all_shipped()) {
    EXPECT_THAT(default_spreads(motor), IsEmpty()) << motor.id;
    EXPECT_NO_THROW(require_sound(motor)) << motor.id;
  }
}

// First-order stochastic dominance on both sides: at each quantile the default is at least as far from the nominal value as the stated
// spread. Every tail of every temperature is therefore at least as heavy.
TEST(DefaultSpread, StandsOutsideOfEveryHonestSpreadThatItReplaces) {
  std::mt19937 engine(7);
  for (const Motor& honest : all_shipped()) {
    for (int round = 0; round < 20; ++round) {
      Motor stripped = honest;
      std::size_t count = 0;
      for (auto& [key, parameter] : stripped.parameters) {
        if (needs_spread(key) && (round == 0 || engine() % 2 == 0)) {
          parameter.spread.reset();
          ++count;
        }
      }
      EXPECT_THAT(default_spreads(stripped), SizeIs(count));
      const Motor filled = with_default_spreads(stripped);
      for (const auto& [key, parameter] : honest.parameters) {
        if (!needs_spread(key)) {
          continue;
        }
        for (int i = 1; i < 100; ++i) {
          const double uniform = 0.01 * i;
          const double distance = std::abs(parameter.quantile(uniform) - parameter.value);
          EXPECT_GE(std::abs(filled.parameters.at(key).quantile(uniform) - parameter.value), distance * (1.0 - 1e-12))
              << honest.id << ", " << key << " at " << uniform;
        }
      }
    }
  }
}

TEST(DefaultSpread, WorseOriginsGetNoNarrowerOnes) {
  Motor motor = ecx_32();
  for (auto& [key, parameter] : motor.parameters) {
    parameter.spread.reset();
  }
  std::vector<DefaultSpread> before;
  // An origin "measured" without an interval counts as no measurement.
  for (const base::Origin origin :
       {base::Origin::datasheet, base::Origin::third_party, base::Origin::derived, base::Origin::estimated, base::Origin::measured}) {
    for (auto& [key, parameter] : motor.parameters) {
      parameter.origin = origin;
    }
    const std::vector<DefaultSpread> now = default_spreads(motor);
    ASSERT_THAT(now, SizeIs(7));
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_LE(now[i].spread.low, before[i].spread.low) << now[i].key;
      EXPECT_GE(now[i].spread.high, before[i].spread.high) << now[i].key;
    }
    before = now;
  }
}

TEST(DefaultSpread, OfEverythingThatTemperaturesDependOn) {
  // Among the declared thermal values only limits are agreed values, which have no spread.
  for (const MotorParameterSpec& each : motor_parameter_specs()) {
    EXPECT_EQ(each.is_thermal && !is_agreed(each.spec.key), needs_spread(each.spec.key) && each.spec.key != "temperature_coefficient")
        << each.spec.key;
  }
}

TEST(DefaultSpread, AZeroToleranceCountsAsMissingAndIsRefused) {
  for (const std::string_view key : {"thermal_resistance_stator_ambient", "terminal_resistance", "no_load_current"}) {
    Motor motor = ecx_32();
    base::ParameterValue& parameter = motor.parameters.at(key);
    parameter.spread = base::Spread{base::Spread::Kind::tolerance, parameter.value, parameter.value, true};
    ASSERT_THAT(default_spreads(motor), SizeIs(1)) << key;
    EXPECT_LT(with_default_spreads(motor).parameters.at(key).spread->low, parameter.value);
    EXPECT_THAT(message_of_refusal(motor), AllOf(HasSubstr(".toml:"), HasSubstr("exact_values"), HasSubstr(key), HasSubstr("state that")));
  }
}

base::Spread of_percent(const base::ParameterValue& parameter, double below_percent, double above_percent) {
  return {base::Spread::Kind::range, parameter.value * (1.0 - 0.01 * below_percent), parameter.value * (1.0 + 0.01 * above_percent), true};
}

// A file states 0.001 % to avoid a larger spread, on both sides or on the side that makes motors hot.
TEST(DefaultSpread, ANarrowerSpreadThanItsOriginSupportsIsRefusedAndNotUsed) {
  for (const std::string_view key : {"thermal_resistance_stator_ambient", "terminal_resistance", "no_load_current"}) {
    for (const base::Origin origin :
         {base::Origin::datasheet, base::Origin::third_party, base::Origin::derived, base::Origin::measured, base::Origin::estimated}) {
      Motor missing = ecx_32();
      missing.parameters.at(key).origin = origin;
      missing.parameters.at(key).spread.reset();
      const base::Spread usual = *with_default_spreads(missing).parameters.at(key).spread;
      for (const auto& [below_percent, above_percent] : {std::pair(1e-3, 1e-3), std::pair(40.0, 0.01), std::pair(0.5, 100.0)}) {
        Motor motor = missing;
        base::ParameterValue& parameter = motor.parameters.at(key);
        parameter.spread = of_percent(parameter, below_percent, above_percent);
        EXPECT_THAT(message_of_refusal(motor),
                    AllOf(HasSubstr(".toml:"), HasSubstr("narrow_values"), HasSubstr(key), HasSubstr("state that")))
            << base::to_string(origin) << " " << below_percent;
        EXPECT_EQ(with_default_spreads(motor).parameters.at(key).spread->low, usual.low);
        EXPECT_EQ(with_default_spreads(motor).parameters.at(key).spread->high, usual.high);
      }
    }
  }
}

TEST(DefaultSpread, AFitThatIsSurerThanItsSensorsIsWidenedAndNotRefused) {
  Motor motor = ecx_32();
  base::ParameterValue& parameter = motor.parameters.at("thermal_resistance_stator_ambient");
  parameter.origin = base::Origin::measured;
  parameter.spread = of_percent(parameter, 0.02, 3.0);
  EXPECT_THAT(message_of_refusal(motor), HasSubstr("narrow_values")) << "the file records no fit";
  motor.fit.emplace().parameters = {"thermal_resistance_stator_ambient"};
  EXPECT_EQ(message_of_refusal(motor), "");
  const std::vector<DefaultSpread> found = default_spreads(motor);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_NEAR(found[0].spread.low, 0.99 * parameter.value, 1e-9 * parameter.value);
  EXPECT_NEAR(found[0].spread.high, 1.03 * parameter.value, 1e-9 * parameter.value);
  parameter.spread = of_percent(parameter, 1.5, 1.5);
  EXPECT_THAT(default_spreads(motor), IsEmpty());
}

/// A fit narrows a time constant of a data sheet that it does not determine alone.
TEST(DefaultSpread, AFittedValueThatKeepsItsOriginIsWidenedAndNotRefused) {
  Motor motor = ecx_32();
  base::ParameterValue& parameter = motor.parameters.at("thermal_time_constant_stator");
  parameter.origin = base::Origin::datasheet;
  parameter.source = "sheet, calibration";
  parameter.spread = of_percent(parameter, 1.3, 1.3);
  EXPECT_THAT(message_of_refusal(motor), HasSubstr("narrow_values")) << "the file records no fit";
  motor.fit.emplace().parameters = {"thermal_time_constant_stator"};
  EXPECT_EQ(message_of_refusal(motor), "");
  EXPECT_EQ(std::ranges::count(lint(motor), "narrow_values", &LintFinding::check), 0);
  EXPECT_LT(with_default_spreads(motor).parameters.at("thermal_time_constant_stator").spread->low, 0.94 * parameter.value);
}

TEST(DefaultSpread, AFileThatACalibrationWroteGetsNoNoteAboutIt) {
  Motor motor = ecx_32();
  base::ParameterValue& parameter = motor.parameters.at("thermal_resistance_stator_ambient");
  parameter.origin = base::Origin::measured;
  parameter.spread = of_percent(parameter, 0.02, 3.0);
  const auto notes = [&] {
    const std::vector<LintFinding> all = lint(motor);
    return std::ranges::count(all, "narrow_values", &LintFinding::check);
  };
  EXPECT_EQ(notes(), 1) << "the user wrote it";
  parameter.source = "calibration";
  motor.fit.emplace().parameters = {"thermal_resistance_stator_ambient"};
  EXPECT_EQ(notes(), 0);
}

TEST(DefaultSpread, MissingOnesAreNoReasonToRefuse) {
  Motor motor = ecx_32();
  for (auto& [key, parameter] : motor.parameters) {
    parameter.spread.reset();
  }
  EXPECT_EQ(message_of_refusal(motor), "");
  EXPECT_THAT(to_string(default_spreads(motor)), HasSubstr("thermal_resistance_stator_ambient -50 to +80 % (estimated)"));
}

TEST(DefaultSpread, ContradictionsAreRefusedWithTheirPlace) {
  const std::string message = message_of_refusal(read_motor(kSource / "tests/data/lint_motors/lint_df45l_phase_resistance.toml"));
  EXPECT_THAT(message, AllOf(HasSubstr("lint_df45l_phase_resistance.toml:"), HasSubstr(": error: nominal_speed: "), HasSubstr("expected")));
}

TEST(DefaultSpread, ParametersOfEffectsStayWithinTheirDeclaration) {
  Motor motor = ecx_32();
  const auto add = [&motor](const thermal::EffectType& type) {
    MotorEffect effect{std::string(type.name), &type, {}, {}};
    for (const base::ParameterSpec& spec : type.parameters) {
      base::ParameterValue parameter;
      parameter.value = std::isfinite(spec.range.high) ? spec.range.high : std::max(1.0, spec.range.low);
      effect.parameters.push_back(parameter);
    }
    motor.effects.push_back(effect);
  };
  for (const thermal::EffectType& type : thermal::all_effects()) {
    add(type);
  }
  const Motor filled = with_default_spreads(motor);
  std::size_t drawn = 0;
  for (const MotorEffect& effect : filled.effects) {
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      const base::ParameterSpec& spec = effect.type->parameters[i];
      const std::optional<base::Spread>& spread = effect.parameters[i].spread;
      EXPECT_FALSE(spread && !spec.choices.empty()) << effect.name << "." << spec.key;
      if (spread) {
        ++drawn;
        EXPECT_GE(spread->low, spec.range.low) << effect.name << "." << spec.key;
        EXPECT_LE(spread->high, spec.range.high) << effect.name << "." << spec.key;
        EXPECT_LT(spread->low, spread->high) << effect.name << "." << spec.key;
      }
    }
  }
  EXPECT_GT(drawn, filled.effects.size() / 2);
  EXPECT_EQ(find(default_spreads(filled), "effects.third_node.conductance"), nullptr);
  EXPECT_NE(find(default_spreads(motor), "effects.third_node.conductance"), nullptr);
}

}  // namespace
}  // namespace heatsoak::motor
