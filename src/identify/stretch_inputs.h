// Heat inputs of a stretch of a recording from row to row, and what is supposed where nobody logged them.
#pragma once

#include <functional>

#include "identify/gap_habits.h"
#include "identify/log_rows.h"
#include "identify/mean_inputs.h"
#include "identify/row_steps.h"

namespace heatsoak {

class StretchInputs {
 public:
  /// Rows first … last; recording and rows outlive it.
  StretchInputs(const Recording& recording, const LogRows& rows, std::size_t first, std::size_t last);

  /// Told every row at which an interval may end.
  using Ends = std::function<void(std::size_t row)>;
  /// From `row` to `next`, the next one whose inputs are known: they are its own to the row behind it, or for a usual step, at that end of
  /// a longer one which its samples speak of; what they were in the rest nobody logged, but for the cells that are there.
  /// Rows whose heat is known but for what the speed brings stay rows of their own.
  void add(std::size_t row, std::size_t next, MeanInputs& mean, const Ends& ends);

 private:
  using Point = OperatingPoint<double>;
  /// Between two rows whose inputs are known.
  struct Gap {
    std::size_t row, next;
    bool lacks_rows;  ///< right behind `row`
    double own_s;     ///< to the row behind
    double unknown_s;
    Point before, after;
  };
  void add_gap(const Gap& gap, MeanInputs& mean, const Ends& ends);
  void add_middle(const Gap& gap, const Point& cells, double middle_s, MeanInputs& mean) const;
  void doubt(const Gap& gap, const Point& cells, double doubted_s, MeanInputs& mean);
  /// What all rows of a gap hold; NaN where one of them does not.
  [[nodiscard]] Point always_known(const Gap& gap) const;
  /// A quantity that is not needed and not known becomes 0, so that means stay numbers.
  [[nodiscard]] Point filled(std::size_t row) const;

  const Recording& recording_;
  const LogRows& rows_;
  RowSteps steps_;
  GapHabits square_A2_, speed_rad_per_s_;
};

}  // namespace heatsoak
