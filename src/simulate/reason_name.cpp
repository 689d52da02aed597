#include "simulate/reason_name.h"

#include <algorithm>
#include <iterator>

namespace heatsoak::simulate {
namespace {

using robot_core::Reason;

struct NamedReason {
  Reason reason = Reason::none;
  std::string_view name;
};
constexpr NamedReason kNames[] = {
    {Reason::none, "none"},
    {Reason::voltage, "voltage"},
    {Reason::driver_current, "driver_current"},
    {Reason::battery_sag, "battery_sag"},
    {Reason::traction, "traction"},
    {Reason::guard, "guard"},
    {Reason::other_wheel, "other_wheel"},
    {Reason::slip, "slip"},
    {Reason::unchecked, "unchecked"},
    {Reason::sensed_current, "sensed_current"},
    {Reason::config_invalid, "config_invalid"},
    {Reason::state_corrupted, "state_corrupted"},
    {Reason::period_invalid, "period_invalid"},
    {Reason::time_jump, "time_jump"},
    {Reason::command_invalid, "command_invalid"},
    {Reason::command_stale, "command_stale"},
    {Reason::pose_invalid, "pose_invalid"},
    {Reason::wheel_speed_missing, "wheel_speed_missing"},
    {Reason::wheel_speed_jump, "wheel_speed_jump"},
    {Reason::wheel_speed_stuck, "wheel_speed_stuck"},
    {Reason::wheel_speed_swapped, "wheel_speed_swapped"},
    {Reason::wheel_speed_unknown, "wheel_speed_unknown"},
    {Reason::wheel_speeds_dead, "wheel_speeds_dead"},
    {Reason::runaway, "runaway"},
    {Reason::wheel_speed_wrong, "wheel_speed_wrong"},
    {Reason::current_missing, "current_missing"},
    {Reason::current_implausible, "current_implausible"},
    {Reason::battery_voltage_missing, "battery_voltage_missing"},
    {Reason::yaw_rate_missing, "yaw_rate_missing"},
    {Reason::yaw_rate_stuck, "yaw_rate_stuck"},
    {Reason::ambient_missing, "ambient_missing"},
    {Reason::stator_missing, "stator_missing"},
    {Reason::guard_unknown, "guard_unknown"},
};

}  // namespace

std::string_view to_string(Reason reason) {
  const auto* const found = std::ranges::find(kNames, reason, &NamedReason::reason);
  return found == std::end(kNames) ? "unknown" : found->name;
}

}  // namespace heatsoak::simulate
