// Findings of lint as data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "motor/lint.h"
#include "motor/read_motor.h"
#include "support/source_folder.h"

namespace heatsoak::motor {
namespace {

using testing::HasSubstr;

/// Returns the findings about heat that counts twice for a motor with this effect at the stator.
std::vector<LintFinding> counted_twice_with(std::string_view type, std::vector<double> values) {
  Motor motor = read_motor(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml");
  std::vector<base::ParameterValue> parameters;
  for (const double value : values) {
    parameters.push_back(motor.parameters.at("no_load_current"));
    parameters.back().value = value;
  }
  motor.effects.push_back({"more", thermal::find_effect(type), {"stator"}, parameters});
  std::vector<LintFinding> found = lint(motor);
  std::erase_if(found, [](const LintFinding& each) { return each.check != "heat_counted_twice"; });
  return found;
}

TEST(LintFindings, input_power_contains_the_losses_of_every_motor) {
  const std::vector<LintFinding> found = counted_twice_with("input_power_loss", {0.5});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].level, LintFinding::Level::warning);
  EXPECT_EQ(found[0].what.words, LintWords::input_power_counted_twice);
  ASSERT_EQ(found[0].what.facts.size(), 1U);
  EXPECT_EQ(std::get<std::string>(found[0].what.facts[0].is), "more");
  EXPECT_THAT(message_of(found[0]), HasSubstr("effects.more is an input_power_loss, which contains the copper loss"));
  const std::vector<LintFinding> copper = counted_twice_with("copper_loss", {0.2, 0.0039});
  ASSERT_EQ(copper.size(), 1U);
  EXPECT_EQ(copper[0].what.words, LintWords::loss_counted_twice);
  EXPECT_TRUE(counted_twice_with("constant_heat", {1.0}).empty());
}

// A finding keeps its numbers: programs can compare them without reading the sentence.
TEST(LintFindings, findings_state_numbers_with_units) {
  const std::vector<LintFinding> all = lint(read_motor(kSource / "tests/data/lint_motors/lint_df45l_phase_constants.toml"));
  const auto found = std::ranges::find(all, "constants", &LintFinding::check);
  ASSERT_NE(found, all.end());
  EXPECT_EQ(found->what.words, LintWords::constants_product);
  ASSERT_EQ(found->what.facts.size(), 4U);
  EXPECT_EQ(std::get<LintQuantity>(found->what.facts[0].is).unit, "mN m/A");
  const double product = std::get<LintNumber>(found->what.facts[2].is).value;
  EXPECT_GT(std::abs(product - 1.0), 0.015);
}

}  // namespace
}  // namespace heatsoak::motor
