#include "identify/measurement/suspicions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/quantity.h"
#include "base/unknown.h"
#include "identify/measurement/row_order.h"

namespace heatsoak {
namespace {

/// A percentile of what is there, 0 … 1; NaN where nothing is.
double percentile(std::span<const double> values, double share) {
  constexpr std::size_t kMostValues = 200'000;  // of a long log, spread evenly
  std::vector<double> sorted;
  for (std::size_t i = 0; i < values.size(); i += values.size() / kMostValues + 1) {
    if (!std::isnan(values[i])) {
      sorted.push_back(values[i]);
    }
  }
  if (sorted.empty()) {
    return kUnknown;
  }
  const auto place = sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
  std::ranges::nth_element(sorted, place);
  return *place;
}

double middle_of(std::span<const double> values) { return percentile(values, 0.5); }

std::vector<double> first_samples(const Channel& channel) {
  std::vector<double> first;
  for (std::size_t i = 0; i < channel.values.size() && first.size() < 5; ++i) {
    if (!std::isnan(channel.values[i])) {
      first.push_back(channel.values[i]);
    }
  }
  return first;
}

double at_start(const Channel& channel) { return middle_of(first_samples(channel)); }
/// Before the first heat warms it.
double coolest_at_start(const Channel& channel) { return percentile(first_samples(channel), 0.0); }

class Suspector {
 public:
  Suspector(const Recording& recording, std::span<const ChannelQuality> channels) : recording_(recording), channels_(channels) {}

  Suspicions run() {
    scales_of_temperature();
    motor_in_fahrenheit();
    ambient_against_motor();
    answer_to_heat();
    cooling_down();
    currents();
    speeds();
    clock();
    std::vector<std::string> spoiling = found_;
    angles();
    wheels();
    std::vector<std::string> spoiling_wheels(found_.begin() + static_cast<std::ptrdiff_t>(spoiling.size()), found_.end());
    limits();
    return {std::move(found_), std::move(spoiling), std::move(spoiling_wheels)};
  }

 private:
  [[nodiscard]] static bool is_thermal(const Channel& channel) {
    return channel.quantity.kind == QuantityKind::temperature || channel.quantity.kind == QuantityKind::surroundings;
  }
  [[nodiscard]] const ChannelQuality* quality(const std::string& key) const {
    const auto found = std::ranges::find_if(channels_, [&key](const ChannelQuality& each) { return each.quantity.key == key; });
    return found == channels_.end() ? nullptr : &*found;
  }

  /// A log mostly starts cold, all of its temperatures at that of the room.
  void scales_of_temperature() {
    std::vector<double> starts_C;
    for (const Channel& channel : recording_.channels) {
      if (is_thermal(channel)) {
        starts_C.push_back(at_start(channel));
      }
    }
    for (const Channel& channel : recording_.channels) {
      if (!is_thermal(channel)) {
        continue;
      }
      const double start = at_start(channel);
      const double from_kelvin_C = start - 273.15;
      const double from_fahrenheit_C = (start - 32.0) / 1.8;
      const bool is_room = channel.quantity.key == "ambient_C";
      constexpr double kAlike_K = 6.0;  // a winding warms by that in the first seconds
      const auto agrees = [&](double value_C) {
        return std::ranges::any_of(starts_C, [&](double other_C) { return other_C != start && std::abs(other_C - value_C) < kAlike_K; });
      };
      constexpr double kApart_K = 15.0;
      const bool stands_apart =
          std::ranges::none_of(starts_C, [&](double other_C) { return other_C != start && std::abs(other_C - start) < kApart_K; });
      // Where the others start warm too, this one may as well.
      const bool others_are_alike = std::ranges::all_of(starts_C, [&](double one_C) {
        return std::ranges::all_of(
            starts_C, [&](double other_C) { return one_C == start || other_C == start || std::abs(one_C - other_C) < kApart_K; });
      });
      const bool all_are_alike =
          starts_C.size() > 1 && std::ranges::all_of(starts_C, [start](double other_C) { return std::abs(other_C - start) < 10.0; });
      const auto in_a_room = [](double value_C) { return value_C > 12.0 && value_C < 40.0; };
      if (start > 250.0 && from_kelvin_C > -25.0 && from_kelvin_C < 60.0) {
        found_.push_back(fmt::format("{} starts at {} °C: is it in kelvin ({} °C)?", channel.quantity.key, significant(start, 4),
                                     significant(from_kelvin_C, 3)));
      } else if ((stands_apart && others_are_alike && (agrees(from_fahrenheit_C) || is_never_cool(channel, from_fahrenheit_C, starts_C))) ||
                 ((is_room || all_are_alike) && start > 55.0 && start < 105.0 && in_a_room(from_fahrenheit_C))) {
        found_.push_back(fmt::format("{} starts at {} °C: is it in degrees Fahrenheit ({} °C)?", channel.quantity.key,
                                     significant(start, 3), significant(from_fahrenheit_C, 3)));
      }
    }
  }

