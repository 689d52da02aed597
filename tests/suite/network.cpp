#include "network.h"

#include <array>

namespace heatsoak::suite {
namespace {

/// Rates of a state: kelvin per second of each body, then heat input and heat loss in W.
struct Rates {
  std::vector<double> temperature_K_per_s;
  double in_W = 0.0;
  double lost_W = 0.0;
};

void set_rates(const Network& network, const Instant& instant, std::span<const double> temperature_C, Rates& rates) {
  std::vector<double>& heat_W = rates.temperature_K_per_s;
  heat_W.assign(network.bodies.size(), 0.0);
  HeatBook book(heat_W);
  for (const Link& link : network.links) {
    book.flow(link.first, link.second, link.conductance_W_per_K * (temperature_C[link.first] - temperature_C[link.second]));
  }
  for (const AirLink& link : network.air_links) {
    book.to_air(link.body, link.conductance_W_per_K * (temperature_C[link.body] - instant.ambient_C));
  }
  for (const Law& law : network.laws) {
    law(instant, temperature_C, book);
  }
  for (std::size_t i = 0; i < heat_W.size(); ++i) {
    heat_W[i] /= network.bodies[i].capacity_J_per_K;
  }
  rates.in_W = book.in_W();
  rates.lost_W = book.lost_W();
}

}  // namespace

void advance(const Network& network, const Instant& instant, double step_s, State& state) {
  static constexpr std::array<double, 4> kReach{0.0, 0.5, 0.5, 1.0};
  static constexpr std::array<double, 4> kWeight{1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  const std::size_t count = network.bodies.size();
  thread_local Rates rates;
  thread_local std::vector<double> at_C;
  thread_local std::vector<double> sum_K;
  rates.temperature_K_per_s.assign(count, 0.0);
  at_C.resize(count);
  sum_K.assign(count, 0.0);
  for (std::size_t stage = 0; stage < kReach.size(); ++stage) {
    for (std::size_t i = 0; i < count; ++i) {
      at_C[i] = state.temperature_C[i] + kReach[stage] * step_s * rates.temperature_K_per_s[i];
    }
    set_rates(network, instant, at_C, rates);
    for (std::size_t i = 0; i < count; ++i) {
      sum_K[i] += kWeight[stage] * step_s * rates.temperature_K_per_s[i];
    }
    state.heat_in_J += kWeight[stage] * step_s * rates.in_W;
    state.heat_lost_J += kWeight[stage] * step_s * rates.lost_W;
  }
  for (std::size_t i = 0; i < count; ++i) {
    state.temperature_C[i] += sum_K[i];
  }
}

}  // namespace heatsoak::suite
