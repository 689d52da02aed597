// Search for the smallest safety factor on heat that a check accepts.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace heatsoak::derate {

/// Answer of a check for one factor.
struct TriedFactor {
  bool is_enough = false;
  std::optional<double> expected_ratio = {};  ///< estimate of the smallest factor that is enough
};

/// Grid of factors: steps of `growth_ratio` from `from_ratio` to `most_ratio`, each halved until it is 1 % wide.
struct FactorGrid {
  double from_ratio = 1.0;
  double most_ratio = 1.0;
  double growth_ratio = 2.0;  ///< > 1

  /// Two neighbouring factors of the grid; `low_ratio` is 0 below the first one, and `high_ratio` is infinite above the last one.
  struct Cell {
    double low_ratio = 0.0;
    double high_ratio = 0.0;
  };
  /// Returns the cell with low_ratio < `ratio` ≤ high_ratio.
  [[nodiscard]] Cell cell_of(double ratio) const {
    constexpr double kTolerance_ratio = 0.01;
    Cell cell = step_of(ratio);
    while (cell.low_ratio > 0.0 && std::isfinite(cell.high_ratio) && cell.high_ratio > cell.low_ratio * (1.0 + kTolerance_ratio)) {
      const double middle_ratio = 0.5 * (cell.low_ratio + cell.high_ratio);
      (ratio <= middle_ratio ? cell.high_ratio : cell.low_ratio) = middle_ratio;
    }
    return cell;
  }
  /// Returns the step that contains `ratio`, before it is halved.
  [[nodiscard]] Cell step_of(double ratio) const {
    Cell step{0.0, std::min(from_ratio, most_ratio)};
    while (ratio > step.high_ratio) {
      step.low_ratio = step.high_ratio;
      step.high_ratio =
          step.high_ratio >= most_ratio ? std::numeric_limits<double>::infinity() : std::min(step.high_ratio * growth_ratio, most_ratio);
    }
    return step;
  }
};

/// Returns the smallest factor of the grid that `check(factor)`, which returns a TriedFactor, accepts; nothing if it rejects the last one.
/// The result itself was accepted. The search assumes that every factor above an accepted one is accepted, too. Then the expected factors
/// change only the number of checks. No factor above the first accepted step is checked.
template <class CheckFactor>
std::optional<double> smallest_factor(const FactorGrid& grid, const CheckFactor& check) {
  constexpr int kMostExpected = 4;                                      // if these do not lead to the result, bisection takes fewer checks
  FactorGrid::Cell open{0.0, std::numeric_limits<double>::infinity()};  // rejected at the low end, accepted at the high one
  double guess_ratio = std::min(grid.from_ratio, grid.most_ratio);
  for (int used = 0;;) {
    const FactorGrid::Cell cell = grid.cell_of(guess_ratio);
    if (cell.low_ratio == open.low_ratio && cell.high_ratio == open.high_ratio) {
      return std::isfinite(open.high_ratio) ? std::optional(open.high_ratio) : std::nullopt;
    }
    const double ratio = cell.high_ratio < open.high_ratio ? cell.high_ratio : cell.low_ratio;
    const TriedFactor found = check(ratio);
    (found.is_enough ? open.high_ratio : open.low_ratio) = ratio;
    const double above_ratio = std::nextafter(open.low_ratio, std::numeric_limits<double>::infinity());
    const bool is_bounded = std::isfinite(open.high_ratio);
    const double largest_ratio = is_bounded ? open.high_ratio : grid.step_of(above_ratio).high_ratio;
    const bool is_far = !is_bounded && found.expected_ratio.value_or(0.0) >= largest_ratio;
    if (!is_far && used < kMostExpected && found.expected_ratio) {
      ++used;
      guess_ratio = std::clamp(*found.expected_ratio, above_ratio, largest_ratio);
    } else {
      guess_ratio = is_bounded ? 0.5 * (open.low_ratio + open.high_ratio) : largest_ratio;
    }
  }
}

}  // namespace heatsoak::derate
