#include "estimation/row_steps.h"

#include <algorithm>
#include <cmath>
#include <vector>

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
  // Timing jitter and the loss of a third of the rows still count as regular.
  constexpr double kJitter_ratio = 0.25;
  constexpr double kUsual_share = 0.6;
  constexpr double kMultiples_share = 0.9;
  const auto share_of = [&](auto&& is_such) {
    return static_cast<double>(std::ranges::count_if(steps_s, is_such)) / static_cast<double>(steps_s.size());
  };
  const auto is_near = [&](double step_s, double times) { return std::abs(step_s / usual_s - times) <= kJitter_ratio; };
  const bool is_regular =
      share_of([&](double step_s) { return is_near(step_s, 1.0); }) >= kUsual_share &&
      share_of([&](double step_s) { return is_near(step_s, std::max(1.0, std::round(step_s / usual_s))); }) >= kMultiples_share;
  return {usual_s, is_regular};
}

}  // namespace heatsoak::estimation
