#include "identify/measurement/quality.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/diagnostic.h"
#include "base/quantity.h"
#include "identify/measurement/clock_offset.h"
#include "identify/measurement/noise.h"
#include "identify/measurement/row_order.h"
#include "identify/measurement/suspicions.h"

namespace heatsoak {
namespace {

constexpr std::size_t kFewestRows = 20;
constexpr std::size_t kMostSteps = 200'000;  ///< of a long log, spread evenly, to tell the jitter
/// From the one that heats a winding most directly.
constexpr std::array<std::string_view, 9> kHeatInputs{"current_A", "current_q_A", "power_in_W", "bus_A",          "torque_Nm",
                                                      "motor_V",   "duty_ratio",  "bus_V",      "speed_rad_per_s"};

Sampling sampling_of(const Recording& recording) {
  Sampling sampling;
  if (recording.rows() < 2) {
    return sampling;
  }
  sampling.duration_s = recording.time_s.back() - recording.time_s.front();
  sampling.usual_period_s = usual_period_s(recording.time_s);
  std::vector<double> deviations_s;
  for (std::size_t i = 1; i < recording.rows(); ++i) {
    const double period_s = recording.time_s[i] - recording.time_s[i - 1];
    sampling.longest_gap_s = std::max(sampling.longest_gap_s, period_s);
    if (i % (recording.rows() / kMostSteps + 1) == 0) {
      deviations_s.push_back(std::abs(period_s - sampling.usual_period_s));
    }
  }
  sampling.jitter_s = 1.4826 * median_of(std::move(deviations_s));
  return sampling;
}

std::vector<Gap> gaps_of(const Recording& recording) {
  std::vector<Gap> gaps;
  for (const std::size_t begin : recording.run_begins) {
    if (begin > 0) {
      gaps.push_back({recording.line[begin], recording.time_s[begin - 1], recording.time_s[begin] - recording.time_s[begin - 1]});
    }
  }
  return gaps;
}

ChannelQuality quality_of(const Recording& recording, const Channel& channel, const RecordingReport& report) {
  ChannelQuality quality;
  quality.quantity = channel.quantity;
  quality.low = std::numeric_limits<double>::infinity();
  quality.high = -quality.low;
  for (const double value : channel.values) {
    if (!std::isnan(value)) {
      quality.low = std::min(quality.low, value);
      quality.high = std::max(quality.high, value);
      ++quality.samples;
    }
  }
  for (const auto& [what, entry] : report.left_out) {
    quality.left_out += what.first == channel.quantity.key ? entry.count : 0;
  }
  const NoiseLevel noise = noise_level(channel.values, recording.runs());
  quality.step = noise.step;
  quality.noise = noise.noise;
  return quality;
}

const ChannelQuality* find(const DataQuality& quality, std::string_view key) {
  const auto found = std::ranges::find_if(quality.channels, [key](const ChannelQuality& each) { return each.quantity.key == key; });
  return found == quality.channels.end() ? nullptr : &*found;
}

bool is_kind(const ChannelQuality& channel, QuantityKind kind) { return channel.quantity.kind == kind; }

std::string shown(double value, const Quantity& quantity) {
  return fmt::format("{} {}", significant(value, 4), unit_for_display(quantity.unit));
}

/// Every temperature is highest within the first third of the log, and plainly lower at its end.
bool cools_down(const Recording& recording, const std::vector<const ChannelQuality*>& temperatures) {
  return !temperatures.empty() && std::ranges::all_of(temperatures, [&](const ChannelQuality* each) {
    const std::vector<double>& values = recording.find(each->quantity.key)->values;
    const auto highest = static_cast<std::size_t>(std::ranges::find(values, each->high) - values.begin());
    const auto last = std::ranges::find_if(values.rbegin(), values.rend(), [](double value) { return !std::isnan(value); });
    constexpr double kPlainly = 20.0;
    return highest < values.size() / 3 && last != values.rend() && each->high - *last > kPlainly * each->noise;
  });
}

Fitness thermal_fitness(const Recording& recording, const DataQuality& quality) {
  Fitness fitness;
  if (recording.rows() < kFewestRows) {
    fitness.lacks.push_back(fmt::format("it has {} rows; at least {} are needed", recording.rows(), kFewestRows));
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
    fitness.lacks.emplace_back("it has no temperature of the motor (winding_C, stator_C, …)");
  }
  if (inputs.empty()) {
    fitness.lacks.emplace_back("it has no heat input (current_A, power_in_W, torque_Nm, speed_rad_per_s, …)");
  }
  // A change below the noise shows nothing; √rows of averaging is left to the fit.
  const auto says_nothing = [](const ChannelQuality* channel) { return channel->high - channel->low <= 6.0 * channel->noise; };
  if (!temperatures.empty() && std::ranges::all_of(temperatures, says_nothing)) {
    const ChannelQuality& one = *temperatures.front();
    fitness.lacks.push_back(one.is_constant()
                                ? fmt::format("{} is constant, {}", one.quantity.key, shown(one.low, one.quantity))
                                : fmt::format("no temperature moves beyond its noise: {} from {} to {}, noise {} K", one.quantity.key,
                                              shown(one.low, one.quantity), shown(one.high, one.quantity), significant(one.noise, 2)));
  }
  // Without heat a motor that cools down still tells its time constants.
  if (!inputs.empty() && !cools_down(recording, temperatures) && heat_input_of(recording) == nullptr &&
      std::ranges::all_of(inputs, [](const ChannelQuality* channel) { return channel->high == 0.0 && channel->low == 0.0; })) {
    fitness.lacks.push_back(fmt::format("no heat goes in: {} is 0 throughout", inputs.front()->quantity.key));
  }
  return fitness;
}

Fitness drive_fitness(const Recording& recording, const DataQuality& quality) {
  Fitness fitness;
  const auto has = [&](std::string_view stem) {
    return std::ranges::any_of(quality.channels, [stem](const ChannelQuality& each) { return each.quantity.key.starts_with(stem); });
  };
  if (recording.rows() < kFewestRows) {
    fitness.lacks.push_back(fmt::format("it has {} rows; at least {} are needed", recording.rows(), kFewestRows));
  }
  if (!has("wheel_speed_rad_per_s_")) {
    fitness.lacks.emplace_back("it has no speeds of wheels (wheel_speed_rad_per_s_1, …)");
  }
  const auto turns = [](const ChannelQuality& each) {
    return each.quantity.key.starts_with("wheel_speed_rad_per_s_") && each.high - each.low > 10.0 * each.noise;
  };
  if (has("wheel_speed_rad_per_s_") && std::ranges::none_of(quality.channels, turns)) {
    fitness.lacks.emplace_back("no wheel changes its speed beyond the noise");
  }
  if (!has("wheel_pwm_ratio_") && !has("wheel_voltage_V_") && !has("wheel_current_A_")) {
    fitness.lacks.emplace_back("it has no effort of wheels (wheel_pwm_ratio_1, wheel_voltage_V_1 or wheel_current_A_1, …)");
  }
  return fitness;
}

}  // namespace

const Channel* heat_input_of(const Recording& recording) {
  for (const std::string_view key : kHeatInputs) {
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

DataQuality assess(const Recording& recording, const RecordingReport& report) {
  DataQuality quality;
  quality.sampling = sampling_of(recording);
  quality.gaps = gaps_of(recording);
  for (const Channel& channel : recording.channels) {
    quality.channels.push_back(quality_of(recording, channel, report));
  }
  if (const Channel* const heat_input = heat_input_of(recording)) {
    for (const Channel& channel : recording.channels) {
      if (channel.quantity.kind == QuantityKind::temperature) {
        quality.clock_offsets.push_back(clock_offset(recording, channel, *heat_input, find(quality, channel.quantity.key)->noise));
      }
    }
  }
  Suspicions suspected = suspicions(recording, quality.channels);
  quality.suspicions = std::move(suspected.all);
  quality.spoiling = std::move(suspected.spoiling);
  quality.thermal = thermal_fitness(recording, quality);
  quality.drive = drive_fitness(recording, quality);
  return quality;
}

void require_thermal(const Recording& recording, const DataQuality& quality) {
  if (!quality.thermal.is_good()) {
    throw Failure(ExitCode::cannot_answer, fmt::format("{}: nothing about heat can be learned from this log: {}", recording.file.string(),
                                                       fmt::join(quality.thermal.lacks, "; ")));
  }
}

}  // namespace heatsoak
