#include "identify/measurement/row_order.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "identify/measurement/noise.h"

namespace heatsoak {
namespace {

/// Three, and a little: a step of exactly three periods must not split by rounding.
constexpr double kLongestStep_ratio = 3.0 * (1.0 + 1e-6);
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

bool changes(double before, double after) { return before != after && !(std::isnan(before) && std::isnan(after)); }

}  // namespace

double usual_period_s(std::span<const double> time_s) {
  std::vector<double> steps_s;
  steps_s.reserve(time_s.size());
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    steps_s.push_back(time_s[i] - time_s[i - 1]);
  }
  return median_of(std::move(steps_s));
}

std::vector<char> increasing_rows(std::span<const double> time_s) {
  if (std::ranges::adjacent_find(time_s, std::greater_equal<>()) == time_s.end()) {
    return std::vector<char>(time_s.size(), 1);
  }
  // Patience: tails[k] ends the best sequence of k + 1 rows. An equal time does not replace, so the first of them stays.
  std::vector<std::size_t> tails;
  std::vector<std::size_t> before(time_s.size(), kNone);
  for (std::size_t row = 0; row < time_s.size(); ++row) {
    const auto place = std::ranges::lower_bound(tails, time_s[row], {}, [&](std::size_t tail) { return time_s[tail]; });
    before[row] = place == tails.begin() ? kNone : *(place - 1);
    if (place == tails.end()) {
      tails.push_back(row);
    } else if (time_s[row] < time_s[*place]) {
      *place = row;
    }
  }
  std::vector<char> stays(time_s.size(), 0);
  for (std::size_t row = tails.empty() ? kNone : tails.back(); row != kNone; row = before[row]) {
    stays[row] = 1;
  }
  return stays;
}

std::vector<std::size_t> run_begins(std::span<const double> time_s, std::span<const double> run_values,
                                    std::optional<double> longest_gap_s) {
  std::vector<std::size_t> begins;
  if (time_s.empty()) {
    return begins;
  }
  begins.push_back(0);
  const double longest_s = longest_gap_s.value_or(kLongestStep_ratio * usual_period_s(time_s));
  for (std::size_t row = 1; row < time_s.size(); ++row) {
    if (time_s[row] - time_s[row - 1] > longest_s || (!run_values.empty() && changes(run_values[row - 1], run_values[row]))) {
      begins.push_back(row);
    }
  }
  return begins;
}

}  // namespace heatsoak
