#include "recording/temperature_scales.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/unknown.h"
#include "recording/quantities.h"
#include "recording/spread.h"

namespace heatsoak::recording {
namespace {

constexpr double kApart_K = 15.0;
/// Largest difference between sensors that start at one temperature, although one may be heated immediately.
constexpr double kAlike_K = 4.0;
/// Largest fall of a motor that starts at room temperature.
constexpr double kFalls_K = 1.5;

double from_kelvin_C(double value) { return value - 273.15; }
double from_fahrenheit_C(double value) { return (value - 32.0) / 1.8; }
double from_tenths_C(double value) { return 0.1 * value; }
bool is_of_a_room(double value_C) { return value_C > 12.0 && value_C < 40.0; }

/// An input heats if it exceeds this share of its usual magnitude.
constexpr double kHeats_share = 0.01;

/// True for inputs that are 0 if the motor is not heated.
bool is_watts(const Channel& channel) {
  return channel.quantity.kind == QuantityKind::heat_input && channel.quantity.unit != "V" && !channel.quantity.unit.empty();
}

/// First row after which the motor is not heated until the end; the number of rows if unknown.
std::size_t heat_ends(const Recording& recording) {
  std::size_t after = recording.run_begins.empty() ? 0 : recording.run_begins.back();
  bool is_logged = false;
  for (const Channel& channel : recording.channels) {
    if (!is_watts(channel)) {
      continue;
    }
    is_logged = true;
    const double least = kHeats_share * top_of_sizes(channel.values);
    // The last row is ignored, because the log ends with it.
    for (std::size_t row = after; row + 1 < recording.rows(); ++row) {
      after = std::isnan(channel.values[row]) || std::abs(channel.values[row]) > least ? row + 1 : after;
    }
  }
  return is_logged ? after : recording.rows();
}

/// Final value of an exponential decay from row `first` to the end of the log, from three equidistant times. NaN if it is not a decay or
/// still far from its end.
double rests_at(const Recording& recording, const Channel& channel, std::size_t first) {
  constexpr std::size_t kFewestRows = 40;
  constexpr double kFall_K = 3.0;
  constexpr double kDecay_ratio = 0.72;
  if (recording.rows() < first + kFewestRows) {
    return base::kUnknown;
  }
  const double begin_s = recording.time_s[first];
  const double third_s = (recording.time_s.back() - begin_s) / 3.0;
  std::array<double, 3> at{};
  for (std::size_t k = 0; k < at.size(); ++k) {
    // Medians over tenths of the time, the last of which ends with the log.
    const double middle_s = begin_s + (static_cast<double>(k) + 0.85) * third_s;
    const auto from = std::ranges::lower_bound(recording.time_s, middle_s - 0.15 * third_s) - recording.time_s.begin();
    const auto to = std::ranges::upper_bound(recording.time_s, middle_s + 0.15 * third_s) - recording.time_s.begin();
    at[k] = middle_of(std::span(channel.values).subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(to - from)));
  }
  const double early_K = at[0] - at[1];
  const double late_K = at[1] - at[2];
  const bool decays = at[0] - at[2] > kFall_K && late_K > 0.0 && late_K < kDecay_ratio * early_K;
  return decays ? at[2] - late_K * late_K / (early_K - late_K) : base::kUnknown;
}

/// True if the channel never falls below its start, as for a motor that starts at room temperature. `degree` is the value of 1 K in the
/// channel's unit.
bool never_falls(const Channel& channel, double degree) {
  return percentile(channel.values, 0.02) > coolest_at_start(channel) - kFalls_K * degree;
}

bool is_constant(const Channel& channel) { return percentile(channel.values, 0.0) == percentile(channel.values, 1.0); }

class Scales {
 public:
  Scales(const Recording& recording, std::optional<double> ambient_C)
      : recording_(recording), ambient_(recording.find(kAmbientColumn)), stated_C_(ambient_C) {
    for (const Channel& channel : recording.channels) {
      if (channel.quantity.kind == QuantityKind::temperature && is_constant(channel)) {
        continue;  // a sensor that does not follow the motor has no scale
      }
      if (channel.quantity.kind == QuantityKind::temperature) {
        sensors_.push_back(&channel);
      }
      if (channel.quantity.kind == QuantityKind::temperature || channel.quantity.kind == QuantityKind::surroundings) {
        channels_.push_back(&channel);
      }
    }
  }

  std::vector<Suspicion> run() {
    const bool in_tenths = std::ranges::any_of(channels_, [this](const Channel* each) { return is_in_tenths(*each); });
    constexpr double kColdest_K = 240.0;
    for (const Channel* each : channels_) {
      const std::string& key = each->quantity.key;
      const double start = at_start(*each);
      if (is_in_tenths(*each) || (in_tenths && is_of_a_room(from_tenths_C(start)) && start > 250.0)) {
        found_.emplace_back(StartsInOtherScale{key, start, from_tenths_C(start), TemperatureScale::tenths_of_degrees});
      } else if (start > 250.0 && from_kelvin_C(start) > -25.0 && from_kelvin_C(start) < 60.0 &&
                 percentile(each->values, 0.02) > kColdest_K) {
        found_.emplace_back(StartsInOtherScale{key, start, from_kelvin_C(start), TemperatureScale::kelvin});
      } else if (is_in_fahrenheit(*each)) {
        is_reported_ = is_reported_ || each->quantity.kind == QuantityKind::temperature;
        found_.emplace_back(StartsInOtherScale{key, start, from_fahrenheit_C(start), TemperatureScale::fahrenheit});
      }
    }
    if (!is_reported_) {
      motor_in_fahrenheit();
      cooling_in_fahrenheit();
    }
    return std::move(found_);
  }