  /// All of the motor's sensors start alike and far above the room, their Fahrenheit is the room's temperature, and none of them ever
  /// cools, as a motor that starts warm would.
  void motor_in_fahrenheit() {
    const Channel* const ambient = recording_.find("ambient_C");
    std::vector<const Channel*> sensors;
    for (const Channel& channel : recording_.channels) {
      if (channel.quantity.kind == QuantityKind::temperature) {
        sensors.push_back(&channel);
      }
    }
    if (ambient == nullptr || sensors.size() < 2) {
      return;
    }
    constexpr double kAlike_K = 1.5;
    constexpr double kFar_K = 15.0;
    constexpr double kRoom_K = 2.5;
    constexpr double kCools_K = 2.0;
    const double room_C = at_start(*ambient);
    const double first_C = coolest_at_start(*sensors.front());
    const bool all = std::ranges::all_of(sensors, [&](const Channel* sensor) {
      const double start_C = coolest_at_start(*sensor);
      return std::abs(start_C - first_C) < kAlike_K && start_C - room_C > kFar_K && std::abs((start_C - 32.0) / 1.8 - room_C) < kRoom_K &&
             percentile(sensor->values, 0.0) > start_C - kCools_K;
    });
    if (all) {
      found_.push_back(fmt::format(
          "{} and the motor's other temperatures start at {} °C in air of {} °C: are they in degrees Fahrenheit ({} °C)?",
          sensors.front()->quantity.key, significant(first_C, 3), significant(room_C, 3), significant((first_C - 32.0) / 1.8, 3)));
    }
  }

  /// Fahrenheit of a winding that starts a little warmer than the rest, and never comes down to where a room's temperatures are.
  static bool is_never_cool(const Channel& channel, double from_fahrenheit_C, std::span<const double> starts_C) {
    constexpr double kRoom_F = 55.0;
    const double start_C = at_start(channel);
    constexpr double kWarmer_K = 12.0;
    constexpr double kColder_K = 4.0;
    return percentile(channel.values, 0.02) > kRoom_F && std::ranges::all_of(starts_C, [&](double other_C) {
             return other_C == start_C || (from_fahrenheit_C > other_C - kColder_K && from_fahrenheit_C < other_C + kWarmer_K);
           });
  }

  void ambient_against_motor() {
    const Channel* const ambient = recording_.find("ambient_C");
    for (const Channel& channel : recording_.channels) {
      if (ambient == nullptr || channel.quantity.kind != QuantityKind::temperature || recording_.find("coolant_C") != nullptr) {
        continue;
      }
      std::vector<double> above_K;
      for (std::size_t i = 0; i < recording_.rows(); ++i) {
        above_K.push_back(channel.values[i] - ambient->values[i]);
      }
      if (middle_of(above_K) < -2.0) {
        found_.push_back(fmt::format("ambient_C is hotter than {} most of the time (by {} K): are the channels swapped?",
                                     channel.quantity.key, significant(-middle_of(above_K), 2)));
      }
    }
  }

