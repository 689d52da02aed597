// A model with the additions of a diagnosis: effects that act only in some runs, sensor errors, and run deviations.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "attribution/candidates.h"
#include "estimation/evidence.h"

namespace heatsoak {

/// An effect of the network that acts only in runs with the condition.
struct ConditionalTerm {
  std::string effect_name;
  int place = 0;           ///< index of the parameter that switches the effect off
  double off_value = 0.0;  ///< value of that parameter at which the effect is zero
  Condition condition;
};

/// A sensor error whose size is a coordinate of the model.
struct SensorTerm {
  const SensorEffectType* type = nullptr;
  double value = 0.0;      ///< size, in the unit of the type
  double spread_sd = 1.0;  ///< prior standard deviation around 0, in the same unit
};

/// Coordinates, in this order: θ of the model; sensor errors, in typical sizes; run deviations, in units of their type's `usual`.
struct ExtendedModel {
  Model model;
  std::vector<ConditionalTerm> conditional;
  std::vector<SensorTerm> sensors;
  std::vector<RunDeviation> deviations;
  std::string column;  ///< name of the log column that a curve uses, see set_column(); empty: none
  /// RMS error of whole runs with the file's parameters if whole runs decided them (free_run_error_K of MotorFit); else 0.
  double usual_error_K = 0.0;
  /// RMS of the unknown heat in the runs that the file was fitted to; 0: not known.
  double usual_flux_W = 0.0;

  [[nodiscard]] Eigen::Index free_count() const {
    return model.free_count() + static_cast<Eigen::Index>(sensors.size() + deviations.size());
  }
  [[nodiscard]] Eigen::Index first_deviation() const { return model.free_count() + static_cast<Eigen::Index>(sensors.size()); }
  [[nodiscard]] Eigen::VectorXd theta() const;
  void set_theta(const Eigen::VectorXd& theta);
  /// Returns the prior of all coordinates. The mean is absolute.
  [[nodiscard]] Prior prior() const;
  /// Returns the lower or upper bound of a coordinate; the lower one may be −∞.
  [[nodiscard]] double low(Eigen::Index coordinate) const;
  [[nodiscard]] double high(Eigen::Index coordinate) const;
  /// Returns the network's parameters in that run, with conditional effects and run deviations applied.
  [[nodiscard]] std::vector<double> values_in(const MeasuredRun& run) const;
};

/// Same as linearise() of a network, with the sensor errors of the model. The columns are per unit of each coordinate. If `start_C` is
/// shorter than the number of state nodes, the other nodes start at ambient temperature.
LinearisedRun linearise(const ExtendedModel& model, std::span<const double> start_C, const MeasuredRun& run);
/// Same as linearise_along() of a network, with the sensor errors of the model.
LinearisedRun linearise_along(const ExtendedModel& model, const Eigen::MatrixXd& path_C, const MeasuredRun& run);

}  // namespace heatsoak
