#include "recording/quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "recording/clock_offset.h"
#include "recording/noise.h"
#include "recording/quantities.h"
#include "recording/row_order.h"
#include "recording/suspicions.h"

namespace heatsoak::recording {
namespace {

constexpr std::size_t kFewestRows = 20;

const ChannelQuality* find(const DataQuality& quality, std::string_view key) {
  const auto found = std::ranges::find_if(quality.channels, [key](const ChannelQuality& each) { return each.quantity.key == key; });
  return found == quality.channels.end() ? nullptr : &*found;
}

bool is_kind(const ChannelQuality& channel, QuantityKind kind) { return channel.quantity.kind == kind; }

/// True if every temperature has its maximum in the first third of the log and is clearly lower at the end.
bool cools_down(const Recording& recording, const std::vector<const ChannelQuality*>& temperatures) {
  const auto is_less = [](double a, double b) { return a < b || (std::isnan(a) && !std::isnan(b)); };
  return !temperatures.empty() && std::ranges::all_of(temperatures, [&](const ChannelQuality* each) {
    const std::vector<double>& values = recording.find(each->quantity.key)->values;
    const auto highest = static_cast<std::size_t>(std::ranges::max_element(values, is_less) - values.begin());
    const auto last = std::ranges::find_if(values.rbegin(), values.rend(), [](double value) { return !std::isnan(value); });
    constexpr double kPlainly = 20.0;
    return highest < values.size() / 3 && last != values.rend() && each->high - *last > kPlainly * each->noise;
  });
}

Fitness thermal_fitness(const Recording& recording, std::size_t rows, const DataQuality& quality) {
  Fitness fitness;
  if (rows < kFewestRows) {
    fitness.lacks.emplace_back(TooFewRows{rows, kFewestRows});
  }
  std::vector<const ChannelQuality*> temperatures;
  std::vector<const ChannelQuality*> inputs;
  for (const ChannelQuality& channel : quality.channels) {
    if (is_kind(channel, QuantityKind::temperature)) {
      temperatures.push_back(&channel);
    }
    if (is_kind(channel, QuantityKind::heat_input)) {
      inputs.push_back(&channel);
    }
  }
  if (temperatures.empty()) {
    fitness.lacks.emplace_back(NoTemperature{});
  }
  if (inputs.empty()) {
    fitness.lacks.emplace_back(NoHeatInput{});
  }
  // Changes below the noise carry no information; the gain from averaging is ignored.
  const auto says_nothing = [](const ChannelQuality* channel) { return channel->high - channel->low <= 6.0 * channel->noise; };
  if (!temperatures.empty() && std::ranges::all_of(temperatures, says_nothing)) {
    const ChannelQuality& one = *temperatures.front();
    fitness.lacks.push_back(one.is_constant() ? Lack(TemperatureIsConstant{one.quantity.key, one.low})
                                              : Lack(TemperatureWithinNoise{one.quantity.key, one.low, one.high, one.noise}));
  }
  // Without heat, the time constants are still identifiable from a cool-down.
  if (!inputs.empty() && !cools_down(recording, temperatures) && most_direct_heat_input(recording) == nullptr &&
      std::ranges::all_of(inputs, [](const ChannelQuality* channel) { return channel->high == 0.0 && channel->low == 0.0; })) {
    fitness.lacks.emplace_back(HeatInputIsZero{inputs.front()->quantity.key});
  }
  return fitness;
}

Fitness drive_fitness(std::size_t rows, const DataQuality& quality) {
  Fitness fitness;
  const auto has = [&](std::string_view stem) {
    return std::ranges::any_of(quality.channels, [stem](const ChannelQuality& each) { return each.quantity.key.starts_with(stem); });
  };
  if (rows < kFewestRows) {
    fitness.lacks.emplace_back(TooFewRows{rows, kFewestRows});
  }
  if (!has("wheel_speed_rad_per_s_")) {
    fitness.lacks.emplace_back(NoWheelSpeed{});
  }
  const auto turns = [](const ChannelQuality& each) {
    return each.quantity.key.starts_with("wheel_speed_rad_per_s_") && each.high - each.low > 10.0 * each.noise;
  };
  if (has("wheel_speed_rad_per_s_") && std::ranges::none_of(quality.channels, turns)) {
    fitness.lacks.emplace_back(WheelsKeepSpeed{});
  }
  if (!has("wheel_modulation_ratio_") && !has("wheel_voltage_V_") && !has("wheel_current_A_")) {
    fitness.lacks.emplace_back(NoWheelEffort{});
  }
  return fitness;
}

}  // namespace

const Channel* most_direct_heat_input(const Recording& recording) {
  for (const std::string_view key : kHeatColumns) {
    const Channel* const channel = recording.find(key);
    if (channel == nullptr) {
      continue;
    }
    double first = std::numeric_limits<double>::quiet_NaN();
    for (const double value : channel->values) {
      first = std::isnan(first) ? value : first;
      if (!std::isnan(value) && value != first) {
        return channel;
      }
    }
  }
  return nullptr;
}

std::vector<double> relative_heat(const Channel& heat_input) {
  std::vector<double> heat = heat_input.values;
  const bool is_power = heat_input.quantity.unit == "W" || heat_input.quantity.key == "bus_A";
  for (double& value : heat) {
    value = is_power ? value : value * value;
  }
  return heat;
}

void Assessment::Gauge::add(std::span<const double> values) {
  noise.add(values);
  for (const double value : values) {
    if (std::isnan(value)) {
      continue;
    }
    ++samples;
    if (value <= low) {
      at_low = value == low ? at_low + 1 : 1;
      low = value;
    }
    if (value >= high) {
      at_high = value == high ? at_high + 1 : 1;
      high = value;
    }
  }
}

void Assessment::add_times(const Recording& part) {
  auto begin = part.run_begins.begin();
  for (std::size_t row = 0; row < part.rows(); ++row) {
    const double time_s = part.time_s[row];
    first_s_ = rows_ == 0 ? time_s : first_s_;
    const double step_s = time_s - last_s_;
    if (rows_ > 0) {
      steps_s_.add(step_s);
      quality_.sampling.longest_gap_s = std::max(quality_.sampling.longest_gap_s, step_s);
    }
    if (begin != part.run_begins.end() && *begin == row) {
      ++begin;
      if (quality_.runs++ > 0 && quality_.gaps.size() < DataQuality::kMostGaps) {
        quality_.gaps.push_back({part.line[row], last_s_, step_s});
      }
    }
    last_s_ = time_s;
    ++rows_;
  }
}

void Assessment::add(const Recording& part) {
  add_times(part);
  gauges_.resize(part.channels.size());
  for (std::size_t c = 0; c < part.channels.size(); ++c) {
    Gauge& gauge = gauges_[c];
    const std::span<const double> values = part.channels[c].values;
    std::size_t row = 0;
    const auto add_until = [&](std::size_t end) {
      gauge.add(values.subspan(row, end - row));
      row = end;
    };
    for (const std::size_t begin : part.run_begins) {
      add_until(begin);
      gauge.noise.begin_run();
    }
    add_until(values.size());
  }
  condensed_.add(part);
}

void Assessment::report_channels(const RecordingReport& report) {
  for (std::size_t c = gauges_.size(); c-- > 0;) {
    if (gauges_[c].samples == 0) {
      gauges_.erase(gauges_.begin() + static_cast<std::ptrdiff_t>(c));
      condensed_.erase_channel(c);
    }
  }
  for (std::size_t c = 0; c < gauges_.size(); ++c) {
    const Gauge& gauge = gauges_[c];
    const NoiseLevel noise = gauge.noise.level();
    ChannelQuality& channel = quality_.channels.emplace_back();
    channel.quantity = condensed_.rows().channels[c].quantity;
    channel.samples = gauge.samples;
    channel.low = gauge.low;
    channel.high = gauge.high;
    channel.at_low = gauge.at_low;
    channel.at_high = gauge.at_high;
    channel.distinct = noise.distinct;
    channel.step = noise.step;
    channel.noise = noise.noise;
    for (const auto& [what, entry] : report.left_out) {
      channel.left_out += what.first == channel.quantity.key ? entry.count : 0;
    }
  }
}

DataQuality Assessment::conclude(const RecordingReport& report, std::optional<double> ambient_C) {
  const Recording& rows = condensed_.rows();
  Sampling& sampling = quality_.sampling;
  sampling.duration_s = last_s_ - first_s_;
  sampling.usual_period_s = median_of(steps_s_.values());
  std::vector<double> deviations_s = steps_s_.values();
  for (double& each_s : deviations_s) {
    each_s = std::abs(each_s - sampling.usual_period_s);
  }
  sampling.jitter_s = 1.4826 * median_of(std::move(deviations_s));
  report_channels(report);
  if (const Channel* const heat_input = most_direct_heat_input(rows)) {
    for (const Channel& channel : rows.channels) {
      if (channel.quantity.kind == QuantityKind::temperature) {
        quality_.clock_offsets.push_back(clock_offset(rows, channel, *heat_input, find(quality_, channel.quantity.key)->noise));
      }
    }
  }
  Suspicions suspected = suspicions(rows, quality_, ambient_C);
  quality_.suspicions = std::move(suspected.all);
  quality_.blocking = std::move(suspected.blocking);
  quality_.blocking_for_wheels = std::move(suspected.blocking_for_wheels);
  quality_.thermal = thermal_fitness(rows, rows_, quality_);
  quality_.drive = drive_fitness(rows_, quality_);
  return std::move(quality_);
}

DataQuality assess(const Recording& recording, const RecordingReport& report, std::optional<double> ambient_C) {
  Assessment assessment;
  for (std::size_t begin = 0; begin < recording.rows(); begin += CondensedRecording::kMostRows) {
    assessment.add(recording.slice(begin, std::min(begin + CondensedRecording::kMostRows, recording.rows())));
  }
  return assessment.conclude(report, ambient_C);
}

NothingAboutHeat::NothingAboutHeat(std::vector<Log> logs)
    : base::Failure(base::ExitCode::cannot_answer, "no information about heat"), logs_(std::move(logs)) {}

RowsGivenTwice::Rows::Rows(const Recording& recording) : file(recording.file) {
  if (!recording.line.empty()) {
    lines = {recording.line.front(), recording.line.back()};
  }
}

RowsGivenTwice::RowsGivenTwice(std::vector<Pair> pairs)
    : base::Failure(base::ExitCode::bad_input, "rows of a log are given twice"), pairs_(std::move(pairs)) {}

}  // namespace heatsoak::recording
