// Requirements of every effect, checked for all entries of the registry. A new file in src/thermal/effects is tested automatically.
#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <regex>
#include <set>

#include "one_effect.h"

namespace heatsoak::thermal {
namespace {

using testing::IsEmpty;
using testing::Not;

INSTANTIATE_TEST_SUITE_P(Registry, EveryEffect, every_effect(), name_of_effect);

TEST_P(EveryEffect, worked_example) {
  const WorkedExample& example = type().example;
  ASSERT_EQ(example.parameters.size(), type().parameters.size());
  ASSERT_EQ(example.temperature_C.size(), type().nodes.size());
  ASSERT_EQ(example.expected_heat_W.size(), type().nodes.size());
  const std::vector<double> heat = heat_W(type(), example.at, example.parameters, example.temperature_C);
  for (std::size_t node = 0; node < heat.size(); ++node) {
    EXPECT_NEAR(heat[node], example.expected_heat_W[node], 1e-9 * std::max(1.0, std::abs(example.expected_heat_W[node])))
        << type().nodes[node].role;
  }
  EXPECT_GT(size_of(heat), 0.0) << "an example of no heat shows nothing";
  for (std::size_t i = 0; i < example.parameters.size(); ++i) {
    EXPECT_TRUE(type().parameters[i].range.contains(example.parameters[i])) << type().parameters[i].key;
  }
}

TEST_P(EveryEffect, is_reported_in_words) {
  for (const std::string_view text : {type().summary, type().equation, type().reference, type().typical, type().confounded_with}) {
    EXPECT_THAT(text, Not(IsEmpty()));
  }
  for (const base::ParameterSpec& spec : type().parameters) {
    EXPECT_THAT(spec.meaning, Not(IsEmpty())) << spec.key;
  }
  // Words spelt like an effect's name must be one.
  const std::string prose(type().confounded_with);
  const std::regex name("[a-z]+(_[a-z]+)+");
  for (std::sregex_iterator found(prose.begin(), prose.end(), name), end; found != end; ++found) {
    EXPECT_NE(find_effect(found->str()), nullptr) << found->str();
  }
}

TEST_P(EveryEffect, lanes_have_the_bits_of_the_law_for_one) {
  Chance chance(800);
  for (int i = 0; i < 200; ++i) {
    std::array<std::vector<double>, base::kLanes> parameters;
    std::array<std::vector<double>, base::kLanes> temperature_C;
    std::array<OperatingPoint<double>, base::kLanes> at;
    std::vector<Lanes> lane_parameters(type().parameters.size());
    std::vector<Lanes> lane_temperature_C(type().nodes.size());
    OperatingPoint<Lanes> lane_at;
    for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
      const auto l = static_cast<Eigen::Index>(lane);
      parameters[lane] = random_parameters(chance, type());
      temperature_C[lane] = random_temperatures(chance, type());
      at[lane] = random_point(chance);
      at[lane].known = at[0].known;  // equal for all samples
      for (std::size_t p = 0; p < lane_parameters.size(); ++p) {
        if (!type().parameters[p].choices.empty()) {
          parameters[lane][p] = parameters[0][p];  // choices are equal for all samples
        }
        lane_parameters[p][l] = parameters[lane][p];
      }
      for (std::size_t node = 0; node < lane_temperature_C.size(); ++node) {
        lane_temperature_C[node][l] = temperature_C[lane][node];
      }
      convert_point([l](Lanes& to, const double& from) { to[l] = from; }, lane_at, at[lane]);
    }
    const std::vector<Lanes> side_by_side = heat_W(type(), lane_at, lane_parameters, lane_temperature_C);
    for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
      const std::vector<double> alone = heat_W(type(), at[lane], parameters[lane], temperature_C[lane]);
      for (std::size_t node = 0; node < alone.size(); ++node) {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(alone[node]),
                  std::bit_cast<std::uint64_t>(side_by_side[node][static_cast<Eigen::Index>(lane)]))
            << alone[node] << " alone, " << side_by_side[node][static_cast<Eigen::Index>(lane)] << " in lane " << lane;
      }
    }
  }
}

