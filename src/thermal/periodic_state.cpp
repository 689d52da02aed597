#include "thermal/periodic_state.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"
#include "thermal/linearised.h"

namespace heatsoak::thermal {
namespace {

/// One cycle as a map from the state before it to the state after it.
class CycleMap {
 public:
  CycleMap(const Network& network, std::span<const Interval> cycle)
      : network_(network), values_(network.values()), cycle_(cycle.begin(), cycle.end()) {
    const Eigen::VectorXd start_C = ambient_C();
    double cycle_s = 0.0;
    double fastest_per_s = 0.0;
    Linearised slope;
    for (const Interval& interval : cycle_) {
      network.linearise(interval.at, values_, std::span(start_C.data(), static_cast<std::size_t>(start_C.size())), slope);
      fastest_per_s = std::max(fastest_per_s, slope.by_state.cwiseAbs().rowwise().sum().maxCoeff());
      cycle_s += interval.duration_s;
    }
    // A shorter cycle would change the temperatures by less than their rounding error.
    constexpr double kShortest = 1e-6;
    for (Interval& interval : cycle_) {
      interval.duration_s *= std::max(1.0, kShortest / (cycle_s * fastest_per_s));
    }
    // An explicit method needs a step per fastest time constant even in the steady state.
    constexpr double kLong = 1e4;
    options_.method = cycle_s * fastest_per_s > kLong ? ode::OdeMethod::cvodes_bdf : ode::OdeMethod::arkode_erk;
    options_.tolerances = {1e-11, 1e-11};
  }

  [[nodiscard]] Eigen::VectorXd ambient_C() const { return Eigen::VectorXd::Constant(network_.state_count(), cycle_.front().at.ambient_C); }

  TransientResult run(const Eigen::VectorXd& start_C, const TransientObserver& observer = {}) {
    options_.start_C.assign(start_C.begin(), start_C.end());
    return run_transient(network_, values_, cycle_, options_, observer);
  }

  /// Returns the state after the cycle, or nothing if a temperature exceeds kDestroyed_C.
  std::optional<Eigen::VectorXd> operator()(const Eigen::VectorXd& start_C) {
    if (!(start_C.maxCoeff() < kDestroyed_C)) {
      return std::nullopt;
    }
    const TransientResult result = run(start_C);
    return result.destroyed ? std::nullopt
                            : std::optional<Eigen::VectorXd>(Eigen::Map<const Eigen::VectorXd>(result.end_C.data(), start_C.size()));
  }

  /// Finite differences over 1 K downwards: a cooler start cannot exceed kDestroyed_C if this one does not.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& start_C, const Eigen::VectorXd& end_C) {
    Eigen::MatrixXd result(start_C.size(), start_C.size());
    for (Eigen::Index i = 0; i < start_C.size(); ++i) {
      Eigen::VectorXd below_C = start_C;
      below_C[i] -= 1.0;
      const double step_K = start_C[i] - below_C[i];
      const TransientResult below = run(below_C);
      result.col(i) = (end_C - Eigen::Map<const Eigen::VectorXd>(below.end_C.data(), start_C.size())) / step_K;
    }
    return result;
  }

  /// Integrates the cubic Hermite interpolation of each solver step. Returns the mean temperatures and writes the peaks.
  std::vector<double> mean_C(const Eigen::VectorXd& start_C, std::vector<double>& peak_C) {
    const auto states = static_cast<std::size_t>(network_.state_count());
    std::vector<double> temperature_C(states + 1);
    Eigen::VectorXd slope(start_C.size());
    Eigen::VectorXd slope_before(start_C.size());
    Eigen::VectorXd before_C = start_C;
    Eigen::VectorXd integral = Eigen::VectorXd::Zero(start_C.size());
    double before_s = 0.0;
    const TransientResult result = run(start_C, [&](const TransientMoment& moment) {
      const Eigen::Map<const Eigen::VectorXd> now_C(moment.state_C.data(), start_C.size());
      std::ranges::copy(moment.state_C, temperature_C.begin());
      network_.rate_K_per_s<double>(cycle_[moment.interval].at, values_, temperature_C, std::span(slope.data(), states));
      if (!moment.begins_interval) {
        const double step_s = moment.time_s - before_s;
        integral += 0.5 * step_s * (before_C + now_C) + step_s * step_s / 12.0 * (slope_before - slope);
      }
      before_s = moment.time_s;
      before_C = now_C;
      slope_before = slope;
    });
    peak_C = result.peak_C;
    integral /= result.end_s;
    return {integral.begin(), integral.end()};
  }

 private:
  const Network& network_;
  std::vector<double> values_;
  std::vector<Interval> cycle_;
  TransientOptions options_;
};

/// Returns the start of the stable cycle, or nothing if there is none.
std::optional<Eigen::VectorXd> repeating_start_C(CycleMap& map, Eigen::VectorXd end_C) {
  constexpr int kMostIterations = 100;
  constexpr double kAlike_K = 1e-3;  // convergence: Newton's next step is far shorter still
  constexpr double kLongestStep_K = 200.0;
  constexpr double kShortestShare = 1.0 / 64.0;
  constexpr double kRounding = 1e-11;  // tolerance for a node without heat exchange, whose eigenvalue is 1 except for rounding
  Eigen::VectorXd start_C = map.ambient_C();
  for (int i = 0; i < kMostIterations; ++i) {
    Eigen::MatrixXd left = -map.jacobian(start_C, end_C);
    const double growth = left.eigenvalues().cwiseAbs().maxCoeff();
    const bool stable = growth < 1.0 + kRounding;
    // Newton's method would return to an unstable cycle. This step leads away from it and doubles the distance instead.
    left.diagonal().array() += stable ? 1.0 : 2.0 * growth - 1.0;
    Eigen::VectorXd step_K = left.completeOrthogonalDecomposition().solve(end_C - start_C);
    const double longest_K = step_K.cwiseAbs().maxCoeff();
    step_K *= std::min(1.0, kLongestStep_K / std::max(longest_K, kAlike_K));
    std::optional<Eigen::VectorXd> next_C = map(start_C + step_K);
    for (double share = 1.0; !next_C; next_C = map(start_C + step_K)) {
      step_K *= 0.5;
      share *= 0.5;
      if (share < kShortestShare) {
        return std::nullopt;
      }
    }
    start_C += step_K;
    end_C = *next_C;
    if (stable && longest_K < kAlike_K) {
      return start_C;
    }
  }
  throw base::Failure(base::ExitCode::numerics_failed, fmt::format("the periodic steady state was not found in {} steps", kMostIterations));
}

}  // namespace

PeriodicState periodic_state(const Network& network, std::span<const Interval> cycle) {
  CycleMap map(network, cycle);
  PeriodicState result;
  const TransientResult first = map.run(map.ambient_C());
  if (first.destroyed) {
    result.destroyed_s = first.end_s;
    result.runaway = true;
    return result;
  }
  const auto start_C = repeating_start_C(map, Eigen::Map<const Eigen::VectorXd>(first.end_C.data(), network.state_count()));
  if (!start_C) {
    result.runaway = true;
    return result;
  }
  result.start_C.assign(start_C->begin(), start_C->end());
  result.mean_C = map.mean_C(*start_C, result.peak_C);
  return result;
}

}  // namespace heatsoak::thermal
