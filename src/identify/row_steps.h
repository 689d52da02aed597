// How a log was sampled: whether a longer step between rows lacks rows, or is how that logger writes.
#pragma once

#include <span>

namespace heatsoak {

struct RowSteps {
  double usual_s = 0.0;  ///< median
  /// Steps are the usual one, or a whole multiple of it where rows were lost; otherwise rows came when something changed.
  bool is_regular = false;
};

RowSteps row_steps(std::span<const double> time_s);

}  // namespace heatsoak
