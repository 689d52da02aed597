// Turns what a run leaves unexplained into independent numbers of variance 1, under the supposition that an unknown smooth heat
// flux reaches the nodes besides what the model knows.
//
// The flux is an Ornstein-Uhlenbeck process inside the differential equation, one per node. One sequence of Kalman gains serves
// the residual, the sensitivities and the responses to effects that the model may lack (de Jong 1991, the augmented Kalman
// filter): the whitening is a linear operator, and everything after it is least squares. A sensor may wander besides: an
// Ornstein-Uhlenbeck error of its own, which heats nothing.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "identify/linearised_run.h"

namespace heatsoak {

/// Of the unknown heat: stationary standard deviation per node that it may reach, and the time over which it forgets.
/// Every sensor may also have a slow error that heats nothing: it stands for bodies that the network does not have. Where SensorNoise
/// states slow errors, those are used instead.
struct LatentFlux {
  std::vector<double> rms_W;
  double time_scale_s = 300.0;
  double wander_K = 0.0;              ///< standard deviation of the slow error of every sensor; 0: none
  double wander_time_scale_s = 40.0;  ///< its correlation time
};

/// Per sensor and sample: standard deviation of the noise in K is noise_K[sensor] / √weight.
struct SensorNoise {
  std::vector<double> noise_K;
  Eigen::VectorXd weight;             ///< n·s, 0 … 1; empty: all 1. 0 leaves the sample out
  std::vector<double> wander_K = {};  ///< per sensor: standard deviation of its slow error; empty: none wanders
  double wander_time_scale_s = 10.0;
};

/// What each sample says that those before it did not; NaN where nothing was measured. Samples that were left out for their weight of 0
/// are judged too, by the noise that they would have.
struct Innovations {
  Eigen::VectorXd standardised;  ///< n·s, at weight 1
  Eigen::VectorXd noise_share;   ///< n·s: of the variance, what is the sensor's noise
};

/// Fluxes × n.
struct FluxEstimate {
  Eigen::MatrixXd mean_W;
  Eigen::MatrixXd sd_W;  ///< posterior standard deviation, given model and flux
};

/// The linear operator W with Wᵀ·W = V⁻¹, V the covariance of noise and flux as the sensors see them, for one run; the start temperatures
/// are taken as known. Masked samples become rows of zeros.
class Whitening {
 public:
  /// `run` outlives the whitening.
  Whitening(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise);

  /// Any number of columns at once; rows as in LinearisedRun, NaN allowed where the sample is masked.
  void apply(Eigen::Ref<Columns> columns) const;
  /// ln|V|.
  [[nodiscard]] double log_determinant() const { return log_determinant_; }
  /// Samples that count.
  [[nodiscard]] Eigen::Index count() const { return count_; }
  [[nodiscard]] Innovations innovations(const Eigen::VectorXd& residual_K) const;
  /// Best estimate of the unknown heat, given all samples of a residual from which everything known is removed (n·s, in K): the
  /// smoother of Bryson and Frazier.
  [[nodiscard]] FluxEstimate smoothed_flux(const Eigen::VectorXd& residual_K) const;

 private:
  template <class Layout>
  void build(const Layout& layout, const SensorNoise& noise);
  /// Calls `with` with how many temperatures, fluxes and slow errors the filter's state has: known to the compiler where they are usual.
  template <class With>
  void for_layout(const With& with) const;
  /// What an interval does to temperatures, fluxes and slow errors.
  struct Step {
    const double* transition;  ///< x × x, row by row
    const double* injection;   ///< x × q
    double forget_ratio;
    double wander_forget_ratio;
  };
  [[nodiscard]] Step step_of(Eigen::Index interval) const;
  template <class Layout, class Matrix>
  static void predict(const Layout& layout, const Step& step, Matrix& covariance, Matrix& moved);
  template <class Matrix>
  void set_transition(Eigen::Index interval, Matrix& transition) const;
  /// What fluxes, slow errors and doubts gain in variance before interval `interval` ends; −1: all of it, at the start.
  template <class Matrix>
  void add_unknown(Eigen::Index interval, Matrix& covariance) const;
  [[nodiscard]] int node_of(Eigen::Index sensor) const { return run_->sensor_node[static_cast<std::size_t>(sensor)]; }
  /// Of a sensor's slow error in the filter's state.
  [[nodiscard]] Eigen::Index wander_place(Eigen::Index sensor) const { return run_->states + run_->fluxes + sensor; }
  template <class Layout>
  void apply_to_strip(const Layout& layout, Eigen::Ref<Columns> columns) const;

  const LinearisedRun* run_;
  LatentFlux flux_;
  std::vector<double> wander_K_;
  bool wanders_ = false;
  Eigen::Index size_ = 0;                    ///< of the filter's state: temperatures, fluxes, slow errors of the sensors
  std::vector<double> forget_ratio_;         ///< per interval: what is left of a flux
  std::vector<double> wander_forget_ratio_;  ///< per interval: what is left of a sensor's slow error
  std::vector<double> gain_;                 ///< per row: size_ numbers
  std::vector<double> inverse_sd_per_K_;     ///< per row; 0 where masked
  std::vector<double> expected_K2_;          ///< per row: variance of the prediction, without noise
  std::vector<double> noise_K_;              ///< per sensor, at weight 1
  double log_determinant_ = 0.0;
  Eigen::Index count_ = 0;
};

}  // namespace heatsoak
