// Sampling of a log: distinguishes missing rows from a logger that writes at irregular times.
#pragma once

#include <span>

namespace heatsoak::estimation {

struct RowSteps {
  double usual_s = 0.0;  ///< median time between rows
  /// True if nearly all steps are integer multiples of the usual one (longer steps lack rows); false if rows were written on changes.
  bool is_regular = false;
};

/// Analyses the times of the rows.
RowSteps row_steps(std::span<const double> time_s);

}  // namespace heatsoak::estimation
