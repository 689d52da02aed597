// Derating of one motor for firmware: thermal observer, current table and their statistical guarantee.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "derate/guarantee.h"
#include "derate/provenance.h"
#include "derate/sensed/sensor.h"
#include "motor/default_spread.h"
#include "motor/lint.h"

namespace heatsoak::derate {

struct DerateOptions {
  double hottest_ambient_C = 40.0;
  double coldest_ambient_C = 0.0;  ///< an air sensor that reads less counts as faulty
  double period_s = 0.01;          ///< time between two calls in the firmware
  /// Time constant of the winding's approach to its limit; by default kApproach_ratio of the motor's winding time constant. A shorter one
  /// allows higher peaks and, once the motor is hot, leaves less current for the rest of a long load.
  std::optional<double> approach_s = {};
  TableGoal table;
  GuaranteeOptions guarantee;
  std::optional<SensorOptions> sensor = {};
};

/// A pushed robot may turn its motors faster than a full battery can, by this factor.
inline constexpr double kPushed_ratio = 1.1;

/// Default of `approach_s` as a share of the winding's nominal time constant. It was chosen by the distance that a robot with the ECX FLAT
/// 32 L lost to the limit in three generated matches. With the tolerances of the motor file, on the hard match, it lost 14.6 % with a share
/// of 1/24, 6.4 % with 1/4 and 5.3 % with 1. With the tolerances of a bench test it lost 0.2, 0.3 and more than 0.8 %.
inline constexpr double kApproach_ratio = 0.25;
/// Returns the time constant in s with which the winding of this motor approaches its limit, > 0. Throws Failure (bad_input) if the options
/// give a longer one than the time constant of its winding.
double approach_s(const motor::Motor& motor, const DerateOptions& options);

/// Returns the rules that follow from motor, robot and options, before any safety factor on heat. A limit that the motor's file gives as a
/// range counts at its lower end. The highest speed is 1.1·U/K_t. U is the voltage of a full battery, at most the driver's command limit.
/// The 10 % cover external pushing and magnets weaker than nominal. The current reaches 0 at 1.1 times the highest speed, or at the highest
/// speed without the command limit if that is more. Throws Failure (bad_input) if the winding limit is not above the hottest air.
BarrierRules barrier_rules(const motor::Motor& motor, const robot::Robot& robot, const DerateOptions& options);

/// Nominal value of a parameter of an effect.
struct EffectParameter {
  std::string key;
  std::string unit;  ///< UDUNITS text; empty for a pure number
  double value = 0.0;
  std::string choice;  ///< name of the choice if the parameter is one, else empty
};

/// An effect of the observer's network.
struct ActingEffect {
  std::string name;
  std::string type;
  std::string equation;
  std::string column;  ///< log column over which the effect has a curve: the observer uses the curve's hottest value; empty if none
  std::vector<std::string> nodes = {};  ///< names of the nodes in the order of the type's roles
  std::vector<EffectParameter> parameters = {};
};

struct Derating {
  std::string motor_id;
  std::string robot_id;
  std::string data_quality;
  double torque_constant_Nm_per_A = 0.0;
  Observer observer;
  BarrierRules rules;
  CurrentTable table;
  DerateOptions options;
  std::map<std::string, std::string> assumed;  ///< Motor::assumed: the derating is valid only under these conditions
  std::vector<ActingEffect> effects;
  Guarantee guarantee;
  std::vector<UsePlayed> uses;
  /// Above rules.most_speed_rad_per_s if beyond that the motor exceeds a limit even without current.
  double reachable_speed_rad_per_s = 0.0;
  /// Default tolerances of values for which the motor's file gives none.
  std::vector<motor::DefaultSpread> default_spreads = {};
  std::vector<motor::LintFinding> doubtful_values = {};  ///< motor::doubtful_values() of the motor's file
  /// MotorFit::heat_input if it is from measured power, which the firmware does not know.
  std::optional<motor::HeatInput> measured_power = {};
  std::optional<double> unmodelled_heat_share = {};  ///< MotorFit::unmodelled_heat_share: not covered by the guarantee
  std::vector<std::string> fit_conditions = {};      ///< motor::unstated_fit_conditions(): the guarantee holds only under them
  bool is_brushless = true;
  double heating_current_ratio = 1.0;     ///< heating_factor() of the robot: heating current per equivalent DC current
  motor::MotorValues nominal = {};        ///< nominal values of the motor's file
  std::optional<SensorPlan> sensor = {};  ///< set if the options declare a sensor
  Provenance provenance = {};             ///< set by the caller, because derate() reads no files
};

/// Returns the continuous current in A that is allowed at every speed and in every hot case; for a wheel whose speed is unknown. It is the
/// smallest steady-state current of all continuous uses (Use::on_s is 0), and 0 without such uses. Each of them draws the full allowed
/// current at constant speed for four of the slowest time constants, but at least 900 s. At the end of it the observer, whose heat is
/// multiplied by the safety factor, is in steady state at its limits. The fastest continuous use runs at 0.98 of the highest speed, which
/// is above the speed that a full battery reaches.
double limp_current_A(const Derating& derating);

/// Smallest number of drawn motors that can show the confidence, if none of them exceeds a limit: 59 for 0.95.
long least_samples(const GuaranteeOptions& options);

/// Returns the effects of the network with their nominal parameters. `motor` names the columns of their curves.
std::vector<ActingEffect> acting_effects(const thermal::Network& network, const motor::Motor& motor);

/// Computes the derating. Values without a tolerance get a default one first (with_default_spreads()). Finds the smallest safety factor on
/// heat at which the share of drawn motors that keep every limit in every use reaches the confidence. Then raises the factor until, on
/// independently drawn motors, the lower bound of that share (kCertainty_share) reaches the confidence as well. Throws Failure: bad_input
/// if the period is too long for the motor, or if the samples are too few for the confidence. limit_exceeded if no factor suffices,
/// because the motor exceeds a limit without current, or if its lasting current is below its no-load current (require_own_friction()).
Derating derate(const motor::Motor& motor, const robot::Robot& robot, const DerateOptions& options, const base::Progress& progress = {});

}  // namespace heatsoak::derate
