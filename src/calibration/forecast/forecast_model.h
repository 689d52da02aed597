// Network of a motor for forecasts. Free parameters, sensor lags included, are logarithms; each run has a heat factor.
#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "calibration/motor_model.h"
#include "estimation/linearised_run.h"
#include "estimation/measured_run.h"
#include "estimation/open_loop.h"

namespace heatsoak::calibration {

/// Prior standard deviation of the logarithm of a run's heat factor (about 5 %).
inline constexpr double kHeatFactor_sd = 0.05;

/// Sensor fault whose size is fitted as a logarithm.
struct FreeFault {
  const motor::SensorEffectType* type = nullptr;
  double size = 0.0;      ///< prior median, in the unit of the type's size
  double prior_sd = 1.0;  ///< prior standard deviation of the logarithm of the size
};

/// Model with coordinates θ: those of the network, then the logarithms of the fault sizes.
class ForecastModel {
 public:
  ForecastModel(MotorModel model, std::vector<FreeFault> faults);

  [[nodiscard]] const MotorModel& motor() const { return motor_; }
  [[nodiscard]] const thermal::Network& network() const { return motor_.model.network; }
  [[nodiscard]] std::span<const FreeFault> faults() const { return faults_; }
  [[nodiscard]] Eigen::Index count() const { return prior_.mean.size(); }
  [[nodiscard]] const estimation::Prior& prior() const { return prior_; }
  /// θ at the values of the file.
  [[nodiscard]] Eigen::VectorXd start() const;
  /// Clamps θ to the bounds of all parameters.
  [[nodiscard]] Eigen::VectorXd within_bounds(Eigen::VectorXd theta) const;
  /// Returns the network's parameters for a run. All heat that the inputs generate is multiplied by exp(log_heat_ratio).
  [[nodiscard]] std::vector<double> values_in(const estimation::MeasuredRun& run, const Eigen::VectorXd& theta,
                                              double log_heat_ratio) const;
  /// Simulates the run from start temperatures (°C) of all state nodes. The columns of by_parameter are θ, then log_heat_ratio. Throws
  /// Failure (numerics_failed) if the temperatures diverge.
  [[nodiscard]] estimation::LinearisedRun along(const estimation::MeasuredRun& run, const Eigen::VectorXd& theta, double log_heat_ratio,
                                                std::span<const double> start_C) const;
  /// Start temperatures estimated from the beginning of the run (open_loop.h).
  [[nodiscard]] estimation::DecidedStart decided_start(const estimation::MeasuredRun& run, const Eigen::VectorXd& theta) const;

 private:
  /// Parameter `place` is 1 minus parameter `of`.
  struct Tie {
    int place = 0;
    int of = 0;
  };
  void find_ties();
  void find_heat();

  MotorModel motor_;
  std::vector<FreeFault> faults_;
  estimation::Prior prior_;
  std::vector<Tie> ties_;
  std::vector<int> heat_places_;  ///< parameters to which the heat of the inputs is proportional
  std::vector<int> wanted_;       ///< indices of the free parameters, then of the ties, then heat_places_
};

}  // namespace heatsoak::calibration
