#include "motor/motor.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "input/data_folders.h"
#include "input/toml_text.h"
#include "motor/datasheet_network.h"
#include "motor/write_motor.h"
#include "support/longest_line.h"
#include "support/source_folder.h"

namespace heatsoak::motor {
namespace {

/// Returns a motor with the given conventions, 0.5 ohm ± 10 % and 30 mN m/A ± 7 %.
Motor motor_with(const std::string& resistance, const std::string& torque, const std::string& more = "") {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / ("motor_" + std::to_string(getpid()) + ".toml");
  std::ofstream(path) << R"(manufacturer = "x"
name = "y"
type = "brushless"
[sources]
sheet = "a sheet"
[conventions]
terminal_resistance = ")"
                      << resistance << "\"\ntorque_constant = \"" << torque << R"("
[figures]
nominal_voltage = { value = "24 V", origin = "datasheet", source = "sheet" }
terminal_resistance = { value = "0.5 ohm", origin = "datasheet", source = "sheet", tolerance = "10 %" }
terminal_inductance = { value = "0.2 mH", origin = "datasheet", source = "sheet" }
torque_constant = { value = "30 mNm/A", origin = "datasheet", source = "sheet", tolerance = "7 %" }
no_load_current = { value = "0.2 A", origin = "datasheet", source = "sheet" }
thermal_resistance_winding_stator = { value = "4 K/W", origin = "datasheet", source = "sheet", range = ["3 K/W", "6 K/W"] }
thermal_resistance_stator_ambient = { value = "2 K/W", origin = "datasheet", source = "sheet" }
thermal_time_constant_winding = { value = "12 s", origin = "datasheet", source = "sheet" }
thermal_time_constant_stator = { value = "80 s", origin = "datasheet", source = "sheet" }
winding_limit = { value = "155 degC", origin = "datasheet", source = "sheet" }
)" << more;
  const Motor motor = read_motor(path);
  std::filesystem::remove(path);
  return motor;
}

TEST(MotorConventions, between_terminals_and_per_dc_ampere_are_ours) {
  const Motor motor = motor_with("between_terminals", "per_dc_ampere");
  EXPECT_DOUBLE_EQ(motor.nominal.terminal_resistance_ohm, 0.5);
  EXPECT_DOUBLE_EQ(motor.nominal.torque_constant_Nm_per_A, 0.03);
  EXPECT_EQ(motor.nominal.temperature_coefficient_per_K, 0.0039);
  EXPECT_FALSE(motor.nominal.stator_limit_C);
}

TEST(MotorConventions, phase_values_are_two_in_series) {
  const Motor motor = motor_with("phase_to_star", "per_dc_ampere");
  EXPECT_DOUBLE_EQ(motor.nominal.terminal_resistance_ohm, 1.0);
  EXPECT_DOUBLE_EQ(motor.nominal.terminal_inductance_H.value(), 0.4e-3);
  const base::ParameterValue& parameter = motor.parameters.at("terminal_resistance");
  EXPECT_DOUBLE_EQ(parameter.spread->low, 0.9);
  EXPECT_DOUBLE_EQ(parameter.spread->high, 1.1);
}

// Block commutation on a sinusoidal back-EMF of amplitude E between two terminals: the mean torque over the 60° around the crest is 3/π of
// the crest's. Per DC ampere this gives K = (3/π)·E/ω. A sinusoidal phase current of peak Î and phase amplitudes E/√3 give M·ω =
// 1.5·Î·E/√3, or (√3/2)·E/ω per peak ampere. The ratio is 2√3/π = 1.1027.
TEST(MotorConventions, per_peak_and_per_rms_ampere_from_the_power_of_a_sinusoidal_machine) {
  const double per_dc = motor_with("between_terminals", "per_dc_ampere").nominal.torque_constant_Nm_per_A;
  const double of_peak = motor_with("between_terminals", "per_peak_phase_ampere").nominal.torque_constant_Nm_per_A;
  const double of_rms = motor_with("between_terminals", "per_rms_phase_ampere").nominal.torque_constant_Nm_per_A;
  EXPECT_NEAR(of_peak / per_dc, 2.0 * std::numbers::sqrt3 / std::numbers::pi, 1e-14);
  EXPECT_NEAR(of_rms * std::numbers::sqrt2, of_peak, 1e-16) << "an rms ampere is √2 peak amperes";
}

TEST(MotorSample, without_spread_is_the_value_and_with_spread_within_it) {
  const Motor motor = motor_with("between_terminals", "per_dc_ampere");
  double lowest_ohm = 1.0;
  double highest_ohm = 0.0;
  for (std::uint64_t stream = 0; stream < 2000; ++stream) {
    base::Random random(3, stream);
    const MotorSample sample = draw_sample(motor, random);
    lowest_ohm = std::min(lowest_ohm, sample.values.terminal_resistance_ohm);
    highest_ohm = std::max(highest_ohm, sample.values.terminal_resistance_ohm);
    EXPECT_EQ(sample.values.no_load_current_A, 0.2);
    EXPECT_GE(sample.values.thermal_resistance_winding_stator_K_per_W, 3.0);
    EXPECT_LE(sample.values.thermal_resistance_winding_stator_K_per_W, 6.0);
    EXPECT_GE(sample.values.torque_constant_Nm_per_A, 0.0279 * (1.0 - 1e-12));
    EXPECT_LE(sample.values.torque_constant_Nm_per_A, 0.0321 * (1.0 + 1e-12));
  }
  EXPECT_GE(lowest_ohm, 0.45 * (1.0 - 1e-12));
  EXPECT_LT(lowest_ohm, 0.455);
  EXPECT_LE(highest_ohm, 0.55 * (1.0 + 1e-12));
  EXPECT_GT(highest_ohm, 0.545);
}

TEST(MotorSample, effect_parameters_are_drawn_too) {
  const Motor motor = motor_with("between_terminals", "per_dc_ampere", R"([effects.flange]
type = "conduction"
hot = "winding"
cold = "ambient"
thermal_resistance = { value = "40 K/W", origin = "estimated", derivation = "guess", range = ["20 K/W", "80 K/W"] }
)");
  ASSERT_EQ(motor.effects.size(), 1U);
  EXPECT_EQ(motor.effects[0].nodes, (std::vector<std::string>{"winding", "ambient"}));
  EXPECT_EQ(nominal_sample(motor).effect_parameters[0][0], 40.0);
  base::Random random(1, 1);
  const double first = draw_sample(motor, random).effect_parameters[0][0];
  const double second = draw_sample(motor, random).effect_parameters[0][0];
  EXPECT_NE(first, second);
  EXPECT_GE(std::min(first, second), 20.0);
  EXPECT_LE(std::max(first, second), 80.0);
}

const std::string kChassis = R"([effects.chassis]
type = "third_node"
conductance = { value = "0.2 W/K", origin = "measured", source = "sheet" }
leak_ratio = { value = "0.5", origin = "measured", source = "sheet" }
heat_capacity = { value = "150 J/K", origin = "measured", source = "sheet" }
)";

