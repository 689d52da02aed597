// Findings of lint as data.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/files.h"
#include "motor/lint.h"
#include "motor/read_motor.h"
#include "support/source_folder.h"

namespace heatsoak::motor {
namespace {

using testing::HasSubstr;

/// Returns the findings about heat that counts twice for a motor with this effect at its usual nodes.
std::vector<LintFinding> counted_twice_with(std::string_view type, std::vector<double> values,
                                            base::Origin origin_of_values = base::Origin::estimated,
                                            base::Origin origin_of_resistance = base::Origin::datasheet) {
  Motor motor = read_motor(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml");
  motor.parameters.at("thermal_resistance_winding_stator").origin = origin_of_resistance;
  std::vector<base::ParameterValue> parameters;
  for (const double value : values) {
    parameters.push_back(motor.parameters.at("no_load_current"));
    parameters.back().value = value;
    parameters.back().origin = origin_of_values;
  }
  const thermal::EffectType* const more = thermal::find_effect(type);
  std::vector<std::string> nodes;
  std::ranges::transform(more->nodes, std::back_inserter(nodes),
                         [](const thermal::NodeRole& role) { return std::string(role.default_node); });
  motor.effects.push_back({"more", more, nodes, parameters});
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

TEST(LintFindings, a_share_of_the_copper_loss_needs_a_fitted_thermal_resistance) {
  const std::vector<LintFinding> found = counted_twice_with("uneven_winding", {0.1});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].what.words, LintWords::share_counted_twice);
  using enum base::Origin;
  EXPECT_TRUE(counted_twice_with("uneven_winding", {0.1}, measured, measured).empty());
  // A share that is added to a fitted file was not part of the fit.
  EXPECT_EQ(counted_twice_with("uneven_winding", {0.1}, estimated, measured).size(), 1U);
  EXPECT_EQ(counted_twice_with("uneven_winding", {0.1}, measured, datasheet).size(), 1U);
}

/// Returns the findings about the size of an effect of a fitted motor.
std::vector<LintFinding> sizes_with(std::string_view type, std::vector<std::string> nodes, const std::vector<double>& values) {
  Motor motor = read_motor(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml");
  motor.fit.emplace();
  std::vector<base::ParameterValue> parameters;
  for (const double value : values) {
    parameters.emplace_back().value = value;
  }
  motor.effects.push_back({"found", thermal::find_effect(type), std::move(nodes), parameters});
  std::vector<LintFinding> found = lint(motor);
  std::erase_if(found, [](const LintFinding& each) { return each.check != "effect_sizes"; });
  return found;
}

// The declared range of these parameters has no upper end. A fit to bad logs or with a wrong unit must not go unnoticed.
TEST(LintFindings, effects_far_larger_than_the_motor_are_reported) {
  EXPECT_TRUE(sizes_with("air_gap_stirring", {"winding", "stator"}, {0.05}).empty());
  const std::vector<LintFinding> large = sizes_with("air_gap_stirring", {"winding", "stator"}, {20.0});
  ASSERT_EQ(large.size(), 1U);
  EXPECT_EQ(large[0].level, LintFinding::Level::warning);
  EXPECT_THAT(message_of(large[0]),
              testing::AllOf(HasSubstr("effects.found.conductance of 20 W/K is "), HasSubstr("own conductances together")));
  EXPECT_EQ(sizes_with("air_gap_stirring", {"winding", "stator"}, {500.0}).at(0).level, LintFinding::Level::error);
  EXPECT_TRUE(sizes_with("constant_heat", {"stator"}, {2.0}).empty());
  EXPECT_EQ(sizes_with("constant_heat", {"stator"}, {2000.0}).at(0).level, LintFinding::Level::warning);
  EXPECT_TRUE(sizes_with("connection_resistance", {"winding"}, {0.02}).empty());
  EXPECT_EQ(sizes_with("connection_resistance", {"winding"}, {20.0}).at(0).level, LintFinding::Level::warning);
  EXPECT_TRUE(sizes_with("third_node", {"stator", "ambient", "found"}, {0.3, 0.2, 60.0}).empty());
  EXPECT_EQ(sizes_with("third_node", {"stator", "ambient", "found"}, {0.3, 0.2, 0.01}).at(0).level, LintFinding::Level::warning);
}

TEST(LintFindings, value_of_an_effect_outside_its_declared_range_is_an_error) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_effect_{}.toml", static_cast<int>(getpid()));
  const auto problems_with = [&](std::string_view value, std::string_view range) {
    constexpr const char* kEffect = R"(
[effects.bearing]
type = "bearing_friction"
loss = {{ value = "0.5 W", origin = "estimated", derivation = "a test" }}
thinning = {{ value = "0.03 1/K", origin = "estimated", derivation = "a test" }}
viscous_share = {{ value = "{}", range = ["0 %", "{}"], origin = "estimated", derivation = "a test" }}
)";
    std::ostringstream sheet;
    sheet << std::ifstream(kSource / "motor_db/maxon_ecx_flat_42m_24v.toml").rdbuf();
    base::write_file(file, sheet.str() + fmt::format(kEffect, value, range));
    base::Diagnostics diagnostics;
    read_motor(file, diagnostics);
    std::filesystem::remove(file);
    std::vector<std::string> keys;
    std::ranges::transform(diagnostics.list(), std::back_inserter(keys), &base::Diagnostic::key);
    return keys;
  };
  EXPECT_THAT(problems_with("50 %", "80 %"), testing::IsEmpty());
  EXPECT_THAT(problems_with("150 %", "150 %"), testing::Contains("effects.bearing.viscous_share.value"));
  EXPECT_THAT(problems_with("50 %", "150 %"), testing::Contains("effects.bearing.viscous_share.range"));
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
