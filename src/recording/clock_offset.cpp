#include "recording/clock_offset.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string_view>

#include "base/copper.h"
#include "base/unknown.h"
#include "recording/noise.h"
#include "recording/quantities.h"
#include "recording/row_order.h"

namespace heatsoak::recording {
namespace {

constexpr int kDelays = 61;
constexpr int kParts = 8;  ///< number of parts of the log for the jackknife
constexpr std::size_t kMostWindows = 600;
constexpr std::size_t kFewestWindows = 40;

/// Integral of a channel between two times. The channel is piecewise constant (`is_held`) or, for temperatures, piecewise linear.
class Integral {
 public:
  Integral(std::span<const double> time_s, std::span<const double> values, bool is_held)
      : time_s_(time_s), values_(values), is_held_(is_held) {
    sums_.resize(time_s.size(), 0.0);
    for (std::size_t i = 1; i < time_s.size(); ++i) {
      const double mean = is_held ? values[i - 1] : 0.5 * (values[i - 1] + values[i]);
      sums_[i] = sums_[i - 1] + mean * (time_s[i] - time_s[i - 1]);
    }
  }
  [[nodiscard]] double between(double from_s, double to_s) const { return at(to_s) - at(from_s); }

 private:
  [[nodiscard]] double at(double moment_s) const {
    if (moment_s < time_s_.front() || moment_s > time_s_.back()) {
      return base::kUnknown;
    }
    const auto after = std::ranges::upper_bound(time_s_, moment_s);
    const auto row = static_cast<std::size_t>(after - time_s_.begin()) - 1;
    return sums_[row] + (moment_s > time_s_[row] ? values_[row] * (moment_s - time_s_[row]) : 0.0);
  }

  std::span<const double> time_s_;
  std::span<const double> values_;
  bool is_held_;
  std::vector<double> sums_;  ///< NaN from the first unknown value on
};

/// Rows [begin, end) in which all needed channels are known.
struct Piece {
  std::size_t begin = 0;
  std::size_t end = 0;
};

std::vector<Piece> known_pieces(const Recording& recording, std::span<const std::span<const double>> channels) {
  std::vector<Piece> pieces;
  for (const auto& [begin, end] : recording.runs()) {
    std::size_t from = begin;
    for (std::size_t row = begin; row <= end; ++row) {
      const bool is_known =
          row < end && std::ranges::none_of(channels, [row](std::span<const double> values) { return std::isnan(values[row]); });
      if (!is_known) {
        if (row > from + 1) {
          pieces.push_back({from, row});
        }
        from = row + 1;
      }
    }
  }
  return pieces;
}

/// Fills gaps up to `longest_s` by linear interpolation. This is accurate enough for the delay, and pieces without gaps may not exist.
std::vector<double> bridged(std::span<const double> time_s, std::span<const double> values, double longest_s) {
  std::vector<double> filled(values.begin(), values.end());
  std::size_t before = values.size();
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (std::isnan(values[row])) {
      continue;
    }
    if (before < row && row > before + 1 && time_s[row] - time_s[before] <= longest_s) {
      for (std::size_t i = before + 1; i < row; ++i) {
        filled[i] = values[before] + (values[row] - values[before]) * (time_s[i] - time_s[before]) / (time_s[row] - time_s[before]);
      }
    }
    before = row;
  }
  return filled;
}

struct Window {
  std::size_t piece = 0;
  double begin_s = 0.0;
  double end_s = 0.0;
  double change_K = 0.0;
};

/// Fits all windows for many delays. Keeps normal equations per part of the log, so that parts can be left out cheaply.
class DelayScan {
 public:
  DelayScan(const Recording& recording, const Channel& temperature, const Channel& heat_input) : time_s_(recording.time_s) {
    const double bridge_s = 10.0 * usual_period_s(time_s_);
    heat_ = relative_heat(heat_input);
    columns_.push_back(bridged(time_s_, temperature.values, bridge_s));
    if (heat_input.quantity.unit == "A") {
      heat_by_hot_copper();
    }
    for (const Channel& other : recording.channels) {
      const bool is_other = &other != &temperature && other.quantity.kind == QuantityKind::temperature;
      if (is_other && std::ranges::count_if(other.values, [](double value) { return std::isnan(value); }) < std::ssize(other.values) / 10) {
        columns_.push_back(bridged(time_s_, other.values, bridge_s));
      }
    }
    std::vector<std::span<const double>> needed{heat_};
    needed.insert(needed.end(), columns_.begin(), columns_.end());
    pieces_ = known_pieces(recording, needed);
  }

