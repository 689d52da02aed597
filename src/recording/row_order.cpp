#include "recording/row_order.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "recording/noise.h"

namespace heatsoak::recording {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

bool changes(double before, double after) { return before != after && !(std::isnan(before) && std::isnan(after)); }

}  // namespace

double usual_period_s(std::span<const double> time_s) {
  Thinned steps_s;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    steps_s.add(time_s[i] - time_s[i - 1]);
  }
  return median_of(steps_s.values());
}

std::vector<char> increasing_rows(std::span<const double> time_s) {
  if (std::ranges::adjacent_find(time_s, std::greater_equal<>()) == time_s.end()) {
    return std::vector<char>(time_s.size(), 1);
  }
  // Patience sorting from the end: tails[k] begins the best sequence of k + 1 rows. An equally good earlier row replaces it,
  // so that the first rows stay.
  std::vector<std::size_t> tails;
  std::vector<std::size_t> after(time_s.size(), kNone);
  for (std::size_t row = time_s.size(); row-- > 0;) {
    const auto place = std::ranges::lower_bound(tails, -time_s[row], {}, [&](std::size_t tail) { return -time_s[tail]; });
    after[row] = place == tails.begin() ? kNone : *(place - 1);
    if (place == tails.end()) {
      tails.push_back(row);
    } else {
      *place = row;
    }
  }
  std::vector<char> stays(time_s.size(), 0);
  for (std::size_t row = tails.empty() ? kNone : tails.back(); row != kNone; row = after[row]) {
    stays[row] = 1;
  }
  return stays;
}

std::vector<std::size_t> run_begins(std::span<const double> time_s, std::span<const double> values, double longest_gap_s) {
  std::vector<std::size_t> begins;
  if (time_s.empty()) {
    return begins;
  }
  begins.push_back(0);
  for (std::size_t row = 1; row < time_s.size(); ++row) {
    if (time_s[row] - time_s[row - 1] > longest_gap_s || (!values.empty() && changes(values[row - 1], values[row]))) {
      begins.push_back(row);
    }
  }
  return begins;
}

}  // namespace heatsoak::recording
