#include "identify/measurement/screening.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "base/unknown.h"
#include "identify/measurement/noise.h"
#include "identify/measurement/spread.h"

namespace heatsoak {
namespace {

/// Rows [begin, end) with one value; NaN inside do not end it.
struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t samples = 0;
  double value = 0.0;
};

std::vector<Stretch> stretches_of(std::span<const double> values, std::pair<std::size_t, std::size_t> run) {
  std::vector<Stretch> found;
  for (std::size_t i = run.first; i < run.second; ++i) {
    if (std::isnan(values[i])) {
      continue;
    }
    if (found.empty() || found.back().value != values[i]) {
      found.push_back({i, i, 0, values[i]});
    }
    found.back().end = i + 1;
    ++found.back().samples;
  }
  return found;
}

/// What the channel does when it is in order.
struct Habits {
  double high = 0.0;
  NoiseLevel noise;
  double repeats_share = 0.0;      ///< of neighbours that are equal, long stretches aside
  std::size_t longest_chance = 0;  ///< samples of one value that noise can give; 0 where that cannot be told
};

/// More of a part does not tell its noise better.
constexpr std::size_t kMostSamples = 1 << 14;
constexpr std::size_t kShortStretch = 20;
constexpr std::size_t kPile = 10;  ///< samples at one end of the range, at least, that are called cut off there

Habits habits_of(std::span<const double> values, std::span<const std::vector<Stretch>> runs, const NoiseLevel& noise, double high) {
  Habits habits;
  habits.high = high;
  habits.noise = noise;
  std::size_t samples = 0;
  std::size_t repeats = 0;
  for (const std::vector<Stretch>& run : runs) {
    for (const Stretch& stretch : run) {
      if (stretch.samples < kShortStretch) {
        samples += stretch.samples;
        repeats += stretch.samples - 1;
      }
    }
  }
  constexpr std::size_t kEnoughSamples = 50;
  constexpr double kTooCoarse_share = 0.5;
  habits.repeats_share = samples > 0 ? static_cast<double>(repeats) / static_cast<double>(samples) : 1.0;
  if (samples >= kEnoughSamples && habits.repeats_share < kTooCoarse_share) {
    // n equal neighbours by chance once in a thousand logs of this length: rows · share^n = 1/1000.
    constexpr double kLogOfThousand = 6.9;
    const double share = std::max(habits.repeats_share, 0.05);
    habits.longest_chance =
        1 + static_cast<std::size_t>(std::ceil((std::log(static_cast<double>(values.size())) + kLogOfThousand) / -std::log(share)));
  }
  return habits;
}

/// The change out of the stretch stands alone: what follows moves far less. A sensor that held still while the temperature went on.
bool ends_in_isolated_jump(const std::vector<Stretch>& run, std::size_t at, const Habits& habits) {
  constexpr std::size_t kLongHold = 30;
  constexpr double kIsolated_ratio = 4.0;
  constexpr std::size_t kAfter = 5;
  const std::size_t long_hold = habits.longest_chance > 0 ? habits.longest_chance : kLongHold;
  if (run[at].samples <= long_hold || at + 2 >= run.size()) {
    return false;
  }
  const double jump = std::abs(run[at + 1].value - run[at].value);
  double after = habits.noise.usual;
  for (std::size_t i = at + 2; i < std::min(run.size(), at + 2 + kAfter); ++i) {
    after = std::max(after, std::abs(run[i].value - run[i - 1].value));
  }
  return jump > std::max(kIsolated_ratio * after, 6.0 * habits.noise.noise);
}

/// Noise that never stopped before has stopped for good, after a slope that would have gone on.
bool stays_still_to_the_end(const std::vector<Stretch>& run, std::size_t at, const Habits& habits) {
  constexpr std::size_t kSlopeStretches = 10;
  constexpr double kFarAway_ratio = 20.0;
  if (at + 1 != run.size() || at < kSlopeStretches || habits.longest_chance == 0 || run[at].samples <= habits.longest_chance) {
    return false;
  }
  const Stretch& from = run[at - kSlopeStretches];
  const double slope = (run[at].value - from.value) / static_cast<double>(run[at].begin - from.begin);
  return std::abs(slope) * static_cast<double>(run[at].samples) > kFarAway_ratio * std::max(habits.noise.noise, habits.noise.usual);
}

/// Three steps towards the extreme, each at least usual, and then none at all.
bool climb_stops_dead(const std::vector<Stretch>& run, std::size_t at, const Habits& habits) {
  constexpr std::size_t kStops = 5;
  constexpr std::size_t kClimbs = 4;  // the last one may already be cut
  if (run[at].samples < kStops || at < kClimbs) {
    return false;
  }
  const double sign_factor = run[at].value == habits.high ? 1.0 : -1.0;
  for (std::size_t i = at - kClimbs + 1; i < at; ++i) {
    if (run[i - 1].samples != 1 || sign_factor * (run[i].value - run[i - 1].value) < habits.noise.usual) {
      return false;
    }
  }
  return run[at - 1].samples == 1;
}

/// A noisy channel whose noise is cut off: far more samples at the very end of its range than at any value within,
/// and it comes there by usual changes, not creeping.
bool piles_up(std::span<const std::vector<Stretch>> runs, double end, const Habits& habits) {
  constexpr double kFine_share = 0.2;
  constexpr std::size_t kPile_ratio = 5;
  constexpr std::size_t kFewestOthers = 5;  // a coarse sensor that rests shows its neighbouring steps now and then
  if (habits.repeats_share > kFine_share) {
    return false;
  }
  std::size_t there = 0;
  std::size_t arrivals = 0;
  std::size_t usual_arrivals = 0;
  for (const std::vector<Stretch>& run : runs) {
    for (std::size_t i = 0; i < run.size(); ++i) {
      if (run[i].value == end) {
        there += run[i].samples;
        ++arrivals;
        usual_arrivals += i > 0 && std::abs(run[i].value - run[i - 1].value) >= 0.5 * habits.noise.usual ? 1 : 0;
      }
    }
  }
  if (there < kPile || arrivals < 3 || 2 * usual_arrivals < arrivals) {
    return false;
  }
  std::unordered_map<double, std::size_t> counts;
  std::size_t elsewhere = 0;
  for (const std::vector<Stretch>& run : runs) {
    for (const Stretch& stretch : run) {
      if (stretch.value != end) {
        elsewhere = std::max(elsewhere, counts[stretch.value] += stretch.samples);
      }
    }
  }
  return counts.size() >= kFewestOthers && there > kPile_ratio * elsewhere;
}

/// Neither five equal neighbours nor ten samples at an end of the range: nothing below could be found. Most long logs end here.
/// `low` and `high`: of what went before, and then of this too.
bool never_rests(std::span<const double> values, double& low, double& high) {
  std::size_t longest = 0;
  std::size_t equal = 0;
  double before = kUnknown;
  for (const double value : values) {
    if (!std::isnan(value)) {
      equal = value == before ? equal + 1 : 1;
      longest = std::max(longest, equal);
      low = std::min(low, value);
      high = std::max(high, value);
      before = value;
    }
  }
  constexpr std::size_t kRests = 5;
  const auto at_ends = std::ranges::count_if(values, [low, high](double value) { return value == low || value == high; });
  return longest < kRests && static_cast<std::size_t>(at_ends) < kPile;
}

/// Where a part's rows are reported, and into what.
struct Reported {
  std::size_t first;
  std::size_t last;
  RecordingReport& report;