  /// How a temperature's rate follows the heat, over blocks long enough to see it.
  struct Answer {
    double slope = 0.0;
    double correlation_ratio = 0.0;
    std::size_t blocks = 0;
  };
  [[nodiscard]] Answer answer_of(const Channel& channel, std::span<const double> heat) const {
    const double duration_s = recording_.time_s.back() - recording_.time_s.front();
    const double block_s = std::max(5.0 * usual_period_s(recording_.time_s), duration_s / 200.0);
    std::vector<double> rates;
    std::vector<double> heats;
    for (const auto& [begin, end] : recording_.runs()) {
      std::size_t from = begin;
      double sum = 0.0;
      for (std::size_t i = begin; i < end; ++i) {
        const double elapsed_s = recording_.time_s[i] - recording_.time_s[from];
        if (elapsed_s >= block_s) {
          const double rate = (channel.values[i] - channel.values[from]) / elapsed_s;
          if (!std::isnan(rate) && !std::isnan(sum)) {
            rates.push_back(rate);
            heats.push_back(sum / static_cast<double>(i - from));
          }
          from = i;
          sum = 0.0;
        }
        sum += heat[i];
      }
    }
    return regress(heats, rates);
  }
  static Answer regress(std::span<const double> x, std::span<const double> y) {
    const auto count = static_cast<double>(x.size());
    double mean_x = 0.0;
    double mean_y = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      mean_x += x[i] / count;
      mean_y += y[i] / count;
    }
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      xx += (x[i] - mean_x) * (x[i] - mean_x);
      xy += (x[i] - mean_x) * (y[i] - mean_y);
      yy += (y[i] - mean_y) * (y[i] - mean_y);
    }
    return xx > 0.0 && yy > 0.0 ? Answer{xy / xx, xy / std::sqrt(xx * yy), x.size()} : Answer{0.0, 0.0, x.size()};
  }

  void answer_to_heat() {
    constexpr std::size_t kEnoughBlocks = 10;
    const Channel* const input = heat_input_of(recording_);
    if (input == nullptr || recording_.rows() < 2) {
      return;
    }
    const std::vector<double> heat = relative_heat(*input);
    const Channel* const winding = recording_.find("winding_C");
    const Channel* const stator = recording_.find("stator_C");
    for (const Channel* channel : {winding, stator}) {
      if (channel != nullptr) {
        const Answer answer = answer_of(*channel, heat);
        if (answer.blocks >= kEnoughBlocks && answer.correlation_ratio < -0.5) {
          found_.push_back(fmt::format("{} falls while {} heats and rises while it rests: is the sign of the sensor wrong?",
                                       channel->quantity.key, input->quantity.key));
        }
      }
    }
    if (winding == nullptr || stator == nullptr) {
      return;
    }
    const Answer of_winding = answer_of(*winding, heat);
    const Answer of_stator = answer_of(*stator, heat);
    const auto swing = [&](const Channel& channel) { return percentile(channel.values, 0.98) - percentile(channel.values, 0.02); };
    if (of_stator.blocks >= kEnoughBlocks && of_stator.correlation_ratio > 0.3 && of_stator.slope > 1.3 * of_winding.slope &&
        swing(*stator) > 1.1 * swing(*winding)) {
      found_.push_back(fmt::format("stator_C answers to {} faster than winding_C and swings more ({} K against {} K): are the two swapped?",
                                   input->quantity.key, significant(swing(*stator), 3), significant(swing(*winding), 3)));
    }
  }

  /// Where nothing heats, the winding falls the faster of the two and stays the hotter: it has only the stator to lose its heat to.
  void cooling_down() {
    constexpr std::size_t kEnoughBlocks = 10;
    constexpr double kLittleHeat = 0.01;  // W or A²
    constexpr double kLittleHeat_share = 1e-3;
    const Channel* const input = heat_input_of(recording_);
    const Channel* const winding = recording_.find("winding_C");
    const Channel* const stator = recording_.find("stator_C");
    if (winding == nullptr || stator == nullptr || recording_.rows() < 2) {
      return;
    }
    const std::vector<double> heat = input != nullptr ? relative_heat(*input) : std::vector<double>(recording_.rows(), 0.0);
    const double little = std::max(kLittleHeat, kLittleHeat_share * percentile(heat, 1.0));
    const Channel* const speed = recording_.find("speed_rad_per_s");
    const double block_s =
        std::max(5.0 * usual_period_s(recording_.time_s), (recording_.time_s.back() - recording_.time_s.front()) / 200.0);
    const auto rests = [&](std::size_t row) {
      return std::abs(heat[row]) < little && (speed == nullptr || std::abs(speed->values[row]) < 1.0) &&
             std::isfinite(winding->values[row]) && std::isfinite(stator->values[row]);
    };
    std::vector<double> apart_K;
    std::vector<double> winding_falls_K_per_s;
    std::vector<double> stator_falls_K_per_s;
    for (const auto& [begin, end] : recording_.runs()) {
      std::size_t from = begin;
      for (std::size_t row = begin; row < end; ++row) {
        const double elapsed_s = recording_.time_s[row] - recording_.time_s[from];
        if (!rests(row) || !rests(from)) {
          from = row;
        } else if (elapsed_s >= block_s) {
          apart_K.push_back(winding->values[row] - stator->values[row]);
          winding_falls_K_per_s.push_back((winding->values[from] - winding->values[row]) / elapsed_s);
          stator_falls_K_per_s.push_back((stator->values[from] - stator->values[row]) / elapsed_s);
          from = row;
        }
      }
    }
    const double steepest_K_per_s = percentile(stator_falls_K_per_s, 0.95);
    if (apart_K.size() >= kEnoughBlocks && middle_of(apart_K) < -1.0 && steepest_K_per_s * block_s > 1.0 &&
        steepest_K_per_s > 1.3 * std::max(0.0, percentile(winding_falls_K_per_s, 0.95))) {
      found_.push_back(
          fmt::format("while nothing heats, stator_C is hotter than winding_C (by {} K) and falls faster: are the two swapped?",
                      significant(-middle_of(apart_K), 2)));
    }
  }

