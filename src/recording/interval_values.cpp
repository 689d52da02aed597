#include "recording/interval_values.h"

#include <algorithm>
#include <cmath>

#include "base/unknown.h"

namespace heatsoak::recording {
namespace {

bool stands_for_an_interval(const Quantity& quantity) {
  return quantity.kind == QuantityKind::heat_input || quantity.kind == QuantityKind::surroundings;
}
bool heats_by_its_square(const Quantity& quantity) { return quantity.kind == QuantityKind::heat_input && quantity.unit == "A"; }

/// Mean over an interval with linear change, or with `by_square` the RMS with the sign of the mean.
double even_change(double from, double to, bool by_square) {
  const double mean = 0.5 * (from + to);
  return by_square ? std::copysign(std::sqrt((from * from + from * to + to * to) / 3.0), mean) : mean;
}

void to_held(std::span<double> values, InputConvention convention, bool by_square) {
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    values[i] = convention == InputConvention::previous_interval ? values[i + 1] : even_change(values[i], values[i + 1], by_square);
  }
  values.back() = base::kUnknown;
}

/// Inputs that are held from time_s[j] + offset_s on, averaged over the rows' intervals.
std::vector<double> shifted_inputs(std::span<const double> time_s, std::span<const double> values, double offset_s, bool by_square) {
  std::vector<double> shifted(values.size(), base::kUnknown);
  std::size_t held = 0;
  for (std::size_t row = 0; row + 1 < values.size(); ++row) {
    const double begin_s = time_s[row];
    const double end_s = time_s[row + 1];
    while (held + 1 < values.size() && time_s[held + 1] + offset_s <= begin_s) {
      ++held;
    }
    double integral = 0.0;
    double sum_of_squares = 0.0;
    double covered_s = 0.0;
    for (std::size_t j = held; j + 1 < values.size() && time_s[j] + offset_s < end_s; ++j) {
      const double part_s = std::min(end_s, time_s[j + 1] + offset_s) - std::max(begin_s, time_s[j] + offset_s);
      if (part_s > 0.0) {
        integral += values[j] * part_s;
        sum_of_squares += values[j] * values[j] * part_s;
        covered_s += part_s;
      }
    }
    if (covered_s > (1.0 - 1e-9) * (end_s - begin_s)) {
      shifted[row] = by_square ? std::copysign(std::sqrt(sum_of_squares / covered_s), integral) : integral / covered_s;
    }
  }
  return shifted;
}

/// Samples taken at time_s[j] + offset_s, interpolated linearly to the rows' times. NaN beside a missing sample.
std::vector<double> shifted_samples(std::span<const double> time_s, std::span<const double> values, double offset_s) {
  std::vector<double> shifted(values.size(), base::kUnknown);
  std::size_t before = 0;
  for (std::size_t row = 0; row < values.size(); ++row) {
    while (before + 2 < values.size() && time_s[before + 1] + offset_s <= time_s[row]) {
      ++before;
    }
    const double from_s = time_s[before] + offset_s;
    const double to_s = time_s[before + 1] + offset_s;
    if (time_s[row] >= from_s && time_s[row] <= to_s) {
      shifted[row] = values[before] + (values[before + 1] - values[before]) * (time_s[row] - from_s) / (to_s - from_s);
    }
  }
  return shifted;
}

}  // namespace

void to_interval_values(Recording& recording, InputConvention convention, std::span<const double> offsets_s) {
  recording.inputs = convention;
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    Channel& channel = recording.channels[i];
    const bool is_input = stands_for_an_interval(channel.quantity);
    const bool by_square = heats_by_its_square(channel.quantity);
    for (const auto& [begin, end] : recording.runs()) {
      const std::span<double> values = std::span(channel.values).subspan(begin, end - begin);
      const std::span<const double> time_s = std::span(recording.time_s).subspan(begin, end - begin);
      if (is_input && convention != InputConvention::held) {
        to_held(values, convention, by_square);
      }
      if (offsets_s[i] != 0.0 && values.size() > 1) {
        std::ranges::copy(
            is_input ? shifted_inputs(time_s, values, offsets_s[i], by_square) : shifted_samples(time_s, values, offsets_s[i]),
            values.begin());
      }
    }
  }
}

}  // namespace heatsoak::recording
