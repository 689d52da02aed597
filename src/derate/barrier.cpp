#include "derate/barrier.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

#include "motor/datasheet_network.h"

namespace heatsoak::derate {
namespace {

constexpr double kBelow_ratio = 1e-8;  ///< relative reduction that keeps the result below the root

/// Zero of the line through the margins at zero and at `most_A2`, which is positive; at most 16 times `most_A2`.
double beyond_A2(double none, double there, double most_A2) {
  constexpr double kFurthest_ratio = 16.0;
  const double fall = (none - there) / most_A2;
  return most_A2 * (fall > 0.0 ? std::min(kFurthest_ratio, none / fall / most_A2) : kFurthest_ratio);
}

/// Returns the largest x with margin(x) ≥ 0, searched up to `most_A2`; see Barrier::square_A2().
template <class Margin>
double largest_square_A2(const Margin& margin, double most_A2) {
  const double probe_A2 = most_A2 / 64.0;
  const double none = margin(0.0);
  const double fall = (none - margin(probe_A2)) / probe_A2;
  if (none <= 0.0) {
    return fall > 0.0 ? std::max(-most_A2, none / fall) : -most_A2;
  }
  // The linear solution is exact for nearly all laws, because they heat with the square of the current.
  const double straight_A2 = fall > 0.0 ? std::min(most_A2, none / fall) : most_A2;
  const double there = margin(straight_A2);
  constexpr double kRounding = 1e-10;
  if (straight_A2 == most_A2 && there >= 0.0) {
    return beyond_A2(none, there, most_A2) * (1.0 - kBelow_ratio);
  }
  if (std::abs(there) <= kRounding * none) {
    return straight_A2 * (1.0 - kBelow_ratio);
  }
  double low_A2 = there > 0.0 ? straight_A2 : 0.0;
  double high_A2 = there > 0.0 ? most_A2 : straight_A2;
  if (const double highest = margin(high_A2); highest >= 0.0) {
    return beyond_A2(none, highest, most_A2);
  }
  constexpr int kBits = 24;
  std::uintmax_t iterations = 60;
  std::tie(low_A2, high_A2) =
      boost::math::tools::toms748_solve(margin, low_A2, high_A2, boost::math::tools::eps_tolerance<double>(kBits), iterations);
  return low_A2 * (1.0 - kBelow_ratio);
}

}  // namespace

Barrier::Barrier(const Observer& observer, const BarrierRules& rules)
    : rules_(rules),
      cases_(hot_cases(observer, rules)),
      rates_(observer.formula(), observer.rate_steps()),
      signals_(observed::kSignalCount + observer.state_count()),
      rate_(observer.state_count()) {}

double Barrier::square_A2(double speed_rad_per_s, double stator_C, double winding_C) {
  const Place at{speed_rad_per_s, stator_C, winding_C};
  const double most_A2 = 4.0 * rules_.most_current_A * rules_.most_current_A;
  double least_A2 = std::numeric_limits<double>::infinity();
  for (const HotCase& each : cases_) {
    const auto winding = [&](double square_A2) { return winding_margin(each, at, square_A2); };
    least_A2 = std::min(least_A2, largest_square_A2(winding, most_A2));
    if (rules_.limits.stator_C) {
      const auto stator = [&](double square_A2) { return stator_margin(each, at, square_A2); };
      least_A2 = std::min(least_A2, largest_square_A2(stator, most_A2));
    }
  }
  return least_A2;
}

double Barrier::current_A(double speed_rad_per_s, double stator_C, double winding_C) {
  return std::min(rules_.most_current_A, std::sqrt(std::max(0.0, square_A2(speed_rad_per_s, stator_C, winding_C))));
}

double Barrier::winding_margin(const HotCase& each, const Place& at, double current_square_A2) {
  find_rates(each.signals(rules_, std::sqrt(current_square_A2), at.speed_rad_per_s), at.stator_C, at.winding_C);
  return (rules_.limits.winding_C - at.winding_C) / rules_.approach_s - rate_[motor::states::winding];
}

double Barrier::stator_margin(const HotCase& each, const Place& at, double current_square_A2) {
  const Signals signals = each.signals(rules_, std::sqrt(current_square_A2), at.speed_rad_per_s);
  find_rates(signals, at.stator_C, at.winding_C);
  find_rates(signals, at.stator_C, at.winding_C + rules_.approach_s * rate_[motor::states::winding]);
  // After a sudden rise of the speed the winding still conducts the heat of the earlier, larger current to the stator.
  constexpr double kHandedOn_K = 0.5;
  return (*rules_.limits.stator_C - kHandedOn_K - at.stator_C) / rules_.stator_approach_s - rate_[motor::states::stator];
}

void Barrier::find_rates(const Signals& signals, double stator_C, double winding_C) {
  std::ranges::copy(signals, signals_.begin());
  std::fill(signals_.begin() + observed::kSignalCount, signals_.end(), stator_C);
  signals_[observed::kSignalCount + motor::states::winding] = winding_C;
  rates_.run(signals_, rate_);
}

double barrier_current_A(const Observer& observer, const BarrierRules& rules, double speed_rad_per_s, double stator_C, double winding_C) {
  return Barrier(observer, rules).current_A(speed_rad_per_s, stator_C, winding_C);
}

}  // namespace heatsoak::derate
