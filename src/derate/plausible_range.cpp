#include "derate/plausible_range.h"

#include <algorithm>
#include <array>

namespace heatsoak::derate {
namespace {

struct Bounds {
  float low = 0.0F;
  float high = 0.0F;
};

/// Largest plausible reading of a speed sensor. It exceeds the motor's range and includes the table's last speed, up to which the allowed
/// current falls continuously.
float fastest_rad_per_s(const Derating& derating) {
  return std::max(1.25F * static_cast<float>(derating.reachable_speed_rad_per_s),
                  static_cast<float>(derating.table.no_current_speed_rad_per_s));
}

/// A failed sensor or a zero-initialised structure reads exactly 0.
float coldest_C(const Derating& derating) { return static_cast<float>(derating.options.coldest_ambient_C) + 0.05F; }

/// Bounds of one signal that depend on motor or robot, wider than the motor's operating range, so that only a faulty sensor exceeds them.
struct SignalBounds {
  observed::Signal signal;
  Bounds (*of)(const Derating& derating);
};
constexpr std::array kBounds{
    SignalBounds{observed::current,
                 [](const Derating& derating) {
                   // The driver limits the current, or the battery at full braking speed. The factor covers overshoot of the current
                   // control and errors of its sensor.
                   const float most_current_A = 2.0F * static_cast<float>(derating.rules.most_current_A);
                   return Bounds{-most_current_A, most_current_A};
                 }},
    SignalBounds{observed::speed,
                 [](const Derating& derating) {
                   return Bounds{-fastest_rad_per_s(derating), fastest_rad_per_s(derating)};
                 }},
    SignalBounds{observed::ambient,
                 [](const Derating& derating) {
                   return Bounds{coldest_C(derating), 300.0F};
                 }},
    SignalBounds{observed::vehicle_speed,
                 [](const Derating& derating) {
                   return Bounds{0.0F, static_cast<float>(derating.rules.most_vehicle_speed_m_per_s)};
                 }},
    SignalBounds{observed::neighbour,
                 [](const Derating& derating) {
                   return Bounds{coldest_C(derating) - kNeighbourBelowAir_K, kMostState_C};
                 }},
    SignalBounds{observed::acceleration,
                 [](const Derating& derating) {
                   return Bounds{
                       0.0F, 2.0F * static_cast<float>(derating.reachable_speed_rad_per_s) / static_cast<float>(derating.options.period_s)};
                 }},
};

constexpr const SignalBounds* own_bounds(std::size_t signal) {
  const auto* const found = std::ranges::find(kBounds, static_cast<observed::Signal>(signal), &SignalBounds::signal);
  return found == kBounds.end() ? nullptr : found;
}

constexpr bool has_all_bounds() {
  for (std::size_t i = 0; i < observed::kSignalCount; ++i) {
    if ((own_bounds(i) != nullptr) == observed::firmware_of(i).plausible.has_value()) {
      return false;
    }
  }
  return true;
}
static_assert(has_all_bounds(), "each input of the firmware needs bounds, either here or as FirmwareInput::plausible");

Bounds bounds(const Derating& derating, observed::Signal signal) {
  if (const SignalBounds* const own = own_bounds(static_cast<std::size_t>(signal))) {
    return own->of(derating);
  }
  const base::InputRange& stated = *observed::firmware_of(static_cast<std::size_t>(signal)).plausible;
  return {static_cast<float>(stated.low), static_cast<float>(stated.high)};
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
