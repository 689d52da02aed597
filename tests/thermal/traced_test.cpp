// Laws as formulas must give the same heat as the laws, for every effect of the registry and for whole networks.
#include "thermal/traced.h"

#include <gmock/gmock.h>

#include "one_effect.h"

namespace heatsoak::thermal {
namespace {

class EveryLaw : public EveryEffect {};
INSTANTIATE_TEST_SUITE_P(Registry, EveryLaw, every_effect(), name_of_effect);

/// Returns the effect's heat through a formula of all inputs: the operating point and the temperatures.
std::vector<double> heat_by_formula_W(const EffectType& type, const OperatingPoint<double>& at, const std::vector<double>& parameters,
                                      const std::vector<double>& temperature_C) {
  Formula formula;
  std::vector<double> inputs;
  const auto input = [&](double value) {
    inputs.push_back(value);
    return Traced(formula, formula.input(""));
  };
  OperatingPoint<Traced> point;
  convert_point([&](Traced& to, const double& from) { to = std::isfinite(from) ? input(from) : Traced(from); }, point, at);
  std::vector<Traced> temperature;
  for (const double each : temperature_C) {
    temperature.push_back(input(each));
  }
  const std::vector<Traced> constants(parameters.begin(), parameters.end());
  std::vector<int> place(std::max(parameters.size(), temperature_C.size()));
  std::iota(place.begin(), place.end(), 0);
  std::vector<TracedHeat> heat(temperature_C.size());
  HeatBook<Traced> book(heat.data(), place.data(), {"law", std::vector<std::string>(place.size(), "node")});
  type.laws->traced(Situation<Traced>(point, constants.data(), place.data(), temperature.data(), place.data()), book);
  std::vector<int> results;
  for (const TracedHeat& each : heat) {
    results.push_back((each.made_W + each.moved_W).step_in(formula));
  }
  FormulaRun<double> run(formula, results);
  std::vector<double> found(results.size());
  run.run(inputs, found);
  return found;
}

TEST_P(EveryLaw, is_the_same_as_a_formula) {
  Chance chance(77);
  for (int i = 0; i < 300; ++i) {
    const std::vector<double> parameters = random_parameters(chance, type());
    const OperatingPoint<double> at = random_point(chance);
    const std::vector<double> temperature_C = random_temperatures(chance, type());
    const std::vector<double> law = heat_W(type(), at, parameters, temperature_C);
    const std::vector<double> formula = heat_by_formula_W(type(), at, parameters, temperature_C);
    for (std::size_t node = 0; node < law.size(); ++node) {
      EXPECT_NEAR(formula[node], law[node], 1e-9 * std::max(1.0, size_of(law))) << type().nodes[node].role << " in try " << i;
    }
  }
}

TEST(Formula, KeepsNoStepThatItHas) {
  Formula formula;
  const Traced x(formula, formula.input("x"));
  const Traced once = x * x + 1.0;
  const std::size_t steps = formula.steps().size();
  const Traced again = x * x + 1.0;
  EXPECT_EQ(formula.steps().size(), steps);
  EXPECT_EQ(once.step_in(formula), again.step_in(formula));
}

TEST(Formula, WorksOutConstants) {
  Formula formula;
  const Traced x(formula, formula.input("x"));
  EXPECT_TRUE((0.0 * x).is_constant());
  EXPECT_EQ((1.0 * x + 0.0).step_in(formula), x.step_in(formula));
  EXPECT_EQ((Traced(2.0) * 3.0 + power(Traced(2.0), 3.0)).value(), 14.0);
}

TEST(Formula, NeedsOnlyWhatItsResultsDependOn) {
  Formula formula;
  const Traced x(formula, formula.input("x"));
  const Traced y(formula, formula.input("y"));
  const Traced unused = exponential(y);
  const std::vector<int> results{(x * 2.0).step_in(formula)};
  const std::vector<char> needed = formula.needed_for(results);
  EXPECT_FALSE(needed[static_cast<std::size_t>(unused.step_in(formula))]);
  EXPECT_FALSE(needed[static_cast<std::size_t>(y.step_in(formula))]);
  EXPECT_TRUE(needed[static_cast<std::size_t>(x.step_in(formula))]);
}

TEST(Formula, LawsNameTheirQuantities) {
  Formula formula;
  const Traced winding_C(formula, formula.input("winding_C"));
  const Traced stator_C(formula, formula.input("stator_C"));
  const Traced conductance_W_per_K = named("air_gap_conductance_W_per_K", winding_C * 0.1);
  EXPECT_EQ(formula.name_of(conductance_W_per_K.step_in(formula)), "air_gap_conductance_W_per_K");
  EXPECT_EQ(formula.name_of(named("another_W_per_K", conductance_W_per_K).step_in(formula)), "air_gap_conductance_W_per_K");
  EXPECT_EQ(formula.name_of(difference_K(winding_C, stator_C).step_in(formula)), "winding_above_stator_K");
  EXPECT_EQ(formula.name_of(difference_K(winding_C * 2.0, stator_C).step_in(formula)), "") << "no temperature of a node";
  EXPECT_EQ(formula.name_of(named("room_C", winding_C).step_in(formula)), "") << "an input has its name";
  EXPECT_EQ(named("ratio", Traced(2.0)).value(), 2.0);
}

// Hand calculation: copper 3² · 0.5 Ω · (1 + 0.004·(75 − 25)) = 5.4 W into the winding; 5 K / 2.5 K/W = 2 W leave it.
TEST(Formula, NetworkSeparatesGeneratedFromTransferredHeat) {
  Network network;
  network.add_node("winding", 4.0);
  network.add_node("stator", 40.0);
  const std::vector<std::string> winding{"winding"};
  const std::vector<std::string> both{"winding", "stator"};
  network.add_effect("copper", *find_effect("copper_loss"), winding, std::vector<double>{0.5, 0.004});
  network.add_effect("contact", *find_effect("conduction"), both, std::vector<double>{2.5});
  network.limit_current_by("copper");
  OperatingPoint<Traced> at;
  at.current_rms_A = 3.0;
  const std::vector<Traced> temperature_C{75.0, 70.0, 25.0};
  std::vector<TracedHeat> heat(3);
  network.trace(at, temperature_C, heat);
  EXPECT_NEAR(heat[0].made_W.value(), 5.4, 1e-12);
  EXPECT_NEAR(heat[0].moved_W.value(), -2.0, 1e-12);
  EXPECT_NEAR(heat[1].made_W.value(), 0.0, 1e-12);
  EXPECT_NEAR(heat[1].moved_W.value(), 2.0, 1e-12);
}

}  // namespace
}  // namespace heatsoak::thermal
