// A linearised run with neighbouring samples averaged. Averages are linear in the samples, so residual and columns stay exact; only the
// filter takes a stretch for its middle. Temperatures that change over tens of seconds lose nothing, and there are fewer rows to go
// through.
#pragma once

#include <vector>

#include "identify/whitening.h"

namespace heatsoak {

/// How many samples of a run may become one: they span at most a fifth of the fastest node's time constant and at most 3 s.
int mergeable_samples(const LinearisedRun& run);

class Averaging {
 public:
  /// `weight` per sample as SensorNoise has it, or empty.
  Averaging(const LinearisedRun& run, const Eigen::VectorXd& weight, int merged);

  /// Rows are averages; transition and injection go from the middle of one stretch to that of the next. Without by_parameter.
  [[nodiscard]] LinearisedRun run() const;
  /// Sum of the weights behind each row: an average of w samples has 1/w of the noise's variance.
  [[nodiscard]] const Eigen::VectorXd& weight() const { return weight_; }
  /// Of columns that belong to the run.
  [[nodiscard]] Columns average(const Columns& columns) const;
  /// Per interval of the run the interval between middles that it is part of; -1 before the first and after the last.
  [[nodiscard]] std::vector<Eigen::Index> interval_of() const;

 private:
  [[nodiscard]] Eigen::Index middle_of(Eigen::Index stretch) const;

  const LinearisedRun& run_;
  Eigen::Index merged_;
  Eigen::Index stretches_;
  Eigen::VectorXd sample_weight_;  ///< n·s; 0 where nothing counts
  Eigen::VectorXd weight_;
};

}  // namespace heatsoak
