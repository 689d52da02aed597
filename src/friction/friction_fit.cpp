#include "friction/friction_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "friction/lack_of_fit.h"
#include "friction/wheel_terms.h"
#include "robot/friction.h"

namespace heatsoak::friction {
namespace {

constexpr double kSameHeading_rad = 2.5 * std::numbers::pi / 180.0;
constexpr double kSpeedLevels_share = 0.15;
constexpr double kPi = std::numbers::pi;

/// Limits of φ − φ_0 within which every wheel turns in the measured direction.
std::pair<double, double> phase_bounds_rad(const std::vector<WheelPoint>& points, const Eigen::VectorXd& weights) {
  double below_rad = kPi / 2.0;
  double above_rad = kPi / 2.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].part->is_rotation || weights(static_cast<Eigen::Index>(i)) <= 0.0) {
      continue;
    }
    const double past_rad = std::atan2(points[i].sine_ratio * points[i].side, points[i].cosine_ratio * points[i].side);  // 0 … π
    below_rad = std::min(below_rad, past_rad);
    above_rad = std::min(above_rad, kPi - past_rad);
  }
  return {-below_rad, above_rad};
}

/// Fieller's interval of δ: all m = tan δ for which B − A·m does not differ significantly from 0. nullopt if it is unbounded.
std::optional<std::pair<double, double>> fieller_rad(double A, double B, const Eigen::Matrix2d& covariance, double t) {
  const double square = t * t;
  const double second = A * A - square * covariance(0, 0);
  const double first = A * B - square * covariance(0, 1);
  const double zeroth = B * B - square * covariance(1, 1);
  const double root = first * first - second * zeroth;
  if (second <= 0.0 || root < 0.0) {
    return std::nullopt;
  }
  return std::pair(std::atan((first - std::sqrt(root)) / second), std::atan((first + std::sqrt(root)) / second));
}

struct SineAndPhase {
  Estimate sine_V;
  Estimate offset_rad;  ///< φ − φ_0
};

Estimate moved(const Estimate& estimate, double value) {
  const auto& interval = estimate.interval;
  return {value, interval ? std::optional(Interval{value + interval->low - estimate.value, value + interval->high - estimate.value})
                          : std::nullopt};
}

/// Converts A and B to a and φ − φ_0. The interval of φ is Fieller's; value and interval are limited to the bounds.
SineAndPhase sine_and_phase(const RobustFit& fit, Eigen::Index sine, Eigen::Index cosine, std::pair<double, double> bounds_rad) {
  const Eigen::Vector2d both_V(fit.coefficients(sine), fit.coefficients(cosine));
  Eigen::Matrix2d covariance;
  covariance << fit.covariance(sine, sine), fit.covariance(sine, cosine), fit.covariance(cosine, sine), fit.covariance(cosine, cosine);
  double offset_rad = std::atan2(both_V.y(), both_V.x());
  if (std::abs(offset_rad) > kPi / 2.0) {
    offset_rad -= std::copysign(kPi, offset_rad);  // a < 0
  }
  const double value_rad = std::clamp(offset_rad, bounds_rad.first, bounds_rad.second);
  const Eigen::Vector2d along(std::cos(value_rad), std::sin(value_rad));
  const double half_V = fit.quantile_factor(sine) * std::sqrt(along.dot(covariance * along));
  const double sine_V = along.dot(both_V);
  const auto interval_rad = fieller_rad(both_V.x(), both_V.y(), covariance, fit.quantile_factor(cosine)).value_or(bounds_rad);
  // If the value is moved to a bound, its interval moves too, so that it does not vanish there.
  const double past_rad = value_rad - offset_rad;
  const double low_rad = std::min(interval_rad.first, interval_rad.first + past_rad);
  const double high_rad = std::max(interval_rad.second, interval_rad.second + past_rad);
  return {estimate_around(sine_V, half_V),
          {value_rad, Interval{std::clamp(low_rad, bounds_rad.first, value_rad), std::clamp(high_rad, value_rad, bounds_rad.second)}}};
}

/// Returns the best a and b for a fixed φ, with all other coefficients as fitted.
Eigen::Vector2d sine_and_constant_at(const Eigen::MatrixXd& X, const Eigen::VectorXd& voltage_V, std::span<const int> legs,
                                     const RobustFit& fit, std::array<Eigen::Index, 3> sine_cosine_constant, double offset_rad) {
  const auto [sine, cosine, constant] = sine_cosine_constant;
  Eigen::MatrixXd both(X.rows(), 2);
  both << std::cos(offset_rad) * X.col(sine) + std::sin(offset_rad) * X.col(cosine), X.col(constant);
  Eigen::VectorXd others = fit.coefficients;
  others(sine) = others(cosine) = others(constant) = 0.0;
  return robust_fit(both, voltage_V - X * others, legs).coefficients;
}