  /// Share of the heat's changes that fall into lost rows. There the previous row is held, so that inputs appear late.
  [[nodiscard]] double lost_changes_share() const {
    constexpr double kLost_ratio = 1.5;
    const double period_s = usual_period_s(time_s_);
    double lost = 0.0;
    double all = 0.0;
    for (std::size_t row = 1; row < time_s_.size(); ++row) {
      const double change = std::abs(heat_[row] - heat_[row - 1]);
      if (!std::isnan(change)) {
        all += change;
        lost += time_s_[row] - time_s_[row - 1] > kLost_ratio * period_s ? change : 0.0;
      }
    }
    return all > 0.0 ? lost / all : 0.0;
  }

  /// True if the log has another temperature and this one is clearly the hottest while heated. Only then its heat flow to the others is
  /// known; a temperature that is not the hottest follows the others instead of the current.
  [[nodiscard]] bool explains_flow(double noise_K) const {
    constexpr double kClearly = 5.0;
    if (columns_.size() < 2) {
      return false;
    }
    std::vector<double> heats;
    std::ranges::copy_if(heat_, std::back_inserter(heats), [](double heat) { return heat > 0.0; });
    const double usual_heat = median_of(heats);
    std::vector<double> above_K;
    for (std::size_t row = 0; row < time_s_.size(); ++row) {
      double highest_C = columns_[1][row];
      for (std::size_t other = 2; other < columns_.size(); ++other) {
        highest_C = std::max(highest_C, columns_[other][row]);
      }
      if (const double here_K = columns_[0][row] - highest_C; heat_[row] >= usual_heat && !std::isnan(here_K)) {
        above_K.push_back(here_K);
      }
    }
    return !above_K.empty() && median_of(std::move(above_K)) > kClearly * noise_K;
  }

  /// Chooses windows long enough that the temperature changes well beyond its noise. Returns their number.
  std::size_t place_windows(double noise_K, double reach_s) {
    const double period_s = usual_period_s(time_s_);
    for (double length_s = 4.0 * period_s; length_s < 0.1 * (time_s_.back() - time_s_.front()); length_s *= 2.0) {
      windows_ = windows_of(length_s, reach_s);
      std::vector<double> changes_K;
      for (const Window& window : windows_) {
        changes_K.push_back(std::abs(window.change_K));
      }
      if (median_of(std::move(changes_K)) > 10.0 * noise_K) {
        break;
      }
    }
    return windows_.size();
  }

  /// Sum of squared errors for each delay, with each part of the log left out; the last entry uses all parts.
  std::vector<std::array<double, kParts + 1>> errors(std::span<const double> delays_s) const {
    const auto size = static_cast<Eigen::Index>(columns_.size() + 2);
    std::vector<Integral> heats;
    std::vector<std::vector<Integral>> temperatures(pieces_.size());
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      const auto part_of = [&](const std::vector<double>& values) {
        return std::span<const double>(values).subspan(pieces_[p].begin, pieces_[p].end - pieces_[p].begin);
      };
      heats.emplace_back(part_of(time_s_), part_of(heat_), true);
      for (const std::vector<double>& column : columns_) {
        temperatures[p].emplace_back(part_of(time_s_), part_of(column), false);
      }
    }
    std::vector<std::array<double, kParts + 1>> found;
    for (const double delay_s : delays_s) {
      // The additional row and column hold y, so that one matrix contains XᵀX, Xᵀy and yᵀy.
      std::array<Eigen::MatrixXd, kParts> products;
      products.fill(Eigen::MatrixXd::Zero(size + 1, size + 1));
      Eigen::VectorXd row(size + 1);
      for (std::size_t k = 0; k < windows_.size(); ++k) {
        const Window& window = windows_[k];
        row[0] = heats[window.piece].between(window.begin_s - delay_s, window.end_s - delay_s);
        row[1] = window.end_s - window.begin_s;
        for (std::size_t c = 0; c < columns_.size(); ++c) {
          row[static_cast<Eigen::Index>(c) + 2] = temperatures[window.piece][c].between(window.begin_s, window.end_s);
        }
        row[size] = window.change_K;
        products[k * kParts / windows_.size()] += row * row.transpose();
      }
      found.push_back(errors_of(products, size));
    }
    return found;
  }

