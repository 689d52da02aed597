#include "identify/measurement/screening.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "identify/measurement/noise.h"

namespace heatsoak {
namespace {

constexpr double kLeftOut = std::numeric_limits<double>::quiet_NaN();

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
  double low = 0.0;
  double high = 0.0;
  NoiseLevel noise;
  double repeats_share = 0.0;      ///< of neighbours that are equal, long stretches aside
  std::size_t longest_chance = 0;  ///< samples of one value that noise can give; 0 where that cannot be told
};

constexpr std::size_t kShortStretch = 20;

Habits habits_of(std::span<const double> values, std::span<const std::vector<Stretch>> runs, const NoiseLevel& noise) {
  Habits habits;
  habits.noise = noise;
  habits.low = std::numeric_limits<double>::infinity();
  habits.high = -habits.low;
  std::size_t samples = 0;
  std::size_t repeats = 0;
  for (const std::vector<Stretch>& run : runs) {
    for (const Stretch& stretch : run) {
      habits.low = std::min(habits.low, stretch.value);
      habits.high = std::max(habits.high, stretch.value);
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
  constexpr std::size_t kPile = 10;
  constexpr std::size_t kPile_ratio = 5;
  if (habits.repeats_share > kFine_share) {
    return false;
  }
  std::map<double, std::size_t> counts;
  std::size_t arrivals = 0;
  std::size_t usual_arrivals = 0;
  for (const std::vector<Stretch>& run : runs) {
    for (std::size_t i = 0; i < run.size(); ++i) {
      counts[run[i].value] += run[i].samples;
      if (i > 0 && run[i].value == end) {
        ++arrivals;
        usual_arrivals += std::abs(run[i].value - run[i - 1].value) >= 0.5 * habits.noise.usual ? 1 : 0;
      }
    }
  }
  const std::size_t there = std::exchange(counts[end], 0);
  std::size_t elsewhere = 0;
  for (const auto& [value, count] : counts) {
    elsewhere = std::max(elsewhere, count);
  }
  return there >= kPile && there > kPile_ratio * elsewhere && arrivals >= 3 && 2 * usual_arrivals >= arrivals;
}

void leave_out_stretches(Recording& recording, Channel& channel, const NoiseLevel& noise, RecordingReport& report) {
  std::vector<std::vector<Stretch>> runs;
  for (const auto& run : recording.runs()) {
    runs.push_back(stretches_of(channel.values, run));
  }
  const Habits habits = habits_of(channel.values, runs, noise);
  if (!(habits.high > habits.low)) {
    return;  // constant from begin to end: what that means is asked elsewhere
  }
  const bool low_is_cut = piles_up(runs, habits.low, habits);
  const bool high_is_cut = piles_up(runs, habits.high, habits);
  for (const std::vector<Stretch>& run : runs) {
    for (std::size_t at = 0; at < run.size(); ++at) {
      const Stretch& stretch = run[at];
      const bool is_low = stretch.value == habits.low;
      const bool is_high = stretch.value == habits.high;
      const bool is_saturated =
          (is_low && low_is_cut) || (is_high && high_is_cut) || ((is_low || is_high) && climb_stops_dead(run, at, habits));
      if (!is_saturated && !ends_in_isolated_jump(run, at, habits) && !stays_still_to_the_end(run, at, habits)) {
        continue;
      }
      LeftOut& entry = report.left_out[{channel.quantity.key, is_saturated ? LeftOutReason::saturated : LeftOutReason::frozen}];
      for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
        if (!std::isnan(channel.values[i])) {
          entry.add(recording.line[i]);
          channel.values[i] = kLeftOut;
        }
      }
    }
  }
}

constexpr std::size_t kWindow = 7;

double median(std::array<double, kWindow>& values, std::size_t count) {
  std::sort(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
  return count % 2 == 1 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

/// Hampel's rule on the samples that are there, window 7, 6 median deviations.
void leave_out_outliers(Recording& recording, Channel& channel, const NoiseLevel& noise, RecordingReport& report) {
  constexpr double kDeviations = 6.0;
  constexpr double kSigmaToMedian = 0.6745;
  const double least_deviation = kSigmaToMedian * std::max(noise.noise, noise.usual);
  std::vector<std::size_t> rows;
  std::vector<std::size_t> outliers;
  for (const auto& [begin, end] : recording.runs()) {
    rows.clear();
    for (std::size_t i = begin; i < end; ++i) {
      if (!std::isnan(channel.values[i])) {
        rows.push_back(i);
      }
    }
    for (std::size_t k = 0; k < rows.size() && rows.size() >= kWindow; ++k) {
      const std::size_t first = k >= kWindow / 2 ? k - kWindow / 2 : 0;
      const std::size_t last = std::min(rows.size(), k + kWindow / 2 + 1);
      std::array<double, kWindow> window{};
      for (std::size_t j = first; j < last; ++j) {
        window[j - first] = channel.values[rows[j]];
      }
      const double middle = median(window, last - first);
      const double deviation = std::abs(channel.values[rows[k]] - middle);
      if (deviation <= kDeviations * least_deviation) {
        continue;
      }
      for (double& value : std::span(window).first(last - first)) {
        value = std::abs(value - middle);
      }
      if (deviation > kDeviations * median(window, last - first)) {
        outliers.push_back(rows[k]);
      }
    }
  }
  if (outliers.empty()) {
    return;
  }
  LeftOut& entry = report.left_out[{channel.quantity.key, LeftOutReason::outlier}];
  for (const std::size_t row : outliers) {
    entry.add(recording.line[row]);
    channel.values[row] = kLeftOut;
  }
}

}  // namespace

void leave_out_bad_samples(Recording& recording, RecordingReport& report) {
  const auto runs = recording.runs();
  for (Channel& channel : recording.channels) {
    if (channel.quantity.kind == QuantityKind::temperature || channel.quantity.kind == QuantityKind::surroundings) {
      const NoiseLevel noise = noise_level(channel.values, runs);
      leave_out_stretches(recording, channel, noise, report);
      leave_out_outliers(recording, channel, noise, report);
    }
  }
}

}  // namespace heatsoak