/// Tests every corner of the permitted ranges, one parameter at each end.
TEST_P(EveryEffect, heat_is_finite_at_the_ends_of_every_range) {
  const std::size_t parameters = type().parameters.size();
  for (std::size_t corner = 0; corner < (std::size_t{1} << parameters); ++corner) {
    std::vector<double> values;
    for (std::size_t p = 0; p < parameters; ++p) {
      const base::Range& range = type().parameters[p].range;
      values.push_back((corner >> p & 1U) != 0U ? high_of(range) : low_of(range));
    }
    for (const double size : {0.0, 1.0, 1e4}) {
      OperatingPoint<double> at;
      for_each_quantity([size](double& quantity) { quantity = size; }, at);
      at.known = ~QuantitySet{0};
      for (const double hot_C : {-60.0, 25.0, kDestroyed_C}) {
        for (const double cold_C : {-60.0, 25.0, kDestroyed_C}) {
          std::vector<double> temperature_C(type().nodes.size(), cold_C);
          temperature_C[0] = hot_C;
          for (const double heat : heat_W(type(), at, values, temperature_C)) {
            EXPECT_TRUE(std::isfinite(heat)) << "corner " << corner << " size " << size << " from " << hot_C << " to " << cold_C << " °C";
          }
        }
      }
    }
  }
}

TEST_P(EveryEffect, heat_is_finite_wherever_a_range_and_a_machine_lead) {
  Chance chance(805);
  for (int i = 0; i < 3000; ++i) {
    for (const double heat : heat_W(type(), random_point(chance), random_parameters(chance, type()), random_temperatures(chance, type()))) {
      EXPECT_TRUE(std::isfinite(heat));
    }
  }
}

/// A law without a signal in its needs must give the same bits when that signal is NaN. The ambient temperature comes from its nodes, and
/// the headroom from the network.
TEST_P(EveryEffect, looks_at_no_signal_but_those_it_needs) {
  Chance chance(806);
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto needs = [](Signal signal) { return std::ranges::find(type().needs, signal) != type().needs.end(); };
  for (int i = 0; i < 200; ++i) {
    const std::vector<double> parameters = random_parameters(chance, type());
    const std::vector<double> temperature_C = random_temperatures(chance, type());
    const OperatingPoint<double> at = random_point(chance);
    OperatingPoint<double> blind = at;
    blind.ambient_C = blind.resistive_headroom_V = none;
    if (!needs(Signal::current)) {
      blind.copper_loss_W = none;
    }
    for (const OperatingQuantity<double>& row : kQuantities<double>) {
      if (row.signal && !needs(*row.signal)) {
        blind.*row.value = none;
      }
    }
    const std::vector<double> seeing_W = heat_W(type(), at, parameters, temperature_C);
    const std::vector<double> blind_W = heat_W(type(), blind, parameters, temperature_C);
    for (std::size_t node = 0; node < seeing_W.size(); ++node) {
      EXPECT_EQ(seeing_W[node], blind_W[node]);
    }
  }
}

/// Adds the copper loss of which the effect moves a share; the two together obey the laws of thermodynamics.
void add_moved_loss(const EffectType& type, const OperatingPoint<double>& at, std::vector<double>& heat_W) {
  if (type.moves_copper_loss) {
    heat_W.front() += at.copper_loss_W;
  }
}

/// First and second law: no heat disappears, and entropy is not destroyed: Σ P ≥ 0 and Σ P/T ≥ 0, T in kelvin.
TEST_P(EveryEffect, neither_destroys_heat_nor_entropy) {
  Chance chance(801);
  for (int i = 0; i < 1000; ++i) {
    const std::vector<double> temperature_C = random_temperatures(chance, type());
    OperatingPoint<double> at = random_point(chance);
    settle_neighbour(at, type(), temperature_C);
    std::vector<double> heat = heat_W(type(), at, random_parameters(chance, type()), temperature_C);
    add_moved_loss(type(), at, heat);
    EXPECT_GE(sum(heat), -1e-12 * size_of(heat));
    double entropy_W_per_K = 0.0;
    for (std::size_t node = 0; node < heat.size(); ++node) {
      entropy_W_per_K += heat[node] / (temperature_C[node] + 273.15);
    }
    EXPECT_GE(entropy_W_per_K, -1e-12 * size_of(heat) / 200.0);
  }
}

