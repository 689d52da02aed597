#include "identify/friction/roll_out.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <optional>

namespace heatsoak {
namespace {

constexpr double kOff_share = 0.02;
constexpr double kEnd_share = 0.15;
constexpr double kMoving_share = 0.3;
constexpr std::size_t kLeastRows = 15;

/// Median of each value and its two neighbours on both sides: single bad rows vanish.
std::vector<double> without_spikes(const std::vector<double>& values) {
  std::vector<double> smooth(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t begin = i < 2 ? 0 : i - 2;
    std::vector<double> near(values.begin() + static_cast<std::ptrdiff_t>(begin),
                             values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), i + 3)));
    smooth[i] = median(near);
  }
  return smooth;
}

/// Per row, whether no wheel is driven; empty where the log does not say.
std::vector<bool> rows_off(const FrictionLog& log, int wheel_count) {
  std::vector<bool> off(log.rows(), true);
  bool is_known = false;
  for (int i = 0; i < wheel_count; ++i) {
    const std::vector<double>& column = log.voltage_V[static_cast<std::size_t>(i)];
    if (column.empty()) {
      continue;
    }
    is_known = true;
    const std::vector<double> smooth = without_spikes(column);
    std::vector<double> sizes;
    std::ranges::transform(smooth, std::back_inserter(sizes), [](double value) { return std::isfinite(value) ? std::abs(value) : 0.0; });
    std::vector<double> sorted = sizes;
    std::ranges::sort(sorted);
    const double top = sorted[sorted.size() * 95 / 100];
    for (std::size_t row = 0; row < off.size(); ++row) {
      off[row] = off[row] && sizes[row] <= kOff_share * top;
    }
  }
  return is_known ? off : std::vector<bool>{};
}

/// One coordinate of a log that rolls out.
struct Coordinate {
  RollOutRun run;
  std::vector<double> speed;   ///< as measured, m/s or rad/s
  std::vector<double> smooth;  ///< the same without spikes
};

struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Where the drivers are off and the coordinate still moves, each to the end of its roll-out.
std::vector<Stretch> stretches(const FrictionLog& log, const std::vector<bool>& off, const std::vector<double>& speed) {
  std::vector<Stretch> found;
  double top = 0.0;
  std::ranges::for_each(speed, [&](double each) { top = std::isfinite(each) ? std::max(top, std::abs(each)) : top; });
  const auto end_of = [&](std::size_t begin, std::size_t limit) {
    std::size_t end = begin;
    while (end < limit && (off.empty() || off[end]) && !(std::abs(speed[end]) < kEnd_share * std::abs(speed[begin]))) {
      ++end;
    }
    return end;
  };
  for (std::size_t n = 0; n < log.run_begins.size(); ++n) {
    const std::size_t first = log.run_begins[n];
    const std::size_t limit = n + 1 < log.run_begins.size() ? log.run_begins[n + 1] : log.rows();
    if (off.empty()) {
      const auto begin =
          std::max_element(speed.begin() + static_cast<std::ptrdiff_t>(first), speed.begin() + static_cast<std::ptrdiff_t>(limit),
                           [](double a, double b) { return std::abs(a) < std::abs(b); });
      const auto at = static_cast<std::size_t>(begin - speed.begin());
      found.push_back({at, end_of(at, limit)});
      continue;
    }
    for (std::size_t row = first; row < limit; ++row) {
      const bool starts = off[row] && (row == first || !off[row - 1]) && std::abs(speed[row]) > kMoving_share * top;
      if (starts) {
        const std::size_t end = end_of(row, limit);
        found.push_back({row, end});
        row = std::max(row, end - 1);
      }
    }
  }
  std::erase_if(found, [](const Stretch& stretch) { return stretch.end - stretch.begin < kLeastRows; });
  return found;
}

