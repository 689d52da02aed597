#include "friction/roll_out.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "base/confidence.h"
#include "base/random.h"

namespace heatsoak::friction {
namespace {

constexpr double kOff_share = 0.02;
constexpr double kEnd_share = 0.15;
constexpr double kMoving_share = 0.3;
constexpr std::size_t kLeastRollOutRows = 15;
constexpr std::size_t kReach = 4;
constexpr double kTrusted_share = 0.1;
constexpr int kMostRollOutRounds = 5;

/// Running median of nine values, which removes single outliers.
std::vector<double> without_spikes(const std::vector<double>& values) {
  std::vector<double> smooth(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t begin = i < kReach ? 0 : i - kReach;
    std::vector<double> near(values.begin() + static_cast<std::ptrdiff_t>(begin),
                             values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), i + kReach + 1)));
    smooth[i] = median(near);
  }
  return smooth;
}

/// Per row, true if no wheel is driven; empty if the log has no voltages.
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

/// Speed and energy of the rolling body (or wheel), per row.
struct Rolling {
  RollOutRun run;
  std::vector<double> speed;                ///< without spikes, m/s of the contact points or rad/s of a lifted wheel
  std::vector<double> energy_J;             ///< from the measured speeds
  std::vector<double> smooth_energy_J;      ///< from speeds without spikes
  std::vector<double> turning_rad_per_s;    ///< Σ|ω_i|, as measured
  std::vector<double> turning_rad2_per_s2;  ///< Σω_i²
  explicit Rolling(std::size_t rows)
      : speed(rows), energy_J(rows), smooth_energy_J(rows), turning_rad_per_s(rows), turning_rad2_per_s2(rows) {}
};

