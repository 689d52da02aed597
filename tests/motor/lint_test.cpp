#include "motor/lint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "support/motors_of_database.h"
#include "support/source_folder.h"

namespace heatsoak::motor {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

Motor motor_of_database(const std::string& id) { return read_motor(kSource / "motor_db" / (id + ".toml")); }
Motor wrong_motor(const std::string& name) { return read_motor(kSource / "tests/data/lint_motors" / ("lint_" + name + ".toml")); }

std::set<std::string> checks_with(LintFinding::Level level, const Motor& motor) {
  std::set<std::string> checks;
  for (const LintFinding& finding : lint(motor)) {
    if (finding.level == level) {
      checks.insert(finding.check);
    }
  }
  return checks;
}
std::set<std::string> errors(const Motor& motor) { return checks_with(LintFinding::Level::error, motor); }

/// Returns all messages of one check, including their advice.
std::string said_by(const std::string& check, const Motor& motor) {
  std::string messages;
  for (const LintFinding& finding : lint(motor)) {
    messages += finding.check == check ? message_of(finding) + "\n" : "";
  }
  return messages;
}

// Every motor of the database must pass.

class MotorOfDatabase : public testing::TestWithParam<std::string> {};

TEST_P(MotorOfDatabase, has_no_contradiction) {
  for (const LintFinding& finding : lint(motor_of_database(GetParam()))) {
    EXPECT_EQ(finding.level, LintFinding::Level::note)
        << base::to_string(finding.at) << ": " << finding.check << ": " << message_of(finding);
  }
}

INSTANTIATE_TEST_SUITE_P(each, MotorOfDatabase, testing::ValuesIn(motors_of_database()), [](const auto& each) {
  std::string name = each.param;
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

// Heat at the nominal point, compared with the calculation in motors.yaml (key Ieq_over_that).

struct KnownHeat {
  std::string id;
  double equivalent_over_limit;
};

class NominalPointOfSheet : public testing::TestWithParam<KnownHeat> {};

TEST_P(NominalPointOfSheet, meets_the_thermal_limit_of_the_network) {
  const std::optional<NominalPointHeat> heat = nominal_point_heat(motor_of_database(GetParam().id));

  ASSERT_TRUE(heat);
  EXPECT_NEAR(heat->equivalent_current_A / heat->limit_current_A, GetParam().equivalent_over_limit, 0.002);
}

INSTANTIATE_TEST_SUITE_P(ec45_flat, NominalPointOfSheet,
                         testing::Values(KnownHeat{"maxon_ec45_flat_70w_24v", 1.026}, KnownHeat{"maxon_ec45_flat_70w_30v_402685", 1.028},
                                         KnownHeat{"maxon_ec45_flat_70w_36v_402686", 1.034},
                                         KnownHeat{"maxon_ec45_flat_70w_48v_402687", 0.946}, KnownHeat{"maxon_ec45_flat_50w_18v", 1.041},
                                         KnownHeat{"maxon_ec45_flat_50w_24v", 1.033}, KnownHeat{"maxon_ec45_flat_50w_36v", 1.023},
                                         KnownHeat{"maxon_ec45_flat_50w_48v", 1.018}, KnownHeat{"maxon_ec45_flat_70w_43mm_24v", 1.045},
                                         KnownHeat{"maxon_ec45_flat_70w_43mm_36v", 1.032}, KnownHeat{"maxon_ec45_flat_70w_43mm_48v", 1.026},
                                         KnownHeat{"maxon_ec45_flat_70w_43mm_60v", 1.004}),
                         [](const auto& each) { return each.param.id; });

// Hand calculation for 397172: (128 + 36.9 · 0.234) mN m / 36.9 mN m/A = 3.703 A. Drag 8.635 mN m · 508.9 rad/s = 4.394 W, · 3.56 K/W =
// 15.64 K. The copper may have (100 − 15.64) K / 7.66 K/W = 11.01 W = I² · 0.608 ohm · 1.39, so I = 3.610 A.
TEST(NominalPointHeat, worked_example) {
  const std::optional<NominalPointHeat> heat = nominal_point_heat(motor_of_database("maxon_ec45_flat_70w_24v"));

  ASSERT_TRUE(heat);
  EXPECT_NEAR(heat->equivalent_current_A, 3.703, 0.001);
  EXPECT_NEAR(heat->limit_current_A, 3.610, 0.001);
}

TEST(NominalPointHeat, needs_torque_and_speed) { EXPECT_FALSE(nominal_point_heat(motor_of_database("maxon_dcx19s_24v"))); }

TEST(NominalPointHeat, is_zero_where_drag_alone_is_too_much) {
  Motor motor = motor_of_database("maxon_ec45_flat_70w_24v");
  motor.nominal.no_load_current_A *= 10.0;

  EXPECT_EQ(nominal_point_heat(motor)->limit_current_A, 0.0);
  EXPECT_THAT(said_by("nominal_point_heat", motor), HasSubstr("without any current"));
}

// Wrong values that are in circulation.

TEST(WrongValues, of_the_wiki) {
  EXPECT_THAT(errors(wrong_motor("df45l_wiki")), ElementsAre("assigned_power", "density", "nominal_current"));
}

TEST(WrongValues, resistance_of_the_wiki_makes_the_nominal_point_too_hot) {
  EXPECT_THAT(said_by("nominal_point_heat", wrong_motor("df45l_wiki")), HasSubstr("expected 0.85 to 1.1 times"));
}

/// Returns the valid file of the DF45L with one value replaced by that of the wiki.
Motor df45l_with(const std::string& key, const std::string& value, bool with_second_sources = true) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / ("df45l_" + std::to_string(getpid()) + ".toml");
  std::ifstream in(kSource / "motor_db" / "nanotec_df45l024048_a2.toml");
  std::ofstream out(path);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(key + " = {")) {
      line = std::regex_replace(line, std::regex("value = \"[^\"]*\""), "value = \"" + value + "\"");
      // The range belongs to the valid value and is replaced, too.
      line = std::regex_replace(line, std::regex("range = \\[[^\\]]*\\]"), "tolerance = \"10 %\"");
    }
    out << (with_second_sources ? line : std::regex_replace(line, std::regex("confirmed_by = \\{[^}]*\\}, "), "")) << "\n";
  }
  out.close();
  Motor motor = read_motor(path);
  std::filesystem::remove(path);
  return motor;
}

