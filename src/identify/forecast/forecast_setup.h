// What a forecast fit is asked for: a motor's file, how its logs tell the heat, and what may be added to the network.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "identify/forecast/forecast_model.h"
#include "motor/motor.h"

namespace heatsoak {

struct ForecastSetup {
  Motor motor;
  HeatInput heat = HeatInput::current;
  bool has_speed = true;               ///< all logs have one
  bool opens_loss_at_speed = false;    ///< the loss at a speed that no log tells is fitted
  std::vector<FreeFault> faults = {};  ///< of sensors, beside those of the file

  [[nodiscard]] ForecastModel model() const;
};

/// For these logs: adds remaining_loss to a motor without one where all of them have the power balance.
ForecastSetup forecast_setup(const Motor& motor, std::span<const Recording> recordings);

/// An addition to the network that is accepted only where it improves the prediction of left-out pieces; no diagnosis.
struct Extension {
  std::string name;
  std::vector<MotorEffect> effects;
  std::vector<FreeFault> faults;
  int free_count = 0;
  /// By which the fitted values of parameters are multiplied so that the whole begins where it was.
  std::vector<std::pair<std::string, double>> start_ratio;
};

/// The extensions that runs with these signals can tell, sized by the fitted values `theta` of the setup's model.
std::vector<Extension> extensions_for(const ForecastSetup& setup, const ForecastModel& model, const Eigen::VectorXd& theta,
                                      std::span<const MeasuredRun> runs);
ForecastSetup with_extension(ForecastSetup setup, const Extension& extension);

/// θ of one model in the coordinates of another: by name, and the start of the other where it has more, which `added` brought.
Eigen::VectorXd carried_over(const ForecastModel& from, const Eigen::VectorXd& theta, const ForecastModel& to, const Extension& added = {});

/// Root mean square over the run of the heat that the network makes or leads to the surroundings, whichever is more, in W.
double rms_heat_W(const Network& network, std::span<const double> values, const MeasuredRun& run, const Eigen::MatrixXd& state_C);

}  // namespace heatsoak