TEST(MotorEffects, a_node_of_its_own_is_named_after_the_effect_and_others_may_name_it) {
  // The lamp and the mount are defined before the effects that they depend on.
  const Motor motor = motor_with("between_terminals", "per_dc_ampere", R"([effects.a_lamp]
type = "constant_heat"
heated = "chassis"
power = { value = "2 W", origin = "measured", source = "sheet" }
[effects.b_mount]
type = "third_node"
node = "chassis"
conductance = { value = "0.1 W/K", origin = "measured", source = "sheet" }
leak_ratio = { value = "1", origin = "measured", source = "sheet" }
heat_capacity = { value = "300 J/K", origin = "measured", source = "sheet" }
)" + kChassis);
  ASSERT_EQ(motor.effects.size(), 3U);
  EXPECT_EQ(motor.effects[0].name, "chassis");
  EXPECT_EQ(motor.effects[0].nodes, (std::vector<std::string>{"stator", "chassis", "ambient"}));
  const thermal::Network network = datasheet_network(motor, nominal_sample(motor));
  EXPECT_EQ(network.state_count(), 4);
  for (const char* node : {"winding", "stator", "chassis", "b_mount"}) {
    EXPECT_TRUE(network.find_node(node)) << node;
  }
  EXPECT_EQ(network.values()[static_cast<std::size_t>(network.capacity_index(network.node("b_mount")))], 300.0);
}

