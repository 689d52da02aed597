// Generated code as a reader of firmware meets it: names of quantities, and no loop that runs once or never.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "base/unit_names.h"
#include "derate/export_text.h"
#include "exported_text.h"
#include "thermal/effect.h"

namespace heatsoak::derate {
namespace {

std::string losses() {
  return effect_table("iron_loss_hysteresis", estimated("loss", "0.5 W")) + effect_table("ac_copper_loss", estimated("share", "0.1"));
}

std::string chassis() {
  return "[effects.chassis]\ntype = \"third_node\"\n" + estimated("conductance", "0.3 W/K") + estimated("leak_ratio", "0.2") +
         estimated("heat_capacity", "60 J/K");
}

/// Expects that no loop with constant bounds runs fewer than two times.
void expect_loops_that_repeat(const std::string& code) {
  const std::regex loop(R"(for \(\w+ = (\d+); \(?\w+ < (\d+)\)?[;& ])");
  for (std::sregex_iterator each(code.begin(), code.end(), loop), end; each != end; ++each) {
    EXPECT_GE(std::atoi((*each)[2].str().c_str()) - std::atoi((*each)[1].str().c_str()), 2) << each->str();
  }
}

TEST(ReadableCode, HasNoLoopThatRunsOnceAndNoNumberedNames) {
  for (const std::string& effects : {std::string(), losses(), chassis(), std::string(kPowerAndExponential)}) {
    const Derating derating = derating_of(ecx_32_with(effects));
    for (const char* const form : {"c_header", "c_header_q15", "vesc"}) {
      if (refusal(form, derating) != "accepted") {
        continue;
      }
      const std::string code = exported(form, derating);
      expect_loops_that_repeat(code);
      EXPECT_FALSE(std::regex_search(code, std::regex("[_-](term|constant)([_-][0-9]+)?\\b"))) << form << effects;
      EXPECT_THAT(code, HasSubstr("terminal_resistance 1.07 ohm")) << "the numbers of the laws have names";
    }
  }
}

TEST(ReadableCode, IntegerFormNamesQuantitiesByTheirUnits) {
  const std::string code = exported("c_header_q15", derating_of(ecx_32_with("")));
  for (const char* const name : {"speed_magnitude_rad_per_s", "no_load_loss_W", "heating_current_squared_A2", "winding_resistance_ohm",
                                 "copper_loss_W", "winding_above_stator_K", "winding_to_stator_W", "winding_guarded_losses_W",
                                 "winding_heat_W", "stator_inflow_W", "winding_rate_K_per_s"}) {
    EXPECT_THAT(code, HasSubstr(fmt::format("const int32_t {} = ", name)));
  }
  EXPECT_THAT(code, HasSubstr("#define MAXON_ECX_FLAT_32L_48V_Q15_UNKNOWN_CURRENT_MA "));
}

/// Values of an effect in a motor's file: the first variant as a candidate, or else the worked example.
std::string in_a_file(const thermal::EffectType& type) {
  const std::vector<double>& values = type.candidacy.variants.empty() ? type.example.parameters : type.candidacy.variants.front();
  std::string lines;
  for (std::size_t i = 0; i < type.parameters.size(); ++i) {
    const base::ParameterSpec& spec = type.parameters[i];
    const std::string_view unit = base::unit_of(type.parameters, i, values);
    lines += spec.choices.empty() ? estimated(spec.key, fmt::format("{}{}{}", values[i], unit.empty() ? "" : " ", unit))
                                  : fmt::format("{} = \"{}\"\n", spec.key, spec.choices[static_cast<std::size_t>(values[i])].name);
  }
  return effect_table(type.name, lines);
}

/// A derating with the laws of this motor and the table of another one, because only the laws are of interest.
Derating with_laws_of(const motor::Motor& motor) {
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  Derating derating = ecx_derating();
  derating.observer = Observer(network, motor.nominal, twente(), 1.5);
  derating.effects = acting_effects(network, motor);
  return derating;
}

/// Names of the variables in the functions that compute the rates.
std::vector<std::string> variable_names(const std::string& code, const std::string& function, const std::string& pattern) {
  std::vector<std::string> names;
  const std::regex variable(pattern);
  for (std::size_t at = code.find(function); at != std::string::npos; at = code.find(function, at + 1)) {
    const std::string body = code.substr(at, code.find("\n}", at) - at);
    for (std::sregex_iterator each(body.begin(), body.end(), variable), end; each != end; ++each) {
      names.push_back(std::regex_replace((*each)[1].str(), std::regex("-"), "_"));
    }
  }
  return names;
}

struct Language {
  const char* exporter;
  const char* function;
  const char* variable;
};
constexpr Language kLanguages[] = {{"c_header", "rates(const ", R"(\n  const float (\w+) =)"},
                                   {"c_header_q15", "_changes(const ", R"(\n  const int32_t (\w+) =)"},
                                   {"vesc", "(defun hs-step ", R"(\n  \(var hs-([\w-]+) )"}};

class NamesOfLaw : public testing::TestWithParam<std::size_t> {
 protected:
  static const thermal::EffectType& type() { return thermal::all_effects()[GetParam()]; }
};
INSTANTIATE_TEST_SUITE_P(Registry, NamesOfLaw, testing::Range(std::size_t{0}, thermal::all_effects().size()),
                         [](const auto& effect) { return std::string(thermal::all_effects()[effect.param].name); });

// A firmware engineer reads quantities with units, not operands of operations.
TEST_P(NamesOfLaw, are_quantities_with_units) {
  const Derating derating = with_laws_of(ecx_32_with(in_a_file(type())));
  const std::regex operand(
      fmt::format("^{}_(operand|power)|operand|scaled|operating_point|(^|_)(number|term|constant|part)(_[0-9]+)?$", type().name));
  for (const Language& language : kLanguages) {
    if (refusal(language.exporter, derating) != "accepted") {
      continue;
    }
    const std::vector<std::string> names = variable_names(exported(language.exporter, derating), language.function, language.variable);
    EXPECT_GT(names.size(), 4U) << language.exporter;
    for (const std::string& name : names) {
      const std::optional<base::UnitOfName> unit = base::unit_of_name(name);
      ASSERT_TRUE(unit) << language.exporter << ": " << name << " ends in no unit";
      EXPECT_FALSE(std::regex_search(std::string(unit->quantity), operand)) << language.exporter << ": " << name;
    }
  }
}

// Code without names of its own for such steps would compute them twice.
TEST_P(NamesOfLaw, exist_for_every_step_that_is_used_twice) {
  using thermal::Operation;
  if (motor::is_loss_of_every_motor(type())) {
    GTEST_SKIP() << "a motor has this loss once";
  }
  const Derating derating = with_laws_of(ecx_32_with(in_a_file(type())));
  const thermal::Formula& formula = derating.observer.formula();
  const std::vector<char> needed = formula.needed_for(derating.observer.rate_steps());
  std::map<int, int> uses;
  for (std::size_t i = 0; i < needed.size(); ++i) {
    const thermal::Formula::Step& step = formula.steps()[i];
    if (needed[i] == 0 || step.operation == Operation::constant || step.operation == Operation::input) {
      continue;
    }
    uses[step.left] += step.operation == Operation::magnitude || step.operation == Operation::positive_part ? 2 : 1;
    if (step.right) {
      ++uses[*step.right];
    }
  }
  for (const auto& [place, count] : uses) {
    const Operation operation = formula.steps()[static_cast<std::size_t>(place)].operation;
    if (count > 1 && operation != Operation::constant && operation != Operation::input) {
      EXPECT_FALSE(formula.name_of(place).empty()) << "step " << place << " of " << formula.law_of(place);
    }
  }
}

TEST(ReadableCode, NumbersNamesThatLawsShare) {
  UniqueNames names({"state_C"});
  EXPECT_EQ(names.add("knot_weight_ratio"), "knot_weight_ratio");
  EXPECT_EQ(names.add("knot_weight_ratio"), "knot_weight_2_ratio");
  EXPECT_EQ(names.add("knot_weight_ratio"), "knot_weight_3_ratio");
  EXPECT_EQ(names.add("state_C"), "state_2_C") << "reserved";
  EXPECT_EQ(names.add("end-winding_rate_K_per_s"), "end_winding_rate_K_per_s");
  EXPECT_EQ(names.add("end winding_rate_K_per_s"), "end_winding_rate_2_K_per_s");
}

}  // namespace
}  // namespace heatsoak::derate
