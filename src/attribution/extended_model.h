// A model with what a diagnosis adds to it: effects that act in some runs only, and faults of sensors.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "attribution/candidates.h"
#include "estimation/evidence.h"

namespace heatsoak {

/// An effect of the network that acts only where a run has the condition.
struct ConditionalTerm {
  std::string effect_name;
  int place = 0;           ///< of the parameter that switches it
  double off_value = 0.0;  ///< with which the effect does nothing
  Condition condition;
};

struct SensorTerm {
  const SensorEffectType* type = nullptr;
  double value = 0.0;      ///< in the unit of the type's size
  double spread_sd = 1.0;  ///< known before, around 0, in the same unit
};

/// Coordinates: the model's θ, then the sensors' sizes in units of their types' typical sizes, then the runs' deviations in units of the
/// usual ones.
struct ExtendedModel {
  Model model;
  std::vector<ConditionalTerm> conditional;
  std::vector<SensorTerm> sensors;
  std::vector<RunDeviation> deviations;
  std::string column;          ///< of the logs, that a curve is drawn over; set_column puts it into runs; empty: none
  double usual_error_K = 0.0;  ///< of whole runs, where those decided the file's figures (free_run_error_K of MotorFit); else 0
  double usual_flux_W = 0.0;   ///< rms of the unknown heat in runs that the file was fitted to: such motors always leave it

  [[nodiscard]] Eigen::Index free_count() const {
    return model.free_count() + static_cast<Eigen::Index>(sensors.size() + deviations.size());
  }
  [[nodiscard]] Eigen::Index first_deviation() const { return model.free_count() + static_cast<Eigen::Index>(sensors.size()); }
  [[nodiscard]] Eigen::VectorXd theta() const;
  void set_theta(const Eigen::VectorXd& theta);
  /// Prior of all coordinates; the mean is absolute.
  [[nodiscard]] Prior prior() const;
  /// Bounds of a coordinate.
  [[nodiscard]] double low(Eigen::Index coordinate) const;
  [[nodiscard]] double high(Eigen::Index coordinate) const;
  /// The network's parameters in that run.
  [[nodiscard]] std::vector<double> values_in(const MeasuredRun& run) const;
};

/// As linearise(), with the sensors as they are; columns by coordinate (per unit of θ). `start_C` may be shorter than the
/// network has nodes: the rest begin at the ambient temperature.
LinearisedRun linearise(const ExtendedModel& model, std::span<const double> start_C, const MeasuredRun& run);
/// As linearise_along().
LinearisedRun linearise_along(const ExtendedModel& model, const Eigen::MatrixXd& path_C, const MeasuredRun& run);

}  // namespace heatsoak
