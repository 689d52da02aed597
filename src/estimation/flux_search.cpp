#include "estimation/flux_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

namespace heatsoak::estimation {
namespace {

constexpr double kLeastShare = 1e-3;
constexpr double kMostShare = kMostFlux_share;
constexpr double kLeastDrift_share = 1e-4;
constexpr double kMostDrift_share = 0.2;
constexpr double kReference_s = 160.0;
constexpr double kDriftReference_s = 10.0;
/// Upper limit of a standard deviation (in logarithms). With a larger one the data do not determine the coordinate.
constexpr double kWidest = 1.2;

/// Coordinates of the search: ln(rms / mean heat / √(time scale / kReference_s)) for each flux, then ln(time scale in s). Over times that
/// are short against the time scale, the effect of a flux depends on this ratio alone. If sensors drift, the same follows for the drift.
class Space {
 public:
  Space(const SuppositionRange& range, bool drifts)
      : range_(range),
        fluxes_(static_cast<Eigen::Index>(range.fluxes)),
        kinds_(drifts ? static_cast<Eigen::Index>(range.drift_unit_K.size()) : 0) {}

  [[nodiscard]] Eigen::Index size() const { return fluxes_ + 1 + (kinds_ > 0 ? kinds_ + 1 : 0); }
  [[nodiscard]] Eigen::VectorXd inside(Eigen::VectorXd x) const {
    clamp(x.head(fluxes_ + 1), {kLeastShare, kMostShare}, {range_.shortest_s, range_.longest_s}, kReference_s);
    const double half = shift(x[fluxes_], kReference_s);
    for (std::size_t i = 0; i < range_.least_W.size(); ++i) {
      if (const double least = std::log(range_.least_W[i] / range_.unit_W); std::isfinite(least)) {
        // Heat that is certain to exist may exceed the limit for other unknown heat.
        x[static_cast<Eigen::Index>(i)] = std::max(x[static_cast<Eigen::Index>(i)], least - half);
      }
    }
    if (kinds_ > 0) {
      clamp(x.tail(kinds_ + 1), {kLeastDrift_share, kMostDrift_share}, {range_.drift_shortest_s, range_.drift_longest_s},
            kDriftReference_s);
    }
    return x;
  }
  [[nodiscard]] Supposition supposition(const Eigen::VectorXd& x) const {
    Supposition all;
    all.flux.time_scale_s = std::exp(x[fluxes_]);
    for (Eigen::Index i = 0; i < fluxes_; ++i) {
      all.flux.rms_W.push_back(range_.unit_W * std::exp(x[i] + shift(x[fluxes_], kReference_s)));
    }
    if (kinds_ > 0) {
      const double time_scale = x[size() - 1];
      all.drift_time_scale_s = std::exp(time_scale);
      for (Eigen::Index i = 0; i < kinds_; ++i) {
        const double unit_K = range_.drift_unit_K[static_cast<std::size_t>(i)];
        all.drift_K.push_back(unit_K * std::exp(x[fluxes_ + 1 + i] + shift(time_scale, kDriftReference_s)));
      }
    }
    return all;
  }
  [[nodiscard]] Eigen::VectorXd point(const Supposition& supposition) const {
    Eigen::VectorXd x(size());
    x[fluxes_] = std::log(supposition.flux.time_scale_s);
    for (Eigen::Index i = 0; i < fluxes_; ++i) {
      const double share = supposition.flux.rms_W[static_cast<std::size_t>(i)] / range_.unit_W;
      x[i] = std::log(std::max(share, kLeastShare)) - shift(x[fluxes_], kReference_s);
    }
    if (kinds_ > 0) {
      const double time_scale = x[size() - 1] = std::log(supposition.drift_time_scale_s);
      for (Eigen::Index i = 0; i < kinds_; ++i) {
        const auto kind = static_cast<std::size_t>(i);
        const double share = supposition.drift_K[kind] / range_.drift_unit_K[kind];
        x[fluxes_ + 1 + i] = std::log(std::max(share, kLeastDrift_share)) - shift(time_scale, kDriftReference_s);
      }
    }
    return inside(x);
  }

 private:
  static double shift(double log_time_scale, double reference_s) { return 0.5 * (log_time_scale - std::log(reference_s)); }
  /// Clamps `x`, which holds the sizes first and the time scale last.
  static void clamp(Eigen::Ref<Eigen::VectorXd> x, std::pair<double, double> share, std::pair<double, double> time_scale_s,
                    double reference_s) {
    double& time_scale = x[x.size() - 1];
    time_scale = std::clamp(time_scale, std::log(time_scale_s.first), std::log(time_scale_s.second));
    const double half = shift(time_scale, reference_s);
    for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
      x[i] = std::clamp(x[i], std::log(share.first) - half, std::log(share.second) - half);
    }
  }

