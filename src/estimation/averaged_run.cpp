#include "estimation/averaged_run.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "thermal/network.h"

namespace heatsoak::estimation {
namespace {

constexpr double kSharesOfTimeConstant = 5.0;
/// Short enough to keep the lag of sensors, which is a few seconds, visible.
constexpr double kLongestSegment_s = 3.0;

/// Matrix of one interval, on the stack: one is made for every interval.
using RowMajor =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, thermal::Network::kMostNodes, thermal::Network::kMostNodes>;

}  // namespace

int mergeable_samples(const LinearisedRun& run) {
  Eigen::VectorXd lost = Eigen::VectorXd::Zero(run.states);
  double duration_s = 0.0;
  for (std::size_t k = 0; k < run.duration_s.size(); ++k) {
    const auto place = static_cast<Eigen::Index>(k) * run.states * run.states;
    for (Eigen::Index node = 0; node < run.states; ++node) {
      lost[node] += 1.0 - run.transition[static_cast<std::size_t>(place + node * (run.states + 1))];
    }
    duration_s += run.duration_s[k];
  }
  const double step_s = duration_s / std::max(1.0, static_cast<double>(run.duration_s.size()));
  const double shortest_s = duration_s / std::max(lost.maxCoeff(), 1e-9);
  return std::max(1, static_cast<int>(std::min(shortest_s / kSharesOfTimeConstant, kLongestSegment_s) / std::max(step_s, 1e-9)));
}

Averaging::Averaging(const LinearisedRun& run, const Eigen::VectorXd& weight, int merged)
    : run_(run), merged_(merged), segments_((run.samples() + merged - 1) / merged), sample_weight_(run.residual_K.size()) {
  weight_.setZero(segments_ * run.sensors());
  for (Eigen::Index row = 0; row < sample_weight_.size(); ++row) {
    sample_weight_[row] = std::isnan(run.residual_K[row]) ? 0.0 : (weight.size() > 0 ? weight[row] : 1.0);
    weight_[row / run.sensors() / merged_ * run.sensors() + row % run.sensors()] += sample_weight_[row];
  }
}

Eigen::Index Averaging::middle_of(Eigen::Index segment) const {
  const Eigen::Index first = segment * merged_;
  return (first + std::min(first + merged_, run_.samples()) - 1) / 2;
}

Columns Averaging::average(const Columns& columns) const {
  Columns mean = Columns::Zero(weight_.size(), columns.cols());
  const Eigen::Index sensors = run_.sensors();
  for (Eigen::Index row = 0; row < columns.rows(); ++row) {
    if (sample_weight_[row] > 0.0) {
      mean.row(row / sensors / merged_ * sensors + row % sensors) += sample_weight_[row] * columns.row(row);
    }
  }
  for (Eigen::Index row = 0; row < mean.rows(); ++row) {
    mean.row(row) /= weight_[row] > 0.0 ? weight_[row] : 1.0;
  }
  return mean;
}

LinearisedRun Averaging::run() const {
  const Eigen::Index x = run_.states;
  const Eigen::Index q = run_.fluxes;
  LinearisedRun out;
  out.states = x;
  out.fluxes = q;
  out.sensor_node = run_.sensor_node;
  out.state_C.resize(x, segments_);
  out.residual_K = average(run_.residual_K);
  out.residual_K = (weight_.array() > 0.0).select(out.residual_K, std::numeric_limits<double>::quiet_NaN());
  out.by_start = average(run_.by_start);
  RowMajor transition, injection, covariance_K2, before;
  auto uncertainty = run_.state_uncertainties.begin();
  for (Eigen::Index segment = 0; segment < segments_; ++segment) {
    out.state_C.col(segment) = run_.state_C.col(middle_of(segment));
    if (segment + 1 == segments_) {
      break;
    }
    transition.setIdentity(x, x);
    injection.setZero(x, q);
    covariance_K2.setZero(x, x);
    double duration_s = 0.0;
    bool has_uncertainty = false;
    for (Eigen::Index k = middle_of(segment); k < middle_of(segment + 1); ++k) {
      const Eigen::Map<const RowMajor> step(run_.transition.data() + k * x * x, x, x);
      before = transition;
      transition = step.lazyProduct(before);
      before = injection;
      injection = step.lazyProduct(before) + Eigen::Map<const RowMajor>(run_.injection.data() + k * x * q, x, q);
      duration_s += run_.duration_s[static_cast<std::size_t>(k)];
      while (uncertainty != run_.state_uncertainties.end() && uncertainty->interval < k) {
        ++uncertainty;
      }
      if (has_uncertainty) {
        before = step.lazyProduct(covariance_K2);
        covariance_K2 = before.lazyProduct(step.transpose());
      }
      if (uncertainty != run_.state_uncertainties.end() && uncertainty->interval == k) {
        covariance_K2 += uncertainty->covariance_K2;
        has_uncertainty = true;
      }
    }
    if (has_uncertainty) {
      out.state_uncertainties.push_back({segment, covariance_K2});
    }
    out.transition.insert(out.transition.end(), transition.data(), transition.data() + x * x);
    out.injection.insert(out.injection.end(), injection.data(), injection.data() + x * q);
    out.duration_s.push_back(duration_s);
  }
  return out;
}

std::vector<std::optional<Eigen::Index>> Averaging::interval_of() const {
  std::vector<std::optional<Eigen::Index>> interval(run_.duration_s.size());
  for (Eigen::Index segment = 0; segment + 1 < segments_; ++segment) {
    std::fill(interval.begin() + middle_of(segment), interval.begin() + middle_of(segment + 1), segment);
  }
  return interval;
}

}  // namespace heatsoak::estimation
