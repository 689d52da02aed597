#include "diagnosis/heat_of_effects.h"

#include <algorithm>
#include <cmath>

namespace heatsoak::diagnosis {

void heat_along(const estimation::Posterior& fit, const estimation::MeasuredRun& run, const estimation::LinearisedRun& path,
                const HeatVisit& visit) {
  const thermal::Network& network = fit.model.network;
  const std::vector<double> values = fit.model.values_in(run);
  std::vector<double> heat_W(network.effects().size() * static_cast<std::size_t>(network.node_count()));
  for (std::size_t k = 0; k < run.at.size(); ++k) {
    const std::span<const double> state_C(path.state_C.col(static_cast<Eigen::Index>(k)).data(), static_cast<std::size_t>(path.states));
    network.balance_W(run.at[k], values, state_C, heat_W);
    visit(k, std::span<const double>(heat_W));
  }
}

HeatOfEffect heat_of(const estimation::Posterior& fit, const std::vector<estimation::MeasuredRun>& runs,
                     const std::function<bool(const thermal::EffectInPlace&)>& counts, const estimation::Condition& condition) {
  const thermal::Network& network = fit.model.network;
  const auto nodes = static_cast<std::size_t>(network.node_count());
  std::vector<std::size_t> places;
  for (std::size_t effect = 0; effect < network.effects().size(); ++effect) {
    if (const thermal::EffectInPlace& in_place = network.effects()[effect]; counts(in_place)) {
      places.push_back(effect * nodes + static_cast<std::size_t>(in_place.node_index.front()));
    }
  }
  std::vector<double> magnitude_W;
  HeatOfEffect out;
  double time_s = 0.0;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const estimation::MeasuredRun& run = runs[r];
    if (!run.has(condition)) {
      continue;
    }
    heat_along(fit, run, fit.fitted[r], [&](std::size_t k, std::span<const double> heat_W) {
      const double duration_s = run.time_s[k + 1] - run.time_s[k];
      magnitude_W.push_back(0.0);
      for (const std::size_t place : places) {
        magnitude_W.back() += std::abs(heat_W[place]);
      }
      out.mean_W += duration_s * magnitude_W.back();
      time_s += duration_s;
    });
  }
  if (!magnitude_W.empty()) {
    out.mean_W /= time_s;
    const auto peak = magnitude_W.begin() + static_cast<std::ptrdiff_t>(magnitude_W.size() * 99 / 100);
    std::nth_element(magnitude_W.begin(), peak, magnitude_W.end());
    out.peak_W = *peak;
  }
  return out;
}

}  // namespace heatsoak::diagnosis
