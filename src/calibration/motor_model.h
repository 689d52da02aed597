// Builds a model that can be fitted from a motor file and the signals of its logs, and maps its parameters to those of the file.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/assumptions.h"
#include "estimation/measured_run.h"
#include "estimation/model.h"
#include "motor/motor.h"

namespace heatsoak::calibration {

/// Name of the effect with the unknown loss of a motor whose speed was not logged.
inline constexpr std::string_view kLossAtUnloggedSpeed = "loss_at_unlogged_speed";

/// Name of the effect that puts the logged input power into the winding, less the shares of the file's own effects.
inline constexpr std::string_view kImplicitPowerLoss = "input_power_loss";

/// Prior standard deviation of the logarithm of a data sheet value without a stated spread.
inline constexpr double kSheet_sd = 0.4;

using motor::HeatInput;

/// Returns true if the heat is copper loss and no-load loss, by a logged current or by the torque.
constexpr bool is_by_current(HeatInput heat) { return heat == HeatInput::current || heat == HeatInput::torque; }

/// Parameter of the motor file, or a heat capacity computed from two of them. Its logarithm is linear in θ.
struct CalibratedValue {
  std::string name;  ///< key in the file, for example "thermal_time_constant_winding" or "effects.fan.conductance"
  std::string unit;
  bool is_of_file = true;     ///< false: a heat capacity; files contain time constants instead
  Eigen::VectorXd exponents;  ///< value = constant · Π parameter^exponent
  double before = 0.0;        ///< value in the file
  double prior_sd = 0.0;      ///< prior standard deviation of the logarithm, from spread and origin
  base::Origin origin = base::Origin::estimated;
};

/// Returns true if the data reduce the prior standard deviation by 30 % or more. `sd_share` is the standard deviation of the logarithm.
bool is_learned(double sd_share, const CalibratedValue& parameter);
/// Returns true if the data, not only the prior, determine the parameter to a factor of two or better. `sd_share` is the standard deviation
/// of its logarithm.
bool is_identifiable(double sd_share, const CalibratedValue& parameter);

struct MotorModel {
  estimation::Model model;
  HeatInput heat = HeatInput::current;
  std::vector<thermal::Signal> needed;
  std::vector<CalibratedValue> parameters;
  std::vector<int> nuisances;  ///< indices of free parameters that are not parameters of the motor
  std::vector<HeldValue> held;
};

/// Returns the options for reading logs of the motor; the caller sets `needed` and `ambient_C`. Rows are merged up to a tenth of the
/// winding's time constant (0.05 to 2 s): a network of two bodies does not describe faster changes of a real winding. A missing
/// torque follows from torque constant and no-load current, except if the input power is the heat, which contains the copper loss. A
/// logged current is read only if it is the heat input. Sensors have the faults stated in the file.
estimation::MeasuredRunOptions how_to_read(const motor::Motor& motor, HeatInput heat);

/// Returns what the recordings do not let act or be fitted as the file states: sensor errors, which are never fitted, and effects whose
/// condition no recording has or that no condition can switch off.
std::vector<HeldValue> held_in_recordings(const motor::Motor& motor, std::span<const recording::Recording> recordings);

/// Returns true if the effect takes its heat from a measured power balance.
bool is_remaining_loss(const motor::MotorEffect& effect);
/// Returns true if the motor has a remaining_loss effect, that is, takes its losses from a measured power balance.
bool has_remaining_loss(const motor::Motor& motor);

/// Rules for choosing a heat input.
struct HeatRules {
  /// Preferred heat input; empty: that of the motor file's fit. Without both, or if a recording lacks it, the recordings decide.
  std::optional<HeatInput> wanted = {};
  /// A motor without effects and without a fit may get a remaining_loss.
  bool may_add_remaining_loss = false;
};

/// Returns the wanted heat input if all recordings have it, else the first of these that all have:
/// - the power balance (current, input power, torque and speed), if the motor has or gets a remaining_loss;
/// - current; input power; torque;
/// - a current in some recordings and a torque in the others.
/// Throws Failure (bad_input) if they have none of these.
HeatInput heat_input_of(const motor::Motor& motor, std::span<const recording::Recording> recordings, const HeatRules& rules = {});

/// Returns a finding if `used` is not the wanted heat input, with the recordings that lack the wanted one.
std::optional<HeatInputLacking> lacking_heat_input(const motor::Motor& motor, std::span<const recording::Recording> recordings,
                                                   const HeatRules& rules, HeatInput used);

/// Returns a finding if `used` is the input power, with the recordings that have no shaft power.
std::optional<ShaftPowerUnknown> shaft_power_unknown(std::span<const recording::Recording> recordings, HeatInput used);

/// Builds the model. Effects with a condition act only in runs that state it. `with_speed`: all logs have a speed, so that the no-load loss is observable. A remaining_loss acts only in the power
/// balance: the other heat inputs contain that loss.
MotorModel motor_model(const motor::Motor& motor, HeatInput heat, bool with_speed);

/// Returns the prior standard deviation of a parameter's logarithm: from its spread, widened according to its origin, or a default for the
/// origin if it has no spread.
double prior_sd_of(const base::ParameterValue& parameter);

}  // namespace heatsoak::calibration