TEST(MotorEffects, a_curve_takes_its_units_from_what_was_chosen_and_a_choice_is_no_estimate) {
  std::string curve = R"([effects.resonance]
type = "tabulated"
driver = "speed"
form = "heat"
first_knot = { value = "0 rpm", origin = "measured", source = "sheet" }
last_knot = { value = "6000 rpm", origin = "measured", source = "sheet" }
)";
  for (int i = 1; i <= 7; ++i) {
    curve +=
        "value_" + std::to_string(i) + " = { value = \"" + std::to_string(i) + "00 mW\", origin = \"measured\", source = \"sheet\" }\n";
  }
  const Motor motor = motor_with("between_terminals", "per_dc_ampere", curve);
  ASSERT_EQ(motor.effects.size(), 1U);
  EXPECT_NEAR(motor.effects[0].parameters[3].value, 200.0 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(motor.effects[0].parameters[6].value, 0.3, 1e-12);
  EXPECT_EQ(data_quality(motor), "datasheet");
}

std::string curve_over_column(const std::string& name, const std::string& rest) {
  std::string curve = fmt::format("[effects.{}]\ntype = \"tabulated\"\ndriver = \"column\"\nform = \"per_copper_loss\"\n{}", name, rest);
  for (const char* key : {"first_knot", "last_knot", "value_1", "value_2", "value_3", "value_4", "value_5", "value_6", "value_7"}) {
    curve += fmt::format("{} = {{ value = \"{}\", origin = \"measured\", source = \"sheet\" }}\n", key,
                         key == std::string_view("last_knot") ? 1 : 0);
  }
  return curve;
}

TEST(MotorEffects, a_curve_over_a_column_of_a_log_names_it) {
  const auto with = [](const std::string& curves) { return motor_with("between_terminals", "per_dc_ampere", curves); };
  const Motor motor = with(curve_over_column("a", "column = \"fan_ratio\"\n") + curve_over_column("b", "column = \"fan_ratio\"\n"));
  ASSERT_EQ(motor.effects.size(), 2U);
  EXPECT_EQ(motor.effects[1].column, "fan_ratio");
  EXPECT_NE(to_toml(motor).find("column = \"fan_ratio\"\n"), std::string::npos);
  EXPECT_THROW(with(curve_over_column("a", "")), base::Failure) << "which column";
}

TEST(MotorEffects, curves_over_several_columns_have_a_place_each) {
  const auto over = [](const std::string& name) { return curve_over_column(name, fmt::format("column = \"{}_ratio\"\n", name)); };
  const Motor motor = motor_with("between_terminals", "per_dc_ampere", over("c") + over("a") + over("b"));
  std::vector<std::size_t> places;
  std::ranges::transform(motor.effects, std::back_inserter(places), &MotorEffect::column_place);
  std::ranges::sort(places);
  EXPECT_THAT(places, testing::ElementsAre(0U, 1U, 2U));
  EXPECT_EQ(to_toml(motor).find("column_2"), std::string::npos) << "the file names columns, not places";
  EXPECT_THROW(motor_with("between_terminals", "per_dc_ampere", over("c") + over("a") + over("b") + over("d")), base::Failure);
}

const std::string kSensors = R"([effects.sensor_lag_stator]
time_constant = { value = "0.2 min", origin = "estimated", derivation = "glued on", range = ["6 s", "20 s"] }
[effects.second_probe]
type = "sensor_offset_winding"
offset = { value = "-1.5 K", origin = "measured", source = "sheet", range = ["-2 K", "0.5 K"] }
)";

