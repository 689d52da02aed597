#include "identify/flux_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

namespace heatsoak {
namespace {

constexpr double kLeastShare = 1e-3;
constexpr double kMostShare = 2.0;
constexpr double kReference_s = 160.0;
/// Beyond this a coordinate is not told by the data, and a standard deviation says nothing.
constexpr double kWidest = 1.2;

/// Coordinates: the logarithm of the time scale in s, and for each flux that of its size, in units of the mean heat, over the root of the
/// time scale in kReference_s: what a flux does within a time that is short against its own scale hangs on this ratio alone.
class Space {
 public:
  explicit Space(const FluxRange& range) : range_(range) {}

  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(range_.count) + 1; }
  [[nodiscard]] Eigen::VectorXd inside(Eigen::VectorXd x) const {
    double& time_scale = x[size() - 1];
    time_scale = std::clamp(time_scale, std::log(range_.shortest_s), std::log(range_.longest_s));
    for (Eigen::Index i = 0; i + 1 < size(); ++i) {
      const double half = shift(time_scale);
      x[i] = std::clamp(x[i], std::log(kLeastShare) - half, std::log(kMostShare) - half);
    }
    return x;
  }
  [[nodiscard]] LatentFlux flux(const Eigen::VectorXd& x) const {
    LatentFlux flux;
    flux.time_scale_s = std::exp(x[size() - 1]);
    for (Eigen::Index i = 0; i + 1 < size(); ++i) {
      flux.rms_W.push_back(range_.unit_W * std::exp(x[i] + shift(x[size() - 1])));
    }
    return flux;
  }
  [[nodiscard]] Eigen::VectorXd point(const LatentFlux& flux) const {
    Eigen::VectorXd x(size());
    x[size() - 1] = std::log(flux.time_scale_s);
    for (Eigen::Index i = 0; i + 1 < size(); ++i) {
      x[i] = std::log(std::max(flux.rms_W[static_cast<std::size_t>(i)] / range_.unit_W, kLeastShare)) - shift(x[size() - 1]);
    }
    return inside(x);
  }

 private:
  static double shift(double log_time_scale) { return 0.5 * (log_time_scale - std::log(kReference_s)); }

  const FluxRange& range_;
};

std::vector<double> at(const FluxEvidence& evidence, const Space& space, const std::vector<Eigen::VectorXd>& points) {
  std::vector<LatentFlux> fluxes;
  for (const Eigen::VectorXd& x : points) {
    fluxes.push_back(space.flux(x));
  }
  return evidence(fluxes);
}

/// Steps of ±width along one coordinate at a time, all tried at once, the best one taken; together with it the best of the others.
double ascend(const FluxEvidence& evidence, const Space& space, double width, double value, Eigen::VectorXd& x) {
  constexpr int kMostMoves = 20;
  for (int move = 0; move < kMostMoves; ++move) {
    std::vector<Eigen::VectorXd> tried;
    for (Eigen::Index i = 0; i < space.size(); ++i) {
      for (const double sign : {-1.0, 1.0}) {
        Eigen::VectorXd next = x;
        next[i] += sign * width;
        tried.push_back(space.inside(next));
      }
    }
    const std::vector<double> values = at(evidence, space, tried);
    // All coordinates that gain move together; where that does not help, the best one alone.
    Eigen::VectorXd together = x;
    for (Eigen::Index i = 0; i < space.size(); ++i) {
      const auto low = static_cast<std::size_t>(2 * i);
      const std::size_t better = values[low] > values[low + 1] ? low : low + 1;
      if (values[better] > value) {
        together[i] = tried[better][i];
      }
    }
    const double joint = at(evidence, space, {together}).front();
    const auto best = std::ranges::max_element(values);
    if (joint > value && joint >= *best) {
      value = joint;
      x = together;
    } else if (*best > value) {
      value = *best;
      x = tried[static_cast<std::size_t>(best - values.begin())];
    } else {
      break;
    }
  }
  return value;
}

struct Curvature {
  Eigen::VectorXd slope;
  Eigen::MatrixXd bend;  ///< of minus the logarithm of the evidence
};

/// By differences of `width`.
Curvature curvature(const FluxEvidence& evidence, const Space& space, double width, double value, const Eigen::VectorXd& x) {
  const Eigen::Index n = space.size();
  std::vector<Eigen::VectorXd> points;
  const auto add = [&](Eigen::Index i, double by_i, Eigen::Index j, double by_j) {
    Eigen::VectorXd next = x;
    next[i] += by_i * width;
    next[j] += by_j * width;
    points.push_back(next);
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    add(i, 1.0, i, 0.0);
    add(i, -1.0, i, 0.0);
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i + 1; j < n; ++j) {
      add(i, 1.0, j, 1.0);
      add(i, -1.0, j, -1.0);
    }
  }
  const std::vector<double> values = at(evidence, space, points);
  Curvature all{Eigen::VectorXd(n), Eigen::MatrixXd(n, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const double up = values[static_cast<std::size_t>(2 * i)];
    const double down = values[static_cast<std::size_t>(2 * i + 1)];
    all.slope[i] = (up - down) / (2.0 * width);
    all.bend(i, i) = -(up + down - 2.0 * value) / (width * width);
  }
  std::size_t pair = static_cast<std::size_t>(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i + 1; j < n; ++j, pair += 2) {
      const double mixed = (values[pair] + values[pair + 1] - 2.0 * value) / (width * width);
      all.bend(i, j) = all.bend(j, i) = -0.5 * (mixed + all.bend(i, i) + all.bend(j, j));
    }
  }
  return all;
}

}  // namespace

