#include "identify/measured_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/diagnostic.h"
#include "base/unknown.h"
#include "identify/mean_inputs.h"
#include "identify/measurement/noise.h"
#include "identify/measurement/row_order.h"
#include "identify/row_steps.h"

namespace heatsoak {
namespace {

/// A stretch with fewer samples has nothing to say about thermal time constants.
constexpr std::size_t kLeastSamples = 10;
/// Of the usual step: a longer one lacks a row.
constexpr double kLostRow_ratio = 1.5;

struct SignalChannel {
  Signal signal;
  std::string_view key;
};
constexpr std::array kSignalChannels{SignalChannel{Signal::current, "current_A"},
                                     SignalChannel{Signal::speed, "speed_rad_per_s"},
                                     SignalChannel{Signal::shaft_power, "torque_Nm"},
                                     SignalChannel{Signal::input_power, "power_in_W"},
                                     SignalChannel{Signal::modulation, "duty_ratio"},
                                     SignalChannel{Signal::bus_voltage, "bus_V"},
                                     SignalChannel{Signal::vehicle_speed, "vehicle_speed_m_per_s"},
                                     SignalChannel{Signal::neighbour_temperature, "neighbour_C"},
                                     SignalChannel{Signal::age, "age_h"}};

/// Where temperatures of a recording sit in the network; of two for one node the first that the recording has counts.
struct SensorPlace {
  std::string_view key;
  std::string_view node;
};
constexpr std::array kSensorPlaces{SensorPlace{"winding_C", "winding"}, SensorPlace{"stator_C", "stator"},
                                   SensorPlace{"housing_C", "stator"}};

bool has_values(const Channel* channel) {
  return channel && std::ranges::any_of(channel->values, [](double value) { return !std::isnan(value); });
}

bool is_stuck(const Channel& channel) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : channel.values) {
    low = std::fmin(low, value);
    high = std::fmax(high, value);
  }
  return low == high;
}

bool is_there(const Recording& recording, Signal signal, const ShaftTorque& torque) {
  const auto is_recorded = [&](Signal each) {
    return has_values(recording.find(std::ranges::find(kSignalChannels, each, &SignalChannel::signal)->key));
  };
  if (signal != Signal::shaft_power) {
    return is_recorded(signal);
  }
  return is_recorded(Signal::speed) && (is_recorded(signal) || (torque.per_current_Nm_per_A > 0.0 && is_recorded(Signal::current)));
}

bool has_negative(const std::vector<double>* values) {
  return values && std::ranges::any_of(*values, [](double value) { return value < 0.0; });
}

/// Operating points of single rows; NaN where a quantity is not known there.
class MeasuredRows {
 public:
  MeasuredRows(const Recording& recording, const MeasuredRunOptions& options)
      : current_A_(values("current_A", recording)),
        speed_rad_per_s_(values("speed_rad_per_s", recording)),
        torque_Nm_(values("torque_Nm", recording)),
        input_power_W_(values("power_in_W", recording)),
        bus_V_(values("bus_V", recording)),
        modulation_(values("duty_ratio", recording)),
        vehicle_speed_m_per_s_(values("vehicle_speed_m_per_s", recording)),
        neighbour_C_(values("neighbour_C", recording)),
        age_h_(values("age_h", recording)),
        surroundings_C_(bridged(values(has_values(recording.find("coolant_C")) ? "coolant_C" : "ambient_C", recording), recording.time_s)),
        is_signed_(has_negative(current_A_) && has_negative(speed_rad_per_s_)),
        is_driven_(current_A_ &&
                   std::ranges::any_of(*current_A_, [&](double each_A) { return std::abs(each_A) > options.least_current_A; })),
        time_s_(recording.time_s),
        options_(options) {}

