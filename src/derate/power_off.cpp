#include "derate/power_off.h"

#include <algorithm>
#include <limits>

#include "derate/plausible_range.h"
#include "thermal/steady_state.h"

namespace heatsoak::derate {
namespace {

/// Returns whether no node warms from `state_C`, nor from temperatures that are higher by the same amount. Heat flows from hot to cold, so
/// a state below such a bound stays below it (comparison theorem of cooperative systems; M. W. Hirsch and H. Smith, 2005, theorem 3.1).
bool bounds_all_later(const thermal::RateFunction& rates, std::span<const double> state_C) {
  constexpr double kSolverError_K_per_s = 1e-9;
  std::vector<double> above_C(state_C.size());
  std::vector<double> rate_K_per_s(state_C.size());
  for (const double above_K : {0.0, 0.1, 1.0, 5.0, 20.0, 60.0, 120.0}) {
    std::ranges::transform(state_C, above_C.begin(), [&](double each_C) { return each_C + above_K; });
    rates(above_C, rate_K_per_s);
    if (!std::ranges::all_of(rate_K_per_s, [](double rate) { return rate <= kSolverError_K_per_s; })) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::array<double, observed::kSignalCount> signals_without_power(const Derating& derating) {
  std::array<double, observed::kSignalCount> signals{};
  for (std::size_t i = 0; i < signals.size(); ++i) {
    switch (observed::signals()[i].without_power) {
      case thermal::WithoutPower::zero:
        break;
      case thermal::WithoutPower::hottest_air:
        signals[i] = derating.rules.hottest_ambient_C;
        break;
      case thermal::WithoutPower::winding_limit:
        signals[i] = derating.rules.limits.winding_C;
        break;
      case thermal::WithoutPower::any:
        break;
    }
  }
  return signals;
}

std::vector<float> ages_without_power_h(const Derating& derating) {
  std::vector<float> ages_h = plausible_range(derating, observed::age).values;
  if (!ages_h.empty() && std::ranges::find(ages_h, 0.0F) == ages_h.end()) {
    ages_h.insert(ages_h.begin(), 0.0F);  // for a motor that warms in hot air
  }
  return ages_h;
}

std::vector<double> resting_C(const Derating& derating, std::span<const int> rate_steps) {
  const std::size_t nodes = derating.observer.state_count();
  const double air_C = derating.rules.hottest_ambient_C;
  thermal::FormulaRun<double> run(derating.observer.formula(), rate_steps);
  std::vector<double> inputs(observed::kSignalCount + nodes);
  std::ranges::copy(signals_without_power(derating), inputs.begin());
  std::vector<float> ages_h = ages_without_power_h(derating);
  ages_h.resize(std::max<std::size_t>(1, ages_h.size()));
  std::vector<double> of_age_K_per_s(nodes);
  const thermal::RateFunction rates = [&](std::span<const double> state_C, std::span<double> rate_K_per_s) {
    std::ranges::copy(state_C, inputs.begin() + observed::kSignalCount);
    std::ranges::fill(rate_K_per_s, -std::numeric_limits<double>::infinity());
    for (const float age_h : ages_h) {
      inputs[observed::age] = static_cast<double>(age_h);
      run.run(inputs, of_age_K_per_s);
      std::ranges::transform(rate_K_per_s, of_age_K_per_s, rate_K_per_s.begin(), [](double a, double b) { return std::max(a, b); });
    }
  };
  if (const auto rest = thermal::steady_state(rates, std::vector<double>(nodes, air_C))) {
    for (const double enlarged : {1.0, 1.05, 1.1, 1.2, 1.4, 2.0, 4.0}) {
      std::vector<double> bound_C(nodes);
      std::ranges::transform(rest->temperature_C, bound_C.begin(),
                             [&](double each_C) { return air_C + enlarged * (each_C - air_C) + kRounding_K; });
      if (bounds_all_later(rates, bound_C)) {
        return bound_C;
      }
    }
  }
  return std::vector<double>(nodes, derating.rules.limits.winding_C);
}

}  // namespace heatsoak::derate
