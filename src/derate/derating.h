// Everything that firmware gets about one motor: its observer, its table, and how far both can be trusted.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "derate/guarantee.h"
#include "derate/provenance.h"
#include "derate/sensed/sensor.h"
#include "motor/default_spread.h"

namespace heatsoak {

struct DerateOptions {
  double hottest_ambient_C = 40.0;
  double coldest_ambient_C = 0.0;  ///< a sensor that shows less is taken for broken
  double period_s = 0.01;          ///< between two calls of the firmware
  double approach_s = 0.5;         ///< over which the winding may come near its limit: shorter lets peaks through for longer
  TableGoal table;
  GuaranteeOptions guarantee;
  std::optional<SensorOptions> sensor = {};
};

/// What follows from motor, robot and options alone: before any reserve. A limit that the motor's file gives as a range counts at its lower
/// end. Throws Failure (bad_input) where the winding's limit is not above the hottest air. The highest speed is 1.1·U/(K_t): U of a full
/// battery within the driver's limit of the command, and 10 % for a push and for magnets weaker than nominal. The current has fallen to
/// none at 1.1 times that, and at the same of the full battery where the command is limited.
BarrierRules barrier_rules(const Motor& motor, const Robot& robot, const DerateOptions& options);

/// An effect that the observer reckons with.
struct ActingEffect {
  std::string name;
  std::string type;
  std::string equation;
  std::string column;  ///< of logs, that the effect goes with: its hottest value counts
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
  std::map<std::string, std::string> assumed;  ///< Motor::assumed: where that does not hold, nothing here does
  std::vector<ActingEffect> effects;
  Guarantee guarantee;
  std::vector<UsePlayed> uses;
  double reachable_speed_rad_per_s = 0.0;  ///< more than the rules' most speed where beyond it the motor passes a limit without current
  /// Values of the motor's file without a tolerance, with what the drawn motors have in its place.
  std::vector<DefaultSpread> default_spreads = {};
  bool is_brushless = true;
  double heating_current_ratio = 1.0;     ///< heating_factor() of the robot: current that heats per equivalent DC current
  MotorValues nominal = {};               ///< of the motor's file
  std::optional<SensorPlan> sensor = {};  ///< where one is declared
  Provenance provenance = {};             ///< empty until the caller sets it: derate() reads no files
};

/// The current that the motor bears for good at every speed and in every hot case, in A ≥ 0: for a wheel whose speed nobody knows.
/// Derivation: each held use draws all that the table allows, at one speed in one hot case, until the slowest body has settled (four
/// slowest time constants, 900 s at least). The current that still flows at the end is the one at which the observer, which counts heat
/// heat_reserve_ratio times, rests at its limits. The smallest of these over all held uses. 0 without held uses. The fastest held use is at
/// 0.98 of the rules' highest speed: above what a full battery drives, because that is 1.1 times as fast.
double limp_current_A(const Derating& derating);

/// Motors that must be drawn to show the confidence at all, none of them over a limit: 59 for 0.95.
long least_samples(const GuaranteeOptions& options);

/// Values without a spread get a default one first (with_default_spreads()). Finds the smallest reserve of heat with which the share of
/// drawn motors that keep every limit in every use is the confidence, and raises it until on motors that the search has not seen the lower
/// bound of that share (kCertainty_share) is the confidence too. Throws Failure: bad_input
/// where the period is too long for the motor or the samples are too few for the confidence, limit_exceeded where no reserve helps, because
/// the motor passes a limit without current.
Derating derate(const Motor& motor, const Robot& robot, const DerateOptions& options, const Progress& progress = {});

}  // namespace heatsoak