  void leave_out(const Recording& part, Channel& channel, std::size_t row, LeftOutReason reason) const {
    if (row >= first && row < last) {
      report.left_out[{channel.quantity.key, reason}].add(part.line[row]);
    }
    channel.values[row] = kUnknown;
  }
};

/// `frozen_at` of the row before the first that is reported, and then of the last.
void leave_out_stretches(Recording& part, Channel& channel, const NoiseLevel& noise, double& low, double& high, double& frozen_at,
                         const Reported& reported) {
  const double was_frozen_at = std::exchange(frozen_at, kUnknown);
  if (never_rests(channel.values, low, high)) {
    return;
  }
  std::vector<std::vector<Stretch>> runs;
  for (const auto& run : part.runs()) {
    runs.push_back(stretches_of(channel.values, run));
  }
  const Habits habits = habits_of(channel.values, runs, noise, high);
  if (!(high > low)) {
    return;  // constant from begin to end: what that means is asked elsewhere
  }
  const bool low_is_cut = piles_up(runs, low, habits);
  const bool high_is_cut = piles_up(runs, high, habits);
  for (const std::vector<Stretch>& run : runs) {
    for (std::size_t at = 0; at < run.size(); ++at) {
      const Stretch& stretch = run[at];
      const bool is_low = stretch.value == low;
      const bool is_high = stretch.value == high;
      const bool is_saturated =
          (is_low && low_is_cut) || (is_high && high_is_cut) || ((is_low || is_high) && climb_stops_dead(run, at, habits));
      const bool goes_on = stretch.value == was_frozen_at && stretch.begin < reported.first && stretch.end > reported.first;
      if (!is_saturated && !goes_on && !ends_in_isolated_jump(run, at, habits) && !stays_still_to_the_end(run, at, habits)) {
        continue;
      }
      if (!is_saturated && stretch.begin < reported.last && stretch.end >= reported.last) {
        frozen_at = stretch.value;
      }
      for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
        if (!std::isnan(channel.values[i])) {
          reported.leave_out(part, channel, i, is_saturated ? LeftOutReason::saturated : LeftOutReason::frozen);
        }
      }
    }
  }
}

constexpr std::size_t kWindow = 7;

