#include "two_body_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace heatsoak::suite {
namespace {

constexpr std::size_t kShared = 5;   ///< parameters that all runs share, as logarithms
constexpr Eigen::Index kDrag = 4;    ///< place of the no-load current
constexpr double kLowestDrag = 0.7;  ///< range of the no-load current in the start file, relative to its value
constexpr double kHighestDrag = 1.5;

/// Parameters: four thermal ones and the no-load current as logarithms relative to the start file, then two start temperatures per run.
using Parameters = Eigen::VectorXd;

struct Pair {
  double winding = 0.0;
  double stator = 0.0;
};

/// Two-body model with the inputs of a log's rows.
class RowModel {
 public:
  RowModel(const Family& family, const Parameters& parameters)
      : family_(family),
        winding_J_per_K_(family.winding_J_per_K * std::exp(parameters[0])),
        contact_K_per_W_(family.contact_K_per_W * std::exp(parameters[1])),
        stator_J_per_K_(family.stator_J_per_K * std::exp(parameters[2])),
        air_K_per_W_(family.air_K_per_W * std::exp(parameters[3])),
        drag_Nm_(family.torque_constant_Nm_per_A * family.no_load_current_A * std::exp(parameters[4])) {}

  /// Classical Runge-Kutta steps of at most one second.
  Pair after(const Row& row, double duration_s, Pair at_C) const {
    const int steps = std::max(1, static_cast<int>(std::ceil(duration_s - 1e-9)));
    const double step_s = duration_s / steps;
    for (int i = 0; i < steps; ++i) {
      const Pair a = rates(row, at_C);
      const Pair b = rates(row, moved(at_C, a, 0.5 * step_s));
      const Pair c = rates(row, moved(at_C, b, 0.5 * step_s));
      const Pair d = rates(row, moved(at_C, c, step_s));
      at_C.winding += step_s / 6.0 * (a.winding + 2.0 * b.winding + 2.0 * c.winding + d.winding);
      at_C.stator += step_s / 6.0 * (a.stator + 2.0 * b.stator + 2.0 * c.stator + d.stator);
    }
    return at_C;
  }

 private:
  static Pair moved(Pair from_C, Pair rate_K_per_s, double by_s) {
    return {from_C.winding + by_s * rate_K_per_s.winding, from_C.stator + by_s * rate_K_per_s.stator};
  }
  Pair rates(const Row& row, Pair at_C) const {
    const double hot_ohm = family_.resistance_25C_ohm * (1.0 + kCopper_per_K * (at_C.winding - 25.0));
    const double flow_W = (at_C.winding - at_C.stator) / contact_K_per_W_;
    const double lost_W = (at_C.stator - row.ambient_C) / air_K_per_W_;
    return {(hot_ohm * row.current_A * row.current_A - flow_W) / winding_J_per_K_,
            (flow_W + drag_Nm_ * std::abs(row.speed_rad_per_s) - lost_W) / stator_J_per_K_};
  }

  const Family& family_;
  double winding_J_per_K_;
  double contact_K_per_W_;
  double stator_J_per_K_;
  double air_K_per_W_;
  double drag_Nm_;
};

/// Residuals of all runs, two per row; that of a sample that is not good is zero.
Eigen::VectorXd residuals_K(const Family& family, const std::vector<Log>& logs, const Parameters& parameters, std::size_t count) {
  const RowModel model(family, parameters);
  Eigen::VectorXd residuals = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 * count));
  Eigen::Index at = 0;
  for (std::size_t run = 0; run < logs.size(); ++run) {
    const auto first = static_cast<Eigen::Index>(kShared + 2 * run);
    Pair now_C{parameters[first], parameters[first + 1]};
    for (std::size_t i = 0; i < logs[run].size(); ++i) {
      const Row& row = logs[run][i];
      residuals[at++] = row.winding_is_good ? row.winding_C - now_C.winding : 0.0;
      residuals[at++] = row.stator_is_good ? row.stator_C - now_C.stator : 0.0;
      if (i + 1 < logs[run].size()) {
        now_C = model.after(row, logs[run][i + 1].time_s - row.time_s, now_C);
      }
    }
  }
  return residuals;
}