  [[nodiscard]] OperatingPoint<double> at(std::size_t row) const {
    const double speed_rad_per_s = of(speed_rad_per_s_, row);
    OperatingPoint<double> at;
    at.current_rms_A = std::abs(of(current_A_, row));
    at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = std::abs(speed_rad_per_s);
    at.velocity_rad_per_s = speed_rad_per_s;
    if (speed_rad_per_s_ && row + 1 < time_s_.size()) {
      at.acceleration_rad_per_s2 = std::abs((*speed_rad_per_s_)[row + 1] - speed_rad_per_s) / (time_s_[row + 1] - time_s_[row]);
    }
    at.ambient_C = surroundings_C_.empty() ? options_.ambient_C : surroundings_C_[row];
    at.shaft_power_W = torque_Nm_ ? of(torque_Nm_, row) * speed_rad_per_s : power_of_current_W(of(current_A_, row), speed_rad_per_s);
    at.input_power_W = of(input_power_W_, row);
    at.bus_V = of(bus_V_, row);
    at.modulation_ratio = std::abs(of(modulation_, row));
    at.vehicle_speed_m_per_s = std::abs(of(vehicle_speed_m_per_s_, row));
    at.neighbour_share = neighbour_C_ && !std::isnan((*neighbour_C_)[row]) ? 1.0 : 0.0;
    at.neighbour_C = at.neighbour_share > 0.0 ? (*neighbour_C_)[row] : 25.0;
    at.unlogged_speed_share = is_driven_ && (!speed_rad_per_s_ || std::isnan(speed_rad_per_s)) ? 1.0 : 0.0;
    at.age_h = of(age_h_, row);
    return at;
  }
  [[nodiscard]] bool has_surroundings() const { return !surroundings_C_.empty(); }

 private:
  static const std::vector<double>* values(std::string_view key, const Recording& recording) {
    const Channel* const channel = recording.find(key);
    return has_values(channel) ? &channel->values : nullptr;
  }
  /// Air and coolant change slowly: between two samples less than a minute apart a straight line is what they did.
  static std::vector<double> bridged(const std::vector<double>* values, const std::vector<double>& time_s) {
    constexpr double kSlow_s = 60.0;
    std::vector<double> all = values ? *values : std::vector<double>();
    std::size_t last = all.size();
    for (std::size_t row = 0; row < all.size(); ++row) {
      if (std::isnan(all[row])) {
        continue;
      }
      for (std::size_t gap = last + 1; last < row && time_s[row] - time_s[last] < kSlow_s && gap < row; ++gap) {
        all[gap] = all[last] + (all[row] - all[last]) * (time_s[gap] - time_s[last]) / (time_s[row] - time_s[last]);
      }
      if (last == all.size() && row > 0 && time_s[row] - time_s.front() < kSlow_s) {
        std::fill(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(row), all[row]);
      }
      last = row;
    }
    if (last < all.size() && time_s.back() - time_s[last] < kSlow_s) {
      std::fill(all.begin() + static_cast<std::ptrdiff_t>(last), all.end(), all[last]);
    }
    return all;
  }
  /// 0 where there is no such channel: what the model needs is checked beforehand.
  static double of(const std::vector<double>* values, std::size_t row) { return values ? (*values)[row] : 0.0; }

  /// Only a current and a speed that both have signs tell braking from driving.
  [[nodiscard]] double power_of_current_W(double current_A, double speed_rad_per_s) const {
    const double drives_A_rad_per_s = is_signed_ ? current_A * speed_rad_per_s : std::abs(current_A * speed_rad_per_s);
    return options_.torque.per_current_Nm_per_A * drives_A_rad_per_s - options_.torque.drag_Nm * std::abs(speed_rad_per_s);
  }

  const std::vector<double>*current_A_, *speed_rad_per_s_, *torque_Nm_, *input_power_W_, *bus_V_, *modulation_, *vehicle_speed_m_per_s_,
      *neighbour_C_, *age_h_;
  std::vector<double> surroundings_C_;
  bool is_signed_;  ///< current and speed
  bool is_driven_;  ///< at any time
  const std::vector<double>& time_s_;
  const MeasuredRunOptions& options_;
};