struct WikiValue {
  std::string key;
  std::string value;
  LintFinding::Level level;
  std::string check;
};
class WikiValueAlone : public testing::TestWithParam<WikiValue> {};

TEST_P(WikiValueAlone, is_found) {
  const auto& [key, value, level, check] = GetParam();

  EXPECT_THAT(checks_with(level, df45l_with(key, value)), Contains(check));
}

INSTANTIATE_TEST_SUITE_P(df45l, WikiValueAlone,
                         testing::Values(WikiValue{"nominal_current", "6.4 A", LintFinding::Level::error, "nominal_current"},
                                         WikiValue{"assigned_power", "151 W", LintFinding::Level::error, "assigned_power"},
                                         WikiValue{"terminal_resistance", "1.2 ohm", LintFinding::Level::error, "confirmations"},
                                         WikiValue{"terminal_inductance", "0.4 mH", LintFinding::Level::error, "confirmations"},
                                         WikiValue{"mass", "320 g", LintFinding::Level::error, "density"},
                                         WikiValue{"length", "48 mm", LintFinding::Level::warning, "density"},
                                         WikiValue{"rotor_inertia", "13 g cm2", LintFinding::Level::error, "rotor_inertia"}),
                         [](const auto& each) { return each.param.key; });

// Hand calculation: the input is 24 V · 3.26 A = 78.2 W. The output and losses are 130 mN m · 506.8 rad/s = 65.9 W, 3.26² A² · 1.2 ohm ·
// 1.41 = 18.0 W and 5.58 mN m · 506.8 rad/s = 2.8 W. Their sum of 86.7 W is 1.108 times the input; with 0.64 ohm it is 1.002 times.
TEST(WrongValues, resistance_of_the_wiki_loses_more_than_goes_in_without_any_second_source) {
  const Motor motor = df45l_with("terminal_resistance", "1.2 ohm", false);

  EXPECT_THAT(errors(motor), ElementsAre());
  EXPECT_THAT(checks_with(LintFinding::Level::warning, motor), ElementsAre("nominal_point_heat", "power_balance"));
  EXPECT_THAT(said_by("power_balance", motor), HasSubstr("1.11 times the input"));
}

