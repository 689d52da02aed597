#include "recording/suspicions.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "recording/clock_offset.h"
#include "recording/quantities.h"
#include "recording/row_order.h"
#include "recording/sensor_places.h"
#include "recording/spread.h"
#include "recording/temperature_scales.h"

namespace heatsoak::recording {
namespace {

using base::Signal;

class Suspector {
 public:
  Suspector(const Recording& recording, const DataQuality& data, std::optional<double> ambient_C)
      : recording_(recording), quality_(data), ambient_C_(ambient_C) {}

  Suspicions run() {
    found_ = suspicious_scales(recording_, ambient_C_);
    std::ranges::move(suspicious_places(recording_, quality_.channels), std::back_inserter(found_));
    currents();
    speeds();
    const auto of_motors = static_cast<std::ptrdiff_t>(found_.size());
    // A wrong unit of the time also falsifies delays, so it is reported before them.
    clock();
    std::vector<Suspicion> blocking_for_wheels(found_.begin() + of_motors, found_.end());
    early_answers();
    constant_heat_inputs();
    std::vector<Suspicion> blocking = found_;
    const auto of_all = static_cast<std::ptrdiff_t>(found_.size());
    angles();
    wheels();
    blocking_for_wheels.insert(blocking_for_wheels.end(), found_.begin() + of_all, found_.end());
    short_clock();
    constants();
    limits();
    return {std::move(found_), std::move(blocking), std::move(blocking_for_wheels)};
  }

 private:
  [[nodiscard]] const ChannelQuality* quality(const std::string& key) const {
    const auto found = std::ranges::find_if(quality_.channels, [&key](const ChannelQuality& each) { return each.quantity.key == key; });
    return found == quality_.channels.end() ? nullptr : &*found;
  }

