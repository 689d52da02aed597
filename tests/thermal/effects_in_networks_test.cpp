// Effects in networks: passivity of heat transfer, additional nodes, curves, neighbours.
#include <algorithm>

#include "one_effect.h"

namespace heatsoak::thermal {
namespace {

OperatingPoint<double> without_sources(OperatingPoint<double> at) {
  at.current_rms_A = at.shaft_power_W = at.input_power_W = at.bus_V = at.copper_loss_W = 0.0;
  return at;
}

/// Returns effects that produce no heat without input power, at any speed.
std::vector<const EffectType*> movers() {
  std::vector<const EffectType*> found;
  for (const EffectType& type : all_effects()) {
    Chance chance(830);
    bool moves = false;
    bool makes = false;
    for (int i = 0; i < 50; ++i) {
      const std::vector<double> heat =
          heat_W(type, without_sources(random_point(chance)), random_parameters(chance, type), random_temperatures(chance, type));
      moves = moves || size_of(heat) > 0.0;
      makes = makes || std::abs(sum(heat)) > 1e-9 * size_of(heat);
    }
    if (moves && !makes) {
      found.push_back(&type);
    }
  }
  return found;
}

/// V = ½ΣC·(T − T_ambient)² must never rise, for random networks with every effect that only transfers heat.
TEST(Passivity, energy_functional_never_rises_with_the_sources_off) {
  const std::vector<const EffectType*> all = movers();
  for (const char* name : {"conduction", "natural_convection", "radiation", "third_node", "contact_ageing", "enclosure_warm_up"}) {
    EXPECT_TRUE(std::ranges::any_of(all, [&](const EffectType* type) { return type->name == name; })) << name;
  }
  Chance chance(831);
  for (int i = 0; i < 300; ++i) {
    Network network;
    for (const EffectType* type : all) {
      add_alone(network, std::string(type->name), *type, chance);
    }
    OperatingPoint<double> at = without_sources(random_point(chance));
    at.neighbour_C = at.ambient_C;
    std::vector<double> temperature_C;
    for (int node = 0; node < network.node_count(); ++node) {
      temperature_C.push_back(chance.between(-60.0, 400.0));
    }
    const std::vector<double> values = network.values();
    std::vector<double> rate(static_cast<std::size_t>(network.state_count()));
    network.rate_K_per_s<double>(at, values, temperature_C, rate);
    double slope = 0.0;
    double scale = 0.0;
    for (std::size_t node = 0; node < rate.size(); ++node) {
      const double capacity_J_per_K = values[static_cast<std::size_t>(network.capacity_index(static_cast<int>(node)))];
      slope += capacity_J_per_K * (temperature_C[node] - at.ambient_C) * rate[node];
      scale += std::abs(capacity_J_per_K * (temperature_C[node] - at.ambient_C) * rate[node]);
    }
    EXPECT_LE(slope, 1e-12 * scale);
  }
}

// --- additional nodes -------------------------------------------------------------------------------------

/// Only stator and body exchange heat: their difference decays with G·(1/C_1 + 1/C_2), and the energy is constant.
TEST(OwnNode, two_bodies_meet_as_computed_by_hand) {
  constexpr double kStator_J_per_K = 80.0;
  constexpr double kBody_J_per_K = 120.0;
  constexpr double kConductance_W_per_K = 0.25;
  Network network;
  network.add_node("stator", kStator_J_per_K);
  const std::vector<std::string> nodes{"stator", "chassis", "ambient"};
  network.add_effect("chassis", *find_effect("third_node"), nodes, std::vector<double>{kConductance_W_per_K, 0.0, kBody_J_per_K});
  ASSERT_EQ(network.state_count(), 2);
  EXPECT_EQ(network.node_name(1), "chassis");
  EXPECT_EQ(network.find_node("ambient"), 2);
  TransientOptions options;
  options.start_C = {90.0, 30.0};
  options.tolerances = {1e-12, 1e-10};
  const TransientResult result = run_transient(network, network.values(), std::vector<Interval>{{300.0, {}}}, options);
  const double decay = std::exp(-300.0 * kConductance_W_per_K * (1.0 / kStator_J_per_K + 1.0 / kBody_J_per_K));
  const double mean_C = (kStator_J_per_K * 90.0 + kBody_J_per_K * 30.0) / (kStator_J_per_K + kBody_J_per_K);
  EXPECT_NEAR(result.end_C[0] - result.end_C[1], 60.0 * decay, 1e-6);
  EXPECT_NEAR((kStator_J_per_K * result.end_C[0] + kBody_J_per_K * result.end_C[1]) / (kStator_J_per_K + kBody_J_per_K), mean_C, 1e-6);
}

/// At steady state the chain stator → body → ambient is two resistances in series.
TEST(OwnNode, leads_heat_through_to_ambient) {
  Network network;
  network.add_node("stator", 80.0);
  network.add_effect("chassis", *find_effect("third_node"), std::vector<std::string>{"stator", "chassis", "ambient"},
                     std::vector<double>{0.2, 0.5, 120.0});
  network.add_effect("lamp", *find_effect("constant_heat"), std::vector<std::string>{"stator"}, std::vector<double>{2.0});
  TransientOptions options;
  options.tolerances = {1e-10, 1e-8};
  const TransientResult result = run_transient(network, network.values(), std::vector<Interval>{{1e5, {}}}, options);
  EXPECT_NEAR(result.end_C[1], 25.0 + 2.0 / 0.1, 1e-4);
  EXPECT_NEAR(result.end_C[0], 25.0 + 2.0 / 0.1 + 2.0 / 0.2, 1e-4);
}

TEST(OwnNode, of_one_name_is_there_once) {
  Network network;
  network.add_node("stator", 80.0);
  EXPECT_THROW(network.add_effect("stator", *find_effect("third_node"), std::vector<std::string>{"stator", "stator", "ambient"},
                                  std::vector<double>{0.2, 0.5, 120.0}),
               std::logic_error);
}

// --- neighbours ---------------------------------------------------------------------------------------------

TEST(NeighbourCoupling, warms_from_a_hotter_one_and_does_nothing_where_it_is_unknown) {
  const EffectType& type = *find_effect("neighbour_coupling");
  OperatingPoint<double> at;
  at.neighbour_C = 90.0;
  EXPECT_EQ(size_of(heat_W<double>(type, at, {0.1}, {40.0, 25.0})), 0.0);
  at.known = kNeighbour;
  EXPECT_NEAR(heat_W<double>(type, at, {0.1}, {40.0, 25.0})[0], 5.0, 1e-12);
  EXPECT_NEAR(heat_W<double>(type, at, {0.1}, {95.0, 25.0})[0], -0.5, 1e-12);
}

// --- curves -------------------------------------------------------------------------------------------------

class Tabulated : public testing::Test {
 protected:
  enum Place { driver, form, first_knot, last_knot, value };
  static constexpr std::array<double, 7> kCurve{1.0, 4.0, 2.0, 0.0, 3.0, 8.0, 5.0};

