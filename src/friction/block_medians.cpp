#include "friction/block_medians.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "friction/robust_fit.h"
#include "recording/noise.h"

namespace heatsoak::friction {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kLeastRows = 5;
constexpr std::size_t kMostRows = 9;
constexpr double kBlock_s = 0.1;
constexpr std::ptrdiff_t kLeastValues = 3;

/// Number of rows that span about kBlock_s, odd so that the median is one of the values.
std::size_t rows_per_block(const FrictionLog& log, std::size_t begin, std::size_t end) {
  std::vector<double> steps_s;
  for (std::size_t i = begin + 1; i < end; ++i) {
    steps_s.push_back(log.time_s[i] - log.time_s[i - 1]);
  }
  const double period_s = median(steps_s);
  const double wanted = std::isfinite(period_s) && period_s > 0.0 ? kBlock_s / period_s : 0.0;
  return std::clamp(static_cast<std::size_t>(std::min(wanted, 1e3)) | 1U, kLeastRows, kMostRows);
}

double median_of_rows(const std::vector<double>& column, std::size_t begin, std::size_t count) {
  std::array<double, kMostRows> values{};
  std::copy_n(column.begin() + static_cast<std::ptrdiff_t>(begin), count, values.begin());
  const std::span<double> rows = std::span(values).first(count);
  return std::ranges::count_if(rows, [](double value) { return std::isfinite(value); }) < kLeastValues ? kNaN : median(rows);
}

/// Running median of three values; the two ends are unchanged.
Eigen::RowVectorXd without_outliers(const Eigen::RowVectorXd& raw) {
  Eigen::RowVectorXd smooth = raw;
  for (Eigen::Index i = 1; i + 1 < raw.size(); ++i) {
    std::array<double, 3> three{raw(i - 1), raw(i), raw(i + 1)};
    smooth(i) = median(three);
  }
  return smooth;
}

double top_of(const Eigen::RowVectorXd& values) {
  std::vector<double> sizes;
  for (const double value : values) {
    if (std::isfinite(value)) {
      sizes.push_back(std::abs(value));
    }
  }
  std::ranges::sort(sizes);
  return sizes.empty() ? 0.0 : sizes[sizes.size() * 95 / 100];
}

}  // namespace

BlockMedians block_medians(const FrictionLog& log, int wheel_count, std::size_t begin, std::size_t end) {
  BlockMedians blocks;
  blocks.rows_per_block = rows_per_block(log, begin, end);
  std::vector<const std::vector<double>*> signals;
  for (const auto* group : {&log.wheel_speed_rad_per_s, &log.voltage_V}) {
    for (int i = 0; i < wheel_count; ++i) {
      if (!(*group)[static_cast<std::size_t>(i)].empty()) {
        signals.push_back(&(*group)[static_cast<std::size_t>(i)]);
      }
    }
  }
  for (std::size_t row = begin; row + blocks.rows_per_block <= end; row += blocks.rows_per_block) {
    blocks.first_row.push_back(row);
    const std::size_t next = std::min(row + blocks.rows_per_block, end - 1);
    blocks.begin_s.push_back(log.time_s[row]);
    blocks.duration_s.push_back(log.time_s[next] - log.time_s[row]);
  }
  const auto count = static_cast<Eigen::Index>(blocks.first_row.size());
  const auto signal_count = static_cast<Eigen::Index>(signals.size());
  blocks.raw.resize(signal_count, count);
  blocks.values.resize(signal_count, count);
  blocks.resolution.resize(signal_count);
  blocks.top.resize(signal_count);
  for (Eigen::Index s = 0; s < signal_count; ++s) {
    const std::vector<double>& column = *signals[static_cast<std::size_t>(s)];
    for (Eigen::Index k = 0; k < count; ++k) {
      blocks.raw(s, k) = median_of_rows(column, blocks.first_row[static_cast<std::size_t>(k)], blocks.rows_per_block);
    }
    blocks.values.row(s) = without_outliers(blocks.raw.row(s));
    blocks.resolution(s) = recording::resolution_of(column);
    blocks.top(s) = top_of(blocks.values.row(s));
  }
  return blocks;
}

double block_deviation(const BlockMedians& blocks, Eigen::Index signal, Eigen::Index begin, Eigen::Index end) {
  std::vector<double> bends;
  for (Eigen::Index i = begin + 1; i + 1 < end; ++i) {
    bends.push_back(std::abs(blocks.raw(signal, i - 1) - 2.0 * blocks.raw(signal, i) + blocks.raw(signal, i + 1)));
  }
  const double typical = median(bends);
  return std::max(std::isfinite(typical) ? 1.4826 / std::sqrt(6.0) * typical : 0.0, 0.5 * blocks.resolution(signal));
}

}  // namespace heatsoak::friction
