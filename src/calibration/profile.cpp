#include "calibration/profile.h"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>

#include "estimation/posterior.h"

namespace heatsoak::calibration {
namespace {

/// Half of the 95 % point of χ² with one degree of freedom.
constexpr double kDrop = 1.92;
/// Largest rise of the cost that the search distinguishes. A simulation that fails has an infinite one, which no interpolation can use.
constexpr double kMostRise_nats = 20.0;

}  // namespace

std::pair<double, double> profile_interval(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs,
                                           const estimation::Fit& fit, int parameter) {
  estimation::PosteriorOptions options = fit.setup.with(fit.flux);
  options.holds_covariance = true;
  options.held = parameter;
  const double sd = std::sqrt(fit.covariance(parameter, parameter));
  const Eigen::VectorXd direction = fit.covariance.col(parameter) / fit.covariance(parameter, parameter);
  const auto cost = [&](double moved) {
    // Start the other parameters at the values that the curvature predicts.
    estimation::Model there = model;
    there.set_theta(fit.theta + moved * direction);
    // Not the sum of squares: the covariance of the unknown heat changes with the parameters, and its determinant counts.
    return -estimation::try_posterior_of(std::move(there), runs, fit.start_C, options).evidence_nats;
  };
  const double least = cost(0.0);
  const auto rise = [&](double moved) { return std::min(cost(moved) - least, kMostRise_nats); };
  const auto end = [&](double sign) {
    const estimation::FreeParameter& which = model.free[static_cast<std::size_t>(parameter)];
    const double bound = model.theta_of(parameter, sign > 0.0 ? which.high : which.low);
    const double reach = std::abs(bound - fit.theta[parameter]);
    double inner = 0.0;
    double outer = std::min(2.0 * sd, reach);
    while (rise(sign * outer) < kDrop) {
      if (outer >= reach) {
        return bound;
      }
      inner = outer;
      outer = std::min(1.6 * outer, reach);
    }
    std::uintmax_t most = 8;
    const auto excess = [&](double moved) { return rise(sign * moved) - kDrop; };
    const auto tolerance = [&](double a, double b) { return std::abs(a - b) < 0.02 * sd; };
    const auto [a, b] = boost::math::tools::toms748_solve(excess, inner, outer, tolerance, most);
    return fit.theta[parameter] + sign * 0.5 * (a + b);
  };
  return {end(-1.0), end(1.0)};
}

}  // namespace heatsoak::calibration
