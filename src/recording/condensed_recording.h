// Condenses a recording of any length to a bounded number of rows, for checks that need the whole log.
#pragma once

#include <cstddef>
#include <vector>

#include "recording/recording.h"

namespace heatsoak::recording {

/// Takes a log part by part. If it exceeds `most_rows`, neighbouring rows of a run are merged. Heat inputs and surroundings become means
/// (currents: RMS with the sign of the mean); temperatures and other signals keep their first valid value. If a log has too many runs,
/// every other run is dropped.
class CondensedRecording {
 public:
  static constexpr std::size_t kMostRows = 1 << 16;

  /// `most_rows` must be even.
  explicit CondensedRecording(std::size_t most_rows = kMostRows) : most_rows_(most_rows) {}

  /// Adds the next part, as returned by RecordingStream.
  void add(const Recording& part);
  [[nodiscard]] const Recording& rows() const { return all_.rows; }
  /// Smallest and largest value of a channel within each row; NaN if it has none.
  [[nodiscard]] const std::vector<double>& low(std::size_t channel) const { return all_.low[channel]; }
  [[nodiscard]] const std::vector<double>& high(std::size_t channel) const { return all_.high[channel]; }
  /// Largest number of log rows in one row; 1 if nothing is condensed.
  [[nodiscard]] std::size_t merged() const { return merged_; }
  void erase_channel(std::size_t channel);

 private:
  struct Rows {
    Recording rows;
    std::vector<double> weight_ratio;  ///< number of log rows in each row
    std::vector<std::vector<double>> low;
    std::vector<std::vector<double>> high;
  };
  /// Merges up to `most` neighbouring rows into one. `counted` has the number of log rows in each row; null means one each.
  static Rows merged(const Recording& rows, const Rows* counted, std::size_t most);
  static void leave_every_other_run_aside(Rows& some);

  std::size_t most_rows_;
  std::size_t merged_ = 1;
  Rows all_;
};

}  // namespace heatsoak::recording
