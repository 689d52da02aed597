#include "attribution/regressors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/unknown.h"
#include "estimation/thresholds.h"

namespace heatsoak::attribution {
namespace {

Regressor regressor_of(std::string name, std::string unit, RegressorKind kind) {
  Regressor regressor;
  regressor.name = std::move(name);
  regressor.unit = std::move(unit);
  regressor.kind = kind;
  return regressor;
}

/// A temperature that a curve can depend on. `choice`, `watched` and `reference` as in Regressor.
Regressor temperature_of(std::string name, std::string unit, std::string choice, std::string_view watched, std::string_view reference) {
  Regressor regressor = regressor_of(std::move(name), std::move(unit), RegressorKind::node_temperature);
  regressor.choice = std::move(choice);
  regressor.watched = watched;
  regressor.reference = reference;
  return regressor;
}

class Collector {
 public:
  explicit Collector(const std::vector<estimation::MeasuredRun>& runs) : runs_(runs) {}

  template <class Value>
  void add(Regressor regressor, const Value& value) {
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      Eigen::VectorXd& values = regressor.values.emplace_back(runs_[r].samples() - 1);
      for (Eigen::Index k = 0; k < values.size(); ++k) {
        values[k] = value(r, k);
      }
    }
    keep(std::move(regressor));
  }

  template <class Value>
  void add_where(std::initializer_list<thermal::Signal> signals, std::string name, std::string unit, const Value& value) {
    for (const thermal::Signal signal : signals) {
      if (!std::ranges::all_of(runs_, [&](const estimation::MeasuredRun& run) { return run.has(signal); })) {
        return;
      }
    }
    Regressor regressor = regressor_of(name, std::move(unit), RegressorKind::operating_point);
    regressor.choice = std::move(name);
    add(std::move(regressor), [&](std::size_t r, Eigen::Index k) { return value(runs_[r].at[static_cast<std::size_t>(k)]); });
  }

  std::vector<Regressor> take() { return std::move(kept_); }

 private:
  void keep(Regressor regressor) {
    std::vector<double> known;
    for (const Eigen::VectorXd& values : regressor.values) {
      std::ranges::copy_if(values, std::back_inserter(known), [](double value) { return !std::isnan(value); });
    }
    if (known.empty()) {
      return;
    }
    std::ranges::sort(known);
    regressor.low = known[known.size() / 100];
    regressor.high = known[known.size() - 1 - known.size() / 100];
    const double size = std::max(std::abs(regressor.low), std::abs(regressor.high));
    constexpr double kPoint_share = 1e-6;
    if (!(regressor.high - regressor.low > kPoint_share * size) || is_copy(regressor)) {
      return;
    }
    double width = regressor.high - regressor.low;
    for (const std::size_t part : {10, 4}) {
      const double low = known[known.size() / part];
      const double high = known[known.size() - 1 - known.size() / part];
      if (high - low < width && high - low > kPoint_share * (regressor.high - regressor.low)) {
        regressor.inner.push_back({low, high});
        width = high - low;
      }
    }
    kept_.push_back(std::move(regressor));
  }

  [[nodiscard]] bool is_copy(const Regressor& regressor) const {
    return std::ranges::any_of(kept_, [&](const Regressor& other) {
      return std::abs(correlation(regressor, other)) > estimation::thresholds().same_signal_ratio;
    });
  }

