// Laws evaluated with derivative-carrying numbers, compared with the plain laws and with finite differences.
#include "one_effect.h"
#include "thermal/linearised.h"

namespace heatsoak::thermal {
namespace {

/// The last bit of an exponent of some hundreds changes a power by 1e-13.
constexpr double kRounding = 1e-12;
/// Smaller numbers are subnormal and lose digits.
constexpr double kSmallest_W = 1e-300;

class Derivatives : public EveryEffect {};
INSTANTIATE_TEST_SUITE_P(Registry, Derivatives, every_effect(), name_of_effect);

/// A state with all variables of differentiation: temperatures, then parameters, then the copper loss.
struct State {
  OperatingPoint<double> at;
  std::vector<double> temperature_C;
  std::vector<double> parameters;

  [[nodiscard]] std::size_t size() const { return temperature_C.size() + parameters.size() + 1; }
  double& operator[](std::size_t place) {
    if (place < temperature_C.size()) {
      return temperature_C[place];
    }
    place -= temperature_C.size();
    return place < parameters.size() ? parameters[place] : at.copper_loss_W;
  }
};

/// Draws parameters of realistic size, so that differences are accurate.
State random_state(Chance& chance, const EffectType& type) {
  State state{random_point(chance), random_temperatures(chance, type), type.example.parameters};
  for (std::size_t p = 0; p < state.parameters.size(); ++p) {
    const base::ParameterSpec& spec = type.parameters[p];
    if (!spec.choices.empty()) {
      state.parameters[p] = chance.below(static_cast<int>(spec.choices.size()));
    } else {
      const double moved = state.parameters[p] * chance.between(0.5, 1.5) + 1e-3;
      state.parameters[p] = spec.range.contains(moved) ? moved : state.parameters[p];
    }
  }
  return state;
}

template <class Scalar>
std::vector<Scalar> as(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

std::vector<Tangent> tangent_heat_W(const EffectType& type, State& state, std::size_t direction) {
  OperatingPoint<Tangent> at;
  convert_point([](Tangent& to, const double& from) { to = Tangent(from); }, at, state.at);
  std::vector<Tangent> temperature_C = as<Tangent>(state.temperature_C);
  std::vector<Tangent> parameters = as<Tangent>(state.parameters);
  constexpr int kSlot = 3;  // any of the eight lanes
  if (direction < temperature_C.size()) {
    temperature_C[direction].v[kSlot] = 1.0;
  } else if (direction - temperature_C.size() < parameters.size()) {
    parameters[direction - temperature_C.size()].v[kSlot] = 1.0;
  } else {
    at.copper_loss_W.v[kSlot] = 1.0;
  }
  return heat_W(type, at, parameters, temperature_C);
}

TEST_P(Derivatives, come_with_the_value_of_the_law) {
  Chance chance(820);
  for (int i = 0; i < 300; ++i) {
    State state{random_point(chance), random_temperatures(chance, type()), random_parameters(chance, type())};
    const std::vector<double> expected_W = heat_W(type(), state.at, state.parameters, state.temperature_C);
    const std::vector<Tangent> heat = tangent_heat_W(type(), state, 0);
    for (std::size_t node = 0; node < heat.size(); ++node) {
      EXPECT_NEAR(heat[node].a, expected_W[node], kRounding * size_of(expected_W));
    }
  }
}

TEST_P(Derivatives, are_those_of_central_differences) {
  Chance chance(821);
  for (int i = 0; i < 200; ++i) {
    State state = random_state(chance, type());
    for (std::size_t direction = 0; direction < state.size(); ++direction) {
      const std::size_t parameter = direction - state.temperature_C.size();
      if (parameter < state.parameters.size() && !type().parameters[parameter].choices.empty()) {
        continue;
      }
      const std::vector<Tangent> heat = tangent_heat_W(type(), state, direction);
      const double middle = state[direction];
      const double step = 1e-5 * std::max(1e-3, std::abs(middle));
      const auto moved_W = [&](double by) {
        state[direction] = middle + by;
        std::vector<double> moved = heat_W(type(), state.at, state.parameters, state.temperature_C);
        state[direction] = middle;
        return moved;
      };
      const std::vector<double> above_W = moved_W(step);
      const std::vector<double> below_W = moved_W(-step);
      const std::vector<double> far_above_W = moved_W(2.0 * step);
      const std::vector<double> far_below_W = moved_W(-2.0 * step);
      for (std::size_t node = 0; node < heat.size(); ++node) {
        const double difference = (above_W[node] - below_W[node]) / (2.0 * step);
        const double wider = (far_above_W[node] - far_below_W[node]) / (4.0 * step);
        // The error of the difference is a third of its change with the step; the tolerance uses all of it.
        const double truncated = std::abs(wider - difference);
        EXPECT_NEAR(heat[node].v[3], difference,
                    1e-6 * std::abs(difference) + truncated + kRounding * size_of(above_W) / step + kSmallest_W)
            << "direction " << direction << " of " << type().nodes[node].role;
      }
    }
  }
}

/// Derivatives must be finite at rest and at uniform temperature, because a fit starts there.
TEST_P(Derivatives, are_finite_at_rest_and_at_one_temperature) {
  State state{{}, std::vector<double>(type().nodes.size(), 25.0), type().example.parameters};
  for (std::size_t direction = 0; direction < state.size(); ++direction) {
    for (const Tangent& heat : tangent_heat_W(type(), state, direction)) {
      EXPECT_TRUE(heat.v.allFinite()) << "direction " << direction;
    }
  }
}

/// All effects in one motor: derivatives of the network, including those through the copper loss that other laws use.
TEST(Linearise, agrees_with_differences_of_the_rate_with_every_effect_in_place) {
  Chance chance(822);
  for (int i = 0; i < 20; ++i) {
    Network network;
    network.add_node("winding", 15.0);
    network.add_node("stator", 90.0);
    for (const EffectType& type : all_effects()) {
      State state = random_state(chance, type);
      std::vector<std::string> nodes;
      for (const NodeRole& role : type.nodes) {
        nodes.emplace_back(role.own_capacity ? type.name : role.default_node);
      }
      network.add_effect(std::string(type.name), type, nodes, state.parameters);
    }
    network.limit_current_by("copper_loss");
    OperatingPoint<double> at = random_point(chance);
    std::vector<double> state_C;
    for (int node = 0; node < network.state_count(); ++node) {
      state_C.push_back(chance.between(20.0, 150.0));
    }
    std::vector<double> values = network.values();
    Linearised linearised;
    network.linearise(at, values, state_C, linearised);
    const auto rate_K_per_s = [&] {
      std::vector<double> temperature_C = state_C;
      temperature_C.push_back(0.0);
      std::vector<double> rate(state_C.size());
      network.rate_K_per_s<double>(at, values, temperature_C, rate);
      return rate;
    };
    const auto expect_column = [&](double& moved, const auto& column, const std::string& what) {
      const double middle = moved;
      const double step = 1e-5 * std::max(1e-3, std::abs(middle));
      moved = middle + step;
      const std::vector<double> above = rate_K_per_s();
      moved = middle - step;
      const std::vector<double> below = rate_K_per_s();
      moved = middle;
      for (std::size_t node = 0; node < above.size(); ++node) {
        const double difference = (above[node] - below[node]) / (2.0 * step);
        EXPECT_NEAR(column[static_cast<Eigen::Index>(node)], difference, 1e-6 * std::abs(difference) + 1e-12 * size_of(above) / step)
            << what;
      }
    };
    for (std::size_t node = 0; node < state_C.size(); ++node) {
      expect_column(state_C[node], linearised.by_state.col(static_cast<Eigen::Index>(node)), "node " + std::to_string(node));
    }
    for (std::size_t p = 0; p < values.size(); ++p) {
      if (network.parameters()[p].choices.empty()) {
        expect_column(values[p], linearised.by_parameter.col(static_cast<Eigen::Index>(p)), network.parameters()[p].name);
      }
    }
  }
}

}  // namespace
}  // namespace heatsoak::thermal
