// Operating point of the machine: every quantity that a thermal law may depend on.
#pragma once

#include <limits>

namespace heatsoak {

/// Means over one interval, chosen so that intervals can be merged without changing the heat: I²R uses the RMS current, a loss ∝ |ω| the
/// mean speed, one ∝ ω² the RMS speed. Products such as |I|·ω² use the product of the means. That is accurate if the interval is short
/// compared with load changes, like the rows of a log.
template <class S>
struct OperatingPoint {
  S current_rms_A = S(0.0);  ///< equivalent DC current at the terminals: I² times the resistance of two phases in series is the heat
  S speed_mean_rad_per_s = S(0.0);  ///< mean of |ω|, motor shaft
  S speed_rms_rad_per_s = S(0.0);   ///< root mean square of ω, motor shaft
  S ambient_C = S(25.0);
  /// Voltage available for I·R after the back-EMF, scaled by the heating factor of the current. As the winding heats up and its resistance
  /// rises, it limits the current. Infinite: no voltage limit.
  S resistive_headroom_V = S(std::numeric_limits<double>::infinity());
  S series_resistance_ohm = S(0.0);    ///< of driver and leads; they share that voltage, but their heat goes elsewhere
  S shaft_power_W = S(0.0);            ///< mean of M·ω: positive drives, negative brakes
  S input_power_W = S(0.0);            ///< electrical power into the motor (or into its driver, if the log says so)
  S bus_V = S(0.0);                    ///< supply voltage of the driver
  S modulation_ratio = S(0.0);         ///< mean of |terminal voltage| / supply voltage, 0 to 1
  S vehicle_speed_m_per_s = S(0.0);    ///< mean of the speed's magnitude
  S neighbour_C = S(25.0);             ///< temperature of the neighbouring motor; valid if neighbour_share is 1
  S neighbour_share = S(0.0);          ///< 1 if neighbour_C is known, else 0
  S unlogged_speed_share = S(0.0);     ///< 1 if the machine may turn at a speed that was not logged, else 0
  S age_h = S(0.0);                    ///< operating hours so far
  S velocity_rad_per_s = S(0.0);       ///< signed mean of ω, motor shaft; a log of |ω| does not provide the sign
  S acceleration_rad_per_s2 = S(0.0);  ///< mean of |dω/dt|, motor shaft
  S column = S(0.0);                   ///< column of a log in its own unit: the abscissa of a tabulated curve over no signal above
  S column_share = S(0.0);             ///< 1 if `column` is known, else 0
  S copper_loss_W = S(0.0);            ///< copper loss of the network, which sets it before it evaluates the other laws
};

/// Calls f for each quantity, with that quantity of all given points as arguments.
template <class F, class... Point>
constexpr void for_each_quantity(F&& f, Point&... at) {
  f(at.current_rms_A...);
  f(at.speed_mean_rad_per_s...);
  f(at.speed_rms_rad_per_s...);
  f(at.ambient_C...);
  f(at.resistive_headroom_V...);
  f(at.series_resistance_ohm...);
  f(at.shaft_power_W...);
  f(at.input_power_W...);
  f(at.bus_V...);
  f(at.modulation_ratio...);
  f(at.vehicle_speed_m_per_s...);
  f(at.neighbour_C...);
  f(at.neighbour_share...);
  f(at.unlogged_speed_share...);
  f(at.age_h...);
  f(at.velocity_rad_per_s...);
  f(at.acceleration_rad_per_s2...);
  f(at.column...);
  f(at.column_share...);
  f(at.copper_loss_W...);
}

/// Signals, other than temperatures, that a law may need. A log without one of them holds no evidence about the law. The copper loss is
/// computed from the current; velocity and acceleration need the speed.
enum class Signal { current, speed, shaft_power, input_power, modulation, bus_voltage, vehicle_speed, neighbour_temperature, age };

}  // namespace heatsoak
