// Averages neighbouring samples of a linearised run, so that filters process fewer rows. Averages are linear in the samples, so residuals
// and sensitivities stay exact. The only approximation: the filter places each average at the middle of its segment, which is harmless
// for temperatures that change over tens of seconds.
#pragma once

#include <optional>
#include <vector>

#include "estimation/whitening.h"

namespace heatsoak::estimation {

/// Returns how many consecutive samples may be averaged into one (at least 1). Together they span at most a fifth of the fastest node's
/// time constant and at most 3 s.
int mergeable_samples(const LinearisedRun& run);

class Averaging {
 public:
  /// Averages `merged` samples at a time. `weight` is SensorNoise::weight (n·s) or empty. `run` must outlive this object.
  Averaging(const LinearisedRun& run, const Eigen::VectorXd& weight, int merged);

  /// The run whose rows are averages. Transition and injection lead from the middle of one segment to the middle of the next. sensor_C and
  /// by_parameter are empty.
  [[nodiscard]] LinearisedRun run() const;
  /// Sum of the sample weights in each row. An average with weight sum w has 1/w of the noise variance of one sample.
  [[nodiscard]] const Eigen::VectorXd& weight() const { return weight_; }
  /// Averages columns with the rows of the original run (n·s) in the same way.
  [[nodiscard]] Columns average(const Columns& columns) const;
  /// For each interval of the original run, the index of the averaged interval that contains it. Empty before the middle of the first
  /// segment and after the middle of the last.
  [[nodiscard]] std::vector<std::optional<Eigen::Index>> interval_of() const;

 private:
  [[nodiscard]] Eigen::Index middle_of(Eigen::Index segment) const;

  const LinearisedRun& run_;
  Eigen::Index merged_;
  Eigen::Index segments_;
  Eigen::VectorXd sample_weight_;  ///< n·s; 0 for samples without a measurement
  Eigen::VectorXd weight_;
};

}  // namespace heatsoak::estimation
