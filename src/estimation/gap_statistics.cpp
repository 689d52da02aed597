#include "estimation/gap_statistics.h"

#include <algorithm>
#include <cmath>

namespace heatsoak::estimation {
namespace {

constexpr std::size_t kLongest = 60;
/// Fewer windows do not determine the two values.
constexpr double kFewest = 20.0;

}  // namespace

GapStatisticsTable::GapStatisticsTable(std::span<const double> time_s, std::vector<double> values, double usual_s)
    : time_s_(time_s), values_(std::move(values)), usual_s_(usual_s) {
  sum_.push_back(0.0);
  unknown_.push_back(0);
  for (const double value : values_) {
    sum_.push_back(sum_.back() + (std::isnan(value) ? 0.0 : value));
    unknown_.push_back(unknown_.back() + (std::isnan(value) ? 1 : 0));
  }
}

const GapStatistics& GapStatisticsTable::over(std::size_t rows) {
  const std::size_t known = std::clamp<std::size_t>(rows, 1, kLongest);
  const auto found = by_rows_.find(known);
  return found != by_rows_.end() ? found->second : by_rows_.emplace(known, from_windows(known)).first->second;
}

GapStatistics GapStatisticsTable::from_windows(std::size_t rows) const {
  double count = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t before = 0; before + rows + 1 < values_.size(); ++before) {
    const std::size_t after = before + rows + 1;
    const bool lacks_rows = time_s_[after] - time_s_[before] > (static_cast<double>(rows) + 1.5) * usual_s_;
    if (lacks_rows || unknown_[after + 1] > unknown_[before]) {
      continue;
    }
    const double off = (sum_[after] - sum_[before + 1]) / static_cast<double>(rows) - 0.5 * (values_[before] + values_[after]);
    const double square = (values_[after] - values_[before]) * (values_[after] - values_[before]);
    count += 1.0;
    x += square;
    y += off * off;
    xx += square * square;
    xy += square * off * off;
  }
  if (count < kFewest) {
    return rows > 1 ? from_windows(rows / 2) : GapStatistics{};
  }
  const double spread = xx - x * x / count;
  const double most = 0.25;
  const double share = spread > 0.0 ? std::clamp((xy - x * y / count) / spread, 0.0, most) : most;
  return {std::sqrt(share), std::sqrt(std::max(0.0, (y - share * x) / count))};
}

}  // namespace heatsoak::estimation
