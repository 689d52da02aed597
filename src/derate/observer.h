// What runs in the firmware beside the motor: its thermal network, traced into straight-line arithmetic, and one step of it.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "motor/motor.h"
#include "robot/motor_drive.h"
#include "robot/robot.h"
#include "thermal/network.h"
#include "thermal/traced.h"

namespace heatsoak {

/// What the firmware tells its observer, in the order of the formula's first inputs.
namespace firmware {
enum Signal : int { current, speed, ambient, vehicle_speed, neighbour, age, acceleration };
struct SignalSpec {
  std::string_view name;     ///< of the field
  std::string_view meaning;  ///< with sign
};
std::span<const SignalSpec> signals();
inline constexpr std::size_t kSignalCount = 7;
}  // namespace firmware

/// What the motor's network sees of the signals, for numbers and for formulas: the battery is full.
template <class S>
OperatingPoint<S> operating_point(const MotorValues& motor, const Robot& robot, std::span<const S, firmware::kSignalCount> signals) {
  const S& current_A = signals[firmware::current];
  const S& speed_rad_per_s = signals[firmware::speed];
  const S shaft_power_W = motor.torque_constant_Nm_per_A * current_A * speed_rad_per_s - drag_torque_Nm(motor) * magnitude(speed_rad_per_s);
  OperatingPoint<S> at = machine_point<S>(motor, robot, current_A, speed_rad_per_s, shaft_power_W);
  at.ambient_C = signals[firmware::ambient];
  at.vehicle_speed_m_per_s = signals[firmware::vehicle_speed];
  at.neighbour_C = signals[firmware::neighbour];
  at.neighbour_share = 1.0;
  at.age_h = signals[firmware::age];
  at.acceleration_rad_per_s2 = signals[firmware::acceleration];
  if (!std::isnan(robot.battery_full_V)) {
    at.bus_V = robot.battery_full_V;
  }
  return at;
}

/// Heat that is made counts `heat_reserve_ratio` times (≥ 1), so that a motor worse than its nominal figures is covered; heat that
/// moves does not. Winding and stator are the first states, as in every motor's network.
class Observer {
 public:
  Observer(const Network& network, const MotorValues& motor, const Robot& robot, double heat_reserve_ratio);

  [[nodiscard]] const Formula& formula() const { return formula_; }
  /// One step of the formula per state: dT/dt in K/s.
  [[nodiscard]] std::span<const int> rate_steps() const { return rate_steps_; }
  /// The same of the nominal motor, whose heat counts once: temperatures to show, not to guard by.
  [[nodiscard]] std::span<const int> nominal_rate_steps() const { return nominal_rate_steps_; }
  [[nodiscard]] std::span<const std::string> state_names() const { return state_names_; }
  [[nodiscard]] std::size_t state_count() const { return state_names_.size(); }
  /// Whether a law looks at it; the first three always count as used.
  [[nodiscard]] bool uses(firmware::Signal signal) const { return is_used_[static_cast<std::size_t>(signal)] != 0; }
  [[nodiscard]] double heat_reserve_ratio() const { return heat_reserve_ratio_; }

 private:
  Formula formula_;
  std::vector<int> rate_steps_;
  std::vector<int> nominal_rate_steps_;
  std::vector<std::string> state_names_;
  std::array<char, firmware::kSignalCount> is_used_{};
  double heat_reserve_ratio_ = 1.0;
};

/// The observer at work, as the generated code does it: explicit Euler steps of one period with the rounding of each step carried to the
/// next (Kahan 1965), for in single precision a step of a slow stator is less than the last digit of its temperature.
template <class Number>
class ObserverRun {
 public:
  ObserverRun(const Observer& observer, Number period_s, Number start_C);

  /// Over one period; `signals` are its means, in the order of firmware::Signal.
  void step(std::span<const Number, firmware::kSignalCount> signals);
  [[nodiscard]] std::span<const Number> state_C() const { return state_C_; }
  /// Of the hottest node but the winding: what the table takes for the stator.
  [[nodiscard]] Number hottest_body_C() const;

 private:
  FormulaRun<Number> rates_;
  Number period_s_;
  std::vector<Number> state_C_;
  std::vector<Number> carry_K_;
  std::vector<Number> inputs_;
  std::vector<Number> rate_;
};
extern template class ObserverRun<float>;
extern template class ObserverRun<double>;

}  // namespace heatsoak