/// Estimates of all terms at φ_0. Their intervals cover the change of each term while φ varies over its uncertainty.
std::vector<Estimate> estimates_with_phase_error(const std::vector<WheelPoint>& points, int wheel, const std::vector<WheelTerm>& terms,
                                                 double given_V_s_per_rad, const RobustFit& fit, double left_V,
                                                 double phase_uncertainty_rad) {
  std::vector<Estimate> estimates;
  for (Eigen::Index term = 0; term < std::ssize(terms); ++term) {
    estimates.push_back(fit.estimate(term));
  }
  if (phase_uncertainty_rad == 0.0) {
    return estimates;
  }
  const std::pair<double, double> bounds_rad = phase_bounds_rad(points, fit.weights);
  for (const double end_rad : {std::max(-phase_uncertainty_rad, bounds_rad.first), std::min(phase_uncertainty_rad, bounds_rad.second)}) {
    const auto [X, voltage_V, legs] = regression_of(turned(points, end_rad), wheel, terms, given_V_s_per_rad);
    RobustFit there = robust_fit(X, voltage_V, legs);
    widen(points, X, left_V, there);
    for (Eigen::Index term = 0; term < std::ssize(terms); ++term) {
      Estimate& estimate = estimates[static_cast<std::size_t>(term)];
      const Estimate end = there.estimate(term);
      if (!end.interval || !estimate.interval) {
        continue;
      }
      const double half = end.interval->high - end.value;
      const double by = end.value - estimate.value;
      Interval& interval = *estimate.interval;
      interval.low = std::min(interval.low, estimate.value - std::hypot(std::min(0.0, by), half));
      interval.high = std::max(interval.high, estimate.value + std::hypot(std::max(0.0, by), half));
    }
  }
  return estimates;
}

double wrapped_rad(double angle_rad) { return std::remainder(angle_rad, 2.0 * kPi); }

void judge(const std::vector<WheelPoint>& points, const Eigen::VectorXd& weights, int wheel, WheelFriction& found) {
  double mean_V = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    mean_V += weights(static_cast<Eigen::Index>(i)) * points[i].part->voltage_V[wheel] / weights.sum();
  }
  double error_V2 = 0.0;
  double variance_V2 = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double weight = weights(static_cast<Eigen::Index>(i));
    const SteadyPart& part = *points[i].part;
    const double speed_rad_per_s = part.wheel_speed_rad_per_s[wheel];
    const double expected_V = part.is_rotation
                                  ? found.damping_V_s_per_rad->value * speed_rad_per_s + found.rotation_V->value * points[i].side
                                  : found.voltage_V(part.heading_rad, speed_rad_per_s);
    error_V2 += weight * (part.voltage_V[wheel] - expected_V) * (part.voltage_V[wheel] - expected_V);
    variance_V2 += weight * (part.voltage_V[wheel] - mean_V) * (part.voltage_V[wheel] - mean_V);
    const bool outlies = weight <= 0.0;
    found.parts_outlying += outlies ? 1 : 0;
    found.parts_used += outlies ? 0 : 1;
    found.rows_used += outlies ? 0U : static_cast<std::size_t>(part.rows_kept[wheel]);
  }
  found.rmse_V = std::sqrt(error_V2 / weights.sum());
  found.r2_ratio = variance_V2 > 0.0 ? std::optional(1.0 - error_V2 / variance_V2) : std::nullopt;
}

