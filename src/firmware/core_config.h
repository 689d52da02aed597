// The drive core's configuration, from the files of robot and motor and from a derating.
#pragma once

#include <span>
#include <string>

#include "derate/derating.h"
#include "firmware/friction_voltage.h"
#include "firmware/host_guard.h"
#include "firmware/wheel_loop.h"
#include "robot_core/drive_core.h"

namespace heatsoak::firmware {

struct CoreOptions {
  double period_s = 0.001;               ///< between two calls of robot_core::step()
  double coldest_ambient_C = 0.0;        ///< a winding is never colder
  double lowest_resistance_ratio = 1.0;  ///< smallest terminal resistance within the tolerance, divided by the nominal one
  bool has_pose_targets = true;          ///< robot_core::plan_to_pose is linked
  bool shadow_mode = false;              ///< the guard counts what it would limit, and limits nothing
};

/// Returns the options with lowest_resistance_ratio from the tolerance or range of the motor's terminal_resistance, from the default
/// tolerance if the file declares none.
CoreOptions with_tolerance(CoreOptions options, const motor::Motor& motor);

/// Returns the configuration without a guard. The robot's file must have the tables body, wheels, drive, battery, traction and limits, and
/// the motor a rotor inertia. [friction] may be missing as a whole; notes_on() reports it. Throws Failure (bad_input) that names all
/// missing parameters, or the longest possible period if it is too long for the wheel-speed loop (wheel_loop.h).
///
/// The values are calculated as follows:
///   resistance           = R25·k + R_driver, with k = 0.75·1.1² for a sinusoidal current, as in the plant (make_electrics())
///   lowest resistance    = the same with R25·lowest_resistance_ratio·(1 + α·(coldest air − 25 °C))
///   gear efficiency      = gear times rolling efficiency, from motor to ground
///   fastest wheel        = 1.1·U_full/(K_t·n), with the voltage of a full battery; a push adds the 10 %, as in barrier_rules()
///   current limit        = that of the driver; without one, the largest current that battery and back-EMF can drive together:
///                          (U + K_t·n·fastest wheel)/lowest resistance, with U the smaller of full battery and voltage limit
///   largest acceleration = K_t·n·current limit/(η·J_wheel), of a braking wheel in the air, where the gear's loss helps
///   traction             = √(μ² − c²), with friction coefficient μ and roller drag c, as inverse_dynamics() assumes
///   friction smoothing   = that of the plant (FrictionConfig::smoothing) at the rim
///   gains                = wheel_loop_gains()
robot_core::Config make_core_config(const robot::Robot& robot, const motor::MotorValues& motor, const CoreOptions& options);

/// Throws Failure (bad_input) with every value that robot and motors lack for the drive core and its simulation.
void require_drive_values(const robot::Robot& robot, std::span<const motor::Motor> motors);

/// Returns the configuration with the guard; `guard` must be of that derating and outlive the Config. The lowest resistance follows from
/// the motor's tolerance and the derating's coldest air. Throws Failure (bad_input) as above, and if the guard period is not a whole number
/// of control periods.
robot_core::Config make_core_config(const robot::Robot& robot, const motor::Motor& motor, const CoreOptions& options,
                                    const derate::Derating& derating, const HostGuard& guard);

/// Throws Failure (bad_input) if the reserve for one full stop leaves a rested motor in the hottest air no current to drive: such a core
/// would be useless. `config` comes from make_core_config() with a guard of this derating.
void require_driving_current(const robot::Robot& robot, const motor::Motor& motor, const derate::Derating& derating,
                             const robot_core::Config& config);

/// Returns the heating of the winding by one full stop from the speed limit with the braking limit, in K: Σ over the stop of the observer's
/// dT_w/dt. All bodies and the air have the winding's limit. The result is an adiabatic heating, ∫I²·R(T_limit) dt·(safety factor on
/// heat)/C_w, plus the heat of the motor file's effects. I is (r·F_i + J·dω_i/dt)/(K_t·n), at most the current
/// limit, for the wheel and direction of travel with the largest force. Friction, drag and gear losses are neglected: they help to brake.
/// Needs the tables that make_core_config() needs.
double braking_reserve_K(const robot::Robot& robot, const motor::MotorValues& motor, const derate::Derating& derating);

}  // namespace heatsoak::firmware