  const SuppositionRange& range_;
  Eigen::Index fluxes_;
  Eigen::Index kinds_;
};

std::vector<double> at(const Evidence& evidence, const Space& space, const std::vector<Eigen::VectorXd>& points) {
  std::vector<Supposition> all;
  for (const Eigen::VectorXd& x : points) {
    all.push_back(space.supposition(x));
  }
  return evidence(all);
}

/// Hill climbing. Tries steps of ±`width` along every coordinate, then all improving steps together, and takes the best. Moves `x` and
/// returns its evidence.
double ascend(const Evidence& evidence, const Space& space, double width, double value, Eigen::VectorXd& x) {
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
    // All improving coordinates move together; if that is not better, only the best one moves.
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
  Eigen::MatrixXd bend;  ///< Hessian of −ln(evidence)
};

/// Gradient and Hessian at `x` by finite differences with step `width`.
Curvature curvature(const Evidence& evidence, const Space& space, double width, double value, const Eigen::VectorXd& x) {
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
  auto pair = static_cast<std::size_t>(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i + 1; j < n; ++j, pair += 2) {
      const double mixed = (values[pair] + values[pair + 1] - 2.0 * value) / (width * width);
      all.bend(i, j) = all.bend(j, i) = -0.5 * (mixed + all.bend(i, i) + all.bend(j, j));
    }
  }
  return all;
}

/// Corners of the n-dimensional cube ±1. Above four dimensions, a fractional factorial design of resolution IV or more: coordinate five
/// is the product of the first four (n = 5) or three (n = 6), coordinate six that of the second to fourth.
std::vector<Eigen::VectorXd> corners(Eigen::Index n) {
  std::vector<Eigen::VectorXd> all;
  const Eigen::Index full = std::min<Eigen::Index>(n, 4);
  for (unsigned corner = 0; corner < (1U << full); ++corner) {
    Eigen::VectorXd z(n);
    for (Eigen::Index i = 0; i < full; ++i) {
      z[i] = (corner >> i) & 1U ? 1.0 : -1.0;
    }
    if (n == 5) {
      z[4] = z.head(4).prod();
    } else if (n > 5) {
      z[4] = z.head(3).prod();
      z[5] = z.segment(1, 3).prod();
    }
    all.push_back(z);
  }
  return all;
}

}  // namespace

Supposition most_probable(const Evidence& evidence, const SuppositionRange& range, const Supposition& start) {
  const Space space(range, !start.drift_K.empty());
  const bool is_warm = !start.flux.rms_W.empty();
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
  return space.supposition(at(evidence, space, {next}).front() > value ? next : x);
}

Supposition with_drift(const SuppositionRange& range, const Supposition& start) {
  Supposition all = start;
  constexpr double kUsualDrift_share = 0.01;
  constexpr double kUsualFlux_share = 0.02;
  for (double& rms_W : all.flux.rms_W) {
    rms_W = std::min(rms_W, kUsualFlux_share * range.unit_W);
  }
  all.flux.time_scale_s = std::clamp(kReference_s, range.shortest_s, range.longest_s);
  all.drift_K = range.drift_unit_K;
  for (double& drift_K : all.drift_K) {
    drift_K *= kUsualDrift_share;
  }
  all.drift_time_scale_s = kDriftReference_s;
  return all;
}

std::vector<WeightedSupposition> suppositions_around(const Evidence& evidence, const SuppositionRange& range, const Supposition& best) {
  const Space space(range, !best.drift_K.empty());
  const Eigen::Index n = space.size();
  const Eigen::VectorXd centre = space.point(best);
  const double value = at(evidence, space, {centre}).front();
  const Curvature here = curvature(evidence, space, std::log(1.2), value, centre);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(here.bend);
  const Eigen::VectorXd sd = solver.eigenvalues().cwiseMax(1.0 / (kWidest * kWidest)).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd axes = solver.eigenvectors() * sd.asDiagonal();
  // Corners of a cube and ends of the axes, all on a sphere of radius kReach·√n.
  constexpr double kReach = 1.1;
  const double radius = kReach * std::sqrt(static_cast<double>(n));
  std::vector<Eigen::VectorXd> points{centre};
  for (Eigen::Index i = 0; i < n; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      points.push_back(space.inside(centre + sign * radius * axes.col(i)));
    }
  }
  for (const Eigen::VectorXd& z : corners(n)) {
    points.push_back(space.inside(centre + kReach * axes * z));
  }
  const std::vector<double> values = at(evidence, space, points);
  const double most = *std::ranges::max_element(values);
  const auto outer = static_cast<double>(points.size() - 1);
  // These weights reproduce the mass and the variances of a Gaussian; the centre has weight 1.
  const double outer_weight = std::exp(0.5 * radius * radius) / (outer * (kReach * kReach - 1.0));
  std::vector<WeightedSupposition> all;
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double area = i == 0 ? 1.0 : outer_weight;
    all.push_back({space.supposition(points[i]), area * std::exp(values[i] - most)});
    sum += all.back().weight;
  }
  for (WeightedSupposition& each : all) {
    each.weight /= sum;
  }
  return all;
}

}  // namespace heatsoak::estimation