// The EC 45 flat with equal size and constants has 0.463 mH. No physical law excludes 0.4 mH, only a measurement does.
TEST(WrongValues, inductance_of_the_wiki_is_refused_by_the_second_source_alone) {
  EXPECT_THAT(said_by("confirmations", df45l_with("terminal_inductance", "0.4 mH")), HasSubstr("tigers_firmware says 0.26 mH"));
  EXPECT_THAT(checks_with(LintFinding::Level::warning, df45l_with("terminal_inductance", "0.4 mH", false)), ElementsAre());
}

// 13 g cm2 is 0.019 of 150 g at 21.4 mm. This fits the internal rotors of the EC-i 40 but no external rotor.
TEST(WrongValues, inertia_of_the_wiki_is_impossible_for_an_external_rotor_only) {
  Motor motor = df45l_with("rotor_inertia", "13 g cm2");
  EXPECT_THAT(errors(motor), ElementsAre("rotor_inertia"));
  EXPECT_THAT(said_by("rotor_inertia", motor), HasSubstr("expected at least 20.6 g cm2"));
  motor.rotor.clear();  // the file does not state it, but the motor is flat
  EXPECT_THAT(errors(motor), ElementsAre());
  EXPECT_THAT(checks_with(LintFinding::Level::warning, motor), ElementsAre("rotor_inertia"));
  motor.rotor = "internal";
  EXPECT_EQ(said_by("rotor_inertia", motor), "");
}

TEST(WrongValues, sound_file_without_a_change_has_none) { EXPECT_THAT(errors(df45l_with("mass", "150 g")), ElementsAre()); }

TEST(WrongValues, of_one_phase_given_as_if_between_terminals) {
  const Motor motor = wrong_motor("df45l_phase_constants");

  EXPECT_THAT(errors(motor), ElementsAre("constants", "nominal_current", "nominal_speed", "peak_point"));
  EXPECT_THAT(said_by("constants", motor), HasSubstr("contradictory conventions: the factor is that of the peak EMF of one phase"));
  EXPECT_THAT(said_by("nominal_speed", motor), HasSubstr("phase_to_star"));
}

TEST(WrongValues, resistance_of_one_phase) {
  const Motor motor = wrong_motor("df45l_phase_resistance");

  EXPECT_THAT(errors(motor), ElementsAre("nominal_speed"));
  EXPECT_THAT(said_by("nominal_speed", motor), HasSubstr("0.623 ohm, about twice as much"));
}

TEST(WrongValues, torque_constant_per_ampere_of_phase_peak) {
  const Motor motor = wrong_motor("df45l_peak_phase_ampere");

  EXPECT_THAT(errors(motor), Contains("constants"));
  EXPECT_THAT(said_by("constants", motor), HasSubstr("\"per_peak_phase_ampere\""));
}

TEST(WrongValues, of_a_failed_identification) {
  const Motor motor = wrong_motor("ecx_flat_42m_24v_misidentified");

  EXPECT_THAT(errors(motor), ElementsAre("constants", "nominal_current"));
  EXPECT_THAT(said_by("constants", motor), HasSubstr("no known convention explains"));
}