/// An effect that produces no heat in any state only transfers it from hot to cold: Σ P·T ≤ 0.
TEST_P(EveryEffect, what_only_moves_heat_moves_it_downhill) {
  Chance chance(802);
  for (int i = 0; i < 1000; ++i) {
    const std::vector<double> temperature_C = random_temperatures(chance, type());
    OperatingPoint<double> at = random_point(chance);
    at.copper_loss_W = at.current_rms_A = 0.0;
    settle_neighbour(at, type(), temperature_C);
    const std::vector<double> heat = heat_W(type(), at, random_parameters(chance, type()), temperature_C);
    if (std::ranges::all_of(heat, [](double each_W) { return each_W >= 0.0; })) {
      continue;  // a source, or no effect
    }
    EXPECT_NEAR(sum(heat), 0.0, 1e-12 * size_of(heat));
    double uphill = 0.0;
    for (std::size_t node = 0; node < heat.size(); ++node) {
      uphill += heat[node] * temperature_C[node];
    }
    EXPECT_LE(uphill, 1e-9 * size_of(heat) * 400.0);
  }
}

TEST_P(EveryEffect, at_one_temperature_no_heat_is_moved) {
  Chance chance(803);
  for (int i = 0; i < 100; ++i) {
    OperatingPoint<double> at = random_point(chance);
    at.neighbour_C = at.ambient_C;
    std::vector<double> heat =
        heat_W(type(), at, random_parameters(chance, type()), std::vector<double>(type().nodes.size(), at.ambient_C));
    add_moved_loss(type(), at, heat);
    EXPECT_THAT(heat, testing::Each(testing::Ge(0.0)));
  }
}

/// Two evaluations of the same network: the rate equals the sum of the balance divided by the capacity.
TEST_P(EveryEffect, balance_and_rate_of_a_network_agree) {
  Chance chance(804);
  Network network;
  add_alone(network, "first", type(), chance);
  add_alone(network, "second", type(), chance);
  const OperatingPoint<double> at = random_point(chance);
  const auto states = static_cast<std::size_t>(network.state_count());
  std::vector<double> temperature_C;
  for (std::size_t node = 0; node < states; ++node) {
    temperature_C.push_back(chance.between(-60.0, 400.0));
  }
  std::vector<double> balance(2 * (states + 1));
  const std::vector<double> values = network.values();
  network.balance_W(at, values, temperature_C, balance);
  temperature_C.push_back(-999.0);  // ambient, will be overwritten
  std::vector<double> rate(states);
  network.rate_K_per_s<double>(at, values, temperature_C, rate);
  EXPECT_EQ(temperature_C.back(), at.ambient_C);
  for (std::size_t node = 0; node < states; ++node) {
    const double capacity_J_per_K = values[static_cast<std::size_t>(network.capacity_index(static_cast<int>(node)))];
    EXPECT_NEAR(rate[node] * capacity_J_per_K, balance[node] + balance[states + 1 + node], 1e-9 * size_of(balance));
  }
}

// --- candidate effects --------------------------------------------------------------------------------------

/// Sizes and shapes of candidate effects.
class EveryCandidate : public EveryEffect {
 protected:
  void SetUp() override {
    if (!type().candidacy.size_parameter) {
      GTEST_SKIP() << "never a candidate";
    }
  }
  static std::size_t size_place() { return static_cast<std::size_t>(*type().candidacy.size_parameter); }
};
INSTANTIATE_TEST_SUITE_P(Registry, EveryCandidate, every_effect(), name_of_effect);