// Sensor faults produce no heat. The motor's temperatures, and the parameters that they depend on, must equal those without sensors.
TEST(MotorSensors, move_no_temperature_of_the_motor) {
  const Motor bare = motor_with("between_terminals", "per_dc_ampere");
  Motor motor = motor_with("between_terminals", "per_dc_ampere", kSensors);
  EXPECT_TRUE(motor.effects.empty());
  const std::vector<SensorFault> at_stator = faults_of(motor, "stator_C");
  ASSERT_EQ(at_stator.size(), 1U);
  EXPECT_EQ(at_stator.front().type->name, "sensor_lag_stator");
  EXPECT_NEAR(at_stator.front().size, 12.0, 1e-9);
  ASSERT_NE(find_parameter(motor, "effects.second_probe.offset"), nullptr);
  EXPECT_EQ(find_parameter(motor, "effects.second_probe.offset")->value, -1.5);
  EXPECT_EQ(datasheet_network(motor, nominal_sample(motor)).values(), datasheet_network(bare, nominal_sample(bare)).values());
  base::Random one(1, 1);
  base::Random other(1, 1);
  EXPECT_EQ(draw_sample(motor, one).values.terminal_resistance_ohm, draw_sample(bare, other).values.terminal_resistance_ohm);
  EXPECT_EQ(data_quality(motor), "datasheet");
}

TEST(MotorSensors, are_written_as_they_were_read) {
  const Motor motor = motor_with("between_terminals", "per_dc_ampere", kSensors);
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / ("written_" + std::to_string(getpid()) + ".toml");
  std::ofstream(path) << to_toml(motor);
  const Motor again = read_motor(path);
  std::filesystem::remove(path);
  ASSERT_EQ(again.sensors.size(), motor.sensors.size());
  for (std::size_t i = 0; i < motor.sensors.size(); ++i) {
    EXPECT_EQ(again.sensors[i].name, motor.sensors[i].name);
    EXPECT_EQ(again.sensors[i].type, motor.sensors[i].type);
    EXPECT_EQ(again.sensors[i].size.value, motor.sensors[i].size.value);
    EXPECT_EQ(again.sensors[i].size.origin, motor.sensors[i].size.origin);
    ASSERT_TRUE(again.sensors[i].size.spread);
    EXPECT_NEAR(again.sensors[i].size.spread->low, motor.sensors[i].size.spread->low, 1e-9);
    EXPECT_NEAR(again.sensors[i].size.spread->high, motor.sensors[i].size.spread->high, 1e-9);
  }
  EXPECT_EQ(to_toml(again), to_toml(motor));
}

TEST(WrittenMotor, has_no_long_lines_and_the_same_values) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / ("written_" + std::to_string(getpid()) + ".toml");
  for (const std::string& id : input::ids_in(kSource / "motor_db")) {
    const Motor motor = read_motor(kSource / "motor_db" / (id + ".toml"));
    const std::string text = to_toml(motor);
    EXPECT_LE(longest_line(text), input::kLongestTomlLine) << id;
    std::ofstream(path) << text;
    const Motor again = read_motor(path);
    EXPECT_EQ(to_toml(again), text) << id;
    EXPECT_EQ(again.notes, motor.notes) << id;
  }
  std::filesystem::remove(path);
}

TEST(MotorSensors, sources_that_they_name_must_be_there) {
  EXPECT_THROW(motor_with("between_terminals", "per_dc_ampere", R"([effects.sensor_offset_stator]
offset = { value = "1 K", origin = "measured", source = "nobody" }
)"),
               base::Failure);
}

constexpr const char* kFit = R"([fit]
motor = "y"
figures = ["thermal_time_constant_winding"]
correlation = ["1"]
speed_within_rows = "%s"
forecast_unknown_heat_winding = "0.1234"
forecast_unknown_heat_stator = "0.0567"
forecast_time_scale = "1234 s"
forecast_heat_factor = "0.0345"
forecast_width = "1.26"
)";

// A deleted line must not make the band, and with it the safety factor of a derating, smaller.
TEST(MotorFit, has_all_sizes_of_the_forecast_band_or_none) {
  std::string text = kFit;
  text.replace(text.find("%s"), 2, "linear");
  for (const std::string key : {"forecast_unknown_heat_winding", "forecast_time_scale", "forecast_heat_factor", "forecast_width"}) {
    const std::size_t begin = text.find(key);
    std::string without = text;
    without.erase(begin, text.find('\n', begin) + 1 - begin);
    EXPECT_THAT([&] { motor_with("between_terminals", "per_dc_ampere", without); },
                testing::ThrowsMessage<base::Failure>(testing::HasSubstr(key)));
  }
  text.erase(text.find("forecast_"));
  EXPECT_FALSE(motor_with("between_terminals", "per_dc_ampere", text).fit->band);
}

