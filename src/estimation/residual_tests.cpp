#include "estimation/residual_tests.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <numbers>

#include "estimation/thresholds.h"

namespace heatsoak::estimation {
namespace {

constexpr int kCrossLags = 20;

/// Σ a(k+lag)·b(k) over the pairs without NaN, and their number.
struct LaggedSum {
  double sum = 0.0;
  double count = 0.0;
};

LaggedSum lagged(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::Index lag) {
  LaggedSum out;
  for (Eigen::Index k = 0; k + lag < a.size(); ++k) {
    const double product = a[k + lag] * b[k];
    if (!std::isnan(product)) {
      out.sum += product;
      out.count += 1.0;
    }
  }
  return out;
}

/// Returns the values with mean 0 and variance 1, ignoring NaN.
Eigen::VectorXd standardised(const Eigen::VectorXd& values) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const double value : values) {
    if (!std::isnan(value)) {
      sum += value, squares += value * value, count += 1.0;
    }
  }
  const double mean = sum / std::max(1.0, count);
  const double variance = squares / std::max(1.0, count) - mean * mean;
  return (values.array() - mean) / std::sqrt(variance > 0.0 ? variance : 1.0);
}

/// Returns the p-value of the Ljung-Box statistic up to lag 40.
double ljung_box(const Eigen::VectorXd& z, double count) {
  double statistic = 0.0;
  for (int lag = 1; lag <= kMostLag; ++lag) {
    const LaggedSum pair = lagged(z, z, lag);
    if (pair.count > 0.0) {
      const double correlation = pair.sum / pair.count;
      statistic += correlation * correlation * pair.count / count;
    }
  }
  statistic *= count;
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(kMostLag), statistic));
}

/// Returns the largest distance of the cumulative periodogram from a straight line, in units of the 95 % band. At most 400 equally spaced
/// frequencies; gaps count as 0.
double periodogram(const Eigen::VectorXd& z, double count) {
  const Eigen::Index n = z.size();
  const Eigen::Index frequencies = std::min<Eigen::Index>(n / 2, 400);
  std::vector<double> cumulated;
  double total = 0.0;
  // Eight frequencies at a time, with a rotating phasor instead of a sine per sample.
  using Eight = Eigen::Array<double, 8, 1>;
  for (Eigen::Index first = 1; first <= frequencies; first += Eight::SizeAtCompileTime) {
    Eight c, s;
    for (Eigen::Index i = 0; i < c.size(); ++i) {
      const double angle = std::numbers::pi * static_cast<double>(first + i) / static_cast<double>(frequencies + 1);
      c[i] = std::cos(angle), s[i] = std::sin(angle);
    }
    Eight re = Eight::Zero(), im = Eight::Zero(), phase_re = Eight::Ones(), phase_im = Eight::Zero();
    for (const double value : z) {
      if (!std::isnan(value)) {
        re += value * phase_re, im += value * phase_im;
      }
      const Eight next = phase_re * c - phase_im * s;
      phase_im = phase_re * s + phase_im * c;
      phase_re = next;
    }
    for (Eigen::Index i = 0; i < c.size() && first + i <= frequencies; ++i) {
      total += re[i] * re[i] + im[i] * im[i];
      cumulated.push_back(total);
    }
  }
  double distance = 0.0;
  for (std::size_t i = 0; i < cumulated.size(); ++i) {
    distance = std::max(distance, std::abs(cumulated[i] / total - static_cast<double>(i + 1) / static_cast<double>(cumulated.size())));
  }
  const double band = 1.36 / std::sqrt(std::min(count / 2.0, static_cast<double>(frequencies)));
  return distance / band;
}

}  // namespace

InnovationTests test_innovations(std::string signal, const Eigen::VectorXd& innovation, const std::vector<NamedInput>& inputs) {
  InnovationTests out;
  out.signal = std::move(signal);
  double squares = 0.0, fourth = 0.0;
  for (const double value : innovation) {
    if (!std::isnan(value)) {
      squares += value * value;
      fourth += value * value * value * value;
      ++out.count;
    }
  }
  if (out.count < 4 * kMostLag) {
    return out;
  }
  const auto count = static_cast<double>(out.count);
  out.variance_ratio = squares / count;
  out.kurtosis_ratio = fourth * count / (3.0 * squares * squares);
  const Eigen::VectorXd z = standardised(innovation);
  out.ljung_box_probability = ljung_box(z, count);
  out.periodogram_ratio = periodogram(z, count);
  const double limit_sd = largest_sd(thresholds().wrong_answer_share, kCrossLags + 1);
  for (const NamedInput& input : inputs) {
    const Eigen::VectorXd u = standardised(input.values);
    bool is_beyond = false;
    double largest = 0.0;
    for (int lag = 0; lag <= kCrossLags; ++lag) {
      const LaggedSum pair = lagged(z, u, lag);
      const double correlation = pair.count > 0.0 ? pair.sum / pair.count : 0.0;
      is_beyond = is_beyond || std::abs(correlation) > limit_sd / std::sqrt(std::max(1.0, pair.count));
      largest = std::abs(correlation) > std::abs(largest) ? correlation : largest;
    }
    if (is_beyond) {
      out.correlated_with.emplace_back(input.name, largest);
    }
  }
  std::ranges::stable_sort(out.correlated_with, [](const auto& a, const auto& b) { return std::abs(a.second) > std::abs(b.second); });
  return out;
}

}  // namespace heatsoak::estimation