/// ω over time and way: offset, −(τ/J), −(D/J).
/// `torques`: Σ|ω_i| of the wheels per speed, `dampings`: Σω_i² per speed².
std::optional<RollOutRun> fitted(const FrictionLog& log, const Coordinate& coordinate, const Stretch& stretch, double inertia,
                                 double torques, double dampings) {
  const auto size = static_cast<Eigen::Index>(stretch.end - stretch.begin);
  std::vector<Eigen::Index> rows;
  Eigen::MatrixXd X(size, 3);
  Eigen::VectorXd speed(size);
  double way = 0.0;
  Eigen::Index used = 0;
  const double side = coordinate.smooth[stretch.begin] > 0.0 ? 1.0 : -1.0;
  for (std::size_t row = stretch.begin; row < stretch.end; ++row) {
    if (row > stretch.begin) {
      way += side * 0.5 * (coordinate.smooth[row] + coordinate.smooth[row - 1]) * (log.time_s[row] - log.time_s[row - 1]);
    }
    if (std::isfinite(coordinate.speed[row]) && std::isfinite(way)) {
      X.row(used) << 1.0, -(log.time_s[row] - log.time_s[stretch.begin]), -way;
      speed(used++) = side * coordinate.speed[row];
    }
  }
  if (used < static_cast<Eigen::Index>(kLeastRows)) {
    return std::nullopt;
  }
  X.conservativeResize(used, 3);
  speed.conservativeResize(used);
  std::vector<int> cluster(static_cast<std::size_t>(used));
  for (std::size_t i = 0; i < cluster.size(); ++i) {
    cluster[i] = static_cast<int>(i);
  }
  const RobustFit fit = robust_fit(X, speed, cluster);
  RollOutRun run = coordinate.run;
  run.wheel_torque_Nm = fit.coefficients(1) * inertia / torques;
  run.force_N = run.kind == RollOut::translation ? fit.coefficients(1) * inertia : 0.0;
  run.wheel_damping_Nm_s_per_rad = fit.coefficients(2) * inertia / dampings;
  const Eigen::VectorXd residuals = speed - X * fit.coefficients;
  const double mean = fit.weights.dot(speed) / fit.weights.sum();
  run.r2_ratio = 1.0 - fit.weights.dot(residuals.cwiseAbs2()) / fit.weights.dot((speed.array() - mean).square().matrix());
  run.rows_used = static_cast<int>((fit.weights.array() > 0.0).count());
  return run;
}

/// Σ s_i² and Σ |s_i| over the wheels, per radius: wheel speed per speed of the coordinate.
struct Shares {
  double squares = 0.0;
  double sizes = 0.0;
};

Shares shares(const Kinematics& kinematics, const BodyVelocity& unit) {
  Shares found;
  for (const double speed : wheel_speeds_rad_per_s(kinematics, unit)) {
    found.squares += speed * speed;
    found.sizes += std::abs(speed);
  }
  return found;
}