double quantity_of(const OperatingPoint<double>& at, Signal signal) {
  switch (signal) {
    case Signal::current:
      return at.current_rms_A;
    case Signal::speed:
      return at.speed_mean_rad_per_s;
    case Signal::shaft_power:
      return at.shaft_power_W;
    case Signal::input_power:
      return at.input_power_W;
    case Signal::modulation:
      return at.modulation_ratio;
    case Signal::bus_voltage:
      return at.bus_V;
    case Signal::vehicle_speed:
      return at.vehicle_speed_m_per_s;
    case Signal::neighbour_temperature:
      return at.neighbour_C;
    case Signal::age:
      return at.age_h;
  }
  return kUnknown;
}

/// The mean of the samples within `reach_s` of the row, moved along their own slope to the row's time.
double sample_at(const std::vector<double>& time_s, const std::vector<double>& value_C, std::size_t begin, std::size_t end, std::size_t row,
                 double reach_s) {
  if (std::isnan(value_C[row])) {
    return kUnknown;
  }
  double sum_C = value_C[row];
  double count = 1.0;
  // Pairs on both sides only, so that a slope cancels.
  for (std::size_t away = 1; row >= begin + away && row + away < end; ++away) {
    if (time_s[row] - time_s[row - away] > reach_s || time_s[row + away] - time_s[row] > reach_s) {
      break;
    }
    const double pair_C = value_C[row - away] + value_C[row + away];
    if (!std::isnan(pair_C)) {
      sum_C += pair_C;
      count += 2.0;
    }
  }
  return sum_C / count;
}

class Builder {
 public:
  Builder(const Recording& recording, const MeasuredRunOptions& options)
      : recording_(recording), options_(options), rows_(recording, options) {
    signals_ = signals_of(recording, options.torque);
    for (const SensorPlace& place : kSensorPlaces) {
      const Channel* const channel = recording.find(place.key);
      const bool is_taken = std::ranges::find(sensors_, place.node, &Sensor::node) != sensors_.end();
      if (has_values(channel) && !is_taken && is_stuck(*channel)) {
        all_.notes.push_back(fmt::format("{}: {} shows the same value throughout and is taken as no sensor", recording.name, place.key));
      } else if (has_values(channel) && !is_taken) {
        sensors_.push_back({std::string(place.key), std::string(place.node)});
        sensor_values_.push_back(&channel->values);
      }
    }
  }

  MeasuredRuns build() {
    check();
    for (const auto& [begin, end] : recording_.runs()) {
      const double longest_s = kLongestStep_ratio * steps_of(begin, end).usual_s;
      for (std::size_t first = begin; first < end;) {
        std::size_t last = first;
        while (last + 1 < end && is_known(last)) {
          const std::size_t next = known_from(last + 1, end);
          last = next < end && recording_.time_s[next] - recording_.time_s[last] <= longest_s ? next : last + 1;
        }
        take(first, last);
        first = last + 1;
      }
    }
    if (all_.runs.empty()) {
      throw Failure(ExitCode::cannot_answer, why_nothing_is_left());
    }
    if (all_.runs.size() > 1) {
      all_.notes.push_back(
          fmt::format("{} is taken as {} runs: in between, heat or surroundings are not known", recording_.name, all_.runs.size()));
    }
    set_noise();
    return std::move(all_);
  }