double window_median(std::array<double, kWindow>& values, std::size_t count) {
  std::sort(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
  return count % 2 == 1 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

/// Three of the six neighbours within the distance: then the window_median of the seven is within it too, and there is nothing to sort.
bool has_near_majority(std::span<const double> values, std::span<const std::size_t> rows, std::size_t k, double distance) {
  constexpr std::size_t kSide = kWindow / 2;
  if (k < kSide || k + kSide >= rows.size()) {
    return false;
  }
  const double value = values[rows[k]];
  std::size_t near = 0;
  for (std::size_t j = k - kSide; j <= k + kSide; ++j) {
    near += std::abs(values[rows[j]] - value) <= distance ? 1 : 0;
  }
  return near > kSide;
}

/// Hampel's rule on the samples that are there, window 7, 6 window_median deviations.
void leave_out_outliers(Recording& part, Channel& channel, const NoiseLevel& noise, const Reported& reported) {
  constexpr double kDeviations = 6.0;
  constexpr double kSigmaToMedian = 0.6745;
  const double least_deviation = kSigmaToMedian * std::max(noise.noise, noise.usual);
  std::vector<std::size_t> rows;
  std::vector<std::size_t> outliers;
  for (const auto& [begin, end] : part.runs()) {
    rows.clear();
    for (std::size_t i = begin; i < end; ++i) {
      if (!std::isnan(channel.values[i])) {
        rows.push_back(i);
      }
    }
    for (std::size_t k = 0; k < rows.size() && rows.size() >= kWindow; ++k) {
      if (has_near_majority(channel.values, rows, k, kDeviations * least_deviation)) {
        continue;
      }
      const std::size_t first = k >= kWindow / 2 ? k - kWindow / 2 : 0;
      const std::size_t last = std::min(rows.size(), k + kWindow / 2 + 1);
      std::array<double, kWindow> window{};
      for (std::size_t j = first; j < last; ++j) {
        window[j - first] = channel.values[rows[j]];
      }
      const double middle = window_median(window, last - first);
      const double deviation = std::abs(channel.values[rows[k]] - middle);
      if (deviation <= kDeviations * least_deviation) {
        continue;
      }
      for (double& value : std::span(window).first(last - first)) {
        value = std::abs(value - middle);
      }
      if (deviation > kDeviations * window_median(window, last - first)) {
        outliers.push_back(rows[k]);
      }
    }
  }
  for (const std::size_t row : outliers) {
    reported.leave_out(part, channel, row, LeftOutReason::outlier);
  }
}

/// 0: nothing of such a channel is too large by itself.
double largest_of_any_motor(const Quantity& quantity) {
  if (quantity.kind != QuantityKind::heat_input) {
    return 0.0;
  }
  return quantity.unit == "A" ? kLargestCurrent_A : quantity.unit == "rad/s" ? kFastest_rad_per_s : 0.0;
}

/// One wild sample among the squares of a current would pass for all the heat. Many of them are rather a unit.
void leave_out_wild_inputs(Recording& part, Channel& channel, const Reported& reported) {
  const double largest = largest_of_any_motor(channel.quantity);
  if (!(largest > 0.0)) {
    return;
  }
  constexpr std::size_t kFew = 3;
  constexpr std::size_t kFew_rows = 1000;  // one of so many
  constexpr double kFar_ratio = 10.0;
  const std::span<const double> values = channel.values;
  std::vector<std::size_t> wild;
  for (std::size_t row = 0; row < values.size(); ++row) {
    const double size = std::abs(values[row]);
    if (!(size > largest)) {
      continue;
    }
    const std::size_t first = row - std::min(row, kWindow / 2);
    const std::size_t last = std::min(values.size(), row + kWindow / 2 + 1);
    std::array<double, kWindow> near{};
    const auto end = std::transform(values.begin() + static_cast<std::ptrdiff_t>(first), values.begin() + static_cast<std::ptrdiff_t>(last),
                                    near.begin(), [](double value) { return std::abs(value); });
    if (size > kFar_ratio * middle_of(std::span(near.begin(), end))) {
      wild.push_back(row);
    }
  }
  if (wild.size() <= std::max(kFew, values.size() / kFew_rows)) {
    for (const std::size_t row : wild) {
      reported.leave_out(part, channel, row, LeftOutReason::outlier);
    }
  }
}

}  // namespace

void Screening::leave_out_bad_samples(Recording& part, std::size_t first, std::size_t last, RecordingReport& report) {
  const auto runs = part.runs();
  const Reported reported{first, last, report};
  past_.resize(part.channels.size());
  for (std::size_t c = 0; c < part.channels.size(); ++c) {
    Channel& channel = part.channels[c];
    if (channel.quantity.kind == QuantityKind::temperature || channel.quantity.kind == QuantityKind::surroundings) {
      const NoiseLevel noise = noise_level(channel.values, runs, kMostSamples);
      leave_out_stretches(part, channel, noise, past_[c].low, past_[c].high, past_[c].value, reported);
      leave_out_outliers(part, channel, noise, reported);
    }
    leave_out_wild_inputs(part, channel, reported);
  }
}

}  // namespace heatsoak