  void currents() {
    constexpr double kLargestCurrent_A = 300.0;
    for (const char* key : {"current_A", "current_q_A", "bus_A"}) {
      const Channel* const current = recording_.find(key);
      const ChannelQuality* const range = quality(key);
      if (current == nullptr) {
        continue;
      }
      if (std::max(std::abs(range->high), std::abs(range->low)) > kLargestCurrent_A) {
        found_.push_back(fmt::format("{} reaches {} A: is it in milliamperes?", key,
                                     significant(std::max(std::abs(range->high), std::abs(range->low)), 3)));
      }
    }
    const Channel* const power = recording_.find("power_in_W");
    const Channel* const voltage = recording_.find("bus_V");
    const Channel* const supply = recording_.find("bus_A");
    if (power != nullptr && voltage != nullptr && supply != nullptr) {
      std::vector<double> ratios;
      const double large_W = 0.3 * std::max(std::abs(percentile(power->values, 0.98)), std::abs(percentile(power->values, 0.02)));
      for (std::size_t i = 0; i < recording_.rows(); ++i) {
        const double product_W = voltage->values[i] * supply->values[i];
        if (std::abs(product_W) > 0.0 && std::abs(power->values[i]) > large_W) {
          ratios.push_back(power->values[i] / product_W);
        }
      }
      const double ratio = middle_of(ratios);
      if (std::abs(ratio) < 0.5 || std::abs(ratio) > 2.0) {
        found_.push_back(fmt::format("power_in_W is {} times bus_V × bus_A: is one of them in another unit?", significant(ratio, 3)));
      } else if (ratio < 0.0) {
        found_.emplace_back("power_in_W and bus_V × bus_A have opposite signs");
      }
    }
    if (const Channel* const torque = recording_.find("torque_Nm"); torque != nullptr && recording_.find("current_A") != nullptr) {
      const Answer answer = pairs(*recording_.find("current_A"), *torque);
      if (answer.blocks > 20 && answer.correlation_ratio < -0.7) {
        found_.emplace_back("torque_Nm and current_A have opposite signs: is the sign of one of them wrong?");
      }
    }
  }
  [[nodiscard]] static Answer pairs(const Channel& a, const Channel& b) {
    std::vector<double> x;
    std::vector<double> y;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
      if (!std::isnan(a.values[i]) && !std::isnan(b.values[i])) {
        x.push_back(a.values[i]);
        y.push_back(b.values[i]);
      }
    }
    return regress(x, y);
  }

  void speeds() {
    constexpr double kRpm = 30.0 / std::numbers::pi;
    constexpr double kFastest_rad_per_s = 4000.0;  // 38 000 rpm
    for (const ChannelQuality& channel : channels_) {
      const double fastest = std::max(std::abs(channel.low), std::abs(channel.high));
      if (channel.quantity.unit == "rad/s" && channel.quantity.key.find("speed") != std::string::npos && fastest > kFastest_rad_per_s) {
        found_.push_back(fmt::format("{} reaches {} rad/s: is it in rpm ({} rad/s) or degrees per second ({} rad/s)?", channel.quantity.key,
                                     significant(fastest, 4), significant(fastest / kRpm, 3),
                                     significant(fastest * std::numbers::pi / 180.0, 3)));
      }
    }
    const Channel* const speed = recording_.find("speed_rad_per_s");
    const Channel* const torque = recording_.find("torque_Nm");
    const Channel* const power = recording_.find("power_in_W");
    if (speed == nullptr || torque == nullptr || power == nullptr) {
      return;
    }
    std::vector<double> ratios;
    const double large_W = 0.3 * percentile(power->values, 0.98);
    for (std::size_t i = 0; i < recording_.rows(); ++i) {
      if (power->values[i] > large_W && large_W > 0.0) {
        ratios.push_back(std::abs(speed->values[i] * torque->values[i]) / power->values[i]);
      }
    }
    if (const double ratio = middle_of(ratios); ratio > 1.1) {
      found_.push_back(
          fmt::format("torque_Nm × speed_rad_per_s is {} times power_in_W, more than goes in: is the speed in rpm (÷ 9.55) or "
                      "degrees per second (÷ 57.3)?",
                      significant(ratio, 3)));
    }
  }

  void angles() {
    for (const ChannelQuality& channel : channels_) {
      const double span = channel.high - channel.low;
      const bool is_angle = channel.quantity.key.starts_with("yaw") || channel.quantity.key.starts_with("heading");
      if (channel.quantity.unit == "rad" && is_angle && span > 100.0 && span <= 721.0) {
        found_.push_back(fmt::format("{} spans {} rad: is it in degrees?", channel.quantity.key, significant(span, 3)));
      }
    }
  }

  /// By the 98 % of the sizes, so that single wild rows do not count.
  void wheels() {
    constexpr double kLargestBattery_V = 1000.0;
    constexpr double kLargestCurrent_A = 300.0;
    for (const Channel& channel : recording_.channels) {
      const std::string& key = channel.quantity.key;
      std::vector<double> sizes(channel.values.size());
      std::ranges::transform(channel.values, sizes.begin(), [](double value) { return std::abs(value); });
      const double top = percentile(sizes, 0.98);
      if (key.starts_with("wheel_pwm_ratio") && top > 1.5) {
        found_.push_back(fmt::format("{} reaches {}: is it in percent or in counts of a timer? 1 is the whole battery voltage", key,
                                     significant(top, 3)));
      } else if ((key == "battery_V" || key.starts_with("wheel_voltage_V")) && top > kLargestBattery_V) {
        found_.push_back(fmt::format("{} reaches {} V: is it in millivolts?", key, significant(top, 3)));
      } else if (key.starts_with("wheel_current_A") && top > kLargestCurrent_A) {
        found_.push_back(fmt::format("{} reaches {} A: is it in milliamperes?", key, significant(top, 3)));
      }
    }
  }

  void clock() {
    constexpr double kLongest_s = 2.0 * 86400.0;
    const double duration_s = recording_.time_s.back() - recording_.time_s.front();
    if (duration_s > kLongest_s) {
      found_.push_back(fmt::format("the log lasts {} days at {} s per row: is the time in milliseconds?",
                                   significant(duration_s / 86400.0, 3), significant(usual_period_s(recording_.time_s), 3)));
    }
  }

  /// What a temperature would be frozen or cut for is often right for an input: it is only said.
  void limits() {
    constexpr double kMuch_share = 0.2;
    for (const Channel& channel : recording_.channels) {
      const ChannelQuality* const range = quality(channel.quantity.key);
      if (channel.quantity.kind != QuantityKind::heat_input || range->samples < 100 || range->is_constant()) {
        continue;
      }
      constexpr std::size_t kManyValues = 50;  // set points have few, measured signals have many
      for (const auto& [end, samples] : {std::pair(range->high, range->at_high), std::pair(range->low, range->at_low)}) {
        const auto there = static_cast<double>(samples);
        if (end != 0.0 && there > kMuch_share * static_cast<double>(range->samples) && range->noise > 0.0 &&
            range->distinct > kManyValues) {
          found_.push_back(fmt::format("{} stays at exactly {} {} in {:.0f} % of its rows: a limit, or a saturated sensor?",
                                       channel.quantity.key, significant(end, 5), unit_for_display(channel.quantity.unit),
                                       100.0 * there / static_cast<double>(range->samples)));
        }
      }
    }
  }

  const Recording& recording_;
  std::span<const ChannelQuality> channels_;
  std::vector<std::string> found_;
};

}  // namespace

Suspicions suspicions(const Recording& recording, std::span<const ChannelQuality> channels) { return Suspector(recording, channels).run(); }

}  // namespace heatsoak
