#include "friction/lack_of_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <map>
#include <set>

namespace heatsoak::friction {
namespace {

constexpr double kFalseAlarm_share = 1e-3;
constexpr double kLeastFreedom_count = 5.0;
/// Smallest error worth reporting, as a share of the friction. A smaller one is irrelevant for a firmware.
constexpr double kMatters_share = 0.02;
constexpr std::array kMissingHarmonics{2.0, 3.0};

/// Mean residual of each repeat, per group. Within a group the law predicts the same value.
using LeftByGroup = std::map<int, std::vector<double>>;

struct RepeatGroups {
  Repeats kind = Repeats::legs_on_one_heading;
  std::vector<std::optional<int>> group;  ///< per point; empty: in no group
  std::vector<std::optional<int>> repeat;
};

/// Possible kinds of repeats, best first. Neighbouring headings also differ slightly by the error of the law itself.
std::vector<RepeatGroups> repeats_of(const std::vector<WheelPoint>& points, std::span<const std::optional<int>> heading) {
  const std::vector<std::optional<int>> headings(heading.begin(), heading.end());
  std::vector<std::optional<int>> legs(points.size()), parts(points.size()), pairs(points.size());
  std::set<int> driven;
  for (const std::optional<int>& each : headings) {
    if (each) {
      driven.insert(*each);
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    legs[i] = points[i].part->leg;
    parts[i] = static_cast<int>(i);
    if (headings[i]) {
      pairs[i] = static_cast<int>(std::distance(driven.begin(), driven.find(*headings[i]))) / 2;
    }
  }
  return {{Repeats::legs_on_one_heading, headings, legs},
          {Repeats::speeds_of_one_leg, headings, parts},
          {Repeats::neighbouring_headings, pairs, headings}};
}

LeftByGroup left_by_group(const RepeatGroups& repeats, const Eigen::VectorXd& left_V, const Eigen::VectorXd& weights) {
  std::map<std::pair<int, std::optional<int>>, std::vector<double>> units;
  for (std::size_t i = 0; i < repeats.group.size(); ++i) {
    if (repeats.group[i] && weights(static_cast<Eigen::Index>(i)) > 0.0) {
      units[{*repeats.group[i], repeats.repeat[i]}].push_back(left_V(static_cast<Eigen::Index>(i)));
    }
  }
  LeftByGroup found;
  for (const auto& [key, values] : units) {
    found[key.first].push_back(Eigen::VectorXd::Map(values.data(), std::ssize(values)).mean());
  }
  return found;
}

double repeats_count(const LeftByGroup& left) {
  double count = 0.0;
  for (const auto& [group, values] : left) {
    count += static_cast<double>(values.size()) - 1.0;
  }
  return count;
}

/// One-way analysis of variance. `heading_terms` is the number of fitted terms that act between groups, `other_terms` that within groups.
LackOfFit compared(const LeftByGroup& left, double heading_terms, double other_terms) {
  double between_V2 = 0.0;
  double within_V2 = 0.0;
  double all = 0.0;
  double squares = 0.0;
  for (const auto& [group, values] : left) {
    const auto V = Eigen::VectorXd::Map(values.data(), std::ssize(values));
    const auto count = static_cast<double>(values.size());
    between_V2 += count * V.mean() * V.mean();
    within_V2 += (V.array() - V.mean()).square().sum();
    all += count;
    squares += count * count;
  }
  const auto groups = static_cast<double>(left.size());
  const double between_count = groups - heading_terms;
  const double within_count = repeats_count(left) - other_terms;
  LackOfFit found;
  if (between_count < 1.0 || within_count < kLeastFreedom_count) {
    return found;
  }
  const double within_mean_V2 = within_V2 / within_count;
  const double per_group = (all - squares / all) / (groups - 1.0);
  found.repeats_V = std::sqrt(within_mean_V2);
  found.left_V = std::sqrt(std::max(0.0, between_V2 / between_count - within_mean_V2) / per_group);
  const double most_ratio =
      boost::math::quantile(boost::math::complement(boost::math::fisher_f(between_count, within_count), kFalseAlarm_share));
  found.is_found = between_V2 / between_count > most_ratio * within_mean_V2;
  return found;
}

Eigen::MatrixXd missing_harmonics(const std::vector<WheelPoint>& points) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(std::ssize(points), 2 * std::ssize(kMissingHarmonics));
  for (Eigen::Index i = 0; i < columns.rows(); ++i) {
    const SteadyPart& part = *points[static_cast<std::size_t>(i)].part;
    for (Eigen::Index k = 0; !part.is_rotation && k < std::ssize(kMissingHarmonics); ++k) {
      const double turn_rad = kMissingHarmonics[static_cast<std::size_t>(k)] * part.heading_rad;
      columns(i, 2 * k) = std::cos(turn_rad);
      columns(i, 2 * k + 1) = std::sin(turn_rad);
    }
  }
  return columns;
}

}  // namespace

LackOfFit lack_of_fit(const std::vector<WheelPoint>& points, std::span<const std::optional<int>> heading, const WheelRegression& asked,
                      const std::vector<WheelTerm>& terms, const RobustFit& fit) {
  const Eigen::VectorXd left_V = asked.voltage_V - asked.X * fit.coefficients;
  const auto has = [&](WheelTerm term) { return std::ranges::find(terms, term) != terms.end() ? 1.0 : 0.0; };
  const double other_terms = has(WheelTerm::damping);
  const double heading_terms = static_cast<double>(terms.size()) - other_terms - has(WheelTerm::rotation);
  LackOfFit found;
  for (const RepeatGroups& repeats : repeats_of(points, heading)) {
    found = compared(left_by_group(repeats, left_V, fit.weights), heading_terms, other_terms);
    if (found.repeats_V) {
      found.repeats = repeats.kind;
      break;
    }
  }
  double friction_V = 0.0;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const bool is_friction = terms[k] != WheelTerm::damping && terms[k] != WheelTerm::rotation;
    friction_V += is_friction ? std::abs(fit.coefficients(static_cast<Eigen::Index>(k))) : 0.0;
  }
  found.is_found = found.is_found && found.left_V.value() > kMatters_share * friction_V;
  return found;
}

void widen(const std::vector<WheelPoint>& points, const Eigen::MatrixXd& X, double left_V, RobustFit& fit) {
  if (left_V <= 0.0) {
    return;
  }
  const Eigen::VectorXd root = fit.weights.cwiseSqrt();
  const Eigen::MatrixXd harmonics = root.asDiagonal() * missing_harmonics(points);
  const Eigen::MatrixXd moved = (root.asDiagonal() * X).colPivHouseholderQr().solve(harmonics);
  const Eigen::MatrixXd stays = harmonics - root.asDiagonal() * X * moved;
  const Eigen::MatrixXd seen = stays.transpose() * stays / fit.weights.sum();
  fit.covariance += left_V * left_V / seen.trace() * moved * moved.transpose();
  // The amplitude of the error is estimated from these harmonics, which limits the degrees of freedom.
  fit.freedom_counts = fit.freedom_counts.cwiseMin(seen.trace() * seen.trace() / seen.squaredNorm());
}

}  // namespace heatsoak::friction
