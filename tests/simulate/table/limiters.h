// Alternatives to the thermal guard. Each is a robot_core::GuardModel, so the same drive core and the same limit stage run it.
#pragma once

#include <memory>
#include <vector>

#include "firmware/core_config.h"
#include "firmware/host_guard.h"

namespace heatsoak::simulate::studies {

/// Derating of the nominal motor with a given safety factor on heat: no tolerances, no check on drawn motors. With a factor of 1 it is
/// exact for this motor.
derate::Derating derating_with(double heat_factor, const motor::Motor& motor, const robot::Robot& robot);

/// Overload data of a data sheet for an I²t limiter.
struct Overload {
  double continuous_A = 0.0;
  double peak_A = 0.0;
  double peak_s = 0.0;

  [[nodiscard]] double budget_A2_s() const { return (peak_A * peak_A - continuous_A * continuous_A) * peak_s; }
};
/// Calculates the overload data. continuous_A: nominal current or, if the data sheet has none, nominal torque/K_t + no-load current.
/// peak_A: stall current U/R, because maxon's data sheets state no other. peak_s: maxon's overload rule from a cold winding, τ_w·ln(K²/(K²
/// − 1)) with K = peak_A/continuous_A.
Overload overload_of(const motor::MotorValues& motor);

/// One limiter of one true motor. Its winding and stator temperatures come from the true motor's network with the sensed current, like a
/// sensor without lag or error. Currents hold for the true motor's resistance, as with a current-controlling driver. Not movable, because
/// its model points into it. Use by one thread at a time.
class Limiter {
 public:
  /// Constant current limit.
  static std::unique_ptr<Limiter> fixed_cap(const derate::Derating& exact, double resistance_ratio, double cap_A);
  /// Full current up to a stator temperature of `full_C`, none from `none_C` on, linear between.
  static std::unique_ptr<Limiter> stator_ramp(const derate::Derating& exact, double resistance_ratio, double full_C, double none_C);
  /// dE/dt = I² − I_continuous², E ≥ 0. Full current up to 90 % of the budget, continuous current at 100 %, linear between.
  static std::unique_ptr<Limiter> i_squared_t(const derate::Derating& exact, double resistance_ratio, const Overload& overload);
  /// The guard from a derating: an oracle if it is that of the true motor.
  static std::unique_ptr<Limiter> guard(const derate::Derating& derating, double resistance_ratio, double braking_reserve_K);

  Limiter(const Limiter&) = delete;
  Limiter& operator=(const Limiter&) = delete;

  /// Returns the configuration of a core that knows the motor as `known`. It is valid only while the limiter exists.
  [[nodiscard]] robot_core::Config config(const robot::Robot& robot, const motor::Motor& known) const;

 private:
  Limiter(const derate::Derating& exact, double resistance_ratio);
  /// Sets a table that depends on the second node only.
  void set_table(const std::vector<float>& body, const std::vector<double>& current_A);
  static void overload_rates(const void* context, const float* signal, const float* state_C, float* rate_K_per_s);

  derate::Derating exact_;
  firmware::HostGuard motor_;
  robot_core::GuardModel model_;
  double resistance_ratio_;  ///< true resistance divided by the known one
  double braking_reserve_K_ = 0.0;
  std::vector<float> speed_rad_per_s_;
  std::vector<float> body_;
  std::vector<float> winding_C_;
  std::vector<float> square_A2_;
  float continuous_squared_A2_ = 0.0F;
  float fill_per_A2_s_ = 0.0F;
};

}  // namespace heatsoak::simulate::studies
