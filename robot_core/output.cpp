// Stage 7: output for the firmware.
#include "robot_core/drive_stages.h"

namespace robot_core {
namespace {

/// The guards check their State when they are stepped. Until then a flipped bit must not put NaN into the telemetry.
[[gnu::cold, gnu::noinline]] float bounded_C(const Config& config, float winding_C) {
  constexpr float kMost_C = 1000.0F;
  const float limit_C = config.guard != nullptr ? config.guard->winding_limit_C : 0.0F;
  return winding_C <= kMost_C && winding_C >= -kMost_C ? winding_C : limit_C;
}

float reported_C(const Config& config, float winding_C) {
  // Positive floats are ordered like their bits, so one integer comparison finds all values that need bounded_C().
  constexpr auto kMost = __builtin_bit_cast(std::uint32_t, 1000.0F);
  return __builtin_bit_cast(std::uint32_t, winding_C) <= kMost ? winding_C : bounded_C(config, winding_C);
}

}  // namespace

void make_output(const Config& config, const State& state, const Validated& validated, const LimitedVoltages& limited, Output& out) {
  // Times are not negative, and such floats are ordered like their bits. A sign that has flipped counts as a long time.
  auto time_to_limit = __builtin_bit_cast(std::uint32_t, kLongTime_s);
  const float per_battery_V = 1.0F / validated.pwm_battery_V;
  for (int i = 0; i < config.wheel_count; ++i) {
    const LimitedWheel& wheel = limited.wheel[i];
    const GuardState& guard = state.guard[i];
    out.is_open[i] = wheel.is_open;
    out.voltage_V[i] = wheel.voltage_V;
    const float pwm_ratio = wheel.voltage_V * per_battery_V;
    out.pwm_ratio[i] = absolute(pwm_ratio) > 1.0F ? clamped(pwm_ratio, -1.0F, 1.0F) : pwm_ratio;
    out.reason[i] = wheel.reason;
    out.allowed_current_A[i] = wheel.allowed_A;
    out.winding_C[i] = reported_C(config, guard.state_C[0]);
    const auto of_guard = __builtin_bit_cast(std::uint32_t, guard.time_to_limit_s);
    time_to_limit = of_guard < time_to_limit ? of_guard : time_to_limit;
  }
  for (int i = config.wheel_count; i < kMostWheels; ++i) {
    out.voltage_V[i] = out.pwm_ratio[i] = out.allowed_current_A[i] = out.winding_C[i] = 0.0F;
    out.reason[i] = Reason::none;
    out.is_open[i] = true;
  }
  // An estimate is up to 0.13 s old, and a current can rise faster: 0 if any byte of the reasons is that of the guard.
  std::uint32_t reasons = 0;
  static_assert(sizeof(out.reason) == sizeof(reasons));
  __builtin_memcpy(&reasons, out.reason, sizeof(reasons));
  reasons ^= 0x01010101U * static_cast<std::uint32_t>(Reason::guard);
  time_to_limit = ((reasons - 0x01010101U) & ~reasons & 0x80808080U) != 0 ? 0 : time_to_limit;
  out.time_to_guard_limit_s = config.guard == nullptr ? kLongTime_s : __builtin_bit_cast(float, time_to_limit);
  out.is_warning = out.time_to_guard_limit_s < config.warning_time_s;
  out.robot_reason = validated.robot_fault != Reason::none ? validated.robot_fault : validated.command_fault;
}

}  // namespace robot_core
