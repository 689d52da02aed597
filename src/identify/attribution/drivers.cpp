#include "identify/attribution/drivers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace heatsoak {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
/// Two drivers whose values go together more than this are one; the earlier name stays.
constexpr double kSameCorrelation_ratio = 0.9995;

class Collector {
 public:
  Collector(const Model& model, const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs)
      : model_(model), fitted_(fitted), runs_(runs) {}

  template <class Value>
  void add(std::string name, std::string unit, DriverKind kind, const Value& value) {
    Driver driver{std::move(name), std::move(unit), kind, {}, 0.0, 0.0, {}};
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      Eigen::VectorXd& values = driver.values.emplace_back(runs_[r].samples() - 1);
      for (Eigen::Index k = 0; k < values.size(); ++k) {
        values[k] = value(r, k);
      }
    }
    keep(std::move(driver));
  }

  template <class Value>
  void add_where(Signal signal, std::string name, std::string unit, const Value& value) {
    if (std::ranges::all_of(runs_, [&](const MeasuredRun& run) { return run.has(signal); })) {
      add(std::move(name), std::move(unit), DriverKind::operating_point,
          [&](std::size_t r, Eigen::Index k) { return value(runs_[r].at[static_cast<std::size_t>(k)]); });
    }
  }

  std::vector<Driver> take() { return std::move(kept_); }

 private:
  void keep(Driver driver) {
    std::vector<double> known;
    for (const Eigen::VectorXd& values : driver.values) {
      std::ranges::copy_if(values, std::back_inserter(known), [](double value) { return !std::isnan(value); });
    }
    if (known.size() < 100) {
      return;
    }
    std::ranges::sort(known);
    driver.low = known[known.size() / 100];
    driver.high = known[known.size() - 1 - known.size() / 100];
    const double size = std::max(std::abs(driver.low), std::abs(driver.high));
    if (!(driver.high - driver.low > 1e-6 * size) || is_copy(driver)) {
      return;
    }
    kept_.push_back(std::move(driver));
  }

  [[nodiscard]] bool is_copy(const Driver& driver) const {
    return std::ranges::any_of(kept_, [&](const Driver& other) { return std::abs(correlation(driver, other)) > kSameCorrelation_ratio; });
  }

  static double correlation(const Driver& a, const Driver& b) {
    double count = 0.0, sum_a = 0.0, sum_b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    for (std::size_t r = 0; r < a.values.size(); ++r) {
      for (Eigen::Index k = 0; k < a.values[r].size(); ++k) {
        const double x = a.values[r][k], y = b.values[r][k];
        if (!std::isnan(x) && !std::isnan(y)) {
          count += 1.0, sum_a += x, sum_b += y, aa += x * x, bb += y * y, ab += x * y;
        }
      }
    }
    const double spread = (aa - sum_a * sum_a / count) * (bb - sum_b * sum_b / count);
    return count > 0.0 && spread > 0.0 ? (ab - sum_a * sum_b / count) / std::sqrt(spread) : 0.0;
  }

  const Model& model_;
  const std::vector<LinearisedRun>& fitted_;
  const std::vector<MeasuredRun>& runs_;
  std::vector<Driver> kept_;
};

void add_operating_points(Collector& all) {
  using Point = OperatingPoint<double>;
  all.add_where(Signal::speed, "speed", "rad/s", [](const Point& at) { return at.speed_mean_rad_per_s; });
  all.add_where(Signal::current, "current", "A", [](const Point& at) { return at.current_rms_A; });
  all.add_where(Signal::modulation, "modulation", "", [](const Point& at) { return at.modulation_ratio; });
  all.add_where(Signal::bus_voltage, "bus_voltage", "V", [](const Point& at) { return at.bus_V; });
  all.add_where(Signal::vehicle_speed, "vehicle_speed", "m/s", [](const Point& at) { return at.vehicle_speed_m_per_s; });
  all.add_where(Signal::shaft_power, "shaft_power", "W", [](const Point& at) { return at.shaft_power_W; });
  all.add_where(Signal::input_power, "input_power", "W", [](const Point& at) { return at.input_power_W; });
  all.add_where(Signal::neighbour_temperature, "neighbour_temperature", "degC", [](const Point& at) { return at.neighbour_C; });
}