struct RollOutSegment {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Segments in which the drivers are off, each to the end of its roll-out.
std::vector<RollOutSegment> segments(const FrictionLog& log, const std::vector<bool>& off, const std::vector<double>& speed) {
  std::vector<RollOutSegment> found;
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
  std::erase_if(found, [](const RollOutSegment& segment) { return segment.end - segment.begin < kLeastRollOutRows; });
  return found;
}

/// Rotation of the wheels since the begin of the segment, integrated over the trusted rows.
struct Turned {
  std::vector<double> sum_rad;         ///< Σ∫|ω_i| dt
  std::vector<double> sum_rad2_per_s;  ///< Σ∫ω_i² dt
};

Turned turned_by(const FrictionLog& log, const Rolling& rolling, const RollOutSegment& segment, const std::vector<bool>& trusted) {
  Turned turned{std::vector<double>(trusted.size()), std::vector<double>(trusted.size())};
  std::optional<std::size_t> last;
  for (std::size_t row = segment.begin; row < segment.end; ++row) {
    const std::size_t i = row - segment.begin;
    if (i > 0) {
      turned.sum_rad[i] = turned.sum_rad[i - 1];
      turned.sum_rad2_per_s[i] = turned.sum_rad2_per_s[i - 1];
    }
    if (trusted[i] && last) {
      const double half_s = 0.5 * (log.time_s[row] - log.time_s[*last]);
      turned.sum_rad[i] += half_s * (rolling.turning_rad_per_s[row] + rolling.turning_rad_per_s[*last]);
      turned.sum_rad2_per_s[i] += half_s * (rolling.turning_rad2_per_s2[row] + rolling.turning_rad2_per_s2[*last]);
    }
    last = trusted[i] ? row : last;
  }
  return turned;
}

struct EnergyFit {
  RobustFit fit;  ///< E_0, τ, D
  Eigen::MatrixXd X;
  Eigen::VectorXd energy;
};

/// Fits E_0, τ and D. Rows are weighted by 1/√E, so that speed noise has the same effect in all rows. nullopt with too few trusted rows.
std::optional<EnergyFit> energy_fit(const Rolling& rolling, const RollOutSegment& segment, const Turned& turned,
                                    const std::vector<bool>& trusted) {
  const double least_J = kEnd_share * kEnd_share * rolling.smooth_energy_J[segment.begin];
  EnergyFit made{{}, Eigen::MatrixXd(trusted.size(), 3), Eigen::VectorXd(trusted.size())};
  Eigen::Index used = 0;
  for (std::size_t i = 0; i < trusted.size(); ++i) {
    const std::size_t row = segment.begin + i;
    if (trusted[i]) {
      const double weight = 1.0 / std::sqrt(std::max(rolling.energy_J[row], least_J));
      made.X.row(used) << weight, -weight * turned.sum_rad[i], -weight * turned.sum_rad2_per_s[i];
      made.energy(used++) = weight * rolling.energy_J[row];
    }
  }
  if (used < static_cast<Eigen::Index>(kLeastRollOutRows)) {
    return std::nullopt;
  }
  made.X.conservativeResize(used, 3);
  made.energy.conservativeResize(used);
  std::vector<int> cluster(static_cast<std::size_t>(used));
  std::iota(cluster.begin(), cluster.end(), 0);
  made.fit = robust_fit(made.X, made.energy, cluster);
  return made;
}

/// Marks rows whose speed differs from the expected one by at most a tenth of the first speed. Other rows are ignored.
template <typename Expected>
std::vector<bool> trusted_rows(const Rolling& rolling, const RollOutSegment& segment, Expected expected_J) {
  std::vector<bool> trusted(segment.end - segment.begin);
  const double most = kTrusted_share * std::sqrt(std::max(0.0, expected_J(0)));
  for (std::size_t i = 0; i < trusted.size(); ++i) {
    const double found_J = rolling.energy_J[segment.begin + i];
    trusted[i] = found_J > 0.0 && std::abs(std::sqrt(found_J) - std::sqrt(std::max(0.0, expected_J(i)))) <= most;
  }
  return trusted;
}

std::optional<RollOutRun> fitted(const FrictionLog& log, const Rolling& rolling, const RollOutSegment& segment) {
  std::vector<bool> trusted = trusted_rows(rolling, segment, [&](std::size_t i) { return rolling.smooth_energy_J[segment.begin + i]; });
  std::optional<EnergyFit> found;
  for (int round = 0; round < kMostRollOutRounds; ++round) {
    const Turned turned = turned_by(log, rolling, segment, trusted);
    found = energy_fit(rolling, segment, turned, trusted);
    if (!found) {
      return std::nullopt;
    }
    const auto expected_J = [&](std::size_t i) {
      return found->fit.coefficients.dot(Eigen::Vector3d(1.0, -turned.sum_rad[i], -turned.sum_rad2_per_s[i]));
    };
    std::vector<bool> now = trusted_rows(rolling, segment, expected_J);
    if (std::exchange(trusted, now) == now) {
      break;
    }
  }
  RollOutRun run = rolling.run;
  const RobustFit& fit = found->fit;
  run.wheel_torque_Nm = fit.coefficients(1);
  run.wheel_damping_Nm_s_per_rad = fit.coefficients(2);
  const Eigen::VectorXd residuals = found->energy - found->X * fit.coefficients;
  const double mean = fit.weights.dot(found->energy) / fit.weights.sum();
  run.r2_ratio = 1.0 - fit.weights.dot(residuals.cwiseAbs2()) / fit.weights.dot((found->energy.array() - mean).square().matrix());
  run.rows_used = static_cast<int>((fit.weights.array() > 0.0).count());
  return run;
}

robot::PerWheel wheel_speeds(const std::array<std::vector<double>, robot::kMostWheels>& columns, int wheel_count, std::size_t row) {
  robot::PerWheel speed_rad_per_s{};
  for (int i = 0; i < wheel_count; ++i) {
    speed_rad_per_s[i] = columns[static_cast<std::size_t>(i)][row];
  }
  return speed_rad_per_s;
}

void add_robot(const FrictionLog& log, const robot::BodyConfig& body, RollOutResult& result) {
  const robot::Kinematics& kinematics = body.kinematics;
  std::array<std::vector<double>, robot::kMostWheels> smooth;
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    smooth[static_cast<std::size_t>(i)] = without_spikes(log.wheel_speed_rad_per_s[static_cast<std::size_t>(i)]);
  }
  Rolling rolling(log.rows());
  std::vector<robot::BodyVelocity> velocity(log.rows());
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const robot::PerWheel measured = wheel_speeds(log.wheel_speed_rad_per_s, kinematics.wheel_count, row);
    rolling.energy_J[row] = robot::kinetic_energy_J(body, robot::body_velocity(kinematics, measured), measured);
    const robot::PerWheel speeds = wheel_speeds(smooth, kinematics.wheel_count, row);
    velocity[row] = robot::body_velocity(kinematics, speeds);
    rolling.smooth_energy_J[row] = robot::kinetic_energy_J(body, velocity[row], speeds);
    rolling.speed[row] =
        std::hypot(velocity[row].x_m_per_s, velocity[row].y_m_per_s, kinematics.contact_radius_m * velocity[row].yaw_rad_per_s);
    for (int i = 0; i < kinematics.wheel_count; ++i) {
      rolling.turning_rad_per_s[row] += std::abs(measured[i]);
      rolling.turning_rad2_per_s2[row] += measured[i] * measured[i];
    }
  }
  for (const RollOutSegment& segment : segments(log, rows_off(log, kinematics.wheel_count), rolling.speed)) {
    const robot::BodyVelocity& first = velocity[segment.begin];
    const double moving_m_per_s = std::hypot(first.x_m_per_s, first.y_m_per_s);
    const bool turns = kinematics.contact_radius_m * std::abs(first.yaw_rad_per_s) > moving_m_per_s;
    rolling.run = {.kind = turns ? RollOut::rotation : RollOut::translation};
    if (std::optional<RollOutRun> run = fitted(log, rolling, segment)) {
      if (!turns) {
        run->heading_rad = std::atan2(first.y_m_per_s, first.x_m_per_s);
        run->force_N = run->wheel_torque_Nm * rolling.turning_rad_per_s[segment.begin] / moving_m_per_s;
      }
      result.runs.push_back(*run);
    }
  }
}

