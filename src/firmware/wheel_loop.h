// Gains of the drive core's velocity control, from the robot's own time constants.
#pragma once

#include "robot/body.h"

namespace heatsoak::firmware {

/// Plant parameters of the velocity loops; inertias are at the wheel.
struct WheelLoopPlant {
  double back_emf_V_s_per_rad = 0.0;        ///< K_t·n, per wheel speed
  double volt_per_Nm = 0.0;                 ///< R/(K_t·n), per torque at the wheel, without gear loss
  double gear_efficiency = 1.0;             ///< motor to ground
  double wheel_inertia_kg_m2 = 0.0;         ///< inertia of a wheel in the air, rotor included
  double loaded_inertia_kg_m2 = 0.0;        ///< inertia of a wheel on the ground: with its share of the robot's mass
  double hardest_body_inertia_kg_m2 = 0.0;  ///< inertia of the body per wheel in the direction of travel with the largest one
};

/// Computes the plant. J_eff = J_wheel + m·r²·level share (of the mean wheel). The hardest direction has m·r²·λ, λ the larger eigenvalue of
/// the plane part of (JᵀJ)⁻¹ = J⁺·J⁺ᵀ.
WheelLoopPlant wheel_loop_plant(const robot::BodyConfig& body, const robot::DriveConstants& drive);

/// Returns the longest control period for which wheel_loop_gains() gives a useful loop.
double longest_loop_period_s(const WheelLoopPlant& plant);

struct WheelLoopGains {
  double wheel_gain_V_s_per_rad = 0.0;    ///< k_p
  double wheel_integral_V_per_rad = 0.0;  ///< k_i
  double body_gain_per_s = 0.0;
  double yaw_gain_per_s = 0.0;
  double yaw_integral_per_s2 = 0.0;
  double tracking_time_s = 0.0;
  double wheel_rate_per_s = 0.0;  ///< 2·ζ·ω_0 of the loaded wheel's loop
};

/// Computes the gains. Plant of one wheel: τ·dω/dt = V/(K_t·n) − ω with τ = J·R/(η·(K_t·n)²). Control: V = k_p·e + k_i·∫e dt. Closed loop
/// of the loaded wheel:
///   s² + (1 + k_p/(K_t·n))/τ·s + k_i/(τ·K_t·n) = s² + 2·ζ·ω_0·s + ω_0²,   ζ = 1.
/// The delay between motion and voltage is L = 2·T, with the control period T. One period is the computation, half of one the held voltage,
/// and half of one the encoder, which gives the mean speed of the last period. Two bounds set the bandwidth; the lower gain counts:
///  1. Loaded wheel: ω_0·L ≤ 0.2, so that the delay takes at most 2·ω_0·L = 23° of phase at the crossover.
///  2. Wheel in the air, or one that slides: its inertia is J_wheel alone. The loop gain is κ = k_p·T/(J_wheel·R/(K_t·n)). With
///     the delays above, the loop of an integrator is z²·(z − 1) + κ·(z + 1)/2. It oscillates at κ_u = 2·tan(π/8) = 0.828, with a
///     frequency of π/4 per period. k_p is at most that of κ_u/3 (gain margin 3), and at most κ_u/2 with the body loop on top, which sees
///     the same wheels.
/// k_i follows from ω_0 = (1 + k_p/(K_t·n))/(2·ζ·τ).
/// The body loop closes over the wheels' speeds through the feed-forward m·a: it adds κ_b = b·T·(m·r²·λ + J_wheel)/J_wheel in the air. b is
/// a quarter of the wheel loop's rate 2·ζ·ω_0, or the rest up to κ_u/2, if that is less. The yaw loop closes over the gyro, which does not
/// respond to a wheel in the air. Its gain is half of the wheel loop's rate, its integral a quarter of the gain's square (double pole).
/// Back-calculation: a fifth of k_p/k_i, five periods at least.
/// A light wheel may allow a gain below its back-EMF constant K_t·n. The margins hold, and the integrator still removes the error.
/// Throws Failure (bad_input) if the period is so long that k_p would be less than half of K_t·n: then the loop adds too little.
WheelLoopGains wheel_loop_gains(const WheelLoopPlant& plant, double period_s);

}  // namespace heatsoak::firmware
