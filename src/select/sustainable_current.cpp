#include "select/sustainable_current.h"

#include <cmath>
#include <limits>
#include <vector>

#include "thermal/ensemble.h"

namespace heatsoak::select {
namespace {

thermal::Lanes worst_excess_K(const std::vector<thermal::Lanes>& peak_C, std::span<const thermal::NodeLimit> limits) {
  thermal::Lanes worst_K = thermal::Lanes::Constant(-std::numeric_limits<double>::infinity());
  for (const thermal::NodeLimit& limit : limits) {
    worst_K = worst_K.max(peak_C[static_cast<std::size_t>(limit.node)] - limit.limit_C);
  }
  return worst_K;
}

}  // namespace

std::optional<double> sustainable_current_factor(const thermal::Network& network, std::span<const thermal::Interval> intervals,
                                                 std::span<const thermal::NodeLimit> limits, bool is_too_much) {
  constexpr int kRounds = 4;
  constexpr double kWider = 16.0;
  constexpr double kFarthest = 1e6;
  double low = 0.0;
  double high = is_too_much ? 1.0 : kWider;
  double share = 0.5;
  std::vector<thermal::Lanes> parameters;
  for (const double value : network.values()) {
    parameters.emplace_back(thermal::Lanes::Constant(value));
  }
  for (int round = 0; round < kRounds;) {
    const thermal::Lanes factor = thermal::Lanes::LinSpaced(low, high);
    const std::vector<thermal::Lanes> start_C(static_cast<std::size_t>(network.state_count()),
                                              thermal::Lanes::Constant(intervals.front().at.ambient_C));
    thermal::EnsembleRun run(network, parameters, start_C);
    for (const thermal::Interval& interval : intervals) {
      thermal::OperatingPoint<thermal::Lanes> at;
      thermal::convert_point([](thermal::Lanes& to, const double& from) { to = thermal::Lanes::Constant(from); }, at, interval.at);
      at.current_rms_A *= factor;
      at.input_power_W = at.shaft_power_W * factor + (at.input_power_W - at.shaft_power_W) * factor * factor;
      at.shaft_power_W *= factor;
      at.resistive_headroom_V = thermal::Lanes::Constant(std::numeric_limits<double>::infinity());
      run.over(interval.duration_s, at, thermal::longest_step_s(network, parameters, at));
    }
    const thermal::Lanes excess_K = worst_excess_K(run.peak_C(), limits);
    int within = -1;
    while (within + 1 < base::kLanes && excess_K[within + 1] <= 0.0) {
      ++within;
    }
    if (within < 0) {
      return std::nullopt;
    }
    if (within + 1 == base::kLanes) {
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

}  // namespace heatsoak::select