void add_robot(const FrictionLog& log, const BodyConfig& body, RollOutResult& result) {
  const std::vector<bool> off = rows_off(log, body.kinematics.wheel_count);
  std::vector<BodyVelocity> velocity(log.rows());
  for (std::size_t row = 0; row < log.rows(); ++row) {
    PerWheel speed_rad_per_s{};
    for (int i = 0; i < body.kinematics.wheel_count; ++i) {
      speed_rad_per_s[i] = log.wheel_speed_rad_per_s[static_cast<std::size_t>(i)][row];
    }
    velocity[row] = body_velocity(body.kinematics, speed_rad_per_s);
  }
  std::vector<double> moving, turning;
  for (const BodyVelocity& each : velocity) {
    moving.push_back(std::hypot(each.x_m_per_s, each.y_m_per_s));
    turning.push_back(each.yaw_rad_per_s);
  }
  const Coordinate translation{{.kind = RollOut::translation}, moving, without_spikes(moving)};
  const Coordinate rotation{{.kind = RollOut::rotation}, turning, without_spikes(turning)};
  for (const Stretch& stretch : stretches(log, off, translation.smooth)) {
    std::vector<double> x, y;
    for (std::size_t row = stretch.begin; row < stretch.end; ++row) {
      x.push_back(velocity[row].x_m_per_s);
      y.push_back(velocity[row].y_m_per_s);
    }
    Coordinate along = translation;
    along.run.heading_rad = std::atan2(median(y), median(x));
    if (std::abs(rotation.smooth[stretch.begin]) * body.kinematics.contact_radius_m > translation.smooth[stretch.begin]) {
      continue;
    }
    const Shares share = shares(body.kinematics, {std::cos(along.run.heading_rad), std::sin(along.run.heading_rad), 0.0});
    const double mass_kg = body.weight.mass_kg + body.wheel_inertia_kg_m2 * share.squares;
    if (std::optional<RollOutRun> run = fitted(log, along, stretch, mass_kg, share.sizes, share.squares)) {
      result.runs.push_back(*run);
    }
  }
  for (const Stretch& stretch : stretches(log, off, rotation.smooth)) {
    if (std::abs(rotation.smooth[stretch.begin]) * body.kinematics.contact_radius_m <= translation.smooth[stretch.begin]) {
      continue;
    }
    const Shares share = shares(body.kinematics, {0.0, 0.0, 1.0});
    const double inertia_kg_m2 = body.yaw_inertia_kg_m2 + body.wheel_inertia_kg_m2 * share.squares;
    if (std::optional<RollOutRun> run = fitted(log, rotation, stretch, inertia_kg_m2, share.sizes, share.squares)) {
      result.runs.push_back(*run);
    }
  }
}

void add_lifted(const FrictionLog& log, const BodyConfig& body, RollOutResult& result) {
  const std::vector<bool> off = rows_off(log, body.kinematics.wheel_count);
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    const std::vector<double>& speed = log.wheel_speed_rad_per_s[static_cast<std::size_t>(i)];
    const Coordinate wheel{{.kind = RollOut::lifted_wheel, .wheel = i}, speed, without_spikes(speed)};
    for (const Stretch& stretch : stretches(log, off, wheel.smooth)) {
      if (std::optional<RollOutRun> run = fitted(log, wheel, stretch, body.wheel_inertia_kg_m2, 1.0, 1.0)) {
        result.runs.push_back(*run);
      }
    }
  }
}

/// Mean over runs, its interval from their scatter.
Estimate over_runs(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const Eigen::Map<const Eigen::VectorXd> all(values.data(), static_cast<Eigen::Index>(values.size()));
  Estimate found;
  if (values.empty()) {
    return found;
  }
  found.value = all.mean();
  if (values.size() >= 3) {
    const RobustLocation typical = robust_location(values, 0.0);
    found.value = typical.value;
    const double deviation = std::sqrt((all.array() - found.value).square().sum() / (count - 1.0));
    const double half = boost::math::quantile(boost::math::students_t(count - 1.0), 0.975) * deviation / std::sqrt(count);
    found.low = found.value - half;
    found.high = found.value + half;
  }
  return found;
}

}  // namespace

RollOutResult roll_out(const std::vector<FrictionLog>& logs, const BodyConfig& body, bool is_lifted) {
  RollOutResult result;
  for (const FrictionLog& log : logs) {
    result.rows += log.rows();
    is_lifted ? add_lifted(log, body, result) : add_robot(log, body, result);
  }
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    std::vector<double> dampings, torques;
    for (const RollOutRun& run : result.runs) {
      if (run.wheel < 0 || run.wheel == i) {
        dampings.push_back(run.wheel_damping_Nm_s_per_rad);
        torques.push_back(run.wheel_torque_Nm);
      }
    }
    result.wheel_damping_Nm_s_per_rad.push_back(over_runs(dampings));
    result.wheel_torque_Nm.push_back(over_runs(torques));
  }
  return result;
}

}  // namespace heatsoak