 private:
  /// Scales the heat with the copper's resistance. Without this, heat that grows with temperature would appear to lag behind the current.
  void heat_by_hot_copper() {
    for (std::size_t row = 0; row < heat_.size(); ++row) {
      heat_[row] *= base::resistance_ratio(base::kCopper_per_K, columns_.front()[row]);
    }
  }

  [[nodiscard]] std::vector<Window> windows_of(double length_s, double reach_s) const {
    std::vector<Window> found;
    // Random steps: even ones would sample a periodic load at only a few of its phases.
    const std::size_t longest_stride = 2 * (time_s_.size() / kMostWindows) + 1;
    std::minstd_rand steps;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      const auto& [begin, end] = pieces_[p];
      std::size_t to = begin;
      for (std::size_t from = begin; from < end; from += 1 + steps() % longest_stride) {
        while (to + 1 < end && time_s_[to] - time_s_[from] < length_s) {
          ++to;
        }
        // All delays must use the same windows.
        if (time_s_[to] - time_s_[from] >= length_s && time_s_[from] - reach_s >= time_s_[begin] &&
            time_s_[to] + reach_s <= time_s_[end - 1]) {
          found.push_back({p, time_s_[from], time_s_[to], columns_[0][to] - columns_[0][from]});
        }
      }
    }
    return found;
  }

  static std::array<double, kParts + 1> errors_of(const std::array<Eigen::MatrixXd, kParts>& products, Eigen::Index size) {
    Eigen::MatrixXd all = products[0];
    for (int part = 1; part < kParts; ++part) {
      all += products[static_cast<std::size_t>(part)];
    }
    std::array<double, kParts + 1> found{};
    for (int part = 0; part <= kParts; ++part) {
      const Eigen::MatrixXd left = part < kParts ? Eigen::MatrixXd(all - products[static_cast<std::size_t>(part)]) : all;
      const Eigen::VectorXd right = left.topRightCorner(size, 1);
      const Eigen::VectorXd solution = left.topLeftCorner(size, size).completeOrthogonalDecomposition().solve(right);
      found[static_cast<std::size_t>(part)] = left(size, size) - solution.dot(right);
    }
    return found;
  }

  const std::vector<double>& time_s_;
  std::vector<double> heat_;
  std::vector<std::vector<double>> columns_;  ///< temperatures, first the one whose delay is estimated
  std::vector<Piece> pieces_;
  std::vector<Window> windows_;
};

/// Delay of the smallest error, interpolated by a parabola; nullopt if it is at an end of the grid.
std::optional<double> bottom_of(std::span<const double> delays_s, const std::vector<std::array<double, kParts + 1>>& errors,
                                std::size_t part) {
  std::size_t best = 0;
  for (std::size_t k = 0; k < errors.size(); ++k) {
    best = errors[k][part] < errors[best][part] ? k : best;
  }
  if (best == 0 || best + 1 == errors.size()) {
    return std::nullopt;
  }
  const double left = errors[best - 1][part];
  const double right = errors[best + 1][part];
  const double curvature = left - 2.0 * errors[best][part] + right;
  return delays_s[best] + (curvature > 0.0 ? 0.5 * (delays_s[1] - delays_s[0]) * (left - right) / curvature : 0.0);
}

