// What the machine does, as far as heat depends on it.
#pragma once

#include <limits>

namespace heatsoak {

/// Means over one interval, so that intervals can be merged without changing heat: I²R takes the rms current, a loss
/// ∝ |ω| the mean, one ∝ ω² the rms. Products of both, such as |I|·ω², are those of the means: exact while the interval is
/// short against changes of the load, as the rows of a log are.
template <class S>
struct OperatingPoint {
  S current_rms_A = S(0.0);         ///< equivalent DC current of the terminals: I²·R of two phases in series is the heat
  S speed_mean_rad_per_s = S(0.0);  ///< mean of |ω|, motor shaft
  S speed_rms_rad_per_s = S(0.0);   ///< root mean square of ω, motor shaft
  S ambient_C = S(25.0);
  /// Voltage that is left for I·R beside the back-EMF, per current that heats: as the winding gets hot and its
  /// resistance rises, less current flows than is asked for. Infinite where voltage is no limit.
  S resistive_headroom_V = S(std::numeric_limits<double>::infinity());
  S series_resistance_ohm = S(0.0);    ///< of the driver and the leads, which share that voltage and heat elsewhere
  S shaft_power_W = S(0.0);            ///< mean of M·ω: positive drives, negative brakes
  S input_power_W = S(0.0);            ///< electrical power that the motor (or its driver, see the log) takes in
  S bus_V = S(0.0);                    ///< supply of the driver
  S modulation_ratio = S(0.0);         ///< mean of |terminal voltage| per supply voltage, 0 … 1
  S vehicle_speed_m_per_s = S(0.0);    ///< mean of the magnitude
  S neighbour_C = S(25.0);             ///< temperature of the motor next to this one, used where neighbour_share is 1
  S neighbour_share = S(0.0);          ///< 1 where neighbour_C is known, else 0
  S unlogged_speed_share = S(0.0);     ///< 1 where the machine may turn at a speed that nobody logged, else 0
  S age_h = S(0.0);                    ///< hours of running behind it
  S velocity_rad_per_s = S(0.0);       ///< signed mean of ω, motor shaft: a log of |ω| alone has none of its sign
  S acceleration_rad_per_s2 = S(0.0);  ///< mean of |dω/dt|, motor shaft
  S column = S(0.0);                   ///< of a log, in its own unit: what a curve over no signal of these is drawn over
  S column_share = S(0.0);             ///< 1 where that is known, else 0
  S copper_loss_W = S(0.0);            ///< heat of the network's copper loss; the network fills it in before other laws are asked
};

/// Calls f with each quantity of the points, one quantity after the other.
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

/// Signals beside temperatures that a law may need; a log that lacks one cannot speak for or against the law. The copper loss
/// needs the current, velocity and acceleration the speed.
enum class Signal { current, speed, shaft_power, input_power, modulation, bus_voltage, vehicle_speed, neighbour_temperature, age };

}  // namespace heatsoak
