// Assumptions of a fit or a forecast as data: parameters that are not fitted, and effects on an error band. src/present puts them into
// words.
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "estimation/findings.h"
#include "motor/fit_table.h"

namespace heatsoak::calibration {

/// The terminal resistance keeps its stated value. All heat capacities and resistances scale with it.
struct ResistanceHeld {};
/// The loss other than copper loss is the measured power balance, so the no-load current is not used.
struct NoLoadCurrentUnused {};
/// The no-load current is not fitted: its loss depends on speed, which not every log has.
struct NoLoadCurrentHeld {};
/// All of the logged input power counts as heat. All heat capacities and resistances scale with this share.
struct HeatShareHeld {
  bool has_loss_at_stator = false;  ///< true: the part due to the no-load current arises at the stator; false: all of it at the winding
};
/// Parameters of an effect are not fitted: the file states no tolerance or range.
struct EffectHeld {
  std::string effect;
  std::vector<std::string> parameters;  ///< keys, at least one
};
/// The error of a sensor is not fitted: it is not a property of the motor.
struct SensorHeld {
  std::string sensor;
  std::string parameter;  ///< key of its size
  double value = 0.0;
  std::string unit;
};
/// No log has the signal of a sensor, so the error of that sensor is not used.
struct SensorUnused {
  std::string sensor;
  std::string signal;
};
/// Logs lack signals that an effect of the file depends on. Each keeps its default of OperatingPoint, or stays unknown if it is optional.
struct SignalsMissing {
  std::vector<thermal::Signal> signals;  ///< at least one
  std::string effect;
  std::string recording = {};  ///< name of the log; empty: no log has them
  bool is_unread = false;      ///< the current is logged but not read, because the heat comes from another input
  bool is_unused = false;      ///< the effect does not act without all of its signals
};
/// A conditional effect acts in every run, because its type has no size that could be set to 0.
struct ConditionNotApplied {
  std::string effect;
  std::string type;
  std::map<std::string, std::string> condition;
};
/// No log has the condition of an effect.
struct ConditionNeverMet {
  std::string effect;
  std::map<std::string, std::string> condition;
};
/// Value of the motor file that is not fitted, or effect that does not act as stated, and why.
using HeldValue = std::variant<ResistanceHeld, NoLoadCurrentUnused, NoLoadCurrentHeld, HeatShareHeld, EffectHeld, SensorHeld, SensorUnused,
                               ConditionNotApplied, ConditionNeverMet>;

/// The log of a recording has a current but no speed, so its band includes a loss at speed of up to `most_W`.
struct BandIncludesLossAtSpeed {
  std::string recording;
  double most_W = 0.0;
};
/// A hold-out log has no score, because the temperatures of a model diverge with its inputs.
struct HoldoutDiverges {
  std::string recording;
};
/// The motor file has no band from a calibration; the band follows from declared uncertainties and the usual error of forecasts.
struct BandIsEstimated {
  std::string motor;
};
/// Recordings lack the heat input for which the parameters of the model hold; the heat comes from another one.
struct HeatInputLacking {
  motor::HeatInput of_model = motor::HeatInput::current;
  motor::HeatInput used = motor::HeatInput::current;
  std::vector<std::string> recordings;  ///< those without it, at least one
};
/// The heat comes from the input power of recordings without torque and speed, so that power of the shaft counts as heat.
struct ShaftPowerUnknown {
  std::vector<std::string> recordings;  ///< at least one
};
/// Assumption of a forecast.
using PredictionNote = std::variant<BandIncludesLossAtSpeed, BandIsEstimated, HeatInputLacking, estimation::RunNote>;

}  // namespace heatsoak::calibration