 private:
  void check() const {
    std::vector<Diagnostic> lacking;
    for (const Signal signal : options_.needed) {
      if (std::ranges::find(signals_, signal) == signals_.end()) {
        const auto* const channel = std::ranges::find(kSignalChannels, signal, &SignalChannel::signal);
        lacking.push_back({{recording_.file.string()}, std::string(channel->key), "the model needs it, and the log has no such column"});
      }
    }
    if (!rows_.has_surroundings() && std::isnan(options_.ambient_C)) {
      lacking.push_back(
          {{recording_.file.string()}, "ambient_C", "the log has no temperature of the surroundings; state it with --ambient 25degC"});
    }
    if (sensors_.empty()) {
      lacking.push_back({{recording_.file.string()}, "winding_C", "the log has no temperature of winding, stator or housing"});
    }
    if (!lacking.empty()) {
      throw Failure(ExitCode::bad_input, fmt::format("{} cannot be used for a fit", recording_.name), std::move(lacking));
    }
  }

  [[nodiscard]] std::string why_nothing_is_left() const {
    std::vector<std::string> reasons;
    const auto runs = recording_.runs();
    if (runs.size() > 1) {
      reasons.push_back(fmt::format("gaps split its {} rows into {} runs ([runs] longest_gap of a mapping says what counts as one)",
                                    recording_.rows(), runs.size()));
    }
    const auto tell = [&](std::string_view key, auto&& is_lacking) {
      std::size_t lacking = 0;
      for (std::size_t row = 0; row < recording_.rows(); ++row) {
        lacking += is_lacking(row) ? 1 : 0;
      }
      if (lacking > 0) {
        reasons.push_back(fmt::format("{} of {} rows have no {}", lacking, recording_.rows(), key));
      }
    };
    for (const Signal signal : options_.needed) {
      tell(std::ranges::find(kSignalChannels, signal, &SignalChannel::signal)->key,
           [&](std::size_t row) { return std::isnan(quantity_of(rows_.at(row), signal)); });
    }
    tell("temperature of the surroundings within a minute", [&](std::size_t row) { return std::isnan(rows_.at(row).ambient_C); });
    tell("temperature of winding or stator", [&](std::size_t row) { return !is_sampled(row); });
    return fmt::format("{}: no stretch of {} rows or more has temperatures and all of the heat inputs: {}; see `heatsoak log inspect {}`",
                       recording_.name, kLeastSamples, fmt::join(reasons, ", "), recording_.file.string());
  }

  /// Whether what happens from this row to the next is known.
  [[nodiscard]] bool is_known(std::size_t row) const {
    const OperatingPoint<double> at = rows_.at(row);
    return !std::isnan(at.ambient_C) &&
           std::ranges::none_of(options_.needed, [&](Signal signal) { return std::isnan(quantity_of(at, signal)); });
  }

  /// The first row from this one on of which everything is known, or `end`.
  [[nodiscard]] std::size_t known_from(std::size_t row, std::size_t end) const {
    while (row < end && !is_known(row)) {
      ++row;
    }
    return row;
  }

  [[nodiscard]] RowSteps steps_of(std::size_t begin, std::size_t end) const {
    return row_steps(std::span(recording_.time_s).subspan(begin, end - begin));
  }

  [[nodiscard]] bool is_sampled(std::size_t row) const {
    return std::ranges::any_of(sensor_values_, [&](const auto* values) { return !std::isnan((*values)[row]); });
  }

