#include "derate/hot_cases.h"

#include <algorithm>
#include <array>
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

/// Values of a signal that depend on motor or robot, among which its worst case is searched.
struct Scan {
  observed::Signal signal;
  std::vector<double> (*values)(const BarrierRules& rules);  ///< ascending
};
constexpr std::array kScans{
    Scan{observed::vehicle_speed, [](const BarrierRules& rules) { return evenly(0.0, rules.most_vehicle_speed_m_per_s, 101); }},
    Scan{observed::neighbour, [](const BarrierRules& rules) { return evenly(rules.hottest_ambient_C, rules.limits.winding_C, 33); }},
};

constexpr bool is_searched(std::size_t signal) { return observed::firmware_of(signal).worst == base::WorstCase::searched; }

constexpr const Scan* own_scan(std::size_t signal) {
  const auto* const found = std::ranges::find(kScans, static_cast<observed::Signal>(signal), &Scan::signal);
  return found == kScans.end() ? nullptr : found;
}

/// Returns whether every signal whose worst case is searched has values, and no other signal has some.
constexpr bool has_every_scan() {
  for (std::size_t signal = 0; signal < observed::kSignalCount; ++signal) {
    const int sources = (own_scan(signal) != nullptr ? 1 : 0) + (observed::firmware_of(signal).searched.count > 0 ? 1 : 0);
    if (sources != (is_searched(signal) ? 1 : 0)) {
      return false;
    }
  }
  return true;
}
static_assert(has_every_scan(), "each input with WorstCase::searched needs values, either here or as FirmwareInput::searched");

/// Returns the values among which the worst case of a signal is searched, ascending.
std::vector<double> searched_values(const BarrierRules& rules, std::size_t signal) {
  if (const Scan* const own = own_scan(signal)) {
    return own->values(rules);
  }
  const auto& [low, high, count, is_by_ratio] = observed::firmware_of(signal).searched;
  return is_by_ratio ? by_ratio(low, high, count) : evenly(low, high, count);
}

std::vector<observed::Signal> searched_signals() {
  std::vector<observed::Signal> all;
  for (std::size_t signal = 0; signal < observed::kSignalCount; ++signal) {
    if (is_searched(signal)) {
      all.push_back(static_cast<observed::Signal>(signal));
    }
  }
  return all;
}

/// A temperature of the surroundings. Its neutral value is that of the air, not 0.
constexpr bool is_temperature(std::size_t signal) { return observed::row_of(signal).unit == "degC"; }

/// Returns whether current and speed alone act in both directions: they are the axes of the table and the arguments of HotCase::signals().
constexpr bool are_axes_alone_signed() {
  for (std::size_t signal = 0; signal < observed::kSignalCount; ++signal) {
    const bool is_axis = signal == observed::current || signal == observed::speed;
    if ((observed::firmware_of(signal).worst == base::WorstCase::both_directions) != is_axis) {
      return false;
    }
  }
  return true;
}
static_assert(are_axes_alone_signed(), "a further signed input needs its largest value here and in operating_point()");

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
  for (const observed::Signal signal : searched_signals()) {
    if (observer.uses(signal)) {
      is_any = true;
      const Hottest found = hottest(observer, rules, signal, searched_values(rules, signal));
      for_winding.held[signal] = found.for_winding;
      for_bodies.held[signal] = found.for_bodies;
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
  for (const observed::Signal signal : searched_signals()) {
    // A body in the surroundings has any temperature that a node may have.
    if (!is_temperature(signal)) {
      const std::vector<double> values = searched_values(rules, signal);
      ranges[signal] = {values.front(), values.back()};
    }
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

HotCase plain_case(const BarrierRules& rules) {
  HotCase plain;
  for (const observed::Signal signal : searched_signals()) {
    plain.held[signal] = is_temperature(signal) ? rules.hottest_ambient_C : 0.0;
  }
  return plain;
}

Signals HotCase::signals(const BarrierRules& rules, double current_A, double speed_rad_per_s) const {
  Signals all = held;
  all[observed::current] = current_sign * current_A;
  all[observed::speed] = speed_sign * speed_rad_per_s;
  all[observed::ambient] = rules.hottest_ambient_C;
  return all;
}

std::vector<double> values_if_unknown(const Observer& observer, const BarrierRules& rules, observed::Signal signal) {
  constexpr int kFew = 17;
  constexpr int kMany = 33;
  switch (observed::signals()[static_cast<std::size_t>(signal)].worst) {
    case thermal::WorstCase::both_directions: {
      const double most = signal == observed::current ? rules.most_current_A : rules.most_speed_rad_per_s;
      return without_needless(with_hottest(evenly(-most, most, kMany), observer, rules, signal), observer, rules, signal);
    }
    case thermal::WorstCase::hottest_air:
      return {rules.hottest_ambient_C};
    case thermal::WorstCase::searched:
      break;
  }
  const std::vector<double> scanned = searched_values(rules, static_cast<std::size_t>(signal));
  std::vector<double> values;
  for (const HotCase& each : surroundings(observer, rules)) {
    values.push_back(each.held[signal]);
  }
  const std::size_t apart = (scanned.size() + kFew - 1) / kFew;
  for (std::size_t i = 0; i < scanned.size(); i += apart) {
    values.push_back(scanned[i]);
  }
  values.push_back(scanned.back());
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
