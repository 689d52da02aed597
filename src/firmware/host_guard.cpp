#include "firmware/host_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/diagnostic.h"
#include "derate/power_off.h"

namespace heatsoak::firmware {
namespace {

/// Returns whether the drive core has the values that the rows state for a motor without power. guard_memory.cpp and, for a gap,
/// thermal_guard.cpp set those of two temperatures and search the age; all others are 0.
constexpr bool has_values_without_power() {
  for (std::size_t i = 0; i < derate::observed::kSignalCount; ++i) {
    const base::WithoutPower expected = i == derate::observed::ambient     ? base::WithoutPower::hottest_air
                                        : i == derate::observed::neighbour ? base::WithoutPower::winding_limit
                                        : i == derate::observed::age       ? base::WithoutPower::any
                                                                           : base::WithoutPower::zero;
    if (derate::observed::firmware_of(i).without_power != expected) {
      return false;
    }
  }
  return true;
}
static_assert(has_values_without_power(), "an input that is not 0 without power needs its value in the drive core");

std::vector<float> single(const std::vector<double>& values) {
  std::vector<float> rounded(values.size());
  std::ranges::transform(values, rounded.begin(), [](double value) { return static_cast<float>(value); });
  return rounded;
}

heatsoak_axis axis(const std::vector<float>& points) { return {points.data(), static_cast<std::int32_t>(points.size())}; }

}  // namespace

HostGuard::Law::Law(const derate::Observer& observer)
    : run(observer.formula(), observer.rate_steps()),
      values(derate::observed::kSignalCount + observer.state_count()),
      rates_K_per_s(observer.state_count()) {}

HostGuard::HostGuard(const derate::Derating& derating)
    : speed_rad_per_s_(single(derating.table.speed_rad_per_s)),
      stator_C_(single(derating.table.stator_C)),
      winding_C_(single(derating.table.winding_C)),
      heat_per_ohm_A2_(single(derating.table.heat_per_ohm_A2)),
      law_(derating.observer) {
  if (derating.observer.state_count() > robot_core::kMostGuardNodes) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("{}: the thermal network has {} nodes; the drive core's guard takes at most {}: remove nodes from the motor's file",
                    derating.motor_id, derating.observer.state_count(), robot_core::kMostGuardNodes));
  }
  model_.node_count = static_cast<int>(derating.observer.state_count());
  model_.period_s = static_cast<float>(derating.options.period_s);
  model_.winding_limit_C = static_cast<float>(derating.rules.limits.winding_C);
  model_.coldest_ambient_C = static_cast<float>(derating.options.coldest_ambient_C);
  model_.hottest_ambient_C = static_cast<float>(derating.rules.hottest_ambient_C);
  model_.most_current_A = static_cast<float>(derating.rules.most_current_A);
  const derate::CurrentTable& table = derating.table;
  model_.cold_current_A = table.allowed_A(0.0F, static_cast<float>(table.stator_C.front()), static_cast<float>(table.winding_C.front()));
  model_.heat_ratio = static_cast<float>(derating.observer.heat_safety_factor());
  std::ranges::copy(single(derate::resting_C(derating, derating.observer.rate_steps())), model_.resting_C);
  model_.table.resistance_at_0C_ratio = static_cast<float>(table.resistance_at_0C_ratio);
  model_.table.resistance_ratio_per_K = static_cast<float>(table.resistance_ratio_per_K);
  model_.table.most_current_A = static_cast<float>(table.most_current_A);
  model_.table.straight_below_A = static_cast<float>(table.straight_below_A);
  model_.table.most_speed_rad_per_s = static_cast<float>(table.most_speed_rad_per_s);
  model_.table.no_current_speed_rad_per_s = static_cast<float>(table.no_current_speed_rad_per_s);
  model_.table.winding_per_stator_K = static_cast<float>(table.winding_per_stator_K);
  for (std::size_t i = 0; i < plausible_ranges_.size(); ++i) {
    plausible_ranges_[i] = derate::plausible_range(derating, static_cast<derate::observed::Signal>(i));
  }
  model_.rates = &HostGuard::rates;
  point_to_own();
}

HostGuard::HostGuard(const HostGuard& other)
    : model_(other.model_),
      speed_rad_per_s_(other.speed_rad_per_s_),
      stator_C_(other.stator_C_),
      winding_C_(other.winding_C_),
      heat_per_ohm_A2_(other.heat_per_ohm_A2_),
      plausible_ranges_(other.plausible_ranges_),
      law_(other.law_) {
  point_to_own();
}

HostGuard& HostGuard::operator=(const HostGuard& other) {
  if (this != &other) {
    model_ = other.model_;
    speed_rad_per_s_ = other.speed_rad_per_s_;
    stator_C_ = other.stator_C_;
    winding_C_ = other.winding_C_;
    heat_per_ohm_A2_ = other.heat_per_ohm_A2_;
    plausible_ranges_ = other.plausible_ranges_;
    law_ = other.law_;
    point_to_own();
  }
  return *this;
}

void HostGuard::point_to_own() {
  model_.table.speed_rad_per_s = axis(speed_rad_per_s_);
  model_.table.stator_C = axis(stator_C_);
  model_.table.winding_C = axis(winding_C_);
  model_.table.heat_per_ohm_A2 = heat_per_ohm_A2_.data();
  for (std::size_t i = 0; i < plausible_ranges_.size(); ++i) {
    const derate::PlausibleRange& from = plausible_ranges_[i];
    model_.plausible_range[i] = {from.is_used, from.low, from.high, from.values.data(), static_cast<int>(from.values.size())};
  }
  model_.context = &law_;
}

void HostGuard::rates(const void* context, const float* signals, const float* state_C, float* rate_K_per_s) {
  // The cast is valid, because the context is always the `mutable` law of a HostGuard.
  Law& law = *const_cast<Law*>(static_cast<const Law*>(context));
  std::copy_n(signals, derate::observed::kSignalCount, law.values.begin());
  std::copy_n(state_C, law.rates_K_per_s.size(), law.values.begin() + derate::observed::kSignalCount);
  law.run.run(law.values, law.rates_K_per_s);
  std::ranges::copy(law.rates_K_per_s, rate_K_per_s);
}

}  // namespace heatsoak::firmware
