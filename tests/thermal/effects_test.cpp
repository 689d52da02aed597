// What every effect owes, driven by the registry: a new file in src/thermal/effects is tested by being there.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>

#include "two_node.h"

namespace heatsoak {
namespace {

/// One effect alone, with its parameters and nodes in declared order.
template <class S>
std::vector<S> heat_W(const EffectType& type, const OperatingPoint<S>& at, const std::vector<S>& parameters,
                      const std::vector<S>& temperature_C) {
  std::vector<int> parameter_index(parameters.size());
  std::iota(parameter_index.begin(), parameter_index.end(), 0);
  std::vector<int> node_index(temperature_C.size());
  std::iota(node_index.begin(), node_index.end(), 0);
  std::vector<S> heat;
  if constexpr (std::is_same_v<S, double>) {
    heat.assign(temperature_C.size(), 0.0);
  } else {
    heat.assign(temperature_C.size(), S::Zero());
  }
  const Situation<S> situation(at, parameters.data(), parameter_index.data(), temperature_C.data(), node_index.data());
  HeatBook<S> book(heat.data(), node_index.data());
  if constexpr (std::is_same_v<S, double>) {
    type.laws.one(situation, book);
  } else {
    type.laws.lanes(situation, book);
  }
  return heat;
}

double low_of(const Range& range) { return std::isfinite(range.low) ? range.low + (range.low_is_open ? 1e-6 : 0.0) : -1e6; }
double high_of(const Range& range) { return std::isfinite(range.high) ? range.high - (range.high_is_open ? 1e-6 : 0.0) : 1e6; }

double random_in(Chance& chance, const Range& range) {
  const double low = low_of(range);
  const double high = high_of(range);
  return low > 0.0 && high / low > 100.0 ? chance.by_ratio(low, high) : chance.between(low, high);
}

std::vector<double> random_parameters(Chance& chance, const EffectType& type) {
  std::vector<double> parameters;
  for (const ParameterSpec& spec : type.parameters) {
    parameters.push_back(random_in(chance, spec.range));
  }
  return parameters;
}
OperatingPoint<double> random_point(Chance& chance) {
  const double mean = chance.between(0.0, 2000.0);
  return {chance.between(0.0, 100.0), mean, mean * chance.between(1.0, 2.0), chance.between(-40.0, 60.0)};
}
std::vector<double> random_temperatures(Chance& chance, const EffectType& type) {
  std::vector<double> temperature_C;
  for (std::size_t i = 0; i < type.nodes.size(); ++i) {
    temperature_C.push_back(chance.between(-60.0, 400.0));
  }
  return temperature_C;
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }
double size_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0, [](double all, double each) { return all + std::abs(each); });
}

class EveryEffect : public testing::TestWithParam<std::size_t> {
 protected:
  static const EffectType& type() { return all_effects()[GetParam()]; }
};
INSTANTIATE_TEST_SUITE_P(Registry, EveryEffect, testing::Range(std::size_t{0}, all_effects().size()),
                         [](const auto& effect) { return std::string(all_effects()[effect.param].name); });

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

TEST_P(EveryEffect, lanes_have_the_bits_of_the_law_for_one) {
  Chance chance(800);
  for (int i = 0; i < 200; ++i) {
    std::array<std::vector<double>, kLanes> parameters;
    std::array<std::vector<double>, kLanes> temperature_C;
    std::array<OperatingPoint<double>, kLanes> at;
    std::vector<Lanes> lane_parameters(type().parameters.size());
    std::vector<Lanes> lane_temperature_C(type().nodes.size());
    OperatingPoint<Lanes> lane_at;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const auto l = static_cast<Eigen::Index>(lane);
      parameters[lane] = random_parameters(chance, type());
      temperature_C[lane] = random_temperatures(chance, type());
      at[lane] = random_point(chance);
      for (std::size_t p = 0; p < lane_parameters.size(); ++p) {
        lane_parameters[p][l] = parameters[lane][p];
      }
      for (std::size_t node = 0; node < lane_temperature_C.size(); ++node) {
        lane_temperature_C[node][l] = temperature_C[lane][node];
      }
      lane_at.current_rms_A[l] = at[lane].current_rms_A;
      lane_at.speed_mean_rad_per_s[l] = at[lane].speed_mean_rad_per_s;
      lane_at.speed_rms_rad_per_s[l] = at[lane].speed_rms_rad_per_s;
      lane_at.ambient_C[l] = at[lane].ambient_C;
    }
    const std::vector<Lanes> side_by_side = heat_W(type(), lane_at, lane_parameters, lane_temperature_C);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::vector<double> alone = heat_W(type(), at[lane], parameters[lane], temperature_C[lane]);
      for (std::size_t node = 0; node < alone.size(); ++node) {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(alone[node]),
                  std::bit_cast<std::uint64_t>(side_by_side[node][static_cast<Eigen::Index>(lane)]))
            << alone[node] << " alone, " << side_by_side[node][static_cast<Eigen::Index>(lane)] << " in lane " << lane;
      }
    }
  }
}

