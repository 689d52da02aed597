#include "estimation/log_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/unknown.h"
#include "estimation/thresholds.h"

namespace heatsoak::estimation {
namespace {

using recording::kAmbientColumn;

bool is_there(const recording::Recording& recording, thermal::Signal signal, const ShaftTorque& torque, bool ignores_current) {
  const auto is_recorded = [&](thermal::Signal each) {
    return has_values(recording.find(column_of(each))) && !(ignores_current && each == thermal::Signal::current);
  };
  if (signal == thermal::Signal::modulation && torque.resistance_ohm > 0.0 && torque.per_current_Nm_per_A > 0.0) {
    const bool is_identifiable =
        is_recorded(thermal::Signal::current) && is_recorded(thermal::Signal::speed) && is_recorded(thermal::Signal::bus_voltage);
    return is_identifiable || is_recorded(signal);
  }
  if (signal == thermal::Signal::current && torque.per_current_Nm_per_A > 0.0 && is_recorded(thermal::Signal::shaft_power)) {
    return true;
  }
  if (signal != thermal::Signal::shaft_power) {
    return is_recorded(signal);
  }
  return is_recorded(thermal::Signal::speed) &&
         (is_recorded(signal) || (torque.per_current_Nm_per_A > 0.0 && is_recorded(thermal::Signal::current)));
}

bool has_negative(const std::vector<double>* values) {
  return values && std::ranges::any_of(*values, [](double value) { return value < 0.0; });
}

const std::vector<double>* values(std::string_view key, const recording::Recording& recording) {
  const recording::Channel* const channel = recording.find(key);
  return has_values(channel) ? &channel->values : nullptr;
}
/// Fills gaps shorter than `slow_s` by linear interpolation, at the ends by the nearest value. Used for temperatures of the surroundings
/// and for signals other than heat inputs: they change slowly or are logged less often.
std::vector<double> bridged(const std::vector<double>* values, const std::vector<double>& time_s, double slow_s = thresholds().slow_s) {
  std::vector<double> all = values ? *values : std::vector<double>();
  std::size_t last = all.size();
  for (std::size_t row = 0; row < all.size(); ++row) {
    if (std::isnan(all[row])) {
      continue;
    }
    for (std::size_t gap = last + 1; last < row && time_s[row] - time_s[last] < slow_s && gap < row; ++gap) {
      all[gap] = all[last] + (all[row] - all[last]) * (time_s[gap] - time_s[last]) / (time_s[row] - time_s[last]);
    }
    if (last == all.size() && row > 0 && time_s[row] - time_s.front() < slow_s) {
      std::fill(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(row), all[row]);
    }
    last = row;
  }
  if (last < all.size() && time_s.back() - time_s[last] < slow_s) {
    std::fill(all.begin() + static_cast<std::ptrdiff_t>(last), all.end(), all[last]);
  }
  return all;
}
/// Returns the value of a row, or 0 if there is no such channel. The signals that a model needs are checked beforehand.
double of(const std::vector<double>* values, std::size_t row) { return values ? (*values)[row] : 0.0; }

}  // namespace

std::string_view words_of(thermal::Signal signal) { return thermal::quantity_of(signal).lacking; }

std::vector<std::string_view> lacking(const thermal::EffectType& type, const std::vector<MeasuredRun>& runs) {
  std::vector<std::string_view> names;
  if (type.candidacy.is_in_current && std::ranges::any_of(runs, &MeasuredRun::is_current_measured)) {
    names.emplace_back("torque in place of the measured current");
  }
  for (const thermal::Signal signal : type.needs) {
    if (std::ranges::any_of(runs, [&](const MeasuredRun& run) { return !run.has(signal); })) {
      names.push_back(words_of(signal));
    }
  }
  return names;
}

bool has_values(const recording::Channel* channel) {
  return channel && std::ranges::any_of(channel->values, [](double value) { return !std::isnan(value); });
}

LogRows::LogRows(const recording::Recording& recording, const MeasuredRunOptions& options)
    : current_A_(options.ignores_current ? nullptr : values(column_of(thermal::Signal::current), recording)),
      speed_rad_per_s_(values(column_of(thermal::Signal::speed), recording)),
      torque_Nm_(values(column_of(thermal::Signal::shaft_power), recording)),
      bus_V_(values(column_of(thermal::Signal::bus_voltage), recording)),
      modulation_(values(column_of(thermal::Signal::modulation), recording)),
      surroundings_C_(bridged(values(has_values(recording.find("coolant_C")) ? "coolant_C" : kAmbientColumn, recording), recording.time_s)),
      is_signed_(has_negative(current_A_) && has_negative(speed_rad_per_s_)),
      is_driven_(current_A_ && std::ranges::any_of(*current_A_, [&](double each_A) { return std::abs(each_A) > options.least_current_A; })),
      time_s_(recording.time_s),
      options_(options) {
  for (std::size_t i = 0; i < thermal::kQuantityCount; ++i) {
    const thermal::OperatingQuantity<double>& each = thermal::kQuantities<double>[i];
    columns_[i] = each.from == thermal::FromColumn::computed ? nullptr : values(each.column, recording);
    const std::optional<recording::Quantity> known = recording::quantity_named(each.column);
    if (columns_[i] != nullptr && (!known || known->kind != recording::QuantityKind::heat_input)) {
      // The age grows by the time of the log, whatever part of it was logged.
      const double slow_s = each.signal == thermal::Signal::age ? std::numeric_limits<double>::infinity() : thresholds().slow_s;
      bridged_[i] = bridged(columns_[i], recording.time_s, slow_s);
      columns_[i] = &bridged_[i];
    }
  }
}

thermal::OperatingPoint<double> LogRows::at(std::size_t row) const {
  const double speed_rad_per_s = of(speed_rad_per_s_, row);
  thermal::OperatingPoint<double> at;
  for (std::size_t i = 0; i < thermal::kQuantityCount; ++i) {
    const thermal::OperatingQuantity<double>& each = thermal::kQuantities<double>[i];
    const double value = of(columns_[i], row);
    // An optional quantity without a value in this row stays unknown.
    if (columns_[i] != nullptr && !(each.is_optional && std::isnan(value))) {
      thermal::set_quantity(at, i, each.from == thermal::FromColumn::magnitude ? std::abs(value) : value);
    }
  }
  const bool has_torque_only = !current_A_ && torque_Nm_ && options_.torque.per_current_Nm_per_A > 0.0;
  at.current_rms_A = std::abs(has_torque_only ? current_of_torque_A(of(torque_Nm_, row), speed_rad_per_s) : of(current_A_, row));
  at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = std::abs(speed_rad_per_s);
  at.velocity_rad_per_s = speed_rad_per_s;
  if (speed_rad_per_s_ && row + 1 < time_s_.size()) {
    at.acceleration_rad_per_s2 = std::abs((*speed_rad_per_s_)[row + 1] - speed_rad_per_s) / (time_s_[row + 1] - time_s_[row]);
  }
  at.ambient_C = surroundings_C_.empty() ? options_.ambient_C.value_or(base::kUnknown) : surroundings_C_[row];
  at.shaft_power_W = torque_Nm_ ? of(torque_Nm_, row) * speed_rad_per_s : power_of_current_W(of(current_A_, row), speed_rad_per_s);
  at.modulation_ratio =
      modulation_ ? std::abs(of(modulation_, row)) : modulation_of_current(of(current_A_, row), speed_rad_per_s, at.bus_V);
  at.unlogged_speed_share = is_driven_ && (!speed_rad_per_s_ || std::isnan(speed_rad_per_s)) ? 1.0 : 0.0;
  return at;
}

double LogRows::current_of_torque_A(double torque_Nm, double speed_rad_per_s) const {
  const double drag_Nm = speed_rad_per_s == 0.0 ? 0.0 : std::copysign(options_.torque.drag_Nm, speed_rad_per_s);
  return (torque_Nm + drag_Nm) / options_.torque.per_current_Nm_per_A;
}

bool LogRows::is_known(std::size_t row) const {
  const thermal::OperatingPoint<double> point = at(row);
  return !std::isnan(point.ambient_C) &&
         std::ranges::none_of(options_.needed, [&](thermal::Signal signal) { return std::isnan(quantity_of(point, signal)); });
}

double LogRows::power_of_current_W(double current_A, double speed_rad_per_s) const {
  const double drives_A_rad_per_s = is_signed_ ? current_A * speed_rad_per_s : std::abs(current_A * speed_rad_per_s);
  return options_.torque.per_current_Nm_per_A * drives_A_rad_per_s - options_.torque.drag_Nm * std::abs(speed_rad_per_s);
}

double LogRows::modulation_of_current(double current_A, double speed_rad_per_s, double bus_V) const {
  const ShaftTorque& motor = options_.torque;
  if (!(motor.resistance_ohm > 0.0) || !current_A_ || !speed_rad_per_s_ || !bus_V_) {
    return 0.0;
  }
  const double back_V = motor.per_current_Nm_per_A * speed_rad_per_s;
  const double across_V = motor.resistance_ohm * current_A;
  const double terminal_V = is_signed_ ? std::abs(back_V + across_V) : std::abs(back_V) + std::abs(across_V);
  return bus_V > 0.0 ? std::min(1.0, terminal_V / bus_V) : std::isnan(bus_V) ? bus_V : 0.0;
}

double quantity_of(const thermal::OperatingPoint<double>& at, thermal::Signal signal) { return at.*thermal::quantity_of(signal).value; }

bool has_signal(const recording::Recording& recording, thermal::Signal signal, const ShaftTorque& torque) {
  return is_there(recording, signal, torque, false);
}

std::vector<thermal::Signal> signals_of(const recording::Recording& recording, const ShaftTorque& torque) {
  return signals_of(recording, MeasuredRunOptions{.torque = torque});
}

std::vector<thermal::Signal> signals_of(const recording::Recording& recording, const MeasuredRunOptions& options) {
  std::vector<thermal::Signal> signals;
  for (std::size_t i = 0; i < thermal::kSignalCount; ++i) {
    if (const auto signal = static_cast<thermal::Signal>(i); is_there(recording, signal, options.torque, options.ignores_current)) {
      signals.push_back(signal);
    }
  }
  return signals;
}

}  // namespace heatsoak::estimation