Parameters first_guess(const std::vector<Log>& logs) {
  Parameters parameters = Parameters::Zero(static_cast<Eigen::Index>(kShared + 2 * logs.size()));
  for (std::size_t run = 0; run < logs.size(); ++run) {
    const auto winding = std::ranges::find_if(logs[run], &Row::winding_is_good);
    const auto stator = std::ranges::find_if(logs[run], &Row::stator_is_good);
    const auto first = static_cast<Eigen::Index>(kShared + 2 * run);
    parameters[first] = winding == logs[run].end() ? 25.0 : winding->winding_C;
    parameters[first + 1] = stator == logs[run].end() ? 25.0 : stator->stator_C;
  }
  return parameters;
}

Eigen::MatrixXd sensitivities(const Family& family, const std::vector<Log>& logs, const Parameters& parameters, const Eigen::VectorXd& at_K,
                              std::size_t count) {
  Eigen::MatrixXd columns(at_K.size(), parameters.size());
  for (Eigen::Index i = 0; i < parameters.size(); ++i) {
    const double difference = i < static_cast<Eigen::Index>(kShared) ? 1e-5 : 1e-3;
    Parameters moved = parameters;
    moved[i] += difference;
    columns.col(i) = (residuals_K(family, logs, moved, count) - at_K) / difference;
  }
  return columns;
}

/// Levenberg-Marquardt fit. With `drag_is_fixed` the no-load current keeps its value.
void refine(const Family& family, const std::vector<Log>& logs, std::size_t count, bool drag_is_fixed, Parameters& parameters,
            Eigen::VectorXd& at_K) {
  double damping = 1e-3;
  at_K = residuals_K(family, logs, parameters, count);
  for (int round = 0; round < 40; ++round) {
    Eigen::MatrixXd columns = sensitivities(family, logs, parameters, at_K, count);
    Eigen::MatrixXd normal = columns.transpose() * columns;
    Eigen::VectorXd slope = columns.transpose() * at_K;
    if (drag_is_fixed) {
      normal.row(kDrag).setZero();
      normal.col(kDrag).setZero();
      normal(kDrag, kDrag) = 1.0;
      slope[kDrag] = 0.0;
    }
    normal.diagonal() *= 1.0 + damping;
    Eigen::VectorXd step = normal.ldlt().solve(slope);
    step.head(kDrag + 1) = step.head(kDrag + 1).cwiseMax(-0.5).cwiseMin(0.5);
    const Parameters moved = parameters - step;
    const Eigen::VectorXd then_K = residuals_K(family, logs, moved, count);
    const double gained = at_K.squaredNorm() - then_K.squaredNorm();
    if (gained > 0.0) {
      parameters = moved;
      damping = std::max(damping * 0.1, 1e-9);
      const bool is_done = gained < 1e-7 * at_K.squaredNorm();
      at_K = then_K;
      if (is_done) {
        return;
      }
    } else if ((damping *= 10.0) > 1e6) {
      return;
    }
  }
}

}  // namespace

TwoBodyFit fit_two_bodies(const Family& family, const std::vector<Log>& logs) {
  std::array<double, 2> good{};
  std::size_t count = 0;
  for (const Log& log : logs) {
    count += log.size();
    good[0] += static_cast<double>(std::ranges::count_if(log, &Row::winding_is_good));
    good[1] += static_cast<double>(std::ranges::count_if(log, &Row::stator_is_good));
  }
  Parameters parameters = first_guess(logs);
  Eigen::VectorXd at_K;
  refine(family, logs, count, false, parameters, at_K);
  const double in_range = std::clamp(parameters[kDrag], std::log(kLowestDrag), std::log(kHighestDrag));
  if (in_range != parameters[kDrag]) {
    parameters[kDrag] = in_range;
    refine(family, logs, count, true, parameters, at_K);
  }
  const Eigen::Map<const Eigen::MatrixXd> by_sensor(at_K.data(), 2, at_K.size() / 2);
  return {.winding_J_per_K = family.winding_J_per_K * std::exp(parameters[0]),
          .contact_K_per_W = family.contact_K_per_W * std::exp(parameters[1]),
          .stator_J_per_K = family.stator_J_per_K * std::exp(parameters[2]),
          .air_K_per_W = family.air_K_per_W * std::exp(parameters[3]),
          .no_load_current_A = family.no_load_current_A * std::exp(parameters[4]),
          .winding_rmse_K = std::sqrt(by_sensor.row(0).squaredNorm() / good[0]),
          .stator_rmse_K = std::sqrt(by_sensor.row(1).squaredNorm() / good[1])};
}

}  // namespace heatsoak::suite
