#include "estimation/usual_heat.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace heatsoak::estimation {

double usual_heat_W(const Model& model, std::span<const MeasuredRun> runs, const std::vector<std::vector<double>>& start_C) {
  const thermal::Network& network = model.network;
  const auto nodes = static_cast<std::size_t>(network.node_count());
  std::vector<double> heat_W(network.effects().size() * nodes);
  double made_J = 0.0;
  double led_away_J = 0.0;
  double duration_s = 0.0;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    std::vector<double> state_C = start_C[r];
    const std::vector<double> values = model.values_in(runs[r]);
    for (std::size_t k = 0; k < runs[r].at.size(); ++k) {
      const double step_s = runs[r].time_s[k + 1] - runs[r].time_s[k];
      for (const Sensor& sensor : runs[r].sensors) {
        const double sensor_C = runs[r].measured_C(static_cast<Eigen::Index>(k), runs[r].sensor_at(sensor.node).value());
        double& node_C = state_C[static_cast<std::size_t>(network.node(sensor.node))];
        node_C = std::isnan(sensor_C) ? node_C : motor::true_at_rest_C(sensor.faults, sensor_C);
      }
      network.balance_W(runs[r].at[k], values, state_C, heat_W);
      double away_W = 0.0;
      for (std::size_t e = 0; e < network.effects().size(); ++e) {
        away_W += heat_W[e * nodes + nodes - 1];
      }
      made_J += step_s * std::accumulate(heat_W.begin(), heat_W.end(), 0.0);
      led_away_J += step_s * std::abs(away_W);
      duration_s += step_s;
    }
  }
  constexpr double kLeast_W = 1e-3;
  return std::max({kLeast_W, made_J / duration_s, led_away_J / duration_s});
}

std::optional<double> large_current_A(std::span<const MeasuredRun> runs) {
  constexpr double kTop_share = 0.98;
  std::vector<double> current_A;
  for (const MeasuredRun& run : runs) {
    std::ranges::transform(run.at, std::back_inserter(current_A), &thermal::OperatingPoint<double>::current_rms_A);
  }
  std::erase_if(current_A, [](double each_A) { return !(each_A > 0.0); });
  if (current_A.empty()) {
    return std::nullopt;
  }
  const auto top = current_A.begin() + static_cast<std::ptrdiff_t>(kTop_share * static_cast<double>(current_A.size() - 1));
  std::ranges::nth_element(current_A, top);
  return *top;
}

}  // namespace heatsoak::estimation