  /// Rows first … last, between which everything is known.
  void take(std::size_t first, std::size_t last) {
    while (first < last && !is_sampled(first)) {
      ++first;
    }
    if (last < first + kLeastSamples - 1) {
      return;
    }
    MeasuredRun run;
    run.sensors = sensors_;
    run.signals = signals_;
    run.conditions = recording_.conditions;
    run.conditions.emplace("run", recording_.name);
    const std::vector<double>& time_s = recording_.time_s;
    const bool is_merged = (time_s[last] - time_s[first]) / static_cast<double>(last - first) < 0.5 * options_.longest_step_s;
    const RowSteps steps = steps_of(first, last + 1);
    const double hidden_A2 = hidden_square_A2(first, last);
    std::vector<std::size_t> kept{first};
    MeanInputs mean;
    std::size_t known = first;
    for (std::size_t row = first; row < last; ++row) {
      known = is_known(row) ? row : known;
      add_inputs(row, known, last, steps, hidden_A2, mean);
      const bool would_be_long = row + 1 < last && mean.duration_s() + 0.5 * (time_s[row + 2] - time_s[row + 1]) > options_.longest_step_s;
      if (!is_merged || would_be_long || row + 1 == last) {
        mean.take(run);
        kept.push_back(row + 1);
      }
    }
    for (const std::size_t row : kept) {
      run.time_s.push_back(time_s[row]);
    }
    run.measured_C.resize(static_cast<Eigen::Index>(kept.size()), static_cast<Eigen::Index>(sensors_.size()));
    const double reach_s = is_merged ? 0.1 * options_.longest_step_s : 0.0;
    for (std::size_t sensor = 0; sensor < sensors_.size(); ++sensor) {
      for (std::size_t k = 0; k < kept.size(); ++k) {
        run.measured_C(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(sensor)) =
            sample_at(time_s, *sensor_values_[sensor], first, last + 1, kept[k], reach_s);
      }
    }
    if (kept.size() >= kLeastSamples) {
      run.name = all_.runs.empty() ? recording_.name : fmt::format("{}#{}", recording_.name, all_.runs.size() + 1);
      all_.runs.push_back(std::move(run));
    }
  }

  static double square_A2(const OperatingPoint<double>& at) { return at.current_rms_A * at.current_rms_A; }

  /// How far a row's square of the current lies, rms, from the middle between its neighbours beyond half of their difference.
  [[nodiscard]] double hidden_square_A2(std::size_t first, std::size_t last) const {
    double sum_A4 = 0.0;
    double count = 0.0;
    double before_A2 = kUnknown;
    double here_A2 = square_A2(rows_.at(first));
    for (std::size_t row = first + 1; row < last; ++row) {
      const double after_A2 = square_A2(rows_.at(row));
      const double off_A2 = here_A2 - 0.5 * (before_A2 + after_A2);
      const double more_A4 = off_A2 * off_A2 - 0.25 * (after_A2 - before_A2) * (after_A2 - before_A2);
      if (!std::isnan(more_A4)) {
        sum_A4 += more_A4;
        count += 1.0;
      }
      before_A2 = std::exchange(here_A2, after_A2);
    }
    return count > 0.0 ? std::sqrt(std::max(0.0, sum_A4 / count)) : 0.0;
  }

  /// From `row` to the next, `known` being the last row that has all inputs: they are its own for a usual step, at that end of a longer
  /// one which its samples speak of; what they were in the rest nobody logged.
  void add_inputs(std::size_t row, std::size_t known, std::size_t last, const RowSteps& steps, double hidden_A2, MeanInputs& mean) const {
    const double duration_s = recording_.time_s[row + 1] - recording_.time_s[row];
    const bool lacks_rows = steps.is_regular && duration_s > kLostRow_ratio * steps.usual_s && recording_.inputs != InputHabit::linear;
    const bool speaks_of_end = row == known && recording_.inputs == InputHabit::previous_interval;
    const double known_s = row > known ? 0.0 : (lacks_rows ? steps.usual_s : duration_s);
    const std::size_t next = known_s == duration_s ? last + 1 : (speaks_of_end ? row : known_from(row + 1, last + 1));
    if (next > last) {
      mean.add(filled(known), duration_s);
      return;
    }
    const double unknown_s = duration_s - known_s;
    const OperatingPoint<double> before = filled(speaks_of_end && row > 0 && is_known(row - 1) ? row - 1 : known);
    const OperatingPoint<double> after = filled(next);
    mean.add(filled(known), known_s);
    // They change in the middle of the rest, or at its beginning or end, or more often than the rows on both sides show.
    mean.add(before, 0.5 * unknown_s);
    mean.add(after, 0.5 * unknown_s);
    mean.doubt(before, after, 0.5 * unknown_s);
    OperatingPoint<double> burst = before;
    burst.current_rms_A = std::sqrt(square_A2(before) + hidden_A2);
    mean.doubt(before, burst, unknown_s);
  }

