#include "select/sustainable_current.h"

#include <cmath>
#include <limits>
#include <vector>

#include "thermal/ensemble.h"

namespace heatsoak {
namespace {

Lanes worst_excess_K(const std::vector<Lanes>& peak_C, std::span<const NodeLimit> limits) {
  Lanes worst_K = Lanes::Constant(-std::numeric_limits<double>::infinity());
  for (const NodeLimit& limit : limits) {
    worst_K = worst_K.max(peak_C[static_cast<std::size_t>(limit.node)] - limit.limit_C);
  }
  return worst_K;
}

}  // namespace

std::optional<double> sustainable_current_factor(const Network& network, std::span<const Interval> intervals,
                                                 std::span<const NodeLimit> limits, bool is_too_much) {
  constexpr int kRounds = 4;
  constexpr double kWider = 16.0;
  constexpr double kFarthest = 1e6;
  double low = 0.0;
  double high = is_too_much ? 1.0 : kWider;
  double share = 0.5;
  std::vector<Lanes> parameters;
  for (const double value : network.values()) {
    parameters.emplace_back(Lanes::Constant(value));
  }
  for (int round = 0; round < kRounds;) {
    const Lanes factor = Lanes::LinSpaced(low, high);
    const std::vector<Lanes> start_C(static_cast<std::size_t>(network.state_count()), Lanes::Constant(intervals.front().at.ambient_C));
    EnsembleRun run(network, parameters, start_C);
    for (const Interval& interval : intervals) {
      OperatingPoint<Lanes> at;
      for_each_quantity([](Lanes& to, const double& from) { to = Lanes::Constant(from); }, at, interval.at);
      at.current_rms_A *= factor;
      at.input_power_W = at.shaft_power_W * factor + (at.input_power_W - at.shaft_power_W) * factor * factor;
      at.shaft_power_W *= factor;
      at.resistive_headroom_V = Lanes::Constant(std::numeric_limits<double>::infinity());
      run.over(interval.duration_s, at, longest_step_s(network, parameters, at));
    }
    const Lanes excess_K = worst_excess_K(run.peak_C(), limits);
    int within = -1;
    while (within + 1 < kLanes && excess_K[within + 1] <= 0.0) {
      ++within;
    }
    if (within < 0) {
      return std::nullopt;
    }
    if (within + 1 == kLanes) {
      if (high >= kFarthest) {
        return std::nullopt;
      }
      low = high;
      high *= kWider;
      continue;
    }
    low = factor[within];
    high = factor[within + 1];
    share = -excess_K[within] / (excess_K[within + 1] - excess_K[within]);
    ++round;
  }
  return std::lerp(low, high, share);
}

}  // namespace heatsoak