  void currents() {
    for (const std::string_view key : {column_of(Signal::current), std::string_view("current_q_A"), std::string_view("bus_A")}) {
      const Channel* const current = recording_.find(key);
      if (const double top_A = current != nullptr ? top_of_sizes(current->values) : 0.0; top_A > kLargestCurrent_A) {
        found_.emplace_back(CurrentTooLarge{std::string(key), top_A});
      }
    }
    const Channel* const power = recording_.find(column_of(Signal::input_power));
    const Channel* const voltage = recording_.find(column_of(Signal::bus_voltage));
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
        found_.emplace_back(PowerDiffersFromBus{ratio});
      } else if (ratio < 0.0) {
        found_.emplace_back(PowerOppositeToBus{});
      }
    }
    if (const Channel* const torque = recording_.find(column_of(Signal::shaft_power));
        torque != nullptr && recording_.find(column_of(Signal::current)) != nullptr) {
      const Regression answer = pairs(*recording_.find(column_of(Signal::current)), *torque);
      if (answer.points > 20 && answer.correlation_ratio < -0.7) {
        found_.emplace_back(TorqueOppositeToCurrent{});
      }
    }
  }
  [[nodiscard]] static Regression pairs(const Channel& a, const Channel& b) {
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
    for (const Channel& channel : recording_.channels) {
      const double fastest = top_of_sizes(channel.values);
      if (channel.quantity.unit == "rad/s" && channel.quantity.key.find("speed") != std::string::npos && fastest > kFastest_rad_per_s) {
        found_.emplace_back(SpeedTooLarge{channel.quantity.key, fastest});
      }
    }
    const Channel* const speed = recording_.find(column_of(Signal::speed));
    const Channel* const torque = recording_.find(column_of(Signal::shaft_power));
    const Channel* const power = recording_.find(column_of(Signal::input_power));
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
      found_.emplace_back(ShaftPowerExceedsInput{ratio});
    }
  }

  void angles() {
    for (const ChannelQuality& channel : quality_.channels) {
      const double span = channel.high - channel.low;
      const bool is_angle = channel.quantity.key.starts_with("yaw") || channel.quantity.key.starts_with("heading");
      if (channel.quantity.unit == "rad" && is_angle && span > 100.0 && span <= 721.0) {
        found_.emplace_back(AngleSpansDegrees{channel.quantity.key, span});
      }
    }
  }

  /// Checks units of wheel signals with the 98th percentile of the magnitudes, which ignores single outliers.
  void wheels() {
    constexpr double kLargestBattery_V = 1000.0;
    constexpr double kLongestPeriod_s = 2.0;  // wheels speed up and stop within it
    const double period_s = usual_period_s(recording_.time_s);
    const bool has_wheels = std::ranges::any_of(recording_.channels,
                                                [](const Channel& each) { return each.quantity.key.starts_with("wheel_speed_rad_per_s"); });
    if (has_wheels && period_s > kLongestPeriod_s && recording_.time_s.back() - recording_.time_s.front() <= kLongest_s) {
      found_.emplace_back(WheelRowsFarApart{period_s});
    }
    for (const Channel& channel : recording_.channels) {
      const std::string& key = channel.quantity.key;
      const double top = top_of_sizes(channel.values);
      if (key.starts_with("wheel_modulation_ratio") && top > 1.5) {
        found_.emplace_back(ModulationAboveOne{key, top});
      } else if ((key == "battery_V" || key.starts_with("wheel_voltage_V")) && top > kLargestBattery_V) {
        found_.emplace_back(VoltageTooLarge{key, top});
      } else if (key.starts_with("wheel_current_A") && top > kLargestCurrent_A) {
        found_.emplace_back(CurrentTooLarge{key, top});
      }
    }
  }

  void clock() {
    const double duration_s = recording_.time_s.back() - recording_.time_s.front();
    if (duration_s > kLongest_s) {
      found_.emplace_back(LastsForDays{duration_s, usual_period_s(recording_.time_s),
                                       duration_s > 1e3 * kLongest_s ? TimeUnit::microseconds : TimeUnit::milliseconds});
    }
  }

  /// Reports temperatures that respond before their heat input.
  void early_answers() {
    for (const ClockOffset& offset : quality_.clock_offsets) {
      if (const std::optional<RespondsEarly> early = early_answer(offset, quality_.sampling.usual_period_s)) {
        found_.emplace_back(*early);
      }
    }
  }

  /// Detects times in minutes or hours: the period is then a whole number of seconds, and a temperature falls faster than any motor cools.
  /// Loggers with 60 Hz look similar.
  void short_clock() {
    const double period_s = usual_period_s(recording_.time_s);
    constexpr double kMost_s = 60.0;
    constexpr double kOff_ratio = 5e-3;
    const auto is_whole = [](double value, double off) { return std::abs(value - std::round(value)) < off; };
    for (const auto& [unit, in_s] : {std::pair(TimeUnit::minutes, 60.0), std::pair(TimeUnit::hours, 3600.0)}) {
      const double true_s = in_s * period_s;
      if (true_s > kMost_s || std::round(true_s) < 1.0 || !is_whole(true_s, kOff_ratio * true_s) || is_whole(1e3 * period_s, 0.01)) {
        continue;
      }
      for (const Channel& channel : recording_.channels) {
        if (channel.quantity.kind != QuantityKind::temperature) {
          continue;
        }
        // The rate of a rise depends on the current, but the rate of a fall only on the motor.
        const double fast_s = channel.quantity.key.find("winding") != std::string::npos ? 0.5 : 5.0;
        if (const double fall_s = usual_fall_s(channel); fall_s < fast_s) {
          found_.emplace_back(FallsTooFast{channel.quantity.key, period_s, kFall_K, fall_s, unit});
          return;
        }
      }
    }
  }
  static constexpr double kFall_K = 10.0;
  /// Median time of a fall by kFall_K without a rise; infinite with fewer than two falls.
  [[nodiscard]] double usual_fall_s(const Channel& channel) const {
    std::vector<double> falls_s;
    for (const auto& [begin, end] : recording_.runs()) {
      double from_C = -std::numeric_limits<double>::infinity();
      double from_s = 0.0;
      for (std::size_t row = begin; row < end; ++row) {
        const double now_C = channel.values[row];
        const bool is_fallen = from_C - now_C >= kFall_K;
        if (is_fallen) {
          falls_s.push_back(recording_.time_s[row] - from_s);
        }
        if (is_fallen || now_C > from_C) {
          from_C = now_C;
          from_s = recording_.time_s[row];
        }
      }
    }
    return falls_s.size() < 2 ? std::numeric_limits<double>::infinity() : middle_of(falls_s);
  }

  /// Reports constant temperatures. The fit ignores such a sensor.
  void constants() {
    constexpr double kMoves_K = 10.0;
    for (const Channel& constant : recording_.channels) {
      const ChannelQuality* const range = quality(constant.quantity.key);
      if (constant.quantity.kind != QuantityKind::temperature || !range->is_constant()) {
        continue;
      }
      const auto moving = std::ranges::find_if(recording_.channels, [](const Channel& each) {
        return each.quantity.kind == QuantityKind::temperature && swing(each) > kMoves_K;
      });
      if (moving != recording_.channels.end()) {
        found_.emplace_back(ConstantSensor{constant.quantity.key, range->low, moving->quantity.key, swing(*moving)});
      }
    }
  }

  /// Reports a current or input power that is constant although the winding is heated and cooled by turns. Iron loss varies at constant
  /// current, but does not make the winding hotter than the stator. One rise and one fall do not count: a motor that is disconnected has
  /// both.
  void constant_heat_inputs() {
    constexpr double kMoves_K = 10.0;
    constexpr double kMoves_share = 0.5;
    constexpr int kFewestMoves = 4;
    constexpr std::size_t kFewestSamples = 100;
    const Channel* const winding = recording_.find("winding_C");
    const Channel* const stator = recording_.find("stator_C");
    if (winding == nullptr || stator == nullptr) {
      return;
    }
    // A fan that is switched changes the difference, too, but only by a part of it.
    double largest_K = 0.0;
    for (std::size_t row = 0; row < winding->values.size(); ++row) {
      const double difference_K = winding->values[row] - stator->values[row];
      largest_K = difference_K > largest_K ? difference_K : largest_K;
    }
    const double by_K = std::max(kMoves_K, kMoves_share * largest_K);
    const int moves = rises_and_falls(*winding, *stator, by_K);
    for (const Signal signal : {Signal::current, Signal::input_power}) {
      const ChannelQuality* const range = quality(std::string(column_of(signal)));
      if (moves >= kFewestMoves && range != nullptr && range->samples >= kFewestSamples && range->is_constant()) {
        found_.emplace_back(ConstantHeatInput{range->quantity.key, range->quantity.unit, range->low, by_K, moves});
      }
    }
  }
  /// Counts the changes of at least `by_K` between turning points of the positive difference of two temperatures.
  [[nodiscard]] static int rises_and_falls(const Channel& hotter, const Channel& than, double by_K) {
    int count = 0;
    int direction = 0;
    std::vector<double> last_K;  // a median of five rows hides single outliers
    double turn_K = 0.0;
    for (std::size_t row = 0; row < hotter.values.size(); ++row) {
      if (const double difference_K = hotter.values[row] - than.values[row]; !std::isnan(difference_K)) {
        last_K.push_back(std::max(0.0, difference_K));
      }
      constexpr std::size_t kRows = 5;
      if (last_K.size() < kRows) {
        continue;
      }
      const double now_K = middle_of(last_K);
      last_K.clear();
      const int towards = now_K > turn_K ? 1 : -1;
      if (towards != direction && std::abs(now_K - turn_K) >= by_K) {
        direction = towards;
        turn_K = now_K;
        ++count;
      } else if (towards == direction) {
        turn_K = now_K;
      }
    }
    return count;
  }

  /// Reports heat inputs that often have their extreme value. For a temperature that would be saturation; for an input it is often valid.
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
          found_.emplace_back(StaysAtLimit{channel.quantity.key, channel.quantity.unit, end, samples, range->samples});
        }
      }
    }
  }

  static constexpr double kLongest_s = 2.0 * 86400.0;

  const Recording& recording_;
  const DataQuality& quality_;
  std::optional<double> ambient_C_;
  std::vector<Suspicion> found_;
};

}  // namespace

Suspicions suspicions(const Recording& recording, const DataQuality& quality, std::optional<double> ambient_C) {
  return Suspector(recording, quality, ambient_C).run();
}

}  // namespace heatsoak::recording
