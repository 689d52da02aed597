#include "estimation/measured_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/diagnostic.h"
#include "base/unknown.h"
#include "estimation/log_columns.h"
#include "estimation/log_rows.h"
#include "estimation/row_steps.h"
#include "estimation/segment_inputs.h"
#include "estimation/thresholds.h"
#include "recording/noise.h"
#include "recording/quantities.h"
#include "recording/row_order.h"

namespace heatsoak::estimation {
namespace {

std::size_t least_samples() { return static_cast<std::size_t>(thresholds().least_rows_count); }
/// The margin is for rounding errors of the time stamps.
double longest_pause_s() { return thresholds().longest_pause_s * (1.0 + 1e-6); }

/// Assigns temperatures of a recording to nodes. If a recording has two for one node, the first is used.
struct SensorPlace {
  std::string_view key;
  std::string_view node;
};
constexpr std::array kSensorPlaces{SensorPlace{"winding_C", "winding"}, SensorPlace{"stator_C", "stator"},
                                   SensorPlace{"housing_C", "stator"}};

bool is_stuck(const recording::Channel& channel) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : channel.values) {
    low = std::fmin(low, value);
    high = std::fmax(high, value);
  }
  return low == high;
}

/// Mean of the samples within ±`reach_s` around a row. NaN if the row itself has no sample.
double sample_at(const std::vector<double>& time_s, const std::vector<double>& value_C, std::size_t begin, std::size_t end, std::size_t row,
                 double reach_s) {
  if (std::isnan(value_C[row])) {
    return base::kUnknown;
  }
  double sum_C = value_C[row];
  double count = 1.0;
  // Only symmetric pairs, so that a constant slope cancels.
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
  Builder(const recording::Recording& recording, const MeasuredRunOptions& options)
      : recording_(recording), options_(options), rows_(recording, options) {
    signals_ = signals_of(recording, options);
    for (const SensorPlace& place : kSensorPlaces) {
      const recording::Channel* const channel = recording.find(place.key);
      const bool is_taken = std::ranges::find(sensors_, place.node, &Sensor::node) != sensors_.end();
      if (has_values(channel) && !is_taken && is_stuck(*channel)) {
        all_.notes.emplace_back(SensorNeverChanges{recording.name, std::string(place.key)});
      } else if (has_values(channel) && !is_taken) {
        Sensor& sensor = sensors_.emplace_back(Sensor{std::string(place.key), std::string(place.node)});
        std::ranges::copy_if(options.faults, std::back_inserter(sensor.faults),
                             [&](const motor::SensorFault& fault) { return fault.type->signal == place.key; });
        sensor_values_.push_back(&channel->values);
      }
    }
  }

  [[nodiscard]] std::vector<base::Diagnostic> lacking() const {
    std::vector<base::Diagnostic> lacking;
    for (const thermal::Signal signal : options_.needed) {
      if (std::ranges::find(signals_, signal) == signals_.end()) {
        lacking.push_back(
            {{recording_.file.string()}, std::string(column_of(signal)), "the model needs it, and the log has no such column"});
      }
    }
    if (!rows_.has_surroundings() && !options_.ambient_C) {
      lacking.push_back({{recording_.file.string()},
                         std::string(recording::kAmbientColumn),
                         "the log has no ambient temperature; state it with --ambient 25degC, in a check file with air = \"25 degC\""});
    }
    if (sensors_.empty()) {
      lacking.push_back({{recording_.file.string()}, "winding_C", "the log has no temperature of winding, stator or housing"});
    }
    return lacking;
  }

  MeasuredRuns build() {
    check();
    for (const auto& [begin, end] : segments()) {
      const double longest_s = std::max(recording::kLongestStep_ratio * steps_of(begin, end).usual_s, longest_pause_s());
      for (std::size_t first = begin; first < end;) {
        std::size_t last = first;
        while (last + 1 < end && rows_.is_known(last)) {
          const std::size_t next = known_from(last + 1, end);
          last = next < end && recording_.time_s[next] - recording_.time_s[last] <= longest_s ? next : last + 1;
        }
        take(first, last);
        first = last + 1;
      }
    }
    if (all_.runs.empty()) {
      throw NoUsableInterval(recording_.name, recording_.file, least_samples(), reasons_of_loss());
    }
    const std::size_t unused = recording_.rows() - used_rows_;
    if (static_cast<double>(unused) > thresholds().most_unused_share * static_cast<double>(recording_.rows())) {
      all_.notes.emplace_back(RowsUnused{recording_.name, unused, recording_.rows(), reasons_of_loss()});
    }
    if (all_.runs.size() > 1) {
      all_.notes.emplace_back(SplitIntoRuns{recording_.name, all_.runs.size()});
    }
    note_long_blanks();
    set_noise();
    return std::move(all_);
  }

 private:
  /// A blank of another needed signal splits the run; see is_known().
  void note_long_blanks() {
    const auto note = [&](std::string_view column, bool is_held) {
      if (const double blank_s = long_blanks_s(recording_, column); blank_s > 0.0) {
        all_.notes.emplace_back(ColumnBlank{recording_.name, std::string(column), blank_s, is_held});
      }
    };
    for (const std::string& column : options_.columns) {
      note(column, true);
    }
    for (const thermal::Signal signal : options_.needed) {
      if (thermal::quantity_of(signal).is_optional) {
        note(column_of(signal), false);
      }
    }
  }

  /// Row ranges of the recording's runs, joined across short pauses. A pause is short compared with a motor's time constants, whereas each
  /// separate run would have its own unknown start temperatures and heat.
  [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> segments() const {
    const double usual_s = recording::usual_period_s(recording_.time_s);
    std::vector<std::pair<std::size_t, std::size_t>> all;
    for (const auto& run : recording_.runs()) {
      if (!all.empty() && is_pause(all.back().second - 1, run.first, usual_s)) {
        all.back().second = run.second;
      } else {
        all.push_back(run);
      }
    }
    return all;
  }

  [[nodiscard]] bool is_pause(std::size_t last, std::size_t first, double usual_s) const {
    const double step_s = recording_.time_s[first] - recording_.time_s[last];
    return step_s > recording::kLongestStep_ratio * usual_s && step_s <= longest_pause_s() &&
           std::ranges::none_of(sensor_values_,
                                [&](const auto* values) { return std::abs((*values)[first] - (*values)[last]) > thresholds().jump_K; });
  }

  void check() const {
    if (std::vector<base::Diagnostic> all = lacking(); !all.empty()) {
      throw base::Failure(base::ExitCode::bad_input, fmt::format("{} cannot be compared with the model", recording_.name), std::move(all));
    }
  }

  [[nodiscard]] std::vector<LossOfRows> reasons_of_loss() const {
    std::vector<LossOfRows> reasons;
    const auto runs = recording_.runs();
    if (runs.size() > 1) {
      reasons.emplace_back(GapsSplitRows{recording_.rows(), runs.size()});
    }
    const auto add = [&](RowsLack::What what, std::optional<thermal::Signal> signal, auto&& is_lacking) {
      std::size_t lacking = 0;
      for (std::size_t row = 0; row < recording_.rows(); ++row) {
        lacking += is_lacking(row) ? 1 : 0;
      }
      if (lacking > 0) {
        reasons.emplace_back(RowsLack{what, signal, lacking, recording_.rows()});
      }
    };
    for (const thermal::Signal signal : options_.needed) {
      add(RowsLack::What::signal, signal, [&](std::size_t row) { return std::isnan(quantity_of(rows_.at(row), signal)); });
    }
    add(RowsLack::What::surroundings, {}, [&](std::size_t row) { return std::isnan(rows_.at(row).ambient_C); });
    add(RowsLack::What::temperature, {}, [&](std::size_t row) { return !is_sampled(row); });
    if (reasons.empty()) {
      const double whole_s = recording_.time_s.back() - recording_.time_s.front();
      reasons.push_back(all_.runs.empty() ? LossOfRows(TooFewIntervals{whole_s, least_samples() - 1, options_.longest_step_s})
                                          : LossOfRows(UsablePartsTooShort{}));
    }
    return reasons;
  }

  /// First row at or after `row` with all inputs known, or `end`.
  [[nodiscard]] std::size_t known_from(std::size_t row, std::size_t end) const {
    while (row < end && !rows_.is_known(row)) {
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

  /// Appends rows first … last as one run; skips it if fewer than least_samples() remain.
  void take(std::size_t first, std::size_t last) {
    while (first < last && (!is_sampled(first) || !rows_.is_known(first))) {
      ++first;
    }
    if (last < first + least_samples() - 1) {
      return;
    }
    MeasuredRun run;
    run.sensors = sensors_;
    run.signals = signals_;
    run.is_current_measured = rows_.has_measured_current();
    run.conditions = recording_.conditions;
    run.conditions.emplace("run", recording_.name);
    const std::vector<double>& time_s = recording_.time_s;
    const bool is_merged = (time_s[last] - time_s[first]) / static_cast<double>(last - first) < 0.5 * options_.longest_step_s;
    SegmentInputs inputs(recording_, rows_, first, last);
    std::vector<std::size_t> kept{first};
    MeanInputs mean;
    const SegmentInputs::Ends ends = [&](std::size_t end) {
      const bool would_be_long = end < last && mean.duration_s() + 0.5 * (time_s[end + 1] - time_s[end]) > options_.longest_step_s;
      if (!is_merged || would_be_long || end == last) {
        mean.take(run);
        kept.push_back(end);
      }
    };
    for (std::size_t row = first; row < last;) {
      // Consecutive rows with unknown inputs are one gap.
      const std::size_t next = known_from(row + 1, last);
      inputs.add(row, next, mean, ends);
      row = next;
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
    if (kept.size() >= least_samples()) {
      run.name = all_.runs.empty() ? recording_.name : fmt::format("{}#{}", recording_.name, all_.runs.size() + 1);
      run.columns = columns_along(recording_, run.time_s);
      set_columns(run, options_.columns);
      all_.runs.push_back(std::move(run));
      used_rows_ += last - first + 1;
    }
  }

  /// Sets one noise level per sensor, estimated from the merged samples of all runs.
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
      // No real sensor is better than this; a lower estimate means that the sensor repeats values.
      constexpr double kLeastNoise_K = 0.01;
      const recording::NoiseLevel level = recording::noise_level(all_C, runs);
      for (MeasuredRun& run : all_.runs) {
        run.sensors[sensor].noise_K = std::max(kLeastNoise_K, level.noise);
        run.sensors[sensor].step_K = level.step;
      }
    }
  }

  const recording::Recording& recording_;
  const MeasuredRunOptions& options_;
  LogRows rows_;
  std::vector<thermal::Signal> signals_;
  std::vector<Sensor> sensors_;
  std::vector<const std::vector<double>*> sensor_values_;
  MeasuredRuns all_;
  std::size_t used_rows_ = 0;
};

}  // namespace

MeasuredRun::MeasuredRun() = default;
MeasuredRun::MeasuredRun(const MeasuredRun&) = default;
MeasuredRun::MeasuredRun(MeasuredRun&&) noexcept = default;
MeasuredRun& MeasuredRun::operator=(const MeasuredRun&) = default;
MeasuredRun& MeasuredRun::operator=(MeasuredRun&&) noexcept = default;
MeasuredRun::~MeasuredRun() = default;

bool MeasuredRun::has(thermal::Signal signal) const { return std::ranges::find(signals, signal) != signals.end(); }

bool MeasuredRun::has(const std::map<std::string, std::string>& of_conditions) const {
  return std::ranges::all_of(of_conditions, [&](const auto& each) {
    const auto found = conditions.find(each.first);
    return found != conditions.end() && found->second == each.second;
  });
}

std::optional<Eigen::Index> MeasuredRun::sensor_at(std::string_view node) const {
  const auto found = std::ranges::find(sensors, node, &Sensor::node);
  return found == sensors.end() ? std::nullopt : std::optional<Eigen::Index>(found - sensors.begin());
}

std::vector<base::Diagnostic> lacking_columns(const recording::Recording& recording, const MeasuredRunOptions& options) {
  return Builder(recording, options).lacking();
}

MeasuredRuns measured_runs(const recording::Recording& recording, const MeasuredRunOptions& options) {
  return Builder(recording, options).build();
}

std::string recording_of(const MeasuredRun& run) {
  const auto found = run.conditions.find("run");
  return found == run.conditions.end() ? run.name : found->second;
}

}  // namespace heatsoak::estimation
