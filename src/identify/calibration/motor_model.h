// From a motor's file and what its logs can tell to a model that can be fitted, and back to figures.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "identify/measured_run.h"
#include "identify/model.h"
#include "motor/motor.h"

namespace heatsoak {

/// Effect with the loss at a speed that no log tells, where it is open.
inline constexpr std::string_view kLossAtUnloggedSpeed = "loss_at_unlogged_speed";

/// Effect that takes the input power of a log into the winding, as far as no effect of the file does.
inline constexpr std::string_view kImplicitPowerLoss = "input_power_loss";

/// How well a data sheet's bare figure is known: standard deviation of its logarithm.
inline constexpr double kSheet_sd = 0.4;

/// What the heat of a model is computed from. `power_balance`: copper loss by current and resistance, all other loss as input power less
/// shaft power less copper loss, by the motor's effect remaining_loss; its no-load loss is then 0.
enum class HeatInput { current, input_power, power_balance };

/// A figure of the file, or a heat capacity made of two of them: its logarithm is linear in θ.
struct FittedFigure {
  std::string name;  ///< as in the file: "thermal_time_constant_winding", "effects.fan.conductance"
  std::string unit;
  bool is_of_file = true;     ///< false: a heat capacity, which files give as time constants
  Eigen::VectorXd exponents;  ///< figure = Π parameter^exponent · constant
  double before = 0.0;        ///< value of the file
  double prior_sd = 0.0;      ///< of the logarithm, by spread and origin
  Origin origin = Origin::estimated;
};

/// Data, not only what was known before, tell the figure to a factor of two or better; the standard deviation is of its logarithm.
bool is_told(double sd_share, const FittedFigure& figure);

struct MotorModel {
  Model model;
  HeatInput heat = HeatInput::current;
  std::vector<Signal> needed;
  std::vector<FittedFigure> figures;
  std::vector<int> nuisances;     ///< free parameters that are no figure of the motor
  std::vector<std::string> held;  ///< what was not fitted and why, in sentences
};

/// How logs of the motor are read, but for what its model needs of them and the air. Rows are merged up to a tenth of the winding's time
/// constant, no finer: what real windings do within less no network of two bodies follows. Where a log has no torque, torque constant and
/// no-load current tell it, except where the input power is the heat: that has the copper loss in it. Sensors have the faults that the file
/// states.
MeasuredRunOptions how_to_read(const Motor& motor, HeatInput heat);

/// What is said of the file's faults of sensors, in sentences: they are taken as stated.
std::vector<std::string> held_sensors(const Motor& motor, std::span<const Recording> recordings);

/// What all of the recordings can drive: the copper loss where each has a current, else the input power, else the copper loss of the
/// current that `torque` makes of their torque. Throws Failure (bad_input) where they have none of these.
HeatInput heat_input_for(std::span<const Recording> recordings, const ShaftTorque& torque = {});

/// Whether the file takes its losses from a measured power balance: it has a remaining_loss.
bool has_remaining_loss(const Motor& motor);

/// As heat_input_for(), but the power balance where all recordings have current, input power, torque and speed, and the motor either has
/// a remaining_loss or, where `may_add_remaining_loss`, no effects and no fit that stand for its losses already.
HeatInput heat_input_of(const Motor& motor, std::span<const Recording> recordings, bool may_add_remaining_loss);

/// `with_speed`: all logs have a speed, so that the no-load loss can be told.
MotorModel motor_model(const Motor& motor, HeatInput heat, bool with_speed);

/// Standard deviation of a figure's logarithm before any data: by its spread where it has one, widened by how far its origin
/// is to be trusted for this motor in this mounting.
double prior_sd_of(const Figure& figure);

}  // namespace heatsoak
