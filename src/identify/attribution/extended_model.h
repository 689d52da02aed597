// A model with what a diagnosis adds to it: effects that act in some runs only, and faults of sensors.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "identify/attribution/candidates.h"
#include "identify/evidence.h"

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
  std::string column;             ///< of the logs, that a curve is drawn over; set_column puts it into runs; empty: none
  double free_run_error_K = 0.0;  ///< of MotorFit: above 0 what is added must let the model follow whole runs better

  /// How much surer of its figures a model is taken to hold them.
  static constexpr double kHeld_ratio = 1e4;
  /// Other runs of the same motor are followed this much worse, nothing missing.
  static constexpr double kAsUsual_ratio = 1.5;
  [[nodiscard]] bool is_as_usual(double error_K) const { return error_K < kAsUsual_ratio * free_run_error_K; }
  void hold_figures() { model.prior.precision *= kHeld_ratio; }

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

}  // namespace heatsoak
