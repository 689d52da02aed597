// Findings about a drive core as data: what it does not know, what it assumes instead, and what limits it.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "derate/derating.h"
#include "derate/observer.h"
#include "motor/default_spread.h"
#include "motor/motor.h"
#include "robot/robot.h"

namespace heatsoak::firmware {

/// The robot's file has no friction, so its feed-forward is off.
struct FrictionUnknown {
  std::string robot_file;
};
/// Effects depend on an input that the core does not measure.
struct InputNotMeasured {
  derate::observed::Signal input;
  std::vector<std::string> effects;  ///< names; empty for a law of every motor
};
/// An effect depends on a log column: the core uses the value with the most heating.
struct ColumnUnknown {
  std::string effect;
  std::string column;
};
/// The motor's file gives no tolerance for these values.
struct SpreadsAssumed {
  std::vector<motor::DefaultSpread> spreads;
};
/// The guard is valid only under a condition that the user stated.
struct ConditionStated {
  std::string key;
  std::string value;
};
/// The reserve for one full stop takes much of the driving current.
struct StopTakesCurrent {
  double stop_K = 0.0;  ///< winding's temperature rise of one full stop
  double room_K = 0.0;  ///< from the hottest air to the winding limit
  double hottest_ambient_C = 0.0;
};
/// A value of the motor's file is unlikely, or an estimate contradicts it.
struct ValueDoubtful {
  motor::LintFinding finding;
};
/// The thermal values of the motor's file were fitted to heat from measured power, which the core does not measure.
struct FittedToPower {
  motor::HeatInput heat{};
};
/// The calibration of the motor's file found heat that the model lacks.
struct HeatUnmodelled {
  double share = 0.0;  ///< MotorFit::unmodelled_heat_share
};
/// All runs of the motor's fit had these conditions "key=value", which the caller did not state.
struct FittedUnder {
  std::vector<std::string> conditions;
};
/// The core was generated with --shadow.
struct ShadowModeChosen {};
using CoreNote = std::variant<FrictionUnknown, InputNotMeasured, ColumnUnknown, SpreadsAssumed, ConditionStated, StopTakesCurrent,
                              ValueDoubtful, FittedToPower, HeatUnmodelled, FittedUnder, ShadowModeChosen>;

/// Returns the findings about the core of this robot and motor. `braking_reserve_K`: rise of the winding in one full stop.
std::vector<CoreNote> notes_on(const robot::Robot& robot, const motor::Motor& motor, const derate::Derating& derating,
                               double braking_reserve_K);

/// Returns whether the finding means that a motor can overheat although the guard works.
bool is_unsafe(const CoreNote& note);

/// Returns the finding as a sentence, for the README of the generated folder and for the answer of `generate core`.
std::string to_string(const CoreNote& note);

}  // namespace heatsoak::firmware
