// A motor without power, as the guard assumes it: no current, and the worst surroundings for as long as it lasts.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "derate/derating.h"

namespace heatsoak::derate {

/// Returns the inputs of the observer without power, in the order of observed::Signal, as FirmwareInput::without_power states them.
/// Current, speed and airflow are 0, the air is the hottest, and the neighbour is at the winding limit. The age is 0 here; callers set it
/// to each of ages_without_power_h().
std::array<double, observed::kSignalCount> signals_without_power(const Derating& derating);

/// Possible ages of the motor in h. Whether a high or a low one is worse depends on the law and on the node, so each node takes the largest
/// rate over all of them. Empty if no law depends on the age.
std::vector<float> ages_without_power_h(const Derating& derating);

/// Returns temperatures in °C, one per node, to which the motor cools without power: its steady state, rounded up by kRounding_K. A
/// restored guard uses them for time that it does not simulate. They are upper bounds: if no node is more than c K above its value (c ≥ 0),
/// none will be later. If the laws of the motor do not ensure this, the rise over the air is enlarged until they do; if that does not
/// help, the result is the winding limit. `rate_steps`: the observer's rates with or without the safety factor on heat.
std::vector<double> resting_C(const Derating& derating, std::span<const int> rate_steps);

/// Largest number of steps of a generated restore: cool-down in Runge-Kutta steps, and heating of unsaved time in periods of the guard.
inline constexpr int kMostCoolingSteps = 1024;
inline constexpr int kMostHeatingSteps = 4096;

/// Allowed current at standstill in the hottest air after one kind of power loss.
struct PowerOffCase {
  std::string_view name;          ///< "2 s without power"
  std::optional<double> off_s;    ///< known time without power; empty: unknown, or nothing could be restored
  std::vector<double> allowed_A;  ///< at each of kPowerOffMoments_s after power-on
};
inline constexpr std::array kPowerOffMoments_s{1.0, 10.0, 60.0};

struct PowerOffReport {
  std::vector<double> start_C;  ///< every node before the loss of power: its hottest steady state at the full allowed current
  std::vector<PowerOffCase> cases;
};
/// Returns the current that the guard allows after each kind of power loss: none, 2 s, an unknown time, and a damaged buffer. The
/// guard treats a damaged buffer like a motor at its limit. Assumes that the state is saved at the moment of the loss, and that the board
/// has no sensor.
PowerOffReport power_off_report(const Derating& derating);

/// Larger than the last digit of a temperature in single precision and in the integer form.
inline constexpr double kRounding_K = 0.01;

}  // namespace heatsoak::derate