WheelFriction fit_wheel(const WheelPoints& wheel_points, std::span<const std::optional<int>> heading, const robot::Kinematics& kinematics,
                        int wheel, const FitSettings& settings, Eigen::VectorXd& weights) {
  const std::vector<WheelPoint>& points = wheel_points.points;
  WheelFriction found;
  found.parts_standing = wheel_points.standing;
  if (points.size() < 4) {
    found.problem = WheelProblem::hardly_turns;
    return found;
  }
  if (std::ranges::all_of(points,
                          [&](const WheelPoint& each) { return each.part->voltage_V[wheel] == points.front().part->voltage_V[wheel]; })) {
    found.problem = WheelProblem::constant_voltage;
    return found;
  }
  const ChosenTerms chosen = chosen_terms(points, wheel, settings);
  found.problem = chosen.problem;
  if (!found.is_learned()) {
    return found;
  }
  found.damping_is_given = chosen.damping_is_given;
  found.phase_is_given = chosen.phase_is_given;
  const double given = chosen.damping_is_given ? settings.known_damping_V_s_per_rad.value() : 0.0;
  const WheelRegression asked = regression_of(points, wheel, chosen.terms, given);
  const auto& [X, voltage_V, legs] = asked;
  RobustFit fit = robust_fit(X, voltage_V, legs);
  weights = fit.weights;
  found.lack = lack_of_fit(points, heading, asked, chosen.terms, fit);
  const double left_V = found.lack.is_found ? found.lack.left_V.value() : 0.0;
  widen(points, X, left_V, fit);
  const auto place = [&](WheelTerm term) { return std::ranges::find(chosen.terms, term) - chosen.terms.begin(); };
  const auto has = [&](WheelTerm term) { return place(term) < std::ssize(chosen.terms); };
  const std::vector<Estimate> estimates = estimates_with_phase_error(points, wheel, chosen.terms, given, fit, left_V,
                                                                     chosen.phase_is_given ? settings.phase_uncertainty_rad : 0.0);
  const auto estimate = [&](WheelTerm term) {
    return has(term) ? std::optional(estimates[static_cast<std::size_t>(place(term))]) : std::nullopt;
  };
  found.damping_V_s_per_rad = has(WheelTerm::damping) ? estimate(WheelTerm::damping) : Estimate{.value = given};
  found.rotation_V = estimate(WheelTerm::rotation);
  found.constant_V = estimate(WheelTerm::constant);
  const double phase_rad = robot::rolling_phase_rad(kinematics.wheels[wheel]);
  if (has(WheelTerm::cosine)) {
    const Eigen::Index sine = place(WheelTerm::sine);
    const Eigen::Index cosine = place(WheelTerm::cosine);
    const std::pair<double, double> bounds_rad = phase_bounds_rad(points, fit.weights);
    SineAndPhase both = sine_and_phase(fit, sine, cosine, bounds_rad);
    const double offset_rad = both.offset_rad.value;
    found.phase_is_bounded = offset_rad <= bounds_rad.first || offset_rad >= bounds_rad.second;
    if (found.phase_is_bounded) {
      // Keep the width of the intervals without the bound.
      const Eigen::Vector2d held_V = sine_and_constant_at(X, voltage_V, legs, fit, {sine, cosine, place(WheelTerm::constant)}, offset_rad);
      both.sine_V = moved(both.sine_V, held_V.x());
      found.constant_V = moved(*found.constant_V, held_V.y());
    }
    found.sine_V = both.sine_V;
    found.phase_rad = moved(both.offset_rad, wrapped_rad(phase_rad + offset_rad));
  } else if (has(WheelTerm::sine)) {
    found.sine_V = estimate(WheelTerm::sine);
    found.phase_rad = Estimate{.value = wrapped_rad(phase_rad)};
  }
  if (chosen.damping_is_given && has(WheelTerm::sine)) {
    Eigen::VectorXd driven_V(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      driven_V(static_cast<Eigen::Index>(i)) = given * points[i].part->wheel_speed_rad_per_s[wheel];
    }
    const Eigen::MatrixXd weighted = fit.weights.asDiagonal() * X;
    found.sine_per_damping_V = (X.transpose() * weighted).ldlt().solve(weighted.transpose() * driven_V)[place(WheelTerm::sine)];
  }
  judge(points, fit.weights, wheel, found);
  return found;
}

/// Straight line of voltage over speed on one heading; only the offset if the heading has one speed.
struct StraightLine {
  double heading_rad = 0.0;
  RobustFit fit;            ///< ordinary least squares; the fit over all headings has already removed outliers
  Eigen::MatrixXd inverse;  ///< (XᵀX)⁻¹
  double error_V2 = 0.0;    ///< sum of squared residuals
  double freedom_count = 0.0;
};

