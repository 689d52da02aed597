// A recording of any length in a bounded number of rows, for what looks at a log as a whole.
#pragma once

#include <cstddef>
#include <vector>

#include "identify/measurement/recording.h"

namespace heatsoak {

/// Takes a log part by part. Where it grows beyond some ten thousand rows, neighbours of one run become one: heat inputs and
/// surroundings their mean (currents the rms with the sign of the mean), temperatures and other signals the first one that is there. Of
/// logs with more runs than that whole runs are left aside, spread evenly.
class CondensedRecording {
 public:
  static constexpr std::size_t kMostRows = 1 << 16;

  /// `most_rows`: even.
  explicit CondensedRecording(std::size_t most_rows = kMostRows) : most_rows_(most_rows) {}

  /// As RecordingStream gives them.
  void add(const Recording& part);
  [[nodiscard]] const Recording& rows() const { return all_.rows; }
  /// The smallest and the largest value in each row of a channel; NaN where it has none.
  [[nodiscard]] const std::vector<double>& low(std::size_t channel) const { return all_.low[channel]; }
  [[nodiscard]] const std::vector<double>& high(std::size_t channel) const { return all_.high[channel]; }
  /// Rows of the log in one row, at most; 1: nothing is condensed.
  [[nodiscard]] std::size_t merged() const { return merged_; }
  void erase_channel(std::size_t channel);

 private:
  struct Rows {
    Recording rows;
    std::vector<double> weight_ratio;  ///< rows of the log in each row
    std::vector<std::vector<double>> low;
    std::vector<std::vector<double>> high;
  };
  /// Up to `most` neighbours become one; `counted`: what the rows are made of, null: each is one row of the log.
  static Rows merged(const Recording& rows, const Rows* counted, std::size_t most);
  static void leave_every_other_run_aside(Rows& some);

  std::size_t most_rows_;
  std::size_t merged_ = 1;
  Rows all_;
};

}  // namespace heatsoak