LatentFlux most_probable_flux(const FluxEvidence& evidence, const FluxRange& range, const LatentFlux& start) {
  const Space space(range);
  const bool is_warm = !start.rms_W.empty();
  Eigen::VectorXd x(space.size());
  if (is_warm) {
    x = space.point(start);
  } else {
    x.setConstant(std::log(0.02));
    x[space.size() - 1] = std::log(kReference_s);
    x = space.inside(x);
  }
  double value = at(evidence, space, {x}).front();
  if (!is_warm) {
    value = ascend(evidence, space, std::log(4.0), value, x);
    value = ascend(evidence, space, std::log(2.0), value, x);
  }
  value = ascend(evidence, space, std::log(1.4), value, x);
  const Curvature here = curvature(evidence, space, std::log(1.2), value, x);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(here.bend);
  const Eigen::VectorXd strength = solver.eigenvalues().cwiseMax(1.0 / (kWidest * kWidest));
  Eigen::VectorXd step = solver.eigenvectors() * (solver.eigenvectors().transpose() * here.slope).cwiseQuotient(strength);
  step = step.cwiseMax(-0.5).cwiseMin(0.5);
  const Eigen::VectorXd next = space.inside(x + step);
  return space.flux(at(evidence, space, {next}).front() > value ? next : x);
}

std::vector<WeightedFlux> hypotheses_around(const FluxEvidence& evidence, const FluxRange& range, const LatentFlux& best) {
  const Space space(range);
  const Eigen::Index n = space.size();
  const Eigen::VectorXd centre = space.point(best);
  const double value = at(evidence, space, {centre}).front();
  const Curvature here = curvature(evidence, space, std::log(1.2), value, centre);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(here.bend);
  const Eigen::VectorXd sd = solver.eigenvalues().cwiseMax(1.0 / (kWidest * kWidest)).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd axes = solver.eigenvectors() * sd.asDiagonal();
  // Corners of a cube and ends of its axes, all on a sphere of radius f·√n.
  constexpr double kReach = 1.1;
  const double radius = kReach * std::sqrt(static_cast<double>(n));
  std::vector<Eigen::VectorXd> points{centre};
  for (Eigen::Index i = 0; i < n; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      points.push_back(space.inside(centre + sign * radius * axes.col(i)));
    }
  }
  for (unsigned corner = 0; corner < (1U << n); ++corner) {
    Eigen::VectorXd z(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      z[i] = (corner >> i) & 1U ? kReach : -kReach;
    }
    points.push_back(space.inside(centre + axes * z));
  }
  const std::vector<double> values = at(evidence, space, points);
  const double most = *std::ranges::max_element(values);
  const auto outer = static_cast<double>(points.size() - 1);
  // So that a Gaussian keeps its mass and its variances; the centre weighs 1.
  const double outer_weight = std::exp(0.5 * radius * radius) / (outer * (kReach * kReach - 1.0));
  std::vector<WeightedFlux> all;
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double area = i == 0 ? 1.0 : outer_weight;
    all.push_back({space.flux(points[i]), area * std::exp(values[i] - most)});
    sum += all.back().weight;
  }
  for (WeightedFlux& each : all) {
    each.weight /= sum;
  }
  return all;
}

}  // namespace heatsoak