TEST_P(EveryCandidate, is_described_at_its_typical_size) {
  EXPECT_THAT(type().candidacy.family, Not(IsEmpty()));
  EXPECT_THAT(type().candidacy.experiment, Not(IsEmpty()));
  ASSERT_THAT(type().candidacy.variants, Not(IsEmpty()));
  std::set<std::vector<double>> shapes;
  for (const std::vector<double>& variant : type().candidacy.variants) {
    ASSERT_EQ(variant.size(), type().parameters.size());
    for (std::size_t p = 0; p < variant.size(); ++p) {
      EXPECT_TRUE(type().parameters[p].range.contains(variant[p])) << type().parameters[p].key;
    }
    EXPECT_GT(variant[size_place()], 0.0);
    std::vector<double> shape = variant;
    shape[size_place()] = 0.0;
    EXPECT_TRUE(shapes.insert(shape).second) << "two variants of one shape";
  }
  EXPECT_TRUE(type().parameters[size_place()].range.contains(0.0));
}

TEST_P(EveryCandidate, of_size_zero_is_absent) {
  Chance chance(807);
  for (int i = 0; i < 200; ++i) {
    std::vector<double> parameters = random_parameters(chance, type());
    parameters[size_place()] = 0.0;
    EXPECT_EQ(size_of(heat_W(type(), random_point(chance), parameters, random_temperatures(chance, type()))), 0.0);
  }
}

TEST_P(EveryCandidate, books_heat_in_proportion_to_its_size) {
  Chance chance(808);
  for (int i = 0; i < 200; ++i) {
    std::vector<double> parameters = random_parameters(chance, type());
    const OperatingPoint<double> at = random_point(chance);
    const std::vector<double> temperature_C = random_temperatures(chance, type());
    const std::vector<double> whole_W = heat_W(type(), at, parameters, temperature_C);
    parameters[size_place()] *= 0.25;
    const std::vector<double> quarter_W = heat_W(type(), at, parameters, temperature_C);
    for (std::size_t node = 0; node < whole_W.size(); ++node) {
      EXPECT_NEAR(quarter_W[node], 0.25 * whole_W[node], 1e-12 * size_of(whole_W));
    }
  }
}

/// At typical size and in a typical state the heat must be plausible for a motor of about 50 W.
TEST_P(EveryCandidate, of_typical_size_books_watts) {
  for (const std::vector<double>& variant : type().candidacy.variants) {
    OperatingPoint<double> at;
    for (std::size_t row = 0; row < kQuantityCount; ++row) {
      if (kQuantities<double>[row].signal && !kQuantities<double>[row].column.empty()) {
        set_quantity(at, row, kQuantities<double>[row].usual.value());
      }
    }
    at.current_rms_A = 5.0;
    at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = 500.0;
    at.shaft_power_W = 50.0;
    at.input_power_W = 65.0;
    at.bus_V = 24.0;
    at.modulation_ratio = 0.6;
    at.vehicle_speed_m_per_s = 2.0;
    at.neighbour_C = 60.0;
    at.copper_loss_W = 10.0;
    std::vector<double> temperature_C;
    for (const NodeRole& role : type().nodes) {
      temperature_C.push_back(role.own_capacity                ? 35.0
                              : role.default_node == "winding" ? 90.0
                              : role.default_node == "stator"  ? 70.0
                                                               : 25.0);
    }
    double most_W = 0.0;
    constexpr double kShaftAndMore_W = 70.0;
    // Some effects act only in certain states: braking, stall, high current, an old contact.
    for (const int state : {0, 1, 2, 3}) {
      OperatingPoint<double> now = at;
      now.shaft_power_W *= state == 1 ? -1.0 : 1.0;
      now.speed_mean_rad_per_s *= state == 2 ? 0.0 : 1.0;
      now.current_rms_A *= state == 2 ? 4.0 : 1.0;
      now.copper_loss_W *= state == 2 ? 16.0 : 1.0;
      now.age_h = state == 3 ? 50.0 : 0.0;
      for (const double heat : heat_W(type(), now, variant, temperature_C)) {
        most_W = std::max(most_W, std::abs(heat));
        EXPECT_LE(std::abs(heat), kShaftAndMore_W + now.copper_loss_W);
      }
    }
    EXPECT_GE(most_W, 0.1);
  }
}

}  // namespace
}  // namespace heatsoak::thermal
