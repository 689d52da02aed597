// Progress of a derating: the work of its stages is known only roughly in advance.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/parallel.h"

namespace heatsoak::derate {

/// Counts the work of the stages in simulations of one motor through one use, and reports it. A stage that takes longer than expected is
/// assumed to take another tenth of its time.
class SearchWork {
 public:
  enum Stage : std::size_t { factor_of_search, factor_of_promise, final_check, sensor_search, sensor_promise, sensor_fault, kStageCount };

  /// `progress` may be empty and must outlive this object.
  explicit SearchWork(const base::Progress& progress) : progress_(progress) {}

  [[nodiscard]] std::size_t expected(Stage stage) const { return expected_[stage]; }
  void expect(Stage stage, std::size_t simulations) { expected_[stage] = simulations; }

  /// Begins a stage and ends those before it: their finished work becomes their whole work.
  void begin(Stage stage) {
    for (std::size_t each = stage_; each < stage; ++each) {
      expected_[each] = done_[each];
    }
    stage_ = stage;
    add(0);
  }
  /// Adds finished work of the present stage. Must be called by one thread at a time.
  void add(std::size_t simulations) {
    done_[stage_] += simulations;
    if (!progress_) {
      return;
    }
    std::size_t done = 0;
    std::size_t all = 1;
    for (std::size_t each = 0; each < kStageCount; ++each) {
      const std::size_t longer = each == stage_ && done_[each] > expected_[each] ? done_[each] / 10 : 0;
      done += done_[each];
      all += std::max(expected_[each], done_[each] + longer);
    }
    progress_(done, all);
  }

 private:
  const base::Progress& progress_;
  std::array<std::size_t, kStageCount> expected_{};
  std::array<std::size_t, kStageCount> done_{};
  std::size_t stage_ = 0;
};

}  // namespace heatsoak::derate
