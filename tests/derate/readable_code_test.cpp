// Generated code as a reader of firmware meets it: names of quantities, and no loop that runs once or never.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>
#include <string>

#include "exported_text.h"

namespace heatsoak::derate {
namespace {

std::string value(const char* key, const char* text) {
  return fmt::format("{} = {{ value = \"{}\", origin = \"estimated\", derivation = \"a test\" }}\n", key, text);
}

std::string effect(const char* type, const std::string& values) { return fmt::format("[effects.{0}]\ntype = \"{0}\"\n{1}", type, values); }

std::string losses() { return effect("iron_loss_hysteresis", value("loss", "0.5 W")) + effect("ac_copper_loss", value("share", "0.1")); }

std::string chassis() {
  return "[effects.chassis]\ntype = \"third_node\"\n" + value("conductance", "0.3 W/K") + value("leak_ratio", "0.2") +
         value("heat_capacity", "60 J/K");
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
  for (const char* const name :
       {"no_load_loss_torque_Nm", "heating_current_squared_A2", "copper_loss_resistance_ohm", "winding_to_stator_conductance_W_per_K",
        "heat_safety_factor_ratio", "guarded_copper_loss_W", "winding_rate_K_per_J", "copper_loss_resistance_change_per_K"}) {
    EXPECT_THAT(code, HasSubstr(fmt::format("const int32_t {} = ", name)));
  }
  EXPECT_THAT(code, HasSubstr("#define MAXON_ECX_FLAT_32L_48V_Q15_UNKNOWN_CURRENT_MA "));
}

}  // namespace
}  // namespace heatsoak::derate
