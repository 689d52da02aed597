#include "estimation/row_steps.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimation/thresholds.h"
#include "recording/spread.h"

namespace heatsoak::estimation {

RowSteps row_steps(std::span<const double> time_s) {
  std::vector<double> steps_s;
  for (std::size_t row = 0; row + 1 < time_s.size(); ++row) {
    steps_s.push_back(time_s[row + 1] - time_s[row]);
  }
  if (steps_s.empty()) {
    return {};
  }
  const double usual_s = recording::middle_of(steps_s);
  // Lost rows make whole numbers of steps.
  double off_steps = 0.0;
  for (const double step_s : steps_s) {
    const double steps = step_s / usual_s;
    off_steps += std::abs(steps - std::max(1.0, std::round(steps)));
  }
  const bool is_regular = off_steps <= thresholds().off_step_ratio * static_cast<double>(steps_s.size());
  return {usual_s, is_regular};
}

}  // namespace heatsoak::estimation
