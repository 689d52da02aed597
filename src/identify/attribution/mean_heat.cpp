#include "identify/attribution/mean_heat.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace heatsoak {

double mean_heat_W(const Model& model, const std::vector<MeasuredRun>& runs) {
  const auto nodes = static_cast<std::size_t>(model.network.node_count());
  std::vector<double> heat_W(model.network.effects().size() * nodes);
  double energy_J = 0.0;
  double time_s = 0.0;
  for (const MeasuredRun& run : runs) {
    const std::vector<double> state_C = measured_start_C(model.network, run);
    for (std::size_t k = 0; k < run.at.size(); ++k) {
      const double duration_s = run.time_s[k + 1] - run.time_s[k];
      model.network.balance_W(run.at[k], model.values, state_C, heat_W);
      time_s += duration_s;
      for (std::size_t e = 0; e < model.network.effects().size(); ++e) {
        const auto row = std::span(heat_W).subspan(e * nodes, nodes);
        // What a flow takes out of one node it brings into another: only sources have a sum.
        energy_J += duration_s * std::abs(std::accumulate(row.begin(), row.end(), 0.0));
      }
    }
  }
  return time_s > 0.0 ? energy_J / time_s : 0.0;
}

double longest_s(const std::vector<MeasuredRun>& runs) {
  double longest = 0.0;
  for (const MeasuredRun& run : runs) {
    longest = std::max(longest, run.time_s.back() - run.time_s.front());
  }
  return longest;
}

void heat_along(const RefitResult& fit, const MeasuredRun& run, const LinearisedRun& path, const HeatVisit& visit) {
  const Network& network = fit.model.model.network;
  const std::vector<double> values = fit.model.values_in(run);
  std::vector<double> heat_W(network.effects().size() * static_cast<std::size_t>(network.node_count()));
  for (std::size_t k = 0; k < run.at.size(); ++k) {
    const std::span<const double> state_C(path.state_C.col(static_cast<Eigen::Index>(k)).data(), static_cast<std::size_t>(path.states));
    network.balance_W(run.at[k], values, state_C, heat_W);
    visit(k, std::span<const double>(heat_W));
  }
}

}  // namespace heatsoak