StraightLine straight_line(const std::vector<const SteadyPart*>& parts, int wheel, const WheelFriction& found) {
  StraightLine line;
  double x = 0.0;
  double y = 0.0;
  std::vector<double> speeds_rad_per_s;
  for (const SteadyPart* part : parts) {
    x += std::cos(part->heading_rad);
    y += std::sin(part->heading_rad);
    speeds_rad_per_s.push_back(part->wheel_speed_rad_per_s[wheel]);
  }
  line.heading_rad = std::atan2(y, x);
  const auto [slowest, fastest] = std::ranges::minmax(speeds_rad_per_s, {}, [](double speed) { return std::abs(speed); });
  const bool has_slope = std::abs(fastest) - std::abs(slowest) > kSpeedLevels_share * std::abs(fastest);
  Eigen::MatrixXd X = Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(parts.size()), has_slope ? 2 : 1);
  Eigen::VectorXd voltage_V(X.rows());
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    const SteadyPart& part = *parts[static_cast<std::size_t>(i)];
    voltage_V(i) = part.voltage_V[wheel] - (has_slope ? 0.0 : found.damping_V_s_per_rad->value * part.wheel_speed_rad_per_s[wheel]);
    if (has_slope) {
      X(i, 1) = part.wheel_speed_rad_per_s[wheel];
    }
  }
  line.inverse = (X.transpose() * X).inverse();
  line.fit.coefficients = line.inverse * X.transpose() * voltage_V;
  line.error_V2 = (voltage_V - X * line.fit.coefficients).squaredNorm();
  line.freedom_count = static_cast<double>(X.rows() - X.cols());
  return line;
}

/// Straight lines of all headings of a wheel. One heading has too few legs, so the scatter is estimated from all headings.
std::vector<HeadingLine> lines_of(const std::vector<WheelPoint>& points, const Eigen::VectorXd& weights,
                                  const std::vector<SteadyPart>& parts, const std::vector<std::optional<int>>& numbers, int wheel,
                                  const WheelFriction& found) {
  std::map<int, std::vector<const SteadyPart*>> by_heading;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::optional<int> number = numbers[static_cast<std::size_t>(points[i].part - parts.data())];
    if (number && weights(static_cast<Eigen::Index>(i)) > 0.0) {
      by_heading[*number].push_back(points[i].part);
    }
  }
  std::vector<StraightLine> straight;
  double error_V2 = 0.0;
  double freedom_count = 0.0;
  for (const auto& [number, members] : by_heading) {
    straight.push_back(straight_line(members, wheel, found));
    error_V2 += straight.back().error_V2;
    freedom_count += straight.back().freedom_count;
  }
  std::vector<HeadingLine> lines;
  for (StraightLine& line : straight) {
    HeadingLine& made = lines.emplace_back(HeadingLine{.heading_rad = line.heading_rad, .offset_V = {}, .damping_V_s_per_rad = {}});
    const bool has_slope = line.fit.coefficients.size() == 2;
    if (freedom_count > 0.0) {
      line.fit.covariance = line.inverse * error_V2 / freedom_count;
      line.fit.freedom_counts = Eigen::VectorXd::Constant(line.fit.coefficients.size(), freedom_count);
      made.offset_V = line.fit.estimate(0);
      made.damping_V_s_per_rad = has_slope ? std::optional(line.fit.estimate(1)) : std::nullopt;
    } else {
      made.offset_V.value = line.fit.coefficients(0);
      made.damping_V_s_per_rad = has_slope ? std::optional(Estimate{.value = line.fit.coefficients(1)}) : std::nullopt;
    }
  }
  std::ranges::sort(lines, {}, [](const HeadingLine& line) { return line.heading_rad; });
  return lines;
}

}  // namespace

double WheelFriction::friction_V(double heading_rad) const {
  const double s = std::sin(heading_rad + phase_rad->value);
  return sine_V->value * s + (s >= 0.0 ? constant_V->value : -constant_V->value);
}

double WheelFriction::voltage_V(double heading_rad, double wheel_speed_rad_per_s) const {
  const double size_V = std::copysign(1.0, std::sin(heading_rad + phase_rad->value)) * friction_V(heading_rad);
  return damping_V_s_per_rad->value * wheel_speed_rad_per_s + (wheel_speed_rad_per_s < 0.0 ? -size_V : size_V);
}

bool FrictionFit::is_learned() const {
  return std::ranges::any_of(wheels, [](const WheelFriction& wheel) { return wheel.is_learned(); });
}

namespace {

/// Number of distinct headings. An absent number is smaller than every other.
int heading_count(std::span<const std::optional<int>> numbers) {
  const auto last = std::ranges::max_element(numbers);
  return last != numbers.end() && *last ? **last + 1 : 0;
}

}  // namespace