TEST(WrongValues, are_found_at_their_line) {
  const std::vector<LintFinding> findings = lint(wrong_motor("df45l_wiki"));

  const auto density = std::ranges::find(findings, "density", &LintFinding::check);
  ASSERT_NE(density, findings.end());
  EXPECT_THAT(density->at.file, HasSubstr("lint_df45l_wiki.toml"));
  EXPECT_EQ(density->at.line, wrong_motor("df45l_wiki").parameters.at("mass").at.line);
  EXPECT_THAT(message_of(*density), HasSubstr("320 g"));
}

// One wrong value in a good data sheet (EC 45 flat, 70 W, 24 V) must trigger exactly the checks that involve it.

struct Slip {
  std::string name;
  std::variant<double MotorValues::*, std::optional<double> MotorValues::*> parameter;
  double factor;
  std::vector<std::string> expected;
};

class SlipOfASheet : public testing::TestWithParam<Slip> {};

TEST_P(SlipOfASheet, fires_its_checks_only) {
  Motor motor = motor_of_database("maxon_ec45_flat_70w_24v");
  if (const auto* const required = std::get_if<double MotorValues::*>(&GetParam().parameter)) {
    motor.nominal.** required *= GetParam().factor;
  } else {
    *(motor.nominal.*std::get<std::optional<double> MotorValues::*>(GetParam().parameter)) *= GetParam().factor;
  }

  EXPECT_THAT(errors(motor), testing::ElementsAreArray(GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(
    each, SlipOfASheet,
    testing::Values(Slip{"speed_constant", &MotorValues::speed_constant_rad_per_s_per_V, 1.05, {"constants", "no_load_speed"}},
                    Slip{"rotor_inertia", &MotorValues::rotor_inertia_kg_m2, 1.05, {"mechanical_time_constant"}},
                    Slip{"rotor_inertia_unit", &MotorValues::rotor_inertia_kg_m2, 10.0, {"mechanical_time_constant", "rotor_inertia"}},
                    Slip{"mechanical_time_constant", &MotorValues::mechanical_time_constant_s, 0.95, {"mechanical_time_constant"}},
                    Slip{"gradient", &MotorValues::speed_torque_gradient_rad_per_s_per_Nm, 1.05, {"speed_torque_gradient"}},
                    Slip{"stall_current", &MotorValues::stall_current_A, 1.03, {"stall_current"}},
                    Slip{"stall_torque", &MotorValues::stall_torque_Nm, 1.03, {"stall_torque"}},
                    Slip{"stall_torque_saturated", &MotorValues::stall_torque_Nm, 0.5, {"stall_torque"}},
                    Slip{"max_efficiency", &MotorValues::max_efficiency, 1.05, {"max_efficiency"}},
                    Slip{"no_load_speed", &MotorValues::no_load_speed_rad_per_s, 1.05, {"no_load_speed"}},
                    Slip{"nominal_current_low", &MotorValues::nominal_current_A, 0.8, {"nominal_current", "power_balance"}},
                    Slip{"nominal_current_high", &MotorValues::nominal_current_A, 1.3, {"nominal_current", "power_balance"}},
                    Slip{"nominal_speed", &MotorValues::nominal_speed_rad_per_s, 1.2, {"nominal_speed", "power_balance"}},
                    Slip{"assigned_power", &MotorValues::assigned_power_W, 2.0, {"assigned_power"}},
                    Slip{"thermal_resistance", &MotorValues::thermal_resistance_winding_stator_K_per_W, 2.0, {"nominal_point_heat"}},
                    Slip{"winding_time_constant", &MotorValues::thermal_time_constant_winding_s, 10.0, {"heat_capacities"}},
                    Slip{"stator_time_constant", &MotorValues::thermal_time_constant_stator_s, 0.1, {"heat_capacities"}},
                    Slip{"mass", &MotorValues::mass_kg, 10.0, {"heat_capacities", "rotor_inertia"}},
                    Slip{"inductance", &MotorValues::terminal_inductance_H, 1000.0, {"electrical_time_constant"}},
                    Slip{"max_speed", &MotorValues::max_speed_rad_per_s, 0.1, {"assigned_power", "limits"}},
                    Slip{"winding_limit", &MotorValues::winding_limit_C, 0.1, {"limits"}},
                    Slip{"ambient_max", &MotorValues::ambient_max_C, 2.0, {"limits"}}),
    [](const auto& each) { return each.param.name; });

TEST(Slip, half_the_resistance_is_named_one_phase) {
  Motor motor = motor_of_database("maxon_ec45_flat_70w_24v");
  motor.nominal.terminal_resistance_ohm *= 0.5;

  for (const std::string check : {"mechanical_time_constant", "speed_torque_gradient", "stall_current", "stall_torque"}) {
    EXPECT_THAT(said_by(check, motor), HasSubstr("phase_to_star")) << check;
  }
}

TEST(Slip, torque_constant_confirmed_by_the_no_load_speed_blames_the_speed_constant) {
  Motor motor = motor_of_database("maxon_ec45_flat_70w_24v");
  *motor.nominal.speed_constant_rad_per_s_per_V *= 0.5;

  EXPECT_THAT(said_by("constants", motor), HasSubstr("the speed constant should be 259 rpm/V"));
}

TEST(Slip, saturation_is_guessed_and_a_wrong_flag_is_found) {
  Motor straight = motor_of_database("maxon_ec45_flat_70w_24v");
  straight.stall_includes_saturation = true;
  Motor saturated = motor_of_database("maxon_ecx_flat_42m_48v");
  saturated.stall_includes_saturation = false;

  EXPECT_THAT(errors(straight), ElementsAre("stall_torque"));
  EXPECT_THAT(errors(saturated), ElementsAre("stall_torque"));
  EXPECT_THAT(said_by("stall_torque", saturated), HasSubstr("stall_includes_saturation = true"));
}

// A wrongly declared convention is found from either side and named.
TEST(Slip, torque_constant_in_another_convention_is_named) {
  const std::vector<std::pair<double, std::string>> factors = {{1.0 / 1.654, "peak EMF of one phase"},
                                                               {0.907, "per_peak_phase_ampere"},
                                                               {1.283, "per_rms_phase_ampere"},
                                                               {1.0 / 0.907, "\"per_dc_ampere\""},
                                                               {1.0 / 1.283, "\"per_dc_ampere\""},
                                                               {1.732, "sqrt(3)"},
                                                               {1.155, "2/sqrt(3)"},
                                                               {0.5, "2 between two phases"}};
  for (const auto& [factor, name] : factors) {
    Motor motor = motor_of_database("maxon_ec45_flat_70w_24v");
    motor.nominal.torque_constant_Nm_per_A *= factor;
    const std::string message = said_by("constants", motor);
    EXPECT_THAT(message, HasSubstr("contradictory conventions")) << factor;
    EXPECT_THAT(message, HasSubstr(name)) << factor;
  }
}

// Missing values are not checked.
TEST(Lint, reports_nothing_about_absent_values) {
  Motor motor = motor_of_database("maxon_ec45_flat_70w_24v");
  for (const MotorParameterSpec& each : motor_parameter_specs()) {
    if (const auto* const optional = std::get_if<std::optional<double> MotorValues::*>(&each.value)) {
      (motor.nominal.**optional).reset();
    }
  }

  EXPECT_THAT(errors(motor), ElementsAre());
}

TEST(Lint, notes_estimates_and_missing_spreads) {
  const Motor estimated = motor_of_database("nanotec_df45l024048_a2");

  const std::string notes = said_by("estimates", estimated);
  for (const std::string key : {"thermal_resistance_winding_stator", "thermal_time_constant_stator", "winding_limit", "nominal_current"}) {
    EXPECT_THAT(notes, HasSubstr(key + " is estimated"));
  }
  EXPECT_EQ(said_by("spreads", estimated), "");
  Motor without_spread = motor_of_database("maxon_ec45_flat_70w_24v");
  EXPECT_EQ(said_by("spreads", without_spread), "");
  without_spread.parameters.at("terminal_resistance").spread.reset();
  EXPECT_THAT(said_by("spreads", without_spread), HasSubstr("terminal_resistance of 0.608 ohm has neither tolerance nor range"));
  EXPECT_THAT(errors(without_spread), ElementsAre());
}

// Agreed values have no spread, manufactured quantities have one, and every value has a source.
TEST(Lint, asks_every_value_for_a_source_and_every_built_one_for_a_spread) {
  const Motor good = motor_of_database("maxon_ec45_flat_70w_24v");
  for (const auto& [key, parameter] : good.parameters) {
    Motor motor = good;
    motor.parameters.at(key).source.clear();
    EXPECT_THAT(errors(motor), ElementsAre("sources")) << key;
    motor = good;
    motor.parameters.at(key).spread.reset();
    EXPECT_EQ(said_by("spreads", motor).empty(), is_agreed(key)) << key;
  }
}

TEST(Lint, asks_the_values_of_an_effect_for_a_source) {
  Motor motor = motor_of_database("maxon_ec45_flat_70w_24v");
  base::ParameterValue parameter;
  parameter.value = 40.0;
  parameter.printed = "40 K/W";
  motor.effects.push_back({"flange", thermal::find_effect("conduction"), {"winding", "ambient"}, {parameter}});

  EXPECT_THAT(said_by("sources", motor), HasSubstr("flange.thermal_resistance of 40 K/W names no source"));
}

// If temperatures depend on estimates, these may cause a hot nominal point instead of the data sheet.
TEST(Lint, heat_of_estimates_is_only_a_warning) {
  Motor estimated = motor_of_database("nanotec_df45l024048_a2");
  estimated.nominal.thermal_resistance_winding_stator_K_per_W *= 2.0;

  EXPECT_THAT(errors(estimated), ElementsAre());
  EXPECT_THAT(checks_with(LintFinding::Level::warning, estimated), Contains("nominal_point_heat"));
}

/// Returns a motor with the required values only; `was` is replaced by `is`.
Motor typed_motor(const std::string& was, const std::string& is) {
  std::stringstream text;
  text << std::ifstream(kSource / "tests/data/lint_motors/lint_typed_from_a_page.toml").rdbuf();
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("heatsoak_typed_" + std::to_string(static_cast<int>(getpid())) + ".toml");
  std::ofstream(file) << std::regex_replace(text.str(), std::regex('"' + was + '"'), '"' + is + '"');
  Motor motor = read_motor(file);
  std::filesystem::remove(file);
  return motor;
}

// With nothing to compare them with, required values are judged by their order of magnitude.
TEST(RequiredValues, ASlipOfTheUnitIsFound) {
  EXPECT_EQ(said_by("required_values", typed_motor("24 V", "24 V")), "");
  struct Typed {
    std::string was;
    std::string is;
    std::string said;
    bool is_error;
  };
  for (const Typed& each :
       {Typed{"0.19 ohm", "0.19 mohm", "mohm or ohm?", true}, Typed{"0.19 ohm", "190 ohm", "stall current of 0.126 A", false},
        Typed{"25 mN m/A", "25 N m/A", "mN m/A or N m/A?", true}, Typed{"400 mA", "40 A", "mA or A?", true},
        Typed{"24 V", "240 V", "heat the stator by 384 K", false}, Typed{"300 s", "30 h", "s or h?", true},
        Typed{"4 K/W", "0.04 K/W", "0.02 times", true}, Typed{"10 s", "0.5 s", "s or h?", false}}) {
    const Motor motor = typed_motor(each.was, each.is);
    EXPECT_THAT(said_by("required_values", motor), HasSubstr(each.said)) << each.is;
    EXPECT_EQ(errors(motor).contains("required_values"), each.is_error) << each.is;
    EXPECT_TRUE(each.is_error || checks_with(LintFinding::Level::warning, motor).contains("required_values")) << each.is;
  }
}

// Values that are too good would make every verdict optimistic.
TEST(Lint, warns_of_thermal_values_that_no_known_sheet_has) {
  for (const auto& [parameter, factor] : {std::pair(&MotorValues::thermal_resistance_winding_stator_K_per_W, 0.5),
                                          {&MotorValues::thermal_resistance_stator_ambient_K_per_W, 0.5},
                                          {&MotorValues::winding_limit_C, 155.0 / 125.0}}) {
    Motor motor = motor_of_database("maxon_ec45_flat_70w_24v");
    motor.nominal.*parameter *= factor;
    EXPECT_THAT(checks_with(LintFinding::Level::warning, motor), ElementsAre("nominal_point_heat"));
    EXPECT_THAT(said_by("nominal_point_heat", motor), HasSubstr("as on known sheets"));
  }
}

// The data sheet's nominal point refers to the data sheet's network. Effects in the file must not contradict it.
TEST(Lint, judges_the_nominal_point_without_the_effects_of_the_file) {
  Motor motor = motor_of_database("maxon_ec45_flat_70w_24v");
  const NominalPointHeat sheet = nominal_point_heat(motor).value();
  base::ParameterValue parameter;
  parameter.value = 2.0;
  parameter.printed = "2 K/W";
  parameter.derivation = "a heat sink";
  motor.effects.push_back({"flange", thermal::find_effect("conduction"), {"winding", "ambient"}, {parameter}});

  EXPECT_EQ(nominal_point_heat(motor)->limit_current_A, sheet.limit_current_A);
  EXPECT_THAT(errors(motor), ElementsAre());
}

// Fitted values describe a single motor. They may differ from the data sheet in a valid file.
TEST(Lint, values_of_a_fit_that_differ_from_the_sheet_are_only_noted) {
  Motor motor = motor_of_database("maxon_ec45_flat_70w_24v");
  motor.nominal.thermal_resistance_winding_stator_K_per_W *= 2.0;
  EXPECT_THAT(errors(motor), Contains("nominal_point_heat"));
  motor.fit.emplace();
  EXPECT_THAT(errors(motor), ElementsAre());
  EXPECT_THAT(checks_with(LintFinding::Level::warning, motor), ElementsAre());
  EXPECT_THAT(checks_with(LintFinding::Level::note, motor), Contains("nominal_point_heat"));
}

// The 48 V winding of a 70 W motor gives 36 W at its own voltage, which is unusual but correct.
TEST(Lint, name_plate_of_the_type_is_only_noted) {
  EXPECT_THAT(said_by("assigned_power", motor_of_database("maxon_ec45_flat_70w_48v_402687")),
              HasSubstr("the assigned power of the type is 70 W"));
}

// Data sheets print speeds in whole rpm. Three digits would make 10000 rpm of 9999 rpm.
TEST(Lint, speeds_are_printed_in_whole_rpm) {
  const auto words = [](double value, std::string_view unit) {
    return text_of(LintClause{LintWords::heat_capacity, {LintQuantity{value, unit}, LintQuantity{1.0, unit}, LintQuantity{1.0, unit}}});
  };
  EXPECT_THAT(words(9999.0, "rpm"), HasSubstr("9999 rpm"));
  EXPECT_THAT(words(12345.4, "rpm"), HasSubstr("12345 rpm"));
  EXPECT_THAT(words(45.26, "rpm"), HasSubstr("45.3 rpm"));
  EXPECT_THAT(words(9999.0, "W"), HasSubstr("10000 W"));
}

}  // namespace
}  // namespace heatsoak::motor
