#include "calibration/training_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "recording/spread.h"

namespace heatsoak::calibration {
namespace {

/// Input whose range limits the validity of a forecast.
struct RangedInput {
  std::string_view channel;
  std::string_view unit;
  bool is_size = false;  ///< true: the magnitude counts, and up to 20 % above the largest is in range
};
constexpr std::string_view kCurrent = base::row_of(base::Signal::current).column;
constexpr std::array kInputs{RangedInput{base::kSignals[base::signal_row("ambient")].column, "°C"},
                             RangedInput{base::row_of(base::Signal::speed).column, base::row_of(base::Signal::speed).unit, true},
                             RangedInput{kCurrent, base::row_of(base::Signal::current).unit, true}};
constexpr double kAmbient_K = 5.0;
constexpr double kSize_ratio = 1.2;

std::optional<motor::InputRange> range_of(const RangedInput& input, const recording::Recording& recording) {
  const recording::Channel* const channel = recording.find(input.channel);
  if (channel == nullptr) {
    return std::nullopt;
  }
  std::vector<double> values = channel->values;
  if (input.is_size) {
    std::ranges::transform(values, values.begin(), [](double value) { return std::abs(value); });
  }
  const motor::InputRange found{recording::percentile(values, 0.01), recording::percentile(values, 0.99)};
  return std::isfinite(found.low) ? std::optional(found) : std::nullopt;
}

}  // namespace

void widen(motor::TrainingRange& range, std::span<const recording::Recording> recordings, motor::HeatInput heat) {
  for (const recording::Recording& recording : recordings) {
    for (const auto& [key, value] : recording.conditions) {
      range.conditions.insert(fmt::format("{}={}", key, value));
    }
    for (const RangedInput& input : kInputs) {
      if (const auto found = range_of(input, recording)) {
        const auto [place, is_new] = range.inputs.try_emplace(std::string(input.channel), *found);
        place->second = {std::min(place->second.low, found->low), std::max(place->second.high, found->high)};
      }
    }
  }
  if (heat == motor::HeatInput::input_power || heat == motor::HeatInput::torque) {
    range.inputs.erase(std::string(kCurrent));
  }
}

std::vector<OutsideTraining> outside(const motor::TrainingRange& range, const recording::Recording& recording) {
  std::vector<OutsideTraining> all;
  for (const auto& [key, value] : recording.conditions) {
    std::vector<std::string> seen;
    std::ranges::copy_if(range.conditions, std::back_inserter(seen),
                         [start = key + "="](const std::string& each) { return each.starts_with(start); });
    if (!range.inputs.empty() && std::ranges::find(seen, fmt::format("{}={}", key, value)) == seen.end()) {
      all.push_back(UnseenCondition{recording.name, key, value, std::move(seen)});
    }
  }
  for (const RangedInput& input : kInputs) {
    const auto known = range.inputs.find(std::string(input.channel));
    const auto found = range_of(input, recording);
    if (known == range.inputs.end() || !found) {
      continue;
    }
    const auto [low, high] = known->second;
    const bool is_below = !input.is_size && found->low < low - kAmbient_K;
    const bool is_above = found->high > (input.is_size ? kSize_ratio * high : high + kAmbient_K);
    if (is_below || is_above) {
      all.push_back(Extrapolation{recording.name, std::string(input.channel), std::string(input.unit), is_above ? found->high : found->low,
                                  low, high});
    }
  }
  return all;
}

}  // namespace heatsoak::calibration
