#include "identify/log_columns.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "base/unknown.h"

namespace heatsoak {
namespace {

Eigen::VectorXd means_along(const Channel& channel, const std::vector<double>& row_time_s, const std::vector<double>& time_s) {
  Eigen::VectorXd means = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(time_s.size()) - 1, kUnknown);
  auto row = static_cast<std::size_t>(std::ranges::lower_bound(row_time_s, time_s.front()) - row_time_s.begin());
  for (Eigen::Index k = 0; k < means.size(); ++k) {
    double sum = 0.0;
    double count = 0.0;
    for (; row < row_time_s.size() && row_time_s[row] < time_s[static_cast<std::size_t>(k) + 1]; ++row) {
      if (!std::isnan(channel.values[row])) {
        sum += channel.values[row];
        count += 1.0;
      }
    }
    means[k] = count > 0.0 ? sum / count : kUnknown;
  }
  return means;
}

}  // namespace

std::map<std::string, Eigen::VectorXd> columns_along(const Recording& recording, const std::vector<double>& time_s) {
  static const std::set<std::string, std::less<>> kElsewhere{
      "current_A", "speed_rad_per_s", "bus_V", "power_in_W", "duty_ratio", "vehicle_speed_m_per_s", "neighbour_C", "ambient_C", "age_h"};
  std::map<std::string, Eigen::VectorXd> columns;
  for (const Channel& channel : recording.channels) {
    // The network's laws see the current's magnitude; which way it flows, only the log knows.
    const bool has_both_signs = channel.quantity.key == "current_A" &&
                                std::ranges::any_of(channel.values, [](double a) { return a < 0.0; }) &&
                                std::ranges::any_of(channel.values, [](double a) { return a > 0.0; });
    if (channel.quantity.kind != QuantityKind::temperature && (!kElsewhere.contains(channel.quantity.key) || has_both_signs)) {
      columns.emplace(channel.quantity.key, means_along(channel, recording.time_s, time_s));
    }
  }
  return columns;
}

void set_column(MeasuredRun& run, const std::string& key) {
  if (key.empty()) {
    return;
  }
  const auto found = run.columns.find(key);
  const auto set = [&](OperatingPoint<double>& at, Eigen::Index k) {
    const double value = found == run.columns.end() ? kUnknown : found->second[k];
    at.column = std::isnan(value) ? 0.0 : value;
    at.column_share = std::isnan(value) ? 0.0 : 1.0;
  };
  for (std::size_t k = 0; k < run.at.size(); ++k) {
    set(run.at[k], static_cast<Eigen::Index>(k));
  }
  for (UnknownInputs& unknown : run.unknown_inputs) {
    set(unknown.other, unknown.interval);
  }
}

void set_column(std::vector<MeasuredRun>& runs, const std::string& key) {
  std::ranges::for_each(runs, [&](MeasuredRun& run) { set_column(run, key); });
}

}  // namespace heatsoak
