// Simulated robot for tests of the drive core, written from first principles and independent of src/. Rigid body on three or four omni
// wheels; contacts with creep and limited grip; DC motors without inductance, with a resistance that follows the winding temperature. The
// battery has an internal resistance, and each motor a two-node thermal network.
#pragma once

#include <array>
#include <cstdint>

#include "robot_core/drive_core.h"

namespace heatsoak::test_robot {

using robot_core::kMostWheels;

inline constexpr float kNone = robot_core::kNoSample;
inline constexpr float kNoise_rad_per_s = 0.3F;  ///< largest error of a wheel speed, even distribution

/// Reproducible random numbers (SplitMix64; Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  float between(float low, float high);
  bool happens(float probability) { return between(0.0F, 1.0F) < probability; }
  int below(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }
  /// Returns any bit pattern; one in 256 is NaN.
  float any_float();

 private:
  std::uint64_t state_;
};

/// Commands as on the field: a new velocity every 0.2 to 0.8 s, in periods of 1 ms.
class ChangingVelocity {
 public:
  const robot_core::Vector3& next(Random& random);

 private:
  robot_core::Vector3 velocity_;
  int periods_left_ = 0;
};

/// True parameters of the robot that the Config does not contain, or contains with a tolerance.
struct Truth {
  double winding_ohm = 1.0;      ///< at 25 °C; the lowest resistance within the tolerance is kLowestResistance_ratio of the nominal one
  double driver_ohm = 0.1;       ///< constant, because the driver does not heat up
  double bearing_Nm = 0.012;     ///< friction torque at the wheel
  double viscous_Nm_s = 2.0e-4;  ///< damping at the wheel
  double drag_N = 1.0;           ///< drag of the rollers against the motion of the body
  double grip_ratio = 0.8;       ///< friction coefficient of wheel and carpet
  double creep_m_per_s = 0.04;   ///< slip speed at which the force reaches the grip
  double battery_V = 24.0;       ///< open-circuit voltage
  double winding_J_per_K = 6.0;
  double stator_J_per_K = 40.0;
  double winding_to_stator_K_per_W = 1.5;
  double stator_to_air_K_per_W = 4.0;
  double iron_W_s = 0.004;  ///< iron loss per motor speed
  double air_C = 25.0;
};

inline constexpr double kCopperRise_per_K = 0.00393;
inline constexpr double kLowestResistance_ratio = 0.95;
inline constexpr double kWindingLimit_C = 155.0;
inline constexpr double kSafetyFactor = 1.3;  ///< safety factor on heat of the guard

/// Config of a robot with three or four wheels, mirrored about the x axis. mirror_of() returns the wheel in the mirrored position. The
/// guard's table holds the values of formula_current_A().
robot_core::Config make_config(int wheel_count, bool has_guard = true);
int mirror_of(int wheel_count, int wheel);

/// Allowed current at which both nodes reach at most the winding's limit after kHorizon_s, with the winding's heat capacity.
double formula_current_A(double speed_rad_per_s, double stator_C, double winding_C);

/// Exact steady-state temperatures of winding and stator for a constant heat input to the winding.
struct SteadyState {
  double winding_C = 0.0;
  double stator_C = 0.0;
};
SteadyState steady_state(const Truth& truth, double copper_W, double iron_W);

class Plant {
 public:
  Plant(const robot_core::Config& config, const Truth& truth) : config_(config), truth_(truth) {}

  /// Simulates one period with the core's output. An open bridge carries no current.
  void move(const robot_core::Output& output);
  /// Returns samples of all sensors without faults. `noise_rad_per_s`: bound of the uniform noise of the wheel speeds.
  robot_core::Input sense(Random& random, float noise_rad_per_s, bool are_currents_fitted) const;

  void warm_up(double body_C);
  /// Sets the open-circuit voltage; a load unknown to the core lowers it.
  void set_battery_V(double battery_V) { truth_.battery_V = battery_V; }
  void set_velocity(double x_m_per_s, double y_m_per_s, double yaw_rad_per_s);
  /// External force on the body and moment about its axis, local frame; stays until it is set again.
  void set_push(double x_N, double y_N, double moment_Nm) { push_ = {x_N, y_N, moment_Nm}; }
  double wheel_speed_rad_per_s(int i) const { return speed_[i]; }
  double rolling_speed_rad_per_s(int i) const;             ///< speed of a wheel that does not slip
  double current_A(int i) const { return current_A_[i]; }  ///< mean over the last period
  double winding_C(int i) const { return winding_C_[i]; }
  double stator_C(int i) const { return stator_C_[i]; }
  double battery_V() const { return battery_V_; }
  /// Current that a PWM ratio would drive now through the coldest motor.
  double coldest_current_A(const robot_core::Output& output, int i) const;
  /// The same through this motor, with its resistance at its temperature.
  double true_current_A(const robot_core::Output& output, int i) const;
  double x_m() const { return pose_[0]; }
  double y_m() const { return pose_[1]; }
  double yaw_rad() const { return pose_[2]; }
  double x_m_per_s() const { return velocity_[0]; }
  double y_m_per_s() const { return velocity_[1]; }
  double yaw_rad_per_s() const { return velocity_[2]; }
  /// Largest change of a wheel speed within a period that the contact can cause.
  double contact_change_rad_per_s() const;

 private:
  void turn_wheels(const robot_core::Output& output, double period_s, double* force_N);
  void heat(double period_s);
  double resistance_ohm(int i) const;

  const robot_core::Config& config_;
  Truth truth_;
  std::array<double, 3> push_{};
  double velocity_[3] = {};  ///< local frame, m/s and rad/s
  double pose_[3] = {};
  double speed_[kMostWheels] = {};
  double current_A_[kMostWheels] = {};
  double winding_C_[kMostWheels] = {25.0, 25.0, 25.0, 25.0};
  double stator_C_[kMostWheels] = {25.0, 25.0, 25.0, 25.0};
  double battery_V_ = 24.0;
};

/// Updates the check sum after a test changed the State; see the tests that run a twin of the core.
void seal(robot_core::State& state);

}  // namespace heatsoak::test_robot
