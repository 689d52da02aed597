#include "recording/screening.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/unknown.h"
#include "recording/noise.h"
#include "recording/spread.h"

namespace heatsoak::recording {
namespace {

/// Rows [begin, end) with one value, apart from NaN.
struct Segment {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t samples = 0;
  double value = 0.0;
};

std::vector<Segment> segments_of(std::span<const double> values, std::pair<std::size_t, std::size_t> run) {
  std::vector<Segment> found;
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

/// Longest constant segment before a jump that is accepted for a channel of unknown noise, in samples.
constexpr std::size_t kLongHold = 30;

/// Normal behaviour of the channel.
struct ChannelStatistics {
  double high = 0.0;
  NoiseLevel noise;
  double repeats_share = 0.0;                   ///< share of equal neighbours, without long constant segments
  std::optional<std::size_t> longest_chance;    ///< longest constant segment that noise explains, in samples; empty if unknown
  std::size_t longest_before_jump = kLongHold;  ///< the same for one given segment, such as the one before a jump
};

/// Sufficient number of samples for a noise estimate.
constexpr std::size_t kMostSamples = 1 << 14;
constexpr std::size_t kShortSegment = 20;
constexpr std::size_t kPile = 10;  ///< smallest number of samples at one end of the range that counts as cut off

/// Probability that a sample equals the previous one if the temperature is constant in the middle of a quantisation step (worst case).
double repeat_probability(const NoiseLevel& noise) {
  const double white = std::sqrt(std::max(0.0, noise.noise * noise.noise - noise.step * noise.step / 12.0));
  return white > 0.0 ? std::erf(0.5 * noise.step / (std::sqrt(2.0) * white)) : 1.0;
}

ChannelStatistics statistics_of(std::span<const double> values, std::span<const std::vector<Segment>> runs, const NoiseLevel& noise,
                                double high) {
  ChannelStatistics statistics;
  statistics.high = high;
  statistics.noise = noise;
  std::size_t samples = 0;
  std::size_t repeats = 0;
  for (const std::vector<Segment>& run : runs) {
    for (const Segment& segment : run) {
      if (segment.samples < kShortSegment) {
        samples += segment.samples;
        repeats += segment.samples - 1;
      }
    }
  }
  constexpr std::size_t kEnoughSamples = 50;
  constexpr double kTooCoarse_share = 0.5;
  constexpr double kLogOfThousand = 6.9;
  statistics.repeats_share = samples > 0 ? static_cast<double>(repeats) / static_cast<double>(samples) : 1.0;
  const double share = std::max({statistics.repeats_share, 0.05, repeat_probability(noise)});
  if (samples >= kEnoughSamples && share < kTooCoarse_share) {
    // n equal neighbours occur by chance in one of 1000 logs of this length: rows · share^n = 1/1000.
    const auto longest = [share](double nats) { return 1 + static_cast<std::size_t>(std::ceil(nats / -std::log(share))); };
    statistics.longest_chance = longest(std::log(static_cast<double>(values.size())) + kLogOfThousand);
    statistics.longest_before_jump = longest(kLogOfThousand);
  }
  return statistics;
}

/// True if noise makes such a long constant segment improbable, even for a constant temperature.
bool is_improbable(const Segment& segment, const ChannelStatistics& statistics) {
  return statistics.longest_chance && segment.samples > *statistics.longest_chance;
}

/// True if the constant segment ends in a jump much larger than the following changes: the sensor was frozen while the temperature changed.
bool ends_in_isolated_jump(const std::vector<Segment>& run, std::size_t at, const ChannelStatistics& statistics) {
  constexpr double kIsolated_ratio = 4.0;
  constexpr std::size_t kAfter = 5;
  if (run[at].samples <= statistics.longest_before_jump || at + 2 >= run.size()) {
    return false;
  }
  const double jump = std::abs(run[at + 1].value - run[at].value);
  double after = statistics.noise.usual;
  for (std::size_t i = at + 2; i < std::min(run.size(), at + 2 + kAfter); ++i) {
    after = std::max(after, std::abs(run[i].value - run[i - 1].value));
  }
  return jump > std::max(kIsolated_ratio * after, 6.0 * statistics.noise.noise);
}

/// True if a noisy channel stays constant to the end of the run after a slope that should have continued.
bool stays_still_to_the_end(const std::vector<Segment>& run, std::size_t at, const ChannelStatistics& statistics) {
  constexpr std::size_t kSlopeSegments = 10;
  constexpr double kFarAway_ratio = 20.0;
  if (at + 1 != run.size() || at < kSlopeSegments || !is_improbable(run[at], statistics)) {
    return false;
  }
  const Segment& from = run[at - kSlopeSegments];
  const double slope = (run[at].value - from.value) / static_cast<double>(run[at].begin - from.begin);
  return std::abs(slope) * static_cast<double>(run[at].samples) > kFarAway_ratio * std::max(statistics.noise.noise, statistics.noise.usual);
}

/// True if three steps of at least the usual size lead to the extreme, followed by a constant segment.
bool climb_stops_dead(const std::vector<Segment>& run, std::size_t at, const ChannelStatistics& statistics) {
  constexpr std::size_t kStops = 5;
  constexpr std::size_t kClimbs = 4;  // the last one may already be cut
  if (run[at].samples < kStops || at < kClimbs) {
    return false;
  }
  const double sign_factor = run[at].value == statistics.high ? 1.0 : -1.0;
  for (std::size_t i = at - kClimbs + 1; i < at; ++i) {
    if (run[i - 1].samples != 1 || sign_factor * (run[i].value - run[i - 1].value) < statistics.noise.usual) {
      return false;
    }
  }
  return run[at - 1].samples == 1;
}

/// True if the noise of a channel is cut off at `end`: far more samples there than at any other value, reached by changes of usual size.
bool piles_up(std::span<const std::vector<Segment>> runs, double end, const ChannelStatistics& statistics) {
  constexpr double kFine_share = 0.2;
  constexpr std::size_t kPile_ratio = 5;
  constexpr std::size_t kFewestOthers = 5;  // a coarse sensor at rest has only a few neighbouring steps
  if (statistics.repeats_share > kFine_share) {
    return false;
  }
  std::size_t there = 0;
  std::size_t arrivals = 0;
  std::size_t usual_arrivals = 0;
  for (const std::vector<Segment>& run : runs) {
    for (std::size_t i = 0; i < run.size(); ++i) {
      if (run[i].value == end) {
        there += run[i].samples;
        ++arrivals;
        usual_arrivals += i > 0 && std::abs(run[i].value - run[i - 1].value) >= 0.5 * statistics.noise.usual ? 1 : 0;
      }
    }
  }
  if (there < kPile || arrivals < 3 || 2 * usual_arrivals < arrivals) {
    return false;
  }
  std::unordered_map<double, std::size_t> counts;
  std::size_t elsewhere = 0;
  for (const std::vector<Segment>& run : runs) {
    for (const Segment& segment : run) {
      if (segment.value != end) {
        elsewhere = std::max(elsewhere, counts[segment.value] += segment.samples);
      }
    }
  }
  return counts.size() >= kFewestOthers && there > kPile_ratio * elsewhere;
}

/// Fast check for most long logs: true if there are neither five equal neighbours nor ten samples at an end of the range, so that nothing
/// can be frozen or saturated. Updates `low` and `high`.
bool never_rests(std::span<const double> values, double& low, double& high) {
  std::size_t longest = 0;
  std::size_t equal = 0;
  double before = base::kUnknown;
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

/// Rows [first, last) of a part that are reported, and the report.
struct Reported {
  std::size_t first;
  std::size_t last;
  RecordingReport& report;

  void leave_out(const Recording& part, Channel& channel, std::size_t row, LeftOutReason reason) const {
    if (row >= first && row < last) {
      report.left_out[{channel.quantity.key, reason}].add(part.line[row]);
    }
    channel.values[row] = base::kUnknown;
  }
};

/// Omits frozen and saturated samples. `frozen_at` is the frozen value before the first reported row, on return that of the last.
void leave_out_segments(Recording& part, Channel& channel, const NoiseLevel& noise, double& low, double& high,
                        std::optional<double>& frozen_at, const Reported& reported) {
  const std::optional<double> was_frozen_at = std::exchange(frozen_at, std::nullopt);
  if (never_rests(channel.values, low, high)) {
    return;
  }
  std::vector<std::vector<Segment>> runs;
  for (const auto& run : part.runs()) {
    runs.push_back(segments_of(channel.values, run));
  }
  const ChannelStatistics statistics = statistics_of(channel.values, runs, noise, high);
  if (!(high > low)) {
    return;  // a constant channel is reported elsewhere
  }
  const bool low_is_cut = piles_up(runs, low, statistics);
  const bool high_is_cut = piles_up(runs, high, statistics);
  for (const std::vector<Segment>& run : runs) {
    for (std::size_t at = 0; at < run.size(); ++at) {
      const Segment& segment = run[at];
      const bool is_low = segment.value == low;
      const bool is_high = segment.value == high;
      const bool is_saturated =
          (is_low && low_is_cut) || (is_high && high_is_cut) || ((is_low || is_high) && climb_stops_dead(run, at, statistics));
      const bool goes_on = segment.value == was_frozen_at && segment.begin < reported.first && segment.end > reported.first;
      if (!is_saturated && !goes_on && !is_improbable(segment, statistics) && !ends_in_isolated_jump(run, at, statistics) &&
          !stays_still_to_the_end(run, at, statistics)) {
        continue;
      }
      if (!is_saturated && segment.begin < reported.last && segment.end >= reported.last) {
        frozen_at = segment.value;
      }
      for (std::size_t i = segment.begin; i < segment.end; ++i) {
        if (!std::isnan(channel.values[i])) {
          reported.leave_out(part, channel, i, is_saturated ? LeftOutReason::saturated : LeftOutReason::frozen);
        }
      }
    }
  }
}

/// Number of valid samples on each side of a tested one.
constexpr std::size_t kSide = 3;
/// Largest difference between the predictions from both sides, as a share of the distance of an outlier.
constexpr double kAgree_share = 0.4;

/// Median of up to three samples, and their median absolute deviation.
struct Side {
  double median = 0.0;
  double deviation = 0.0;
};

Side side_of(std::span<const double> values, std::span<const std::size_t> rows) {
  std::array<double, kSide> sorted{};
  const std::size_t count = rows.size();
  std::ranges::transform(rows, sorted.begin(), [&](std::size_t row) { return values[row]; });
  const auto middle_of_first = [&sorted, count] {
    std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count));
    return count % 2 == 1 ? sorted[count / 2] : 0.5 * (sorted[count / 2 - 1] + sorted[count / 2]);
  };
  Side side{middle_of_first(), 0.0};
  for (double& value : sorted) {
    value = std::abs(value - side.median);
  }
  side.deviation = middle_of_first();
  return side;
}

/// True if the sample is far from the medians of the three valid samples before and after, on the same side of both, and these medians
/// agree. At the ends of a run only one side exists and decides.
bool is_spike(std::span<const double> values, std::span<const std::size_t> rows, std::size_t k, double least) {
  constexpr double kOfSlope_ratio = 3.0;
  const double value = values[rows[k]];
  const bool has_before = k >= kSide;
  const bool has_after = k + kSide < rows.size();
  const Side before = has_before ? side_of(values, rows.subspan(k - kSide, kSide)) : side_of(values, rows.subspan(k + 1, kSide));
  const Side after = has_after ? side_of(values, rows.subspan(k + 1, kSide)) : before;
  if (!has_before || !has_after) {
    // A change that continues at a similar rate is real: copper can warm by several kelvins per second.
    constexpr double kAlone_ratio = 3.0;
    const double next = values[rows[has_after ? k + 1 : k - 1]];
    const double second = values[rows[has_after ? k + 2 : k - 2]];
    if (std::abs(value - next) < kAlone_ratio * std::abs(next - second)) {
      return false;
    }
  }
  const double distance = std::min(std::abs(value - before.median), std::abs(value - after.median));
  return distance > std::max(least, kOfSlope_ratio * std::max(before.deviation, after.deviation)) &&
         (value > before.median) == (value > after.median) && std::abs(before.median - after.median) <= kAgree_share * distance;
}

/// Value at the tested time of the straight line through three samples (median slope, Theil 1950), and the largest distance of one of them
/// from that line.
struct Line {
  double value = 0.0;
  double deviation = 0.0;
};

double middle(double a, double b, double c) { return std::max(std::min(a, b), std::min(std::max(a, b), c)); }

Line line_of(std::span<const double> values, std::span<const double> time_s, std::span<const std::size_t> rows, double tested_s) {
  std::array<double, kSide> ahead_s{};
  std::array<double, kSide> value{};
  for (std::size_t i = 0; i < kSide; ++i) {
    ahead_s[i] = time_s[rows[i]] - tested_s;
    value[i] = values[rows[i]];
  }
  const auto slope_per_s = [&](std::size_t i, std::size_t j) { return (value[j] - value[i]) / (ahead_s[j] - ahead_s[i]); };
  const double usual_per_s = middle(slope_per_s(0, 1), slope_per_s(1, 2), slope_per_s(0, 2));
  for (std::size_t i = 0; i < kSide; ++i) {
    value[i] -= usual_per_s * ahead_s[i];
  }
  const double tested = middle(value[0], value[1], value[2]);
  const auto distance = [tested](double each) { return std::abs(each - tested); };
  return {tested, std::max({distance(value[0]), distance(value[1]), distance(value[2])})};
}

/// True if the sample lies outside the range of three predictions: the lines through the three valid samples before and after, and the
/// straight line between its neighbours. The distance must exceed the noise, the deviations from the lines and the difference of the
/// neighbours. A smooth peak lies between the neighbours and the two lines.
bool is_off_slope(std::span<const double> values, std::span<const double> time_s, std::span<const std::size_t> rows, std::size_t k,
                  double least) {
  constexpr double kOfLine_ratio = 5.0;
  if (k < kSide || k + kSide >= rows.size()) {
    return false;
  }
  const double tested_s = time_s[rows[k]];
  const Line before = line_of(values, time_s, rows.subspan(k - kSide, kSide), tested_s);
  const Line after = line_of(values, time_s, rows.subspan(k + 1, kSide), tested_s);
  const double share = (tested_s - time_s[rows[k - 1]]) / (time_s[rows[k + 1]] - time_s[rows[k - 1]]);
  const double value = values[rows[k]];
  const double last = values[rows[k - 1]];
  const double next = values[rows[k + 1]];
  const auto [low, high] = std::minmax({before.value, after.value, std::lerp(last, next, share)});
  const double distance = std::max(low - value, value - high);
  const double usual = std::max({least, std::abs(next - last), kOfLine_ratio * std::max(before.deviation, after.deviation)});
  return distance > usual && high - low <= kAgree_share * distance;
}

/// Omits outliers. Neighbours are the nearest valid samples, across gaps within a run.
void leave_out_outliers(Recording& part, Channel& channel, const NoiseLevel& noise, const Reported& reported) {
  constexpr double kFar_ratio = 5.0;
  const double least = kFar_ratio * std::max(noise.noise, noise.usual);
  std::vector<std::size_t> rows;
  std::vector<std::size_t> outliers;
  for (const auto& [begin, end] : part.runs()) {
    rows.clear();
    for (std::size_t i = begin; i < end; ++i) {
      if (!std::isnan(channel.values[i])) {
        rows.push_back(i);
      }
    }
    for (std::size_t k = 0; k < rows.size() && rows.size() > 2 * kSide; ++k) {
      const bool is_near_next = k + 1 < rows.size() && k > 0 && std::abs(channel.values[rows[k]] - channel.values[rows[k - 1]]) < least &&
                                std::abs(channel.values[rows[k]] - channel.values[rows[k + 1]]) < least;
      if (!is_near_next && (is_spike(channel.values, rows, k, least) || is_off_slope(channel.values, part.time_s, rows, k, least))) {
        outliers.push_back(rows[k]);
      }
    }
  }
  for (const std::size_t row : outliers) {
    reported.leave_out(part, channel, row, LeftOutReason::outlier);
  }
}

constexpr std::size_t kWindow = 7;  ///< window of the running median of a heat input, in rows

/// Largest magnitude that any motor reaches, in the quantity's unit; empty if there is no such limit.
std::optional<double> largest_of_any_motor(const Quantity& quantity) {
  if (quantity.kind != QuantityKind::heat_input) {
    return std::nullopt;
  }
  if (quantity.unit == "A") {
    return kLargestCurrent_A;
  }
  return quantity.unit == "rad/s" ? std::optional(kFastest_rad_per_s) : std::nullopt;
}

/// Omits single impossible heat inputs: one outlier of a current, squared, could exceed all other heat. Many of them indicate a wrong unit
/// and are kept.
void leave_out_wild_inputs(Recording& part, Channel& channel, const Reported& reported) {
  const std::optional<double> largest = largest_of_any_motor(channel.quantity);
  if (!largest) {
    return;
  }
  constexpr std::size_t kFew = 3;
  constexpr std::size_t kFew_rows = 1000;  // one of so many
  constexpr double kFar_ratio = 10.0;
  const std::span<const double> values = channel.values;
  std::vector<std::size_t> wild;
  for (std::size_t row = 0; row < values.size(); ++row) {
    const double size = std::abs(values[row]);
    if (!(size > *largest)) {
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
      leave_out_segments(part, channel, noise, past_[c].low, past_[c].high, past_[c].value, reported);
      leave_out_outliers(part, channel, noise, reported);
    }
    leave_out_wild_inputs(part, channel, reported);
  }
}

}  // namespace heatsoak::recording