/// Searches the delay within around_s ± reach_s. If it cannot be determined, why_not states the reason.
ClockOffset offset_within(double around_s, double reach_s, DelayScan& scan, double noise_K, double period_s) {
  ClockOffset offset;
  if (scan.place_windows(noise_K, std::abs(around_s) + reach_s) < kFewestWindows) {
    offset.why_not = IntervalsTooShort{};
    return offset;
  }
  std::vector<double> delays_s;
  for (int k = 0; k < kDelays; ++k) {
    delays_s.push_back(around_s + reach_s * (2.0 * k / (kDelays - 1) - 1.0));
  }
  const auto errors = scan.errors(delays_s);
  const std::optional<double> delay_s = bottom_of(delays_s, errors, kParts);
  double sum_s = 0.0;
  double sum_s2 = 0.0;
  int found = 0;
  for (std::size_t part = 0; part < kParts; ++part) {
    if (const std::optional<double> without_s = bottom_of(delays_s, errors, part)) {
      sum_s += *without_s;
      sum_s2 += *without_s * *without_s;
      ++found;
    }
  }
  constexpr double kTooWide_share = 0.25;
  if (!delay_s || found < kParts) {
    offset.why_not = NoBestDelay{reach_s};
    return offset;
  }
  const double mean_s = sum_s / kParts;
  constexpr double kMany_share = 0.1;
  const double held_too_long_s = scan.lost_changes_share() > kMany_share ? period_s : 0.0;
  // Jackknife error, plus the unknown time of a heat step between two rows.
  const double by_parts_s = std::sqrt(std::max(0.0, (kParts - 1.0) * (sum_s2 / kParts - mean_s * mean_s)));
  const double standard_error_s = std::hypot(by_parts_s, period_s / std::sqrt(12.0), held_too_long_s);
  if (standard_error_s > kTooWide_share * reach_s) {
    offset.why_not = PartsDisagree{standard_error_s};
    return offset;
  }
  offset.delay_s = *delay_s;
  offset.delay_uncertainty_s = standard_error_s;
  offset.misfit_ratio = scan.errors(std::array{0.0}).front()[kParts] / scan.errors(std::array{*delay_s}).front()[kParts];
  return offset;
}

/// True if the delay exceeds its uncertainty and the possible effects of row averages and unmodelled heat. Only for the winding and its
/// current: other bodies respond late, and power also contains mechanical work. Needs another temperature (explains_flow), because unknown
/// heat flow would look like an offset.
bool is_sure(const ClockOffset& offset, double period_s) {
  constexpr double kStandardErrors = 3.0;
  // Ratio of squared errors: up to 2 for logs without offset but with another heat source, 11 or more for an offset of one row.
  constexpr double kMuchBetter_ratio = 5.0;
  constexpr double kLeast_s = 0.3;
  constexpr double kLeast_rows = 0.2;
  constexpr std::array<std::string_view, 2> kDirect{column_of(base::Signal::current), "current_q_A"};
  return offset.delay_s && offset.explains_flow && offset.misfit_ratio > kMuchBetter_ratio && offset.temperature == "winding_C" &&
         std::ranges::find(kDirect, offset.heat_input) != kDirect.end() &&
         std::abs(*offset.delay_s) > std::max({kStandardErrors * offset.delay_uncertainty_s, kLeast_s, kLeast_rows * period_s});
}

}  // namespace

ClockOffset clock_offset(const Recording& recording, const Channel& temperature, const Channel& heat_input, double noise_K) {
  const double period_s = usual_period_s(recording.time_s);
  const double farthest_s = 0.1 * (recording.time_s.back() - recording.time_s.front());
  const double near_s = std::min(farthest_s, std::max(10.0, 10.0 * period_s));
  DelayScan scan(recording, temperature, heat_input);
  ClockOffset offset = offset_within(0.0, near_s, scan, noise_K, period_s);
  // Two loggers started by hand may differ by more.
  constexpr double kByHand = 10.0;
  if (!offset.delay_s && farthest_s > near_s) {
    const ClockOffset wide = offset_within(0.0, std::min(farthest_s, kByHand * near_s), scan, noise_K, period_s);
    if (wide.delay_s && std::abs(*wide.delay_s) > near_s) {
      offset = offset_within(*wide.delay_s, near_s, scan, noise_K, period_s);
    }
  }
  offset.temperature = temperature.quantity.key;
  offset.heat_input = heat_input.quantity.key;
  offset.explains_flow = scan.explains_flow(noise_K);
  return offset;
}

std::optional<RespondsEarly> early_answer(const ClockOffset& offset, double period_s) {
  if (!is_sure(offset, period_s) || *offset.delay_s > 0.0) {
    return {};
  }
  constexpr double kAboutOneRow = 0.3;
  const bool is_one_row = std::abs(*offset.delay_s + period_s) < std::max(kAboutOneRow * period_s, offset.delay_uncertainty_s);
  return RespondsEarly{offset.temperature, offset.heat_input, *offset.delay_s, offset.delay_uncertainty_s, is_one_row};
}

std::optional<RespondsLate> late_answer(const ClockOffset& offset, double period_s) {
  if (!is_sure(offset, period_s) || *offset.delay_s < 0.0) {
    return {};
  }
  return RespondsLate{offset.temperature, offset.heat_input, *offset.delay_s, offset.delay_uncertainty_s};
}

}  // namespace heatsoak::recording
