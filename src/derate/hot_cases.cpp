#include "derate/hot_cases.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>

#include "base/random.h"
#include "motor/datasheet_network.h"

namespace heatsoak::derate {

std::vector<double> evenly(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(std::lerp(low, high, static_cast<double>(i) / (count - 1)));
  }
  return values;
}

namespace {

/// Evaluates the observer's rates in K/s with all nodes except the winding at the same temperature.
class Rates {
 public:
  explicit Rates(const Observer& observer)
      : run_(observer.formula(), observer.rate_steps()),
        inputs_(observed::kSignalCount + observer.state_count()),
        rate_(observer.state_count()) {}

  std::span<const double> at(const Signals& signals, double winding_C, double body_C) {
    std::ranges::copy(signals, inputs_.begin());
    std::fill(inputs_.begin() + observed::kSignalCount, inputs_.end(), body_C);
    inputs_[observed::kSignalCount + motor::states::winding] = winding_C;
    run_.run(inputs_, rate_);
    return rate_;
  }

 private:
  thermal::FormulaRun<double> run_;
  std::vector<double> inputs_;
  std::vector<double> rate_;
};

HotCase plain_case(const BarrierRules& rules) {
  HotCase plain;
  plain.neighbour_C = rules.hottest_ambient_C;
  return plain;
}

/// Returns the combinations of signs with different rates; combinations that no law distinguishes appear once.
std::vector<HotCase> directions(const Observer& observer, const BarrierRules& rules) {
  Rates rates(observer);
  const auto fingerprint = [&](const HotCase& each) {
    std::vector<double> print;
    for (const double share : {0.02, 0.1, 0.37, 0.9}) {
      const Signals signals = each.signals(rules, (1.1 - share) * rules.most_current_A, share * rules.most_speed_rad_per_s);
      const std::span<const double> found =
          rates.at(signals, rules.limits.winding_C, 0.5 * (rules.limits.winding_C + rules.hottest_ambient_C));
      print.insert(print.end(), found.begin(), found.end());
    }
    return print;
  };
  std::vector<HotCase> distinct;
  std::vector<std::vector<double>> prints;
  for (const double speed_sign : {1.0, -1.0}) {
    for (const double current_sign : {1.0, -1.0}) {
      HotCase each = plain_case(rules);
      each.speed_sign = speed_sign;
      each.current_sign = speed_sign * current_sign;
      const std::vector<double> print = fingerprint(each);
      if (std::ranges::find(prints, print) == prints.end()) {
        prints.push_back(print);
        distinct.push_back(each);
      }
    }
  }
  return distinct;
}

std::vector<double> by_ratio(double first, double last, int count) {
  std::vector<double> values{0.0};
  for (int i = 0; i < count; ++i) {
    values.push_back(first * std::pow(last / first, static_cast<double>(i) / (count - 1)));
  }
  return values;
}

struct Scan {
  observed::Signal signal;
  double HotCase::*value;
  std::vector<double> values;
};

std::vector<Scan> scans(const BarrierRules& rules) {
  return {{observed::vehicle_speed, &HotCase::vehicle_speed_m_per_s, evenly(0.0, rules.most_vehicle_speed_m_per_s, 101)},
          {observed::neighbour, &HotCase::neighbour_C, evenly(rules.hottest_ambient_C, rules.limits.winding_C, 33)},
          {observed::age, &HotCase::age_h, by_ratio(1e-2, 1e5, 141)},
          {observed::acceleration, &HotCase::acceleration_rad_per_s2, by_ratio(1.0, 1e6, 241)}};
}

struct Hottest {
  double for_winding = 0.0;
  double for_bodies = 0.0;
};

/// Returns the values of a signal that heat the winding most and the bodies most, at part load with all other signals as in the plain case.
Hottest hottest(const Observer& observer, const BarrierRules& rules, observed::Signal signal, std::span<const double> values) {
  Rates rates(observer);
  Signals signals = plain_case(rules).signals(rules, 0.3 * rules.most_current_A, 0.5 * rules.most_speed_rad_per_s);
  Hottest found;
  double most_winding = -std::numeric_limits<double>::infinity();
  double most_bodies = most_winding;
  for (const double value : values) {
    signals[signal] = value;
    const std::span<const double> rate =
        rates.at(signals, rules.limits.winding_C - 1.0, 0.5 * (rules.limits.winding_C + rules.hottest_ambient_C));
    if (rate[motor::states::winding] > most_winding) {
      most_winding = rate[motor::states::winding];
      found.for_winding = value;
    }
    if (const double bodies = *std::max_element(rate.begin() + 1, rate.end()); bodies > most_bodies) {
      most_bodies = bodies;
      found.for_bodies = value;
    }
  }
  return found;
}

/// Returns the plain case, the case that heats the winding most and the case that heats the bodies most.
std::vector<HotCase> surroundings(const Observer& observer, const BarrierRules& rules) {
  HotCase for_winding = plain_case(rules);
  HotCase for_bodies = for_winding;
  bool is_any = false;
  for (const Scan& scan : scans(rules)) {
    if (observer.uses(scan.signal)) {
      is_any = true;
      const Hottest found = hottest(observer, rules, scan.signal, scan.values);
      for_winding.*scan.value = found.for_winding;
      for_bodies.*scan.value = found.for_bodies;
    }
  }
  return is_any ? std::vector{plain_case(rules), for_winding, for_bodies} : std::vector{plain_case(rules)};
}

/// Adds the two values that heat winding and bodies most, searched on a fine grid between the first and the last value.
std::vector<double> with_hottest(std::vector<double> values, const Observer& observer, const BarrierRules& rules, observed::Signal signal) {
  constexpr int kFine = 2001;
  const Hottest found = hottest(observer, rules, signal, evenly(values.front(), values.back(), kFine));
  values.insert(values.end(), {found.for_winding, found.for_bodies});
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// Returns random inputs of the formula: every signal and every node by itself, as often at an end of its range as inside.
std::vector<std::vector<float>> random_inputs(const Observer& observer, const BarrierRules& rules) {
  constexpr int kPlaces = 1024;
  constexpr double kMargin_K = 50.0;
  const double hottest_C = rules.limits.winding_C + kMargin_K;
  const double coldest_C = -kMargin_K;
  std::vector<std::pair<double, double>> ranges(observed::kSignalCount + observer.state_count(), {coldest_C, hottest_C});
  ranges[observed::current] = {-rules.most_current_A, rules.most_current_A};
  ranges[observed::speed] = {-rules.most_speed_rad_per_s, rules.most_speed_rad_per_s};
  ranges[observed::vehicle_speed] = {0.0, rules.most_vehicle_speed_m_per_s};
  for (const Scan& scan : scans(rules)) {
    ranges[scan.signal] = scan.signal == observed::neighbour ? ranges[scan.signal] : std::pair(scan.values.front(), scan.values.back());
  }
  base::Random random(1, 0);
  std::vector<std::vector<float>> places(kPlaces);
  for (std::vector<float>& place : places) {
    for (const auto& [low, high] : ranges) {
      const double share = std::clamp(2.0 * random.uniform() - 0.5, 0.0, 1.0);
      place.push_back(static_cast<float>(std::lerp(low, high, share)));
    }
  }
  return places;
}

/// Removes each value that the others together make needless: at random inputs and temperatures, and for each node, one of them heats at
/// least as much. The guard then finds the same highest rates in a shorter search. Losses that grow with the speed leave one of its values;
/// a flow of heat that grows with the speed leaves the two ends, because its direction depends on the temperatures.
std::vector<double> without_needless(const std::vector<double>& values, const Observer& observer, const BarrierRules& rules,
                                     observed::Signal signal) {
  thermal::FormulaRun<float> run(observer.formula(), observer.rate_steps());
  std::vector<std::vector<float>> rates(values.size());
  for (std::vector<float>& inputs : random_inputs(observer, rules)) {
    std::vector<float> rate(observer.state_count());
    for (std::size_t i = 0; i < values.size(); ++i) {
      inputs[signal] = static_cast<float>(values[i]);
      run.run(inputs, rate);
      rates[i].insert(rates[i].end(), rate.begin(), rate.end());
    }
  }
  // The ends come last, because rounding may make a value beside an end equal to it.
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return i == 0 || i + 1 == values.size(); });
  std::vector<bool> is_needed(values.size(), true);
  for (const std::size_t i : order) {
    is_needed[i] = false;
    for (std::size_t at = 0; at < rates[i].size() && !is_needed[i]; ++at) {
      bool is_matched = false;
      for (std::size_t other = 0; other < values.size() && !is_matched; ++other) {
        is_matched = is_needed[other] && rates[other][at] >= rates[i][at];
      }
      is_needed[i] = !is_matched;
    }
  }
  std::vector<double> needed;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (is_needed[i]) {
      needed.push_back(values[i]);
    }
  }
  return needed;
}

}  // namespace