TEST(MotorFit, states_how_the_speed_changes_within_rows) {
  std::string text = kFit;
  const std::size_t place = text.find("%s");
  const Motor motor = motor_with("between_terminals", "per_dc_ampere", std::string(text).replace(place, 2, "linear"));
  ASSERT_TRUE(motor.fit);
  EXPECT_TRUE(motor.fit->is_speed_linear);
  EXPECT_THAT(to_toml(motor), testing::HasSubstr("speed_within_rows = \"linear\""));
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"\"cubic\"", "'cubic' is not known; expected linear"}, {"1", "is a number, expected linear"}, {"true", "expected linear"}};
  for (const auto& [value, expected] : wrong) {
    try {
      motor_with("between_terminals", "per_dc_ampere", std::string(text).replace(place - 1, 4, value));
      FAIL() << "accepted";
    } catch (const base::Failure& failure) {
      EXPECT_THAT(failure.what(), testing::HasSubstr(expected));
    }
  }
}

/// Measured heat may be uncertain by a factor of three, but no model has a resistance outside of its range.
TEST(MotorFit, a_wide_heat_factor_leaves_resistances_possible) {
  std::string text = kFit;
  text.replace(text.find("%s"), 2, "linear");
  text.replace(text.find("\"0.0345\""), 8, "\"3\"");
  const Motor motor = motor_with("between_terminals", "per_dc_ampere", text);
  double least_K_per_W = 1.0;
  double most_K_per_W = 1.0;
  for (std::uint64_t stream = 0; stream < 2000; ++stream) {
    base::Random random(3, stream);
    const MotorValues values = draw_sample(motor, random).values;
    for (const double resistance_K_per_W :
         {values.thermal_resistance_winding_stator_K_per_W, values.thermal_resistance_stator_ambient_K_per_W}) {
      least_K_per_W = std::min(least_K_per_W, resistance_K_per_W);
      most_K_per_W = std::max(most_K_per_W, resistance_K_per_W);
    }
  }
  EXPECT_EQ(least_K_per_W, 1e-3);
  EXPECT_EQ(most_K_per_W, 1e3);
  EXPECT_EQ(at_upper_band(motor)->nominal.thermal_resistance_stator_ambient_K_per_W, 1e3);
}

TEST(MotorFit, band_is_rounded_as_in_its_file) {
  const Motor motor =
      motor_with("between_terminals", "per_dc_ampere", std::string(kFit).replace(std::string(kFit).find("%s"), 2, "linear"));
  const ForecastBand rounded = rounded_as_in_file(motor.fit->band.value());
  EXPECT_DOUBLE_EQ(rounded.unknown_heat_share[0], 0.12);
  EXPECT_DOUBLE_EQ(rounded.unknown_heat_share[1], 0.057);
  EXPECT_DOUBLE_EQ(rounded.time_scale_s, 1200.0);
  EXPECT_DOUBLE_EQ(rounded.heat_factor_sd, 0.035);
  EXPECT_DOUBLE_EQ(rounded.width_ratio, 1.3);
  Motor written = motor;
  written.fit->band = rounded;
  EXPECT_EQ(to_toml(written), to_toml(motor));
}

TEST(DataQuality, is_that_of_the_worst_thermal_value) {
  Motor motor = motor_with("between_terminals", "per_dc_ampere");
  EXPECT_EQ(data_quality(motor), "datasheet");
  motor.parameters.at("terminal_resistance").origin = base::Origin::measured;
  EXPECT_EQ(data_quality(motor), "datasheet");
  motor.parameters.at("terminal_resistance").origin = base::Origin::third_party;
  EXPECT_EQ(data_quality(motor), "mixed");
  motor.parameters.at("thermal_time_constant_stator").origin = base::Origin::estimated;
  EXPECT_EQ(data_quality(motor), "estimated");
  motor.parameters.at("thermal_time_constant_stator").origin = base::Origin::datasheet;
  motor.parameters.at("winding_limit").origin = base::Origin::estimated;
  EXPECT_EQ(data_quality(motor), "estimated");
}

}  // namespace
}  // namespace heatsoak::motor
