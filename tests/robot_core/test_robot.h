// A robot to try the drive core on, written from first principles and independent of src/: a rigid body on three or four omni wheels,
// contacts with creep and limited grip, DC motors without inductance whose resistance follows the winding's temperature, a battery with
// an inner resistance, and the two-node thermal network of each motor.
#pragma once

#include <array>
#include <cstdint>

#include "robot_core/drive_core.h"

namespace heatsoak::test_robot {

using robot_core::kMostWheels;

/// Reproducible numbers (SplitMix64; Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  float between(float low, float high);
  bool happens(float probability) { return between(0.0F, 1.0F) < probability; }
  int below(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }
  /// Any bit pattern, of which one in 256 is no number.
  float any_float();

 private:
  std::uint64_t state_;
};

/// Values of the true robot that the Config does not have, or has with a tolerance.
struct Truth {
  double winding_ohm = 1.0;      ///< at 25 °C; the smallest within the tolerance is kLowestResistance_ratio of the nominal one
  double driver_ohm = 0.1;       ///< not heated
  double bearing_Nm = 0.012;     ///< at the wheel
  double viscous_Nm_s = 2.0e-4;  ///< at the wheel
  double drag_N = 1.0;           ///< of the rollers, against the motion of the body
  double grip_ratio = 0.8;       ///< friction coefficient of wheel and carpet
  double creep_m_per_s = 0.04;   ///< slip speed at which the grip is reached
  double battery_V = 24.0;       ///< open circuit
  double winding_J_per_K = 6.0;
  double stator_J_per_K = 40.0;
  double winding_to_stator_K_per_W = 1.5;
  double stator_to_air_K_per_W = 4.0;
  double iron_W_s = 0.004;  ///< loss per motor speed
  double air_C = 25.0;
};

inline constexpr double kCopperRise_per_K = 0.00393;
inline constexpr double kLowestResistance_ratio = 0.95;
inline constexpr double kWindingLimit_C = 155.0;
inline constexpr double kSafetyFactor = 1.3;  ///< on the guard's heat

/// Three or four wheels, mirrored about the x axis: mirror_of() tells which wheel takes the place of which.
/// The guard's table is that of formula_current_A().
robot_core::Config make_config(int wheel_count, bool has_guard = true);
int mirror_of(int wheel_count, int wheel);

/// Allowed current: of both nodes at the winding's limit after kHorizon_s, the winding's heat capacity taking its part.
double formula_current_A(double speed_rad_per_s, double stator_C, double winding_C);

/// Steady temperatures of winding and stator under a constant heat in the winding: of the network without approximation.
struct SteadyState {
  double winding_C = 0.0;
  double stator_C = 0.0;
};
SteadyState steady_state(const Truth& truth, double copper_W, double iron_W);

class Plant {
 public:
  Plant(const robot_core::Config& config, const Truth& truth) : config_(config), truth_(truth) {}

  /// One period with the core's output; a bridge that is open carries nothing.
  void move(const robot_core::Output& output);
  /// What the sensors show without a fault. `noise_rad_per_s` of the wheel speeds, even distribution.
  robot_core::Input sense(Random& random, float noise_rad_per_s, bool are_currents_fitted) const;

  void warm_up(double body_C);
  /// Open circuit; a load that the core does not know lowers it.
  void set_battery_V(double battery_V) { truth_.battery_V = battery_V; }
  void set_velocity(double x_m_per_s, double y_m_per_s, double yaw_rad_per_s);
  /// External force on the body and moment about its axis, local frame; stays until it is set again.
  void set_push(double x_N, double y_N, double moment_Nm) { push_ = {x_N, y_N, moment_Nm}; }
  double wheel_speed_rad_per_s(int i) const { return speed_[i]; }
  double rolling_speed_rad_per_s(int i) const;             ///< of a wheel that does not slip
  double current_A(int i) const { return current_A_[i]; }  ///< mean of the last period
  double winding_C(int i) const { return winding_C_[i]; }
  double stator_C(int i) const { return stator_C_[i]; }
  double battery_V() const { return battery_V_; }
  /// That a PWM ratio would drive now through the coldest motor.
  double coldest_current_A(const robot_core::Output& output, int i) const;
  double x_m() const { return pose_[0]; }
  double y_m() const { return pose_[1]; }
  double yaw_rad() const { return pose_[2]; }
  double x_m_per_s() const { return velocity_[0]; }
  double y_m_per_s() const { return velocity_[1]; }
  double yaw_rad_per_s() const { return velocity_[2]; }
  /// Largest change of a wheel speed within a period that the contact can force on a wheel.
  double contact_change_rad_per_s() const;

 private:
  void turn_wheels(const robot_core::Output& output, double period_s, double* force_N);
  void heat(double period_s);
  double resistance_ohm(int i) const;

  const robot_core::Config& config_;
  Truth truth_;
  std::array<double, 3> push_{};
  double velocity_[3] = {};  ///< local frame
  double pose_[3] = {};
  double speed_[kMostWheels] = {};
  double current_A_[kMostWheels] = {};
  double winding_C_[kMostWheels] = {25.0, 25.0, 25.0, 25.0};
  double stator_C_[kMostWheels] = {25.0, 25.0, 25.0, 25.0};
  double battery_V_ = 24.0;
};

/// Lets an observer believe values that it was not given, and seals its State; see the tests that run a twin of the core.
void seal(robot_core::State& state);

}  // namespace heatsoak::test_robot