Signals HotCase::signals(const BarrierRules& rules, double current_A, double speed_rad_per_s) const {
  return {current_sign * current_A, speed_sign * speed_rad_per_s, rules.hottest_ambient_C, vehicle_speed_m_per_s, neighbour_C, age_h,
          acceleration_rad_per_s2};
}

std::vector<double> values_if_unknown(const Observer& observer, const BarrierRules& rules, observed::Signal signal) {
  constexpr int kFew = 17;
  constexpr int kMany = 33;
  switch (signal) {
    case observed::current:
      return without_needless(with_hottest(evenly(-rules.most_current_A, rules.most_current_A, kMany), observer, rules, signal), observer,
                               rules, signal);
    case observed::speed:
      return without_needless(
          with_hottest(evenly(-rules.most_speed_rad_per_s, rules.most_speed_rad_per_s, kMany), observer, rules, signal), observer, rules,
          signal);
    case observed::ambient:
      return {rules.hottest_ambient_C};
    default:
      break;
  }
  const std::vector<Scan> all = scans(rules);
  const Scan& scan = *std::ranges::find(all, signal, &Scan::signal);
  std::vector<double> values;
  for (const HotCase& each : surroundings(observer, rules)) {
    values.push_back(each.*scan.value);
  }
  const std::size_t apart = (scan.values.size() + kFew - 1) / kFew;
  for (std::size_t i = 0; i < scan.values.size(); i += apart) {
    values.push_back(scan.values[i]);
  }
  values.push_back(scan.values.back());
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return without_needless(values, observer, rules, signal);
}

