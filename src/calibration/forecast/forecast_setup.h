// Setup of a forecast fit: motor file, heat input of its logs, and possible extensions of the network.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/forecast/forecast_model.h"
#include "motor/motor.h"

namespace heatsoak::calibration {

struct ForecastSetup {
  motor::Motor motor;
  HeatInput heat = HeatInput::current;
  bool has_speed = true;               ///< all logs have a speed
  bool opens_loss_at_speed = false;    ///< fits the loss at a speed that was not logged
  std::vector<FreeFault> faults = {};  ///< fitted sensor faults, in addition to those of the file

  [[nodiscard]] ForecastModel model() const;
};

/// Returns the setup for these logs, with the heat input of heat_input_of(). Adds remaining_loss to a motor without one if that is the
/// power balance.
ForecastSetup forecast_setup(const motor::Motor& motor, std::span<const recording::Recording> recordings,
                             std::optional<HeatInput> wanted_heat = {});

/// Extension of the network, accepted only if it improves the prediction of left-out pieces. It is not a diagnosis.
struct Extension {
  std::string name;
  std::vector<motor::MotorEffect> effects;
  std::vector<FreeFault> faults;
  int free_count = 0;
  /// Factors on fitted parameters (by name) that keep the initial behaviour of the extended network close to that before.
  std::vector<std::pair<std::string, double>> start_ratio;
};

/// Returns the extensions that are observable with the signals of these runs. Their initial sizes follow from the fitted `theta`.
std::vector<Extension> extensions_for(const ForecastSetup& setup, const ForecastModel& model, const Eigen::VectorXd& theta,
                                      std::span<const estimation::MeasuredRun> runs);
/// Returns the setup with the effects and sensor faults of the extension added.
ForecastSetup with_extension(ForecastSetup setup, const Extension& extension);

/// Converts θ of model `from` to the coordinates of model `to`, matched by name. Parameters that only `to` has start at its own values;
/// the start factors of `added` are applied.
Eigen::VectorXd carried_over(const ForecastModel& from, const Eigen::VectorXd& theta, const ForecastModel& to, const Extension& added = {});

/// Returns the RMS over the run, in W, of the heat that the network generates or dissipates to ambient, whichever is larger.
double rms_heat_W(const thermal::Network& network, std::span<const double> values, const estimation::MeasuredRun& run,
                  const Eigen::MatrixXd& state_C);

}  // namespace heatsoak::calibration