  /// A quantity that is not needed and not known becomes 0, so that means stay numbers.
  [[nodiscard]] OperatingPoint<double> filled(std::size_t row) const {
    OperatingPoint<double> at = rows_.at(row);
    for_each_quantity([](double& value) { value = std::isnan(value) ? 0.0 : value; }, at);
    return at;
  }

  /// One level per sensor, from all runs of the recording as they were merged.
  void set_noise() {
    for (std::size_t sensor = 0; sensor < sensors_.size(); ++sensor) {
      std::vector<double> all_C;
      std::vector<std::pair<std::size_t, std::size_t>> runs;
      for (const MeasuredRun& run : all_.runs) {
        const std::size_t begin = all_C.size();
        const auto column = run.measured_C.col(static_cast<Eigen::Index>(sensor));
        all_C.insert(all_C.end(), column.begin(), column.end());
        runs.emplace_back(begin, all_C.size());
      }
      // Far below any contact resistance's doing: a sensor that claims less repeats itself.
      constexpr double kLeastNoise_K = 0.01;
      const NoiseLevel level = noise_level(all_C, runs);
      for (MeasuredRun& run : all_.runs) {
        run.sensors[sensor].noise_K = std::max(kLeastNoise_K, level.noise);
        run.sensors[sensor].step_K = level.step;
      }
    }
  }

  const Recording& recording_;
  const MeasuredRunOptions& options_;
  MeasuredRows rows_;
  std::vector<Signal> signals_;
  std::vector<Sensor> sensors_;
  std::vector<const std::vector<double>*> sensor_values_;
  MeasuredRuns all_;
};

}  // namespace

bool MeasuredRun::has(Signal signal) const { return std::ranges::find(signals, signal) != signals.end(); }

Eigen::Index MeasuredRun::sensor_at(std::string_view node) const {
  const auto found = std::ranges::find(sensors, node, &Sensor::node);
  return found == sensors.end() ? -1 : found - sensors.begin();
}

std::vector<Signal> signals_of(const Recording& recording, const ShaftTorque& torque) {
  std::vector<Signal> signals;
  for (const SignalChannel& each : kSignalChannels) {
    if (is_there(recording, each.signal, torque)) {
      signals.push_back(each.signal);
    }
  }
  return signals;
}

MeasuredRuns measured_runs(const Recording& recording, const MeasuredRunOptions& options) { return Builder(recording, options).build(); }

MeasuredRun thinned(const MeasuredRun& run, int merged) {
  MeasuredRun thin;
  thin.name = run.name;
  thin.sensors = run.sensors;
  thin.signals = run.signals;
  thin.conditions = run.conditions;
  std::vector<Eigen::Index> kept{0};
  MeanInputs mean;
  auto unknown = run.unknown_inputs.begin();
  for (std::size_t k = 0; k + 1 < run.time_s.size(); ++k) {
    const double duration_s = run.time_s[k + 1] - run.time_s[k];
    mean.add(run.at[k], duration_s);
    if (unknown != run.unknown_inputs.end() && unknown->interval == static_cast<Eigen::Index>(k)) {
      mean.doubt(run.at[k], (unknown++)->other, duration_s);
    }
    if ((k + 1) % static_cast<std::size_t>(merged) == 0 || k + 2 == run.time_s.size()) {
      mean.take(thin);
      kept.push_back(static_cast<Eigen::Index>(k) + 1);
    }
  }
  thin.measured_C.resize(static_cast<Eigen::Index>(kept.size()), run.measured_C.cols());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    thin.time_s.push_back(run.time_s[static_cast<std::size_t>(kept[k])]);
    thin.measured_C.row(static_cast<Eigen::Index>(k)) = run.measured_C.row(kept[k]);
  }
  return thin;
}

}  // namespace heatsoak