void add_temperatures(Collector& all, const Model& model, const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs) {
  for (int node = 0; node < model.network.state_count(); ++node) {
    const std::string name(model.network.node_name(node));
    all.add(name + "_temperature", "degC", DriverKind::node_temperature,
            [&](std::size_t r, Eigen::Index k) { return fitted[r].state_C(node, k); });
    all.add(name + "_excess", "K", DriverKind::node_temperature, [&](std::size_t r, Eigen::Index k) {
      return fitted[r].state_C(node, k) - runs[r].at[static_cast<std::size_t>(k)].ambient_C;
    });
  }
  if (model.network.state_count() > 1) {
    all.add("winding_above_stator", "K", DriverKind::node_temperature,
            [&](std::size_t r, Eigen::Index k) { return fitted[r].state_C(0, k) - fitted[r].state_C(1, k); });
  }
  all.add("ambient_temperature", "degC", DriverKind::operating_point,
          [&](std::size_t r, Eigen::Index k) { return runs[r].at[static_cast<std::size_t>(k)].ambient_C; });
}

/// Of what is left of a name once "#2", which a split run carries, is gone.
std::string recording_of(const std::string& run) { return run.substr(0, run.find('#')); }

}  // namespace

FreeSignals free_signals(const Recording& recording, const MeasuredRun& run) {
  static const std::set<std::string, std::less<>> kElsewhere{"current_A",   "bus_V",    "power_in_W", "duty_ratio", "vehicle_speed_m_per_s",
                                                             "neighbour_C", "ambient_C"};
  FreeSignals signals;
  for (const Channel& channel : recording.channels) {
    if (channel.quantity.kind == QuantityKind::temperature || kElsewhere.contains(channel.quantity.key)) {
      continue;
    }
    Eigen::VectorXd& values = signals[channel.quantity.key];
    values.setConstant(run.samples() - 1, kUnknown);
    auto row = static_cast<std::size_t>(std::ranges::lower_bound(recording.time_s, run.time_s.front()) - recording.time_s.begin());
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      double sum = 0.0;
      double count = 0.0;
      for (; row < recording.rows() && recording.time_s[row] < run.time_s[static_cast<std::size_t>(k) + 1]; ++row) {
        if (!std::isnan(channel.values[row])) {
          sum += channel.values[row];
          count += 1.0;
        }
      }
      values[k] = count > 0.0 ? sum / count : kUnknown;
    }
  }
  return signals;
}

std::vector<Driver> drivers_of(const Model& model, const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs,
                               const std::vector<FreeSignals>& free) {
  Collector all(model, fitted, runs);
  add_operating_points(all);
  add_temperatures(all, model, fitted, runs);
  all.add("time", "s", DriverKind::log_only, [&](std::size_t r, Eigen::Index k) {
    return runs[r].time_s[static_cast<std::size_t>(k)] - runs[r].time_s.front();
  });
  std::set<std::string> names;
  for (const FreeSignals& of_run : free) {
    for (const auto& [name, values] : of_run) {
      names.insert(name);
    }
  }
  for (const std::string& name : names) {
    const std::optional<Quantity> quantity = quantity_named(name);
    all.add(name, quantity ? quantity->unit : "", DriverKind::log_only, [&](std::size_t r, Eigen::Index k) {
      const auto found = free[r].find(name);
      return found == free[r].end() ? kUnknown : found->second[k];
    });
  }
  std::vector<Driver> drivers = all.take();
  std::set<std::string> recordings;
  for (const MeasuredRun& run : runs) {
    recordings.insert(recording_of(run.name));
  }
  for (const std::string& recording : recordings) {
    if (recordings.size() < 2) {
      break;
    }
    Driver driver{recording, "", DriverKind::run, {}, 0.0, 1.0, {{"run", recording}}};
    for (const MeasuredRun& run : runs) {
      driver.values.push_back(Eigen::VectorXd::Constant(run.samples() - 1, recording_of(run.name) == recording ? 1.0 : 0.0));
    }
    drivers.push_back(std::move(driver));
  }
  return drivers;
}

}  // namespace heatsoak
