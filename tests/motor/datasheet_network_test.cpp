#include "motor/datasheet_network.h"

#include <gtest/gtest.h>

#include <array>

#include "base/unknown.h"
#include "thermal/steady_state.h"

namespace heatsoak::motor {
namespace {

/// A motor with values that are convenient for hand calculation.
Motor simple_motor() {
  Motor motor;
  motor.nominal.terminal_resistance_ohm = 0.5;
  motor.nominal.torque_constant_Nm_per_A = 0.03;
  motor.nominal.no_load_current_A = 0.2;
  motor.nominal.temperature_coefficient_per_K = 0.004;
  motor.nominal.thermal_resistance_winding_stator_K_per_W = 4.0;
  motor.nominal.thermal_resistance_stator_ambient_K_per_W = 2.0;
  motor.nominal.thermal_time_constant_winding_s = 12.0;
  motor.nominal.thermal_time_constant_stator_s = 80.0;
  return motor;
}

double value_of(const thermal::Network& network, std::string_view name) {
  for (const thermal::NetworkParameter& parameter : network.parameters()) {
    if (parameter.name == name) {
      return parameter.value;
    }
  }
  ADD_FAILURE() << "no parameter " << name;
  return base::kUnknown;
}

TEST(DatasheetNetwork, heat_capacity_is_time_constant_over_resistance) {
  const Motor motor = simple_motor();
  const thermal::Network network = datasheet_network(motor, nominal_sample(motor));
  EXPECT_DOUBLE_EQ(value_of(network, "winding.heat_capacity"), 3.0);  // 12 s / 4 K/W
  EXPECT_DOUBLE_EQ(value_of(network, "stator.heat_capacity"), 40.0);  // 80 s / 2 K/W
}

TEST(DatasheetNetwork, drag_torque_is_torque_constant_times_no_load_current) {
  EXPECT_DOUBLE_EQ(drag_torque_Nm(simple_motor().nominal), 0.006);
}

// (3 A)² · 0.5 Ω · (1 + 0.004 · 50) = 5.4 W into the winding, (75 − 45)/4 = 7.5 W on to the stator, 0.006 N m · 500 rad/s = 3 W of drag,
// (45 − 25)/2 = 10 W to ambient. Rates: −2.1 W / 3 J/K and 0.5 W / 40 J/K.
TEST(DatasheetNetwork, rate_computed_by_hand) {
  const Motor motor = simple_motor();
  const thermal::Network network = datasheet_network(motor, nominal_sample(motor));
  std::array<double, 3> temperature_C{75.0, 45.0, 0.0};
  std::array<double, 2> rate{};
  network.rate_K_per_s<double>({3.0, 500.0, 520.0, 25.0}, network.values(), temperature_C, rate);
  EXPECT_NEAR(rate[0], -0.7, 1e-14);
  EXPECT_NEAR(rate[1], 0.0125, 1e-14);
}

// Time constants of a data sheet describe one element while the other is held constant. They are not the eigenvalues of the network.
TEST(DatasheetNetwork, time_constants_are_those_of_one_element) {
  const Motor motor = simple_motor();
  const thermal::Network network = datasheet_network(motor, nominal_sample(motor));
  std::array<double, 3> temperature_C{26.0, 25.0, 0.0};
  std::array<double, 2> rate{};
  network.rate_K_per_s<double>({0.0, 0.0, 0.0, 25.0}, network.values(), temperature_C, rate);
  EXPECT_NEAR(rate[0], -1.0 / 12.0, 1e-15);
  temperature_C = {26.0, 26.0, 0.0};
  network.rate_K_per_s<double>({0.0, 0.0, 0.0, 25.0}, network.values(), temperature_C, rate);
  EXPECT_NEAR(rate[1], -1.0 / 80.0, 1e-15);
}

TEST(DatasheetNetwork, rests_where_the_paper_says) {
  const Motor motor = simple_motor();
  const thermal::Network network = datasheet_network(motor, nominal_sample(motor));
  const std::optional<thermal::SteadyState> rest = thermal::steady_state(network, {4.0, 0.0, 0.0, 30.0});
  // R_TA = 0.5·1.02 = 0.51 Ω; 6 K/W · 0.51 Ω · 16 A² = 48.96 K; over 1 − 0.004/1.02 · 48.96 = 0.808: 60.594… K
  ASSERT_TRUE(rest.has_value());
  EXPECT_NEAR(rest->temperature_C[0], 30.0 + 48.96 / 0.808, 1e-9);
  EXPECT_NEAR(rest->temperature_C[1], 30.0 + 48.96 / 0.808 / 3.0, 1e-9);
}

TEST(DatasheetNetwork, an_effect_of_the_file_is_added) {
  Motor motor = simple_motor();
  base::ParameterValue resistance;
  resistance.value = 5.0;
  motor.effects.push_back({"flange", thermal::find_effect("conduction"), {"winding", "ambient"}, {resistance}});
  const thermal::Network network = datasheet_network(motor, nominal_sample(motor));
  EXPECT_EQ(value_of(network, "flange.thermal_resistance"), 5.0);
  std::array<double, 3> temperature_C{75.0, 75.0, 0.0};
  std::array<double, 2> rate{};
  network.rate_K_per_s<double>({0.0, 0.0, 0.0, 25.0}, network.values(), temperature_C, rate);
  EXPECT_NEAR(rate[0], -10.0 / 3.0, 1e-14);  // 50 K / 5 K/W on 3 J/K
}

TEST(DatasheetNetwork, takes_the_values_of_the_sample) {
  const Motor motor = simple_motor();
  MotorSample sample = nominal_sample(motor);
  sample.values.terminal_resistance_ohm = 0.7;
  sample.values.thermal_time_constant_winding_s = 20.0;
  const thermal::Network network = datasheet_network(motor, sample);
  EXPECT_EQ(value_of(network, "copper_loss.terminal_resistance"), 0.7);
  EXPECT_DOUBLE_EQ(value_of(network, "winding.heat_capacity"), 5.0);
}

}  // namespace
}  // namespace heatsoak::motor