/// Every corner of what is allowed, one parameter at each end.
TEST_P(EveryEffect, heat_is_finite_at_the_ends_of_every_range) {
  const std::size_t parameters = type().parameters.size();
  for (std::size_t corner = 0; corner < (std::size_t{1} << parameters); ++corner) {
    std::vector<double> values;
    for (std::size_t p = 0; p < parameters; ++p) {
      const Range& range = type().parameters[p].range;
      values.push_back((corner >> p & 1U) != 0U ? high_of(range) : low_of(range));
    }
    for (const double size : {0.0, 1.0, 1e4}) {
      for (const double hot_C : {-60.0, 25.0, kDestroyed_C}) {
        for (const double cold_C : {-60.0, 25.0, kDestroyed_C}) {
          std::vector<double> temperature_C(type().nodes.size(), cold_C);
          temperature_C[0] = hot_C;
          for (const double heat : heat_W(type(), {size, size, size, cold_C}, values, temperature_C)) {
            EXPECT_TRUE(std::isfinite(heat)) << "corner " << corner << " size " << size << " from " << hot_C << " to " << cold_C << " °C";
          }
        }
      }
    }
  }
}

/// Either heat is made, then no node loses any; or it is moved, then none is gained or lost and it runs downhill: Σ P·T ≤ 0.
TEST_P(EveryEffect, makes_heat_or_moves_it_downhill) {
  Chance chance(801);
  for (int i = 0; i < 500; ++i) {
    const std::vector<double> temperature_C = random_temperatures(chance, type());
    const std::vector<double> heat = heat_W(type(), random_point(chance), random_parameters(chance, type()), temperature_C);
    if (std::ranges::all_of(heat, [](double each_W) { return each_W >= 0.0; })) {
      continue;
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
    const OperatingPoint<double> at = random_point(chance);
    for (const double heat :
         heat_W(type(), at, random_parameters(chance, type()), std::vector<double>(type().nodes.size(), at.ambient_C))) {
      EXPECT_GE(heat, 0.0);
    }
  }
}

/// Two books of the same network: the rate is the sum of the balance over the capacity.
TEST_P(EveryEffect, balance_and_rate_of_a_network_agree) {
  Chance chance(804);
  Network network;
  std::vector<std::string> nodes;
  std::vector<double> capacity_J_per_K;
  for (std::size_t i = 0; i < type().nodes.size(); ++i) {
    nodes.push_back("node" + std::to_string(i));
    capacity_J_per_K.push_back(chance.by_ratio(1.0, 100.0));
    network.add_node(nodes.back(), capacity_J_per_K.back());
  }
  network.add_effect("first", type(), nodes, random_parameters(chance, type()));
  network.add_effect("second", type(), nodes, random_parameters(chance, type()));
  const OperatingPoint<double> at = random_point(chance);
  std::vector<double> temperature_C = random_temperatures(chance, type());
  const std::size_t count = temperature_C.size() + 1;
  std::vector<double> balance(2 * count);
  const std::vector<double> values = network.values();
  network.balance_W(at, values, temperature_C, balance);
  temperature_C.push_back(-999.0);  // ambient: overwritten
  std::vector<double> rate(count - 1);
  network.rate_K_per_s<double>(at, values, temperature_C, rate);
  EXPECT_EQ(temperature_C.back(), at.ambient_C);
  for (std::size_t node = 0; node + 1 < count; ++node) {
    EXPECT_NEAR(rate[node] * capacity_J_per_K[node], balance[node] + balance[count + node], 1e-9 * size_of(balance));
  }
}

}  // namespace
}  // namespace heatsoak