std::vector<HotCase> hot_cases(const Observer& observer, const BarrierRules& rules) {
  std::vector<HotCase> cases;
  for (const HotCase& around : surroundings(observer, rules)) {
    for (const HotCase& direction : directions(observer, rules)) {
      cases.push_back(around);
      cases.back().current_sign = direction.current_sign;
      cases.back().speed_sign = direction.speed_sign;
    }
  }
  return cases;
}

double sustainable_speed_rad_per_s(const Observer& observer, const BarrierRules& rules) {
  constexpr int kPlaces = 200;
  const std::vector<HotCase> cases = hot_cases(observer, rules);
  Rates rates(observer);
  const double winding_C = rules.limits.winding_C;
  const double hottest_body_C = std::min(winding_C, rules.limits.stator_C.value_or(winding_C));
  const auto cools = [&](const HotCase& each, double speed_rad_per_s) {
    constexpr int kBodies = 40;
    const Signals signals = each.signals(rules, 0.0, speed_rad_per_s);
    for (int i = 1; i <= kBodies; ++i) {
      const double body_C = std::lerp(rules.hottest_ambient_C, hottest_body_C, static_cast<double>(i) / kBodies);
      // A stator limit of its own keeps the winding below the winding limit.
      const std::span<const double> found = rates.at(signals, rules.limits.stator_C ? body_C : winding_C, body_C);
      if (std::ranges::all_of(found, [](double rate) { return rate <= 0.0; })) {
        return true;
      }
    }
    return false;
  };
  double sustainable_rad_per_s = 0.0;
  for (int i = 0; i <= kPlaces; ++i) {
    const double speed_rad_per_s = rules.most_speed_rad_per_s * i / kPlaces;
    if (!std::ranges::all_of(cases, [&](const HotCase& each) { return cools(each, speed_rad_per_s); })) {
      break;
    }
    sustainable_rad_per_s = speed_rad_per_s;
  }
  return sustainable_rad_per_s;
}

}  // namespace heatsoak::derate