  static double correlation(const Regressor& a, const Regressor& b) {
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

  const std::vector<estimation::MeasuredRun>& runs_;
  std::vector<Regressor> kept_;
};

void add_operating_points(Collector& all) {
  using Point = thermal::OperatingPoint<double>;
  for (const std::size_t row : base::kCurveSignals) {
    const thermal::OperatingQuantity<double>& each = thermal::kQuantities<double>[row];
    all.add_where({each.signal.value()}, std::string(each.name), std::string(each.unit), [&](const Point& at) { return at.*each.value; });
    // The later of two signals that are nearly copies is left out.
    if (each.signal == thermal::Signal::input_power) {
      all.add_where({thermal::Signal::current, thermal::Signal::speed}, "current_speed_squared", "A rad2/s2",
                    [](const Point& at) { return at.current_rms_A * at.speed_rms_rad_per_s * at.speed_rms_rad_per_s; });
    }
  }
}

void add_temperatures(Collector& all, const estimation::Model& model, const std::vector<estimation::LinearisedRun>& fitted,
                      const std::vector<estimation::MeasuredRun>& runs) {
  const auto ambient_C = [&](std::size_t r, Eigen::Index k) { return runs[r].at[static_cast<std::size_t>(k)].ambient_C; };
  const std::string_view ambient = thermal::Network::kAmbient;
  for (int node = 0; node < model.network.state_count(); ++node) {
    const std::string name(model.network.node_name(node));
    const bool is_seen = std::ranges::any_of(runs, [&](const estimation::MeasuredRun& run) { return run.sensor_at(name).has_value(); });
    if (!is_seen && name != "winding" && name != "stator") {
      continue;  // a body without a sensor is no signal
    }
    all.add(temperature_of(name + "_temperature", "degC", "temperature", name, ambient),
            [&](std::size_t r, Eigen::Index k) { return fitted[r].state_C(node, k); });
    all.add(temperature_of(name + "_excess", "K", "temperature_difference", name, ambient),
            [&](std::size_t r, Eigen::Index k) { return fitted[r].state_C(node, k) - ambient_C(r, k); });
  }
  if (model.network.state_count() > 1) {
    const std::string_view inner = model.network.node_name(0), outer = model.network.node_name(1);
    all.add(temperature_of(fmt::format("{}_above_{}", inner, outer), "K", "temperature_difference", inner, outer),
            [&](std::size_t r, Eigen::Index k) { return fitted[r].state_C(0, k) - fitted[r].state_C(1, k); });
  }
  if (std::ranges::all_of(runs, [](const estimation::MeasuredRun& run) { return run.has(thermal::Signal::neighbour_temperature); })) {
    const int stator = model.network.find_node("stator").value_or(0);
    all.add(
        temperature_of("neighbour_above_stator", "K", "neighbour_difference", model.network.node_name(stator), ambient),
        [&](std::size_t r, Eigen::Index k) { return runs[r].at[static_cast<std::size_t>(k)].neighbour_C - fitted[r].state_C(stator, k); });
  }
  all.add(temperature_of("ambient_temperature", "degC", "temperature", ambient, ambient), ambient_C);
}

}  // namespace

std::vector<Regressor> regressors_of(const estimation::Model& model, const std::vector<estimation::LinearisedRun>& fitted,
                                     const std::vector<estimation::MeasuredRun>& runs) {
  Collector all(runs);
  add_operating_points(all);
  add_temperatures(all, model, fitted, runs);
  all.add(regressor_of(std::string(kTimeRegressor), "s", RegressorKind::log_only), [&](std::size_t r, Eigen::Index k) {
    const auto first = std::ranges::find(runs, estimation::recording_of(runs[r]), estimation::recording_of);
    return runs[r].time_s[static_cast<std::size_t>(k)] - first->time_s.front();
  });
  std::set<std::string> names;
  for (const estimation::MeasuredRun& run : runs) {
    for (const auto& [name, values] : run.columns) {
      names.insert(name);
    }
  }
  for (const std::string& name : names) {
    const std::optional<recording::Quantity> quantity = recording::quantity_named(name);
    Regressor regressor = regressor_of(name, quantity ? quantity->unit : "", RegressorKind::log_only);
    regressor.choice = thermal::kColumnChoice;
    all.add(std::move(regressor), [&](std::size_t r, Eigen::Index k) {
      const auto found = runs[r].columns.find(name);
      return found == runs[r].columns.end() ? base::kUnknown : found->second[k];
    });
  }
  return all.take();
}

}  // namespace heatsoak::attribution
