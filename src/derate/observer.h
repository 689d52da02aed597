// Thermal observer of the firmware: the motor's network traced into straight-line arithmetic, and its time step.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "motor/motor.h"
#include "robot/robot.h"
#include "robot_core/thermal_guard.h"
#include "thermal/lanes.h"
#include "thermal/network.h"
#include "thermal/operating_point.h"
#include "thermal/traced.h"

namespace heatsoak::derate {

/// Inputs of the observer: the rows of base::kSignals that have a FirmwareInput, in the order of the drive core and of the formula's first
/// inputs. thermal::Signal enumerates other signals: those of a log.
namespace observed {
using Signal = robot_core::GuardSignal;
inline constexpr std::size_t kSignalCount = robot_core::kGuardSignals;
inline constexpr Signal current = robot_core::guard_current_A;
inline constexpr Signal speed = robot_core::guard_speed_rad_per_s;
inline constexpr Signal ambient = robot_core::guard_ambient_C;
inline constexpr Signal vehicle_speed = robot_core::guard_vehicle_speed_m_per_s;
inline constexpr Signal neighbour = robot_core::guard_neighbour_C;
inline constexpr Signal age = robot_core::guard_age_h;
inline constexpr Signal acceleration = robot_core::guard_acceleration_rad_per_s2;

#define HEATSOAK_FIELD_NAME(field) #field,
inline constexpr std::array<std::string_view, kSignalCount> kFields{ROBOT_CORE_GUARD_SIGNALS(HEATSOAK_FIELD_NAME)};
#undef HEATSOAK_FIELD_NAME
/// Row of base::kSignals for each input.
inline constexpr std::array kRows = [] {
  std::array<std::size_t, kSignalCount> rows{};
  for (std::size_t i = 0; i < kSignalCount; ++i) {
    const auto found =
        std::ranges::find_if(base::kSignals, [i](const base::SignalRow& row) { return row.firmware && row.firmware->field == kFields[i]; });
    rows[i] = static_cast<std::size_t>(found - base::kSignals.begin());
  }
  return rows;
}();
static_assert(std::ranges::count_if(base::kSignals, [](const base::SignalRow& row) { return row.firmware.has_value(); }) == kSignalCount &&
                  std::ranges::find(kRows, base::kSignals.size()) == kRows.end(),
              "each input of the firmware has a row in base/signal_table.h and a name in robot_core/thermal_guard.h");

/// Row of an input.
constexpr const base::SignalRow& row_of(std::size_t signal) { return base::kSignals[kRows[signal]]; }
constexpr const base::FirmwareInput& firmware_of(std::size_t signal) { return *row_of(signal).firmware; }

struct SignalSpec {
  std::string_view name;     ///< field name in generated code
  std::string_view meaning;  ///< description with sign convention
  thermal::WorstCase worst;
  thermal::WithoutPower without_power;
  std::optional<std::size_t> row = {};  ///< row of kQuantities that it sets; current and speed set several
};
std::span<const SignalSpec> signals();
}  // namespace observed

/// Converts the signals to the operating point of the motor's network, S is double, Lanes or Traced. The bus has the voltage of a
/// full battery, if the robot gives one.
template <class S>
thermal::OperatingPoint<S> operating_point(const motor::MotorValues& motor, const robot::Robot& robot,
                                           std::span<const S, observed::kSignalCount> signals);

/// Rates of the network's temperatures as formulas. Generated heat is multiplied by the safety factor `heat_safety_factor` ≥ 1, so that
/// motors worse than nominal are covered; conducted heat is not. Winding and stator are the first states, as in every motor's network.
class Observer {
 public:
  Observer(const thermal::Network& network, const motor::MotorValues& motor, const robot::Robot& robot, double heat_safety_factor);

  [[nodiscard]] const thermal::Formula& formula() const { return formula_; }
  /// Index of the formula step that computes dT/dt in K/s, one per state.
  [[nodiscard]] std::span<const int> rate_steps() const { return rate_steps_; }
  /// Steps of dT/dt without the safety factor on heat: estimates for display, not for protection.
  [[nodiscard]] std::span<const int> nominal_rate_steps() const { return nominal_rate_steps_; }
  [[nodiscard]] std::span<const std::string> state_names() const { return state_names_; }
  [[nodiscard]] std::size_t state_count() const { return state_names_.size(); }
  /// True if a law depends on the signal; always true for current, speed and ambient.
  [[nodiscard]] bool uses(observed::Signal signal) const { return is_used_[static_cast<std::size_t>(signal)] != 0; }
  [[nodiscard]] double heat_safety_factor() const { return heat_safety_factor_; }
  /// Rise of the winding's resistance per kelvin, as a ratio to that at 25 °C.
  [[nodiscard]] double resistance_rise_per_K() const { return resistance_rise_per_K_; }

 private:
  thermal::Formula formula_;
  std::vector<int> rate_steps_;
  std::vector<int> nominal_rate_steps_;
  std::vector<std::string> state_names_;
  std::array<char, observed::kSignalCount> is_used_{};
  double heat_safety_factor_ = 1.0;
  double resistance_rise_per_K_ = 0.0;
};

/// Runs the observer as the generated code does: explicit Euler steps of one period with compensated summation (Kahan 1965). In single
/// precision a step of a slow stator is smaller than the last digit of its temperature. Number is float, double or SingleLanes, whose lanes
/// have the bits of float.
template <class Number>
class ObserverRun {
 public:
  ObserverRun(const Observer& observer, Number period_s, Number start_C);

  /// Advances one period. `signals` are the means over it, in the order of observed::Signal.
  void step(std::span<const Number, observed::kSignalCount> signals);
  [[nodiscard]] std::span<const Number> state_C() const { return state_C_; }
  /// Temperature of the hottest node except the winding: the stator input of the table.
  [[nodiscard]] Number hottest_body_C() const;

 private:
  thermal::FormulaRun<Number> rates_;
  Number period_s_;
  std::vector<Number> state_C_;
  std::vector<Number> carry_K_;
  std::vector<Number> inputs_;
  std::vector<Number> rate_;
};
extern template class ObserverRun<float>;
extern template class ObserverRun<double>;
extern template class ObserverRun<thermal::SingleLanes>;

}  // namespace heatsoak::derate
