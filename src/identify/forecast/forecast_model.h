// A motor's network as a forecast runs it: free parameters by their logarithm, sensor lags among them, and a heat factor per run.
#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "identify/calibration/motor_model.h"
#include "identify/linearised_run.h"
#include "identify/measured_run.h"
#include "identify/open_loop.h"

namespace heatsoak {

/// Known of the logarithm of a run's heat factor before any run: standard deviation (about 5 %).
inline constexpr double kHeatFactor_sd = 0.05;

/// A sensor fault whose size is fitted by its logarithm.
struct FreeFault {
  const SensorEffectType* type = nullptr;
  double size = 0.0;      ///< prior median, in the unit of the type's size
  double prior_sd = 1.0;  ///< of its logarithm
};

/// Coordinates θ: those of the model, then the logarithms of the sizes of the faults.
class ForecastModel {
 public:
  /// `model` is that of the motor.
  ForecastModel(MotorModel model, const Motor& motor, std::vector<FreeFault> faults);

  [[nodiscard]] const MotorModel& motor() const { return motor_; }
  [[nodiscard]] const Network& network() const { return motor_.model.network; }
  [[nodiscard]] std::span<const FreeFault> faults() const { return faults_; }
  [[nodiscard]] Eigen::Index count() const { return prior_.mean.size(); }
  [[nodiscard]] const Prior& prior() const { return prior_; }
  /// The values of the file.
  [[nodiscard]] Eigen::VectorXd start() const;
  /// Within the bounds of all parameters.
  [[nodiscard]] Eigen::VectorXd within_bounds(Eigen::VectorXd theta) const;
  /// The network's parameters; all heat that the model makes of the inputs is multiplied by e^log_heat_ratio.
  [[nodiscard]] std::vector<double> values_in(const MeasuredRun& run, const Eigen::VectorXd& theta, double log_heat_ratio) const;
  /// The run from start temperatures of all state nodes. Columns by_parameter: θ, then log_heat_ratio. Throws Failure (numerics_failed)
  /// where the temperatures run away.
  [[nodiscard]] LinearisedRun along(const MeasuredRun& run, const Eigen::VectorXd& theta, double log_heat_ratio,
                                    std::span<const double> start_C) const;
  /// Start temperatures that the beginning of the run decides (open_loop.h).
  [[nodiscard]] DecidedStart decided_start(const MeasuredRun& run, const Eigen::VectorXd& theta) const;

 private:
  /// A share that is what another one leaves of 1.
  struct Tie {
    int place = 0;
    int of = 0;
  };
  /// A parameter that is 0 in runs without the condition.
  struct Conditional {
    int place = 0;
    std::map<std::string, std::string> condition;
  };
  void find_ties();
  void find_heat();
  void find_conditions(const Motor& motor);

  MotorModel motor_;
  std::vector<FreeFault> faults_;
  Prior prior_;
  std::vector<Tie> ties_;
  std::vector<Conditional> conditional_;
  std::vector<int> heat_places_;  ///< parameters that the heat of the inputs is proportional to
  std::vector<int> wanted_;       ///< places of the free parameters, then of the ties, then of the heat
};

}  // namespace heatsoak
