#include "calibration/profile.h"

#include <boost/math/tools/roots.hpp>
#include <cmath>

#include "estimation/least_squares.h"
#include "estimation/linearised_run.h"

namespace heatsoak {
namespace {

/// Half of the 95 % point of χ² with one degree of freedom.
constexpr double kDrop = 1.92;

}  // namespace

std::pair<double, double> profile_interval(const Model& model, std::span<const MeasuredRun> runs, const Fit& fit, int parameter,
                                           int threads) {
  std::vector<int> wanted;
  std::vector<LinearisedRun> linearised;
  std::vector<Whitening> whitening;
  const std::vector<double> values = model.values_at(fit.theta);
  linearised.reserve(runs.size());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Eigen::VectorXd& start_C = fit.starts[r].state_C;
    linearised.push_back(
        linearise(model.network, values, wanted, model.flux_nodes, {start_C.data(), static_cast<std::size_t>(start_C.size())}, runs[r]));
    whitening.emplace_back(linearised.back(), fit.flux, noise_of(runs[r], fit, r));
  }
  LeastSquaresProblem problem{
      .model = &model, .runs = runs, .whitening = whitening, .held = parameter, .threads = threads, .most_iterations = 8};
  const double sd = std::sqrt(fit.covariance(parameter, parameter));
  const Eigen::VectorXd direction = fit.covariance.col(parameter) / fit.covariance(parameter, parameter);
  const auto cost = [&](double moved) {
    // Start the other parameters at the values that the curvature predicts.
    Eigen::VectorXd theta = fit.theta + moved * direction;
    std::vector<RunStart> starts = fit.starts;
    return minimise(problem, theta, starts).cost;
  };
  const double least = cost(0.0);
  const auto end = [&](double sign) {
    const FreeParameter& which = model.free[static_cast<std::size_t>(parameter)];
    const double bound = model.theta_of(parameter, sign > 0.0 ? which.high : which.low);
    const double reach = std::abs(bound - fit.theta[parameter]);
    double inner = 0.0;
    double outer = std::min(2.0 * sd, reach);
    while (cost(sign * outer) - least < kDrop) {
      if (outer >= reach) {
        return bound;
      }
      inner = outer;
      outer = std::min(1.6 * outer, reach);
    }
    std::uintmax_t most = 8;
    const auto excess = [&](double moved) { return cost(sign * moved) - least - kDrop; };
    const auto tolerance = [&](double a, double b) { return std::abs(a - b) < 0.02 * sd; };
    const auto [a, b] = boost::math::tools::toms748_solve(excess, inner, outer, tolerance, most);
    return fit.theta[parameter] + sign * 0.5 * (a + b);
  };
  return {end(-1.0), end(1.0)};
}

}  // namespace heatsoak
