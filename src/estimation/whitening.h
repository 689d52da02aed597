// Whitens the residuals of a run: converts them to independent numbers with unit variance, assuming that an unknown, smooth heat flux
// acts on the nodes in addition to the modelled heat.
//
// The flux is an Ornstein-Uhlenbeck process in the differential equation, one per node. One sequence of Kalman gains serves the
// residual, the sensitivities and the responses to candidate effects (de Jong 1991, the augmented Kalman filter). The whitening is
// therefore a linear operator, and everything after it is least squares. A sensor may also drift: it then has an Ornstein-Uhlenbeck error
// of its own, which adds no heat.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimation/linearised_run.h"

namespace heatsoak::estimation {

/// Unknown heat flux: stationary standard deviation per flux node, and correlation time. All sensors may also drift, which represents
/// bodies that the network does not have.
struct LatentFlux {
  std::vector<double> rms_W;
  double time_scale_s = 300.0;
  double drift_K = 0.0;              ///< standard deviation of the drift of every sensor; 0: none
  double drift_time_scale_s = 40.0;  ///< correlation time of the drift
};

/// Sensor noise. The standard deviation of a sample is noise_K[sensor] / √weight.
struct SensorNoise {
  std::vector<double> noise_K;
  Eigen::VectorXd weight;  ///< n·s, 0 to 1; 0 excludes the sample; empty: all 1
};

/// Innovations: deviation of each sample from its prediction by all earlier samples; NaN if not measured. Samples with weight 0 have one
/// too, computed with the noise at weight 1.
struct Innovations {
  Eigen::VectorXd standardised;  ///< n·s, divided by the standard deviation at weight 1
  Eigen::VectorXd noise_share;   ///< n·s: fraction of the variance that is sensor noise
};

/// Estimated heat flux, fluxes × n.
struct FluxEstimate {
  Eigen::MatrixXd mean_W;
  Eigen::MatrixXd sd_W;  ///< posterior standard deviation, given the model and the flux's statistics
};

/// Linear operator W of one run with Wᵀ·W = V⁻¹. V is the covariance that noise, drift and flux cause in the readings, with known start
/// temperatures. Masked samples (NaN or weight 0) become rows of zeros.
class Whitening {
 public:
  /// `run` must outlive this object.
  Whitening(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise);

  /// Whitens any number of columns in place. Rows as in LinearisedRun; masked samples may be NaN.
  void apply(Eigen::Ref<Columns> columns) const;
  /// ln|V|, with V in K².
  [[nodiscard]] double log_determinant() const { return log_determinant_; }
  /// Number of samples that are not masked.
  [[nodiscard]] Eigen::Index count() const { return count_; }
  [[nodiscard]] Innovations innovations(const Eigen::VectorXd& residual_K) const;
  /// Estimates the unknown heat flux from all samples with the smoother of Bryson and Frazier. `residual_K` (n·s) must not contain any
  /// known contribution.
  [[nodiscard]] FluxEstimate smoothed_flux(const Eigen::VectorXd& residual_K) const;

 private:
  template <class Layout>
  void build(const Layout& layout, const SensorNoise& noise);
  /// Calls `with` with the layout of the filter's state. Common layouts have sizes known at compile time.
  template <class With>
  void for_layout(const With& with) const;
  /// Propagation of temperatures, fluxes and drifts over one interval.
  struct Step {
    const double* transition;  ///< x × x, row-major
    const double* injection;   ///< x × q, row-major, K/W
    double forget_ratio;
    double drift_forget_ratio;
  };
  [[nodiscard]] Step step_of(Eigen::Index interval) const;
  template <class Layout, class Matrix>
  static void predict(const Layout& layout, const Step& step, Matrix& covariance, Matrix& moved);
  template <class Matrix>
  void set_transition(Eigen::Index interval, Matrix& transition) const;
  /// Adds the variance that fluxes, drifts and unlogged inputs contribute during `interval`; without one, the stationary variance of fluxes
  /// and drifts at the start.
  template <class Matrix>
  void add_unknown(std::optional<Eigen::Index> interval, Matrix& covariance) const;
  [[nodiscard]] int node_of(Eigen::Index sensor) const { return run_->sensor_node[static_cast<std::size_t>(sensor)]; }
  /// Index of a sensor's drift in the filter's state.
  [[nodiscard]] Eigen::Index drift_place(Eigen::Index sensor) const { return run_->states + run_->fluxes + sensor; }
  template <class Layout>
  void apply_to_strip(const Layout& layout, Eigen::Ref<Columns> columns) const;

  const LinearisedRun* run_;
  LatentFlux flux_;
  bool drifts_ = false;
  Eigen::Index size_ = 0;                   ///< size of the filter's state: temperatures, fluxes, sensor drifts
  std::vector<double> forget_ratio_;        ///< per interval: autocorrelation of a flux
  std::vector<double> drift_forget_ratio_;  ///< per interval: autocorrelation of a sensor's drift
  std::vector<double> gain_;                ///< Kalman gains: size_ numbers per row
  std::vector<double> inverse_sd_per_K_;    ///< per row: 1 / standard deviation of the innovation; 0 if masked
  std::vector<double> expected_K2_;         ///< per row: variance of the prediction without sensor noise
  std::vector<double> noise_K_;             ///< per sensor, at weight 1
  double log_determinant_ = 0.0;
  Eigen::Index count_ = 0;
};

}  // namespace heatsoak::estimation