std::vector<std::optional<int>> heading_numbers(const std::vector<SteadyPart>& parts, const FitSettings& settings) {
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), 0U);
  std::erase_if(order, [&](std::size_t i) { return parts[i].is_rotation || !is_used(parts[i], settings); });
  const auto turn_rad = [&](std::size_t i) {
    return wrapped_rad(parts[i].heading_rad + kSameHeading_rad / 2.0);
  };  // so that 0° and −0° are one heading
  std::ranges::stable_sort(order, {}, turn_rad);
  std::vector<std::optional<int>> numbers(parts.size());
  std::optional<int> number;
  double first_rad = 0.0;
  for (const std::size_t i : order) {
    if (!number || turn_rad(i) - first_rad > kSameHeading_rad) {
      number = number ? *number + 1 : 0;
      first_rad = turn_rad(i);
    }
    numbers[i] = number;
  }
  return numbers;
}

FrictionFit fit_friction(const std::vector<SteadyPart>& parts, const robot::Kinematics& kinematics, const FitSettings& settings) {
  FrictionFit found;
  const std::vector<std::optional<int>> numbers = heading_numbers(parts, settings);
  found.headings = heading_count(numbers);
  for (int wheel = 0; wheel < kinematics.wheel_count; ++wheel) {
    const WheelPoints points = points_of(parts, kinematics, wheel, settings);
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(points.points.size()));
    std::vector<std::optional<int>> heading;
    std::ranges::transform(points.points, std::back_inserter(heading),
                           [&](const WheelPoint& point) { return numbers[static_cast<std::size_t>(point.part - parts.data())]; });
    found.wheels.push_back(fit_wheel(points, heading, kinematics, wheel, settings, weights));
    found.lines.push_back(lines_of(points.points, weights, parts, numbers, wheel, found.wheels.back()));
  }
  return found;
}

namespace {

/// Root of the mean of squares; nothing without any.
std::optional<double> rms(double sum_of_squares, double count) {
  return count > 0.0 ? std::optional(std::sqrt(sum_of_squares / count)) : std::nullopt;
}

}  // namespace

HeldOutError error_on_held_out_headings(const std::vector<SteadyPart>& parts, const robot::Kinematics& kinematics,
                                        const FitSettings& settings, const ExpectedVoltages& before) {
  HeldOutError error;
  const std::vector<std::optional<int>> numbers = heading_numbers(parts, settings);
  std::vector<SteadyPart> taught;
  std::vector<SteadyPart> held_out;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    (numbers[i] && *numbers[i] % 3 == 2 ? held_out : taught).push_back(parts[i]);
  }
  error.all_headings = heading_count(numbers);
  error.headings = error.all_headings / 3;
  FitSettings values_only = settings;
  values_only.phase_uncertainty_rad = 0.0;  // affects only intervals; if a and b are indistinguishable, the prediction is not worse
  const FrictionFit fit = fit_friction(taught, kinematics, values_only);
  double before_V2 = 0.0;
  double after_V2 = 0.0;
  double all = 0.0;
  for (int wheel = 0; wheel < kinematics.wheel_count; ++wheel) {
    const WheelFriction& learned = fit.wheels[static_cast<std::size_t>(wheel)];
    const bool predicts = learned.constant_V.has_value();
    double before_of_wheel_V2 = 0.0;
    double after_of_wheel_V2 = 0.0;
    double count = 0.0;
    for (const WheelPoint& point : points_of(held_out, kinematics, wheel, settings).points) {
      const SteadyPart& part = *point.part;
      const double measured_V = part.voltage_V[wheel];
      const double after_V = predicts ? measured_V - learned.voltage_V(part.heading_rad, part.wheel_speed_rad_per_s[wheel]) : 0.0;
      const double before_V = before ? measured_V - before(part)[wheel] : 0.0;
      before_of_wheel_V2 += before_V * before_V;
      after_of_wheel_V2 += after_V * after_V;
      count += 1.0;
    }
    error.before_of_wheel_V.push_back(before ? rms(before_of_wheel_V2, count) : std::nullopt);
    error.after_of_wheel_V.push_back(predicts ? rms(after_of_wheel_V2, count) : std::nullopt);
    if (predicts) {
      before_V2 += before_of_wheel_V2;
      after_V2 += after_of_wheel_V2;
      all += count;
    }
  }
  error.before_V = before ? rms(before_V2, all) : std::nullopt;
  error.after_V = rms(after_V2, all);
  return error;
}

}  // namespace heatsoak::friction
