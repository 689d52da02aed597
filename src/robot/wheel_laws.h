// Laws of the plant evaluated for all wheels at once. Only .cpp files include it: it needs Eigen.
#pragma once

#include <array>
#include <limits>

#include "base/copper.h"
#include "robot/driver.h"
#include "robot/friction.h"
#include "robot/traction.h"
#include "robot/wheels.h"

namespace heatsoak::robot {

/// Returns the loads in N, linear in the contact position. A negative load means that the wheel lifts off: see normal_loads().
inline Wheels plane_loads_N(const WeightConfig& weight, const LoadMoment& moment) {
  return as_wheels(weight.level_share) * (weight.mass_kg * kGravity_m_per_s2) + as_wheels(weight.along_x_per_m) * moment.x_Nm +
         as_wheels(weight.along_y_per_m) * moment.y_Nm;
}

/// Returns the magnitude of each wheel's dry friction torque in N m: wheel_torque_Nm, or the curve over the direction of travel.
Wheels dry_friction_Nm(const FrictionConfig& friction, const WheelArrays& wheels, const BodyVelocity& local);

/// Returns the friction torque of each wheel in N m, with the sign of its speed: subtract it from the driving torque. `dry_Nm` is
/// dry_friction_Nm(), `sign` is smooth_sign() of the speed.
inline Wheels friction_torque_Nm(const FrictionConfig& friction, const Wheels& dry_Nm, const Wheels& sign, const Wheels& speed_rad_per_s) {
  return dry_Nm * sign + friction.wheel_damping_Nm_s_per_rad * speed_rad_per_s;
}

/// Electrical constants of the motors of all wheels at their temperatures.
struct MotorCircuits {
  Wheels torque_constant_Nm_per_A;
  Wheels winding_ohm;     ///< resistance that gives the copper loss, heating factor included
  Wheels resistance_ohm;  ///< winding plus driver
  Wheels conductance_S;   ///< 1/resistance_ohm
};
inline MotorCircuits motor_circuits(const MotorElectrics& motor, const DriverConfig& driver, const Wheels& winding_C,
                                    const Wheels& magnet_C) {
  MotorCircuits made;
  made.torque_constant_Nm_per_A =
      motor.torque_constant_25C_Nm_per_A * (1.0 - motor.torque_constant_fall_per_K * (magnet_C - base::kSheetTemperature_C));
  made.winding_ohm = motor.heating_factor * motor.resistance_25C_ohm *
                     base::resistance_ratio<Wheels>(Wheels::Constant(motor.resistance_rise_per_K), winding_C);
  made.resistance_ohm = made.winding_ohm + driver.resistance_ohm;
  made.conductance_S = 1.0 / made.resistance_ohm;
  return made;
}

/// Commands and limits of all wheels as numbers, so that motor_currents() needs no branch per wheel. An open motor or a missing wheel is a
/// current command of 0 without a voltage limit.
struct DriverDemands {
  Wheels voltage_V;        ///< 0 if the command is not a voltage
  Wheels current_A;        ///< 0 if the command is not a current
  Wheels voltage_share;    ///< 1 if the command is a voltage, else 0
  Wheels voltage_limit_V;  ///< limit of the command; infinite if open
  Wheels beyond_bus_V;     ///< 0 if the bus voltage is a limit, infinite if open
  Wheels current_limit_A;  ///< 0 if open
};
inline DriverDemands driver_demands(const DriverConfig& driver, const std::array<MotorCommand, kMostWheels>& command, int wheel_count) {
  constexpr double kNone_V = std::numeric_limits<double>::infinity();
  const auto is = [&](int i, MotorCommand::Kind kind) { return i < wheel_count && command[i].kind == kind; };
  const auto is_open = [&](int i) { return i >= wheel_count || command[i].kind == MotorCommand::Kind::open; };
  // Wheels are assembled in registers, because loading a vector just after scalar stores is slow.
  const auto of_all = [](const auto& of) { return Wheels(of(0), of(1), of(2), of(3)); };
  return {of_all([&](int i) { return is(i, MotorCommand::Kind::voltage) ? command[i].value : 0.0; }),
          of_all([&](int i) { return is(i, MotorCommand::Kind::current) ? command[i].value : 0.0; }),
          of_all([&](int i) { return is(i, MotorCommand::Kind::voltage) ? 1.0 : 0.0; }),
          of_all([&](int i) { return is_open(i) ? kNone_V : driver.voltage_limit_V; }),
          of_all([&](int i) { return is_open(i) ? kNone_V : 0.0; }),
          of_all([&](int i) { return is_open(i) ? 0.0 : driver.current_limit_A; })};
}

/// Returns true if any motor gets less than its command.
bool is_limited(const DriverDemands& demands, const Wheels& limit_V, const Wheels& wanted_A, const Wheels& within_A,
                const Wheels& current_A);

struct MotorCurrents {
  Wheels current_A;
  Wheels bridge_V;
  bool limited = false;  ///< true if any motor is limited by the bus, the limit of its command or the current limit
};

/// Returns the steady-state currents; the electrical time constant L/R is below a millisecond. I = (U − K_t·ω)/(R(T)·k + R_driver) with the
/// heating factor k, so that U·I = copper + driver conduction + K_t·ω·I holds to rounding error. |U| ≤ min(bus, voltage limit), |I| ≤
/// current limit.
inline MotorCurrents motor_currents(const MotorCircuits& circuits, const DriverDemands& demands, const Wheels& back_emf_V, double bus_V) {
  const Wheels limit_V = (demands.beyond_bus_V + bus_V).min(demands.voltage_limit_V);
  const Wheels asked_V = demands.voltage_V.max(-limit_V).min(limit_V);
  const Wheels wanted_A = demands.current_A + demands.voltage_share * (asked_V - back_emf_V) * circuits.conductance_S;
  const Wheels within_A = wanted_A.max(-demands.current_limit_A).min(demands.current_limit_A);
  const Wheels needed_V = within_A * circuits.resistance_ohm + back_emf_V;
  MotorCurrents made;
  made.bridge_V = needed_V.max(-limit_V).min(limit_V);
  made.current_A = (made.bridge_V - back_emf_V) * circuits.conductance_S;
  // Rounding errors alone can put needed_V above the limit, so is_limited() decides.
  const bool may_be_limited =
      (demands.voltage_V.abs() - limit_V).max((within_A - wanted_A).abs()).max(needed_V.abs() - limit_V).maxCoeff() > 0.0;
  made.limited = may_be_limited && is_limited(demands, limit_V, wanted_A, within_A, made.current_A);
  return made;
}

}  // namespace heatsoak::robot
