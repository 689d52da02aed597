// Heat inputs of a segment of a recording, from row to row, with assumptions and their uncertainty where rows or values are missing.
#pragma once

#include <functional>

#include "estimation/gap_statistics.h"
#include "estimation/log_rows.h"
#include "estimation/mean_inputs.h"
#include "estimation/row_steps.h"

namespace heatsoak::estimation {

class SegmentInputs {
 public:
  /// Uses rows first … last. Recording and rows must outlive this object.
  SegmentInputs(const recording::Recording& recording, const LogRows& rows, std::size_t first, std::size_t last);

  /// Called for every row at which an interval may end.
  using Ends = std::function<void(std::size_t row)>;
  /// Adds the inputs of the time from `row` to `next`, the next row with known inputs. The inputs of `row` hold until the row after it. If
  /// rows are missing there, they hold for one usual step, which ends at `next` if the rows of the log describe the interval before them.
  /// The remaining time is a gap. Its first half gets the inputs before the gap, its second half those after it. Cells that were logged
  /// within the gap replace them. The gap gets an uncertainty: one for each row if only the speed is missing, otherwise one as a whole.
  void add(std::size_t row, std::size_t next, MeanInputs& mean, const Ends& ends);

 private:
  using Point = thermal::OperatingPoint<double>;
  /// Gap between two rows with known inputs.
  struct Gap {
    std::size_t row, next;
    bool lacks_rows;  ///< rows are missing directly after `row`
    double own_s;     ///< time from `row` to the row after it
    double unknown_s;
    Point before, after;
  };
  void add_gap(const Gap& gap, MeanInputs& mean, const Ends& ends);
  void add_middle(const Gap& gap, const Point& cells, double middle_s, MeanInputs& mean) const;
  void add_uncertainty(const Gap& gap, const Point& cells, double uncertain_s, MeanInputs& mean);
  /// Quantities that every row of a gap has; NaN for those that at least one row lacks.
  [[nodiscard]] Point always_known(const Gap& gap) const;
  /// Operating point of a row with 0 for unknown quantities (the model does not need them), so that means are not NaN.
  [[nodiscard]] Point filled(std::size_t row) const;

  const recording::Recording& recording_;
  const LogRows& rows_;
  RowSteps steps_;
  GapStatisticsTable square_A2_, speed_rad_per_s_;
};

}  // namespace heatsoak::estimation
