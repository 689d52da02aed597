#include "derate/plausible_range.h"

#include <algorithm>

namespace heatsoak::derate {
namespace {

struct Bounds {
  float low = 0.0F;
  float high = 0.0F;
};

/// Returns bounds wider than the motor's operating range, so that only a faulty sensor exceeds them.
Bounds bounds(const Derating& derating, observed::Signal signal) {
  const auto most_current_A = static_cast<float>(derating.rules.most_current_A);
  const auto reachable_rad_per_s = static_cast<float>(derating.reachable_speed_rad_per_s);
  // The bound includes the table's last speed, up to which the allowed current falls continuously.
  const float fastest_rad_per_s = std::max(1.25F * reachable_rad_per_s, static_cast<float>(derating.table.no_current_speed_rad_per_s));
  switch (signal) {
    case observed::current:
      return {-10.0F * most_current_A, 10.0F * most_current_A};
    case observed::speed:
      return {-fastest_rad_per_s, fastest_rad_per_s};
    case observed::ambient:
      // A failed sensor or a zero-initialised structure reads exactly 0.
      return {static_cast<float>(derating.options.coldest_ambient_C) + 0.05F, 300.0F};
    case observed::neighbour:
      return {static_cast<float>(derating.options.coldest_ambient_C) + 0.05F - kNeighbourBelowAir_K, kMostState_C};
    case observed::vehicle_speed:
      return {0.0F, static_cast<float>(derating.rules.most_vehicle_speed_m_per_s)};
    case observed::age:
      return {0.0F, 1e6F};
    default:
      return {0.0F, 2.0F * reachable_rad_per_s / static_cast<float>(derating.options.period_s)};
  }
}

}  // namespace

PlausibleRange plausible_range(const Derating& derating, observed::Signal signal) {
  if (!derating.observer.uses(signal)) {
    return {};
  }
  const Bounds validated = bounds(derating, signal);
  // A speed that is not known may be any accepted one.
  BarrierRules accepted = derating.rules;
  accepted.most_speed_rad_per_s = bounds(derating, observed::speed).high;
  PlausibleRange made{.is_used = true, .low = validated.low, .high = validated.high, .values = {}};
  for (const double value : values_if_unknown(derating.observer, accepted, signal)) {
    made.values.push_back(static_cast<float>(value));
  }
  return made;
}

}  // namespace heatsoak::derate
