#include "friction/wheel_terms.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "robot/friction.h"

namespace heatsoak::friction {
namespace {

constexpr double kIndependent_share = 0.05;
constexpr std::size_t kLegsPerTerm = 3;
constexpr double kPhaseStep_rad = std::numbers::pi / 180.0;

double regressor(const WheelPoint& point, int wheel, WheelTerm term) {
  switch (term) {
    case WheelTerm::damping:
      return point.part->wheel_speed_rad_per_s[wheel];
    case WheelTerm::sine:
      return point.sine_ratio;
    case WheelTerm::cosine:
      return point.cosine_ratio;
    case WheelTerm::constant:
      return point.part->is_rotation ? 0.0 : point.side;
    case WheelTerm::rotation:
      return point.part->is_rotation ? point.side : 0.0;
  }
  return 0.0;
}

Eigen::MatrixXd design(const std::vector<WheelPoint>& points, int wheel, const std::vector<WheelTerm>& terms) {
  Eigen::MatrixXd X(points.size(), terms.size());
  for (std::size_t row = 0; row < points.size(); ++row) {
    for (std::size_t column = 0; column < terms.size(); ++column) {
      X(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) = regressor(points[row], wheel, terms[column]);
    }
  }
  return X;
}

bool is_identifiable(const Eigen::MatrixXd& X, const std::vector<WheelTerm>& terms, WheelTerm term) {
  const auto place = std::ranges::find(terms, term);
  return place != terms.end() && independent_share(X, place - terms.begin()) >= kIndependent_share;
}

/// True if a and b are identifiable for every φ within its uncertainty. Otherwise both would diverge for some φ.
bool friction_is_identifiable(const std::vector<WheelPoint>& points, int wheel, const std::vector<WheelTerm>& terms,
                              double phase_uncertainty_rad) {
  const int steps = static_cast<int>(std::ceil(phase_uncertainty_rad / kPhaseStep_rad));
  for (int step = -steps; step <= steps; ++step) {
    const Eigen::MatrixXd X = design(turned(points, steps == 0 ? 0.0 : phase_uncertainty_rad * step / steps), wheel, terms);
    if (!is_identifiable(X, terms, WheelTerm::sine) || !is_identifiable(X, terms, WheelTerm::constant)) {
      return false;
    }
  }
  return true;
}

}  // namespace

bool is_used(const SteadyPart& part, const FitSettings& settings) { return settings.use_return_legs || !part.is_return; }

WheelPoints points_of(const std::vector<SteadyPart>& parts, const robot::Kinematics& kinematics, int wheel, const FitSettings& settings) {
  WheelPoints found;
  const double phase_rad = robot::rolling_phase_rad(kinematics.wheels[wheel]);
  for (const SteadyPart& part : parts) {
    if (!is_used(part, settings)) {
      continue;
    }
    const double speed_rad_per_s = part.wheel_speed_rad_per_s[wheel];
    WheelPoint point{&part, 0.0, 0.0, speed_rad_per_s > 0.0 ? 1 : -1};
    double expected = part.yaw_rad_per_s;
    if (!part.is_rotation) {
      point.sine_ratio = std::sin(part.heading_rad + phase_rad);
      point.cosine_ratio = std::cos(part.heading_rad + phase_rad);
      expected = should_stand(kinematics.wheels[wheel], part.heading_rad) ? 0.0 : point.sine_ratio;
    }
    // The sign of a mean speed within its own noise is unknown.
    const double uncertainty_rad_per_s = 3.0 * part.speed_noise_rad_per_s[wheel] / std::sqrt(std::max(1, part.rows_kept[wheel]));
    if (expected * speed_rad_per_s <= 0.0 || std::abs(speed_rad_per_s) <= uncertainty_rad_per_s || !std::isfinite(part.voltage_V[wheel])) {
      ++found.standing;
    } else {
      found.points.push_back(point);
    }
  }
  return found;
}

std::vector<WheelPoint> turned(std::vector<WheelPoint> points, double offset_rad) {
  for (WheelPoint& point : points) {
    const double sine = std::cos(offset_rad) * point.sine_ratio + std::sin(offset_rad) * point.cosine_ratio;
    point.cosine_ratio = std::cos(offset_rad) * point.cosine_ratio - std::sin(offset_rad) * point.sine_ratio;
    point.sine_ratio = sine;
  }
  return points;
}

ChosenTerms chosen_terms(const std::vector<WheelPoint>& points, int wheel, const FitSettings& settings) {
  ChosenTerms chosen;
  const auto turns = std::ranges::count_if(points, [](const WheelPoint& point) { return point.part->is_rotation; });
  const bool travels = turns < std::ssize(points);
  std::vector<WheelTerm>& terms = chosen.terms;
  terms = {WheelTerm::damping};
  if (travels) {
    terms.insert(terms.end(), {WheelTerm::sine, WheelTerm::constant, WheelTerm::cosine});
  }
  if (turns > 0) {
    terms.push_back(WheelTerm::rotation);
  }
  if (travels && !is_identifiable(design(points, wheel, terms), terms, WheelTerm::cosine)) {
    std::erase(terms, WheelTerm::cosine);
    chosen.phase_is_given = true;
  }
  if (!is_identifiable(design(points, wheel, terms), terms, WheelTerm::damping)) {
    if (!travels || !settings.known_damping_V_s_per_rad) {
      chosen.problem = WheelProblem::one_speed;
      return chosen;
    }
    std::erase(terms, WheelTerm::damping);
    chosen.damping_is_given = true;
  }
  if (travels && !friction_is_identifiable(points, wheel, terms, chosen.phase_is_given ? settings.phase_uncertainty_rad : 0.0)) {
    chosen.problem = WheelProblem::too_few_headings;
  } else if (points.size() < terms.size() + 3) {
    chosen.problem = WheelProblem::too_few_legs;
  }
  return chosen;
}

WheelRegression regression_of(const std::vector<WheelPoint>& points, int wheel, const std::vector<WheelTerm>& terms,
                              double given_V_s_per_rad) {
  WheelRegression asked{design(points, wheel, terms), Eigen::VectorXd(points.size()), {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SteadyPart& part = *points[i].part;
    asked.voltage_V(static_cast<Eigen::Index>(i)) = part.voltage_V[wheel] - given_V_s_per_rad * part.wheel_speed_rad_per_s[wheel];
    asked.legs.push_back(part.leg);
  }
  // With few legs the scatter between legs is unknown; then each segment is its own cluster.
  if (std::set<int>(asked.legs.begin(), asked.legs.end()).size() < kLegsPerTerm * terms.size()) {
    std::iota(asked.legs.begin(), asked.legs.end(), 0);
  }
  return asked;
}

}  // namespace heatsoak::friction
