#include "attribution/mean_heat.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimation/design.h"

namespace heatsoak::attribution {

double mean_heat_W(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs) {
  const auto nodes = static_cast<std::size_t>(model.network.node_count());
  std::vector<double> heat_W(model.network.effects().size() * nodes);
  double energy_J = 0.0;
  double time_s = 0.0;
  for (const estimation::MeasuredRun& run : runs) {
    const std::vector<double> state_C = estimation::measured_start_C(model.network, run);
    const std::vector<double> values = model.values_in(run);
    for (std::size_t k = 0; k < run.at.size(); ++k) {
      const double duration_s = run.time_s[k + 1] - run.time_s[k];
      model.network.balance_W(run.at[k], values, state_C, heat_W);
      time_s += duration_s;
      for (std::size_t e = 0; e < model.network.effects().size(); ++e) {
        const auto row = std::span(heat_W).subspan(e * nodes, nodes);
        // A flow only moves heat between nodes and sums to 0, so only sources count.
        energy_J += duration_s * std::abs(std::accumulate(row.begin(), row.end(), 0.0));
      }
    }
  }
  return time_s > 0.0 ? energy_J / time_s : 0.0;
}

}  // namespace heatsoak::attribution