void add_lifted(const FrictionLog& log, const robot::BodyConfig& body, RollOutResult& result) {
  const std::vector<bool> off = rows_off(log, body.kinematics.wheel_count);
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    const std::vector<double>& speed_rad_per_s = log.wheel_speed_rad_per_s[static_cast<std::size_t>(i)];
    if (speed_rad_per_s.empty()) {
      continue;
    }
    Rolling rolling(log.rows());
    rolling.run = {.kind = RollOut::lifted_wheel, .wheel = i};
    rolling.speed = without_spikes(speed_rad_per_s);
    for (std::size_t row = 0; row < log.rows(); ++row) {
      rolling.turning_rad_per_s[row] = std::abs(speed_rad_per_s[row]);
      rolling.turning_rad2_per_s2[row] = speed_rad_per_s[row] * speed_rad_per_s[row];
      rolling.energy_J[row] = 0.5 * body.wheel_inertia_kg_m2 * rolling.turning_rad2_per_s2[row];
      rolling.smooth_energy_J[row] = 0.5 * body.wheel_inertia_kg_m2 * rolling.speed[row] * rolling.speed[row];
    }
    for (const RollOutSegment& segment : segments(log, off, rolling.speed)) {
      if (std::optional<RollOutRun> run = fitted(log, rolling, segment)) {
        result.runs.push_back(*run);
      }
    }
  }
}

/// Mean over runs with an interval from their scatter (robust mean from three runs on).
std::optional<Estimate> over_runs(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const Eigen::Map<const Eigen::VectorXd> all(values.data(), static_cast<Eigen::Index>(values.size()));
  if (values.empty()) {
    return std::nullopt;
  }
  if (values.size() >= 3) {
    const double typical = robust_location(values, 0.0).value.value();
    const double deviation = std::sqrt((all.array() - typical).square().sum() / (count - 1.0));
    const double half =
        boost::math::quantile(boost::math::students_t(count - 1.0), base::kBoundConfidence_share) * deviation / std::sqrt(count);
    return estimate_around(typical, half);
  }
  return Estimate{.value = all.mean()};
}

}  // namespace

RollOutResult roll_out(const std::vector<FrictionLog>& logs, const robot::BodyConfig& body, bool is_lifted) {
  RollOutResult result;
  for (const FrictionLog& log : logs) {
    result.rows += log.rows();
    is_lifted ? add_lifted(log, body, result) : add_robot(log, body, result);
  }
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    std::vector<double> dampings, torques;
    for (const RollOutRun& run : result.runs) {
      if (!run.wheel || run.wheel == i) {
        dampings.push_back(run.wheel_damping_Nm_s_per_rad);
        torques.push_back(run.wheel_torque_Nm);
      }
    }
    result.wheel_damping_Nm_s_per_rad.push_back(over_runs(dampings));
    result.wheel_torque_Nm.push_back(over_runs(torques));
  }
  return result;
}

RollOutResult roll_out(const std::vector<FrictionLog>& logs, const robot::Robot& robot, const motor::MotorValues& motor, bool is_lifted) {
  constexpr int kDraws = 100;
  RollOutResult result = roll_out(logs, robot::make_body(robot, motor), is_lifted);
  std::vector<RollOutResult> drawn;
  base::Random random(1, 0);
  for (int i = 0; i < kDraws; ++i) {
    drawn.push_back(roll_out(logs, robot::make_body(robot::draw_sample(robot, random), motor), is_lifted));
  }
  const auto widen = [&](std::vector<std::optional<Estimate>> RollOutResult::*which) {
    for (std::size_t wheel = 0; wheel < (result.*which).size(); ++wheel) {
      std::optional<Estimate>& estimate = (result.*which)[wheel];
      std::vector<double> values;
      for (const RollOutResult& each : drawn) {
        if ((each.*which).size() > wheel && (each.*which)[wheel]) {
          values.push_back((each.*which)[wheel]->value);
        }
      }
      std::ranges::sort(values);
      if (estimate && estimate->interval && values.size() == drawn.size()) {
        const auto quantile = [&values](double share) {
          return values[static_cast<std::size_t>(share * static_cast<double>(values.size()))];
        };
        const double value = estimate->value;
        Interval& interval = *estimate->interval;
        interval.low = value - std::hypot(value - interval.low, std::max(0.0, value - quantile(0.5 * base::kError_share)));
        interval.high = value + std::hypot(interval.high - value, std::max(0.0, quantile(base::kBoundConfidence_share) - value));
      }
    }
  };
  widen(&RollOutResult::wheel_damping_Nm_s_per_rad);
  widen(&RollOutResult::wheel_torque_Nm);
  return result;
}

}  // namespace heatsoak::friction
