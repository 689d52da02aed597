#include "derate/power_off.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "derate/plausible_range.h"
#include "motor/datasheet_network.h"
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
      case thermal::WithoutPower::unstated:
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

namespace {

/// Returns the largest rate of each node over the possible ages, without power.
thermal::RateFunction rates_without_power(const Derating& derating, std::span<const int> rate_steps) {
  std::vector<float> ages_h = ages_without_power_h(derating);
  ages_h.resize(std::max<std::size_t>(1, ages_h.size()));
  std::vector<double> inputs(observed::kSignalCount + derating.observer.state_count());
  std::ranges::copy(signals_without_power(derating), inputs.begin());
  return [run = thermal::FormulaRun<double>(derating.observer.formula(), rate_steps), inputs = std::move(inputs),
          ages_h = std::move(ages_h), of_age_K_per_s = std::vector<double>(derating.observer.state_count())](
             std::span<const double> state_C, std::span<double> rate_K_per_s) mutable {
    std::ranges::copy(state_C, inputs.begin() + observed::kSignalCount);
    std::ranges::fill(rate_K_per_s, -std::numeric_limits<double>::infinity());
    for (const float age_h : ages_h) {
      inputs[observed::age] = static_cast<double>(age_h);
      run.run(inputs, of_age_K_per_s);
      std::ranges::transform(rate_K_per_s, of_age_K_per_s, rate_K_per_s.begin(), [](double a, double b) { return std::max(a, b); });
    }
  };
}

}  // namespace

std::vector<double> resting_C(const Derating& derating, std::span<const int> rate_steps) {
  const std::size_t nodes = derating.observer.state_count();
  const double air_C = derating.rules.hottest_ambient_C;
  const thermal::RateFunction rates = rates_without_power(derating, rate_steps);
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

namespace {

/// A guard without current: explicit Euler steps of its period, as in the firmware.
class Cooling {
 public:
  Cooling(const Derating& derating, std::vector<double> state_C)
      : derating_(derating),
        rates_(rates_without_power(derating, derating.observer.rate_steps())),
        state_C_(std::move(state_C)),
        rate_K_per_s_(state_C_.size()) {}

  void advance(double time_s) {
    const auto steps = std::lround(time_s / derating_.options.period_s);
    for (long i = 0; i < steps; ++i) {
      step();
    }
  }
  /// Returns the highest temperature of each node over all later times. They are reached when no node warms any more.
  std::vector<double> peaks_C() {
    std::vector<double> peak_C = state_C_;
    const auto most_steps = std::lround(use_duration_s(derating_.nominal) / derating_.options.period_s);
    for (long i = 0; i < most_steps; ++i) {
      step();
      std::ranges::transform(peak_C, state_C_, peak_C.begin(), [](double a, double b) { return std::max(a, b); });
      if (std::ranges::all_of(rate_K_per_s_, [](double rate) { return rate <= 0.0; })) {
        return peak_C;
      }
    }
    const std::vector<double> rest_C = resting_C(derating_, derating_.observer.rate_steps());
    std::ranges::transform(peak_C, rest_C, peak_C.begin(), [](double a, double b) { return std::max(a, b); });
    return peak_C;
  }
  [[nodiscard]] double allowed_A() const {
    return derating_.table.allowed_A(0.0, *std::max_element(state_C_.begin() + 1, state_C_.end()), state_C_[motor::states::winding]);
  }

 private:
  void step() {
    rates_(state_C_, rate_K_per_s_);
    std::ranges::transform(state_C_, rate_K_per_s_, state_C_.begin(),
                           [this](double state_C, double rate) { return state_C + derating_.options.period_s * rate; });
  }

  const Derating& derating_;
  thermal::RateFunction rates_;
  std::vector<double> state_C_;
  std::vector<double> rate_K_per_s_;
};

/// Returns the highest steady-state temperature of each node over all continuous uses; the winding limit if there is none.
std::vector<double> hottest_permitted_C(const Derating& derating) {
  const std::size_t nodes = derating.observer.state_count();
  std::vector<double> hottest_C;
  thermal::FormulaRun<double> run(derating.observer.formula(), derating.observer.rate_steps());
  std::vector<double> inputs(observed::kSignalCount + nodes);
  for (const UsePlayed& each : derating.uses) {
    if (each.use.on_s > 0.0 || each.current_A.empty()) {
      continue;
    }
    const double speed_rad_per_s = each.use.speed_share * derating.rules.most_speed_rad_per_s;
    std::ranges::copy(each.use.hot_case.signals(derating.rules, each.current_A.back(), speed_rad_per_s), inputs.begin());
    const thermal::RateFunction rates = [&](std::span<const double> state_C, std::span<double> rate_K_per_s) {
      std::ranges::copy(state_C, inputs.begin() + observed::kSignalCount);
      run.run(inputs, rate_K_per_s);
    };
    if (const auto steady = thermal::steady_state(rates, std::vector<double>(nodes, derating.rules.hottest_ambient_C))) {
      hottest_C.resize(nodes, derating.rules.hottest_ambient_C);
      std::ranges::transform(hottest_C, steady->temperature_C, hottest_C.begin(),
                             [&](double a, double b) { return std::min(std::max(a, b), derating.rules.limits.winding_C); });
    }
  }
  return hottest_C.empty() ? std::vector<double>(nodes, derating.rules.limits.winding_C) : hottest_C;
}

}  // namespace

PowerOffReport power_off_report(const Derating& derating) {
  constexpr double kReset_s = 2.0;
  PowerOffReport report{.start_C = hottest_permitted_C(derating), .cases = {}};
  const auto add = [&](std::string_view name, std::optional<double> off_s, const std::vector<double>& state_C) {
    Cooling guard(derating, state_C);
    guard.advance(off_s.value_or(0.0));
    PowerOffCase made{name, off_s, {}};
    double time_s = 0.0;
    for (const double moment_s : kPowerOffMoments_s) {
      guard.advance(moment_s - time_s);
      time_s = moment_s;
      made.allowed_A.push_back(guard.allowed_A());
    }
    report.cases.push_back(std::move(made));
  };
  add("no loss of power", 0.0, report.start_C);
  add("2 s without power", kReset_s, report.start_C);
  add("an unknown time", std::nullopt, Cooling(derating, report.start_C).peaks_C());
  add("a damaged buffer", std::nullopt, std::vector<double>(report.start_C.size(), derating.rules.limits.winding_C));
  return report;
}

}  // namespace heatsoak::derate