 private:
  [[nodiscard]] std::vector<double> other_starts_C(const Channel& channel) const {
    std::vector<double> starts_C;
    for (const Channel* each : channels_) {
      if (each != &channel) {
        starts_C.push_back(at_start(*each));
      }
    }
    return starts_C;
  }

  /// True if the channel is probably in tenths of degrees: kelvin gives no room temperature, and another channel starts at a tenth of it.
  [[nodiscard]] bool is_in_tenths(const Channel& channel) const {
    constexpr double kLeast = 180.0;
    const double start = coolest_at_start(channel);
    return start > kLeast && is_of_a_room(from_tenths_C(start)) && !is_of_a_room(from_kelvin_C(start)) && never_falls(channel, 10.0) &&
           std::ranges::any_of(other_starts_C(channel), [start](double other_C) {
             return std::abs(other_C - from_tenths_C(start)) < kAlike_K || std::abs(other_C - start) < 10.0 * kAlike_K;
           });
  }

  /// True if the channel is probably in degrees Fahrenheit. Assumes that most logs start cold, with all temperatures at room temperature.
  [[nodiscard]] bool is_in_fahrenheit(const Channel& channel) const {
    const double start = at_start(channel);
    const double coolest_C = from_fahrenheit_C(coolest_at_start(channel));
    std::vector<double> others_C = other_starts_C(channel);
    const auto all_within = [&others_C](double value_C, double within_K) {
      return std::ranges::all_of(others_C, [=](double other_C) { return std::abs(other_C - value_C) < within_K; });
    };
    constexpr double kAllAlike_K = 10.0;
    const bool room_is_as_hot = ambient_ == nullptr && stated_C_ && std::abs(*stated_C_ - start) < kApart_K;
    const bool all_are_alike = !others_C.empty() && all_within(start, kAllAlike_K) && !room_is_as_hot;
    if (ambient_ == nullptr && stated_C_) {
      others_C.push_back(*stated_C_);
    }
    const bool stands_apart = std::ranges::none_of(others_C, [start](double other_C) { return std::abs(other_C - start) < kApart_K; });
    // If the others start at different temperatures, this one may be warm too.
    const bool others_are_alike = std::ranges::all_of(others_C, [&](double one_C) { return all_within(one_C, kApart_K); });
    // A single other channel may agree by chance, so the limit is smaller. A motor may be slightly warmer than the room.
    const double below_K = others_C.size() > 1 ? kAlike_K : 0.5 * kAlike_K;
    const bool is_beside_room = sensors_.size() == 1 && sensors_.front() == &channel;
    const double above_K = is_beside_room ? 1.2 * kAlike_K : below_K;
    const bool one_agrees =
        std::ranges::any_of(others_C, [=](double other_C) { return coolest_C > other_C - below_K && coolest_C < other_C + above_K; });
    if (stands_apart && others_are_alike && one_agrees && never_falls(channel, 1.8)) {
      return true;
    }
    const bool is_room = &channel == ambient_;
    return (is_room || (all_are_alike && never_falls(channel, 1.8))) && start > 55.0 && start < 105.0 &&
           is_of_a_room(from_fahrenheit_C(start));
  }

  /// Detects a motor in Fahrenheit: all sensors start alike, far above room temperature, but at room temperature if read as Fahrenheit.
  void motor_in_fahrenheit() {
    const double room_C = ambient_ != nullptr ? at_start(*ambient_) : stated_C_.value_or(base::kUnknown);
    if (std::isnan(room_C) || sensors_.size() < 2) {
      return;
    }
    const double first = coolest_at_start(*sensors_.front());
    const bool all = std::ranges::all_of(sensors_, [&](const Channel* sensor) {
      const double start = coolest_at_start(*sensor);
      return std::abs(start - first) < 1.8 * kAlike_K && start - room_C > kApart_K &&
             std::abs(from_fahrenheit_C(start) - room_C) < kAlike_K && never_falls(*sensor, 1.8);
    });
    if (all) {
      is_reported_ = true;
      found_.emplace_back(MotorStartsInFahrenheit{sensors_.front()->quantity.key, first, from_fahrenheit_C(first), room_C});
    }
  }

  /// Detects Fahrenheit from a cool-down: without heat, a motor approaches the air temperature, but in Fahrenheit a value far above it.
  void cooling_in_fahrenheit() {
    const double room_C = ambient_ != nullptr ? middle_of(ambient_->values) : stated_C_.value_or(base::kUnknown);
    if (std::isnan(room_C) || sensors_.empty() || is_reported_) {
      return;
    }
    constexpr double kFlat_share = 0.4;
    const std::size_t first = heat_ends(recording_);
    const bool all = std::ranges::all_of(sensors_, [&](const Channel* sensor) {
      const double rest = rests_at(recording_, *sensor, first);
      return rest - room_C > kApart_K && at_end(*sensor) - rest < kFlat_share * (rest - room_C) &&
             std::abs(from_fahrenheit_C(rest) - room_C) < kAlike_K;
    });
    if (all) {
      const double rest = rests_at(recording_, *sensors_.front(), first);
      found_.emplace_back(MotorCoolsInFahrenheit{sensors_.front()->quantity.key, rest, from_fahrenheit_C(rest), room_C});
    }
  }

  const Recording& recording_;
  const Channel* ambient_;
  std::optional<double> stated_C_;
  bool is_reported_ = false;              ///< true: Fahrenheit has already been reported for a sensor of the motor
  std::vector<const Channel*> sensors_;   ///< temperatures of the motor
  std::vector<const Channel*> channels_;  ///< these and the surroundings
  std::vector<Suspicion> found_;
};

}  // namespace

std::vector<Suspicion> suspicious_scales(const Recording& recording, std::optional<double> ambient_C) {
  return Scales(recording, ambient_C).run();
}

}  // namespace heatsoak::recording