  static const EffectType& type() { return *find_effect("tabulated"); }
  static std::size_t choice(Place place, std::string_view name) {
    const std::span<const base::Choice> choices = type().parameters[place].choices;
    return static_cast<std::size_t>(std::ranges::find(choices, name, &base::Choice::name) - choices.begin());
  }
  static std::vector<double> parameters(std::string_view driver_name, std::string_view form_name, double first, double last) {
    std::vector<double> all{static_cast<double>(choice(driver, driver_name)), static_cast<double>(choice(form, form_name)), first, last};
    all.insert(all.end(), kCurve.begin(), kCurve.end());
    return all;
  }
  static std::vector<double> heat(const std::vector<double>& parameters, const OperatingPoint<double>& at,
                                  const std::vector<double>& temperature_C = {60.0, 40.0, 60.0, 40.0}) {
    return heat_W(type(), at, parameters, temperature_C);
  }
  static OperatingPoint<double> at_speed(double speed_rad_per_s) {
    OperatingPoint<double> at;
    at.speed_mean_rad_per_s = speed_rad_per_s;
    return at;
  }
};

TEST_F(Tabulated, goes_through_its_knots_is_straight_between_and_constant_outside) {
  const std::vector<double> curve = parameters("speed", "heat", 100.0, 700.0);
  for (std::size_t knot = 0; knot < kCurve.size(); ++knot) {
    const double speed_rad_per_s = 100.0 + 100.0 * static_cast<double>(knot);
    EXPECT_NEAR(heat(curve, at_speed(speed_rad_per_s))[0], kCurve[knot], 1e-12);
    if (knot + 1 < kCurve.size()) {
      EXPECT_NEAR(heat(curve, at_speed(speed_rad_per_s + 30.0))[0], 0.7 * kCurve[knot] + 0.3 * kCurve[knot + 1], 1e-12);
    }
  }
  EXPECT_EQ(heat(curve, at_speed(0.0))[0], kCurve.front());
  EXPECT_EQ(heat(curve, at_speed(1e5))[0], kCurve.back());
}

TEST_F(Tabulated, is_heat_a_share_of_the_copper_loss_or_a_conductance) {
  OperatingPoint<double> at = at_speed(200.0);
  at.copper_loss_W = 7.0;
  EXPECT_NEAR(heat(parameters("speed", "heat", 100.0, 700.0), at)[0], 4.0, 1e-12);
  EXPECT_NEAR(heat(parameters("speed", "per_copper_loss", 100.0, 700.0), at)[0], 4.0 * 7.0, 1e-12);
  const std::vector<double> moved_W = heat(parameters("speed", "per_difference", 100.0, 700.0), at);
  EXPECT_NEAR(moved_W[0], -4.0 * 20.0, 1e-12);
  EXPECT_NEAR(moved_W[1], 4.0 * 20.0, 1e-12);
  at.current_rms_A = 3.0;
  EXPECT_NEAR(heat(parameters("speed", "per_current", 100.0, 700.0), at)[0], 4.0 * 3.0, 1e-12);
  at.bus_V = 200.0;
  EXPECT_NEAR(heat(parameters("bus_voltage", "per_speed", 100.0, 700.0), at)[0], 4.0 * 200.0, 1e-12);
}

/// The signals in needs() must be exactly those that the curve's heat depends on.
TEST_F(Tabulated, needs_the_signals_that_it_depends_on) {
  using At = OperatingPoint<double>;
  At before;
  before.copper_loss_W = 2.2;
  for (std::size_t row = 0; row < kQuantityCount; ++row) {
    if (kQuantities<double>[row].signal) {
      set_quantity(before, row, kQuantities<double>[row].unit == "degC" ? 62.2 : 2.2);
    }
  }
  for (const base::Choice& signal : type().parameters[driver].choices) {
    for (const base::Choice& shape : type().parameters[form].choices) {
      std::vector<double> curve = parameters(signal.name, shape.name, -50.0, 60.0);
      for (std::size_t knot = 0; knot < kCurve.size(); ++knot) {
        curve[value + knot] = 1.0 + static_cast<double>(knot);
      }
      const std::vector<Signal> needed = type().needed_with(curve);
      for (std::size_t one = 0; one < kSignalCount; ++one) {
        At at = before;
        at.copper_loss_W += static_cast<Signal>(one) == Signal::current ? 6.8 : 0.0;
        for (const OperatingQuantity<double>& row : kQuantities<double>) {
          at.*row.value += row.signal == static_cast<Signal>(one) ? 2.5 : 0.0;
        }
        const bool is_needed = std::ranges::find(needed, static_cast<Signal>(one)) != needed.end();
        EXPECT_EQ(heat(curve, at) != heat(curve, before), is_needed) << signal.name << " " << shape.name << " signal " << one;
      }
    }
  }
}

TEST_F(Tabulated, looks_at_the_signal_that_was_chosen) {
  OperatingPoint<double> at;
  std::vector<std::pair<std::string_view, double>> expected;
  for (std::size_t place = 0; place < base::kCurveSignalCount; ++place) {
    const OperatingQuantity<double>& row = kQuantities<double>[base::kCurveSignals[place]];
    const double size = 0.5 + static_cast<double>(place);
    at.*row.value = row.name == "velocity" || row.name == "shaft_power" ? -size : size;
    expected.emplace_back(row.name, at.*row.value);
  }
  at.speed_rms_rad_per_s = 3.0;
  at.neighbour_C = 46.5;
  at.known = kNeighbour | column_bit(0) | column_bit(1) | column_bit(2);
  at.first_column = 7.5, at.second_column = 8.5, at.third_column = 9.5;
  // A line from −10 to 50 returns the regressor itself: value = regressor + 10.
  const std::vector<double> temperature_C{60.0, 40.0, 43.0, 42.0};
  expected.insert(expected.end(), {{"current_speed_squared", at.current_rms_A * 9.0},
                                   {"temperature", 43.0},
                                   {"temperature_difference", 1.0},
                                   {"neighbour_difference", 3.5},
                                   {"column", 7.5},
                                   {"column_2", 8.5},
                                   {"column_3", 9.5}});
  EXPECT_EQ(expected.size(), type().parameters[driver].choices.size());
  for (const auto& [name, reading] : expected) {
    std::vector<double> line = parameters(name, "heat", -10.0, 50.0);
    for (std::size_t knot = 0; knot < kCurve.size(); ++knot) {
      line[value + knot] = 10.0 * static_cast<double>(knot);
    }
    EXPECT_NEAR(heat(line, at, temperature_C)[0], reading + 10.0, 1e-12) << name;
  }
}

TEST_F(Tabulated, is_at_its_hottest_where_a_column_is_not_known) {
  OperatingPoint<double> at;
  at.copper_loss_W = 7.0;
  EXPECT_NEAR(heat(parameters("column", "heat", 0.0, 6.0), at)[0], 8.0, 1e-12);
  EXPECT_NEAR(heat(parameters("column", "per_copper_loss", 0.0, 6.0), at)[0], 8.0 * 7.0, 1e-12);
  EXPECT_EQ(heat(parameters("column", "per_difference", 0.0, 6.0), at)[0], 0.0);
  at.first_column = 2.0;
  at.known = column_bit(0);
  EXPECT_NEAR(heat(parameters("column", "per_difference", 0.0, 6.0), at)[0], -2.0 * 20.0, 1e-12);
}

TEST_F(Tabulated, takes_the_units_of_what_was_chosen) {
  const std::vector<double> curve = parameters("temperature", "per_difference", 40.0, 100.0);
  EXPECT_EQ(base::unit_of(type().parameters, first_knot, curve), "degC");
  EXPECT_EQ(base::unit_of(type().parameters, value, curve), "W/K");
  Network network;
  network.add_node("stator", 80.0);
  network.add_effect("curve", type(), std::vector<std::string>{"stator", "ambient", "stator", "ambient"}, curve);
  const auto parameter = [&](std::string_view name) { return *std::ranges::find(network.parameters(), name, &NetworkParameter::name); };
  EXPECT_EQ(parameter("curve.value_3").unit, "W/K");
  EXPECT_EQ(parameter("curve.last_knot").unit, "degC");
  EXPECT_FALSE(parameter("curve.driver").choices.empty());
  EXPECT_TRUE(parameter("curve.value_3").choices.empty());
}

}  // namespace
}  // namespace heatsoak::thermal
