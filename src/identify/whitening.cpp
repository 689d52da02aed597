#include "identify/whitening.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace heatsoak {
namespace {

/// Most nodes that a network has, each with a flux.
constexpr int kMostSize = 2 * (Network::kMostNodes - 1);
constexpr Eigen::Index kStrip = 8;

template <int Size>
using Square = Eigen::Matrix<double, Size, Size, Eigen::RowMajor, Size == Eigen::Dynamic ? kMostSize : Size,
                             Size == Eigen::Dynamic ? kMostSize : Size>;

using RowMajorMap = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

/// [[Φ, Γ], [0, ρ]] of one interval.
template <int Size>
void set_transition(const LinearisedRun& run, Eigen::Index interval, double forget_ratio, Square<Size>& transition) {
  const Eigen::Index x = run.states;
  const Eigen::Index q = run.fluxes;
  transition.setZero();
  transition.topLeftCorner(x, x) = RowMajorMap(run.transition.data() + interval * x * x, x, x);
  transition.topRightCorner(x, q) = RowMajorMap(run.injection.data() + interval * x * q, x, q);
  transition.bottomRightCorner(q, q).diagonal().setConstant(forget_ratio);
}

}  // namespace

Whitening::Whitening(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise)
    : run_(&run), flux_(flux), size_(run.states + run.fluxes) {
  const Eigen::Index rows = run.samples() * run.sensors();
  gain_.resize(static_cast<std::size_t>(rows * size_));
  inverse_sd_per_K_.assign(static_cast<std::size_t>(rows), 0.0);
  expected_K2_.assign(static_cast<std::size_t>(rows), 0.0);
  noise_K_ = noise.noise_K;
  forget_ratio_.resize(run.duration_s.size());
  for (std::size_t k = 0; k < run.duration_s.size(); ++k) {
    forget_ratio_[k] = std::exp(-run.duration_s[k] / flux.time_scale_s);
  }
  switch (size_) {
    case 4:
      build<4>(noise);
      break;
    case 5:
      build<5>(noise);
      break;
    case 6:
      build<6>(noise);
      break;
    default:
      build<Eigen::Dynamic>(noise);
  }
}

template <int Size>
void Whitening::build(const SensorNoise& noise) {
  const Eigen::Index x = run_->states;
  Square<Size> covariance = Square<Size>::Zero(size_, size_);
  Square<Size> transition(size_, size_);
  Square<Size> moved(size_, size_);
  for (Eigen::Index f = 0; f < run_->fluxes; ++f) {
    const double rms_W = flux_.rms_W[static_cast<std::size_t>(f)];
    covariance(x + f, x + f) = rms_W * rms_W;
  }
  for (Eigen::Index k = 0; k < run_->samples(); ++k) {
    for (Eigen::Index sensor = 0; sensor < run_->sensors(); ++sensor) {
      const Eigen::Index row = k * run_->sensors() + sensor;
      Eigen::Map<Eigen::VectorXd> gain(gain_.data() + row * size_, size_);
      const double weight = noise.weight.size() > 0 ? noise.weight[row] : 1.0;
      const int node = run_->sensor_node[static_cast<std::size_t>(sensor)];
      expected_K2_[static_cast<std::size_t>(row)] = covariance(node, node);
      if (std::isnan(run_->residual_K[row]) || weight <= 0.0) {
        gain.setZero();
        continue;
      }
      const double noise_K = noise.noise_K[static_cast<std::size_t>(sensor)];
      const double variance_K2 = covariance(node, node) + noise_K * noise_K / weight;
      gain = covariance.col(node) / variance_K2;
      covariance.noalias() -= variance_K2 * gain.head(size_) * gain.head(size_).transpose();
      inverse_sd_per_K_[static_cast<std::size_t>(row)] = 1.0 / std::sqrt(variance_K2);
      log_determinant_ += std::log(variance_K2);
      ++count_;
    }
    if (k + 1 < run_->samples()) {
      const double forget_ratio = forget_ratio_[static_cast<std::size_t>(k)];
      set_transition<Size>(*run_, k, forget_ratio, transition);
      moved.noalias() = transition * covariance;
      covariance.noalias() = moved * transition.transpose();
      for (Eigen::Index f = 0; f < run_->fluxes; ++f) {
        const double rms_W = flux_.rms_W[static_cast<std::size_t>(f)];
        covariance(x + f, x + f) += (1.0 - forget_ratio * forget_ratio) * rms_W * rms_W;
      }
    }
  }
}

template <bool IsWhole>
void Whitening::apply_to_strip(Eigen::Ref<Columns> columns) const {
  using Row = Eigen::Array<double, 1, kStrip>;
  const Eigen::Index x = run_->states;
  const Eigen::Index q = run_->fluxes;
  // Known when compiled where it can be: a call that copies eight numbers costs more than they do.
  const Eigen::Index count = IsWhole ? kStrip : columns.cols();
  std::array<Row, kMostSize> state, moved;
  state.fill(Row::Zero());
  for (Eigen::Index k = 0; k < run_->samples(); ++k) {
    for (Eigen::Index sensor = 0; sensor < run_->sensors(); ++sensor) {
      const Eigen::Index row = k * run_->sensors() + sensor;
      const double inverse_sd_per_K = inverse_sd_per_K_[static_cast<std::size_t>(row)];
      double* const shown = columns.data() + row * columns.outerStride();
      if (inverse_sd_per_K == 0.0) {
        std::fill_n(shown, count, 0.0);
        continue;
      }
      Row innovation = Row::Zero();
      std::copy_n(shown, count, innovation.data());
      innovation -= state[static_cast<std::size_t>(run_->sensor_node[static_cast<std::size_t>(sensor)])];
      const double* const gain = gain_.data() + row * size_;
      for (Eigen::Index i = 0; i < size_; ++i) {
        state[static_cast<std::size_t>(i)] += gain[i] * innovation;
      }
      innovation *= inverse_sd_per_K;
      std::copy_n(innovation.data(), count, shown);
    }
    if (k + 1 < run_->samples()) {
      const double* const transition = run_->transition.data() + k * x * x;
      const double* const injection = run_->injection.data() + k * x * q;
      for (Eigen::Index i = 0; i < x; ++i) {
        Row sum = transition[i * x] * state[0];
        for (Eigen::Index j = 1; j < x; ++j) {
          sum += transition[i * x + j] * state[static_cast<std::size_t>(j)];
        }
        for (Eigen::Index j = 0; j < q; ++j) {
          sum += injection[i * q + j] * state[static_cast<std::size_t>(x + j)];
        }
        moved[static_cast<std::size_t>(i)] = sum;
      }
      std::copy_n(moved.begin(), x, state.begin());
      for (Eigen::Index j = x; j < size_; ++j) {
        state[static_cast<std::size_t>(j)] *= forget_ratio_[static_cast<std::size_t>(k)];
      }
    }
  }
}

void Whitening::apply(Eigen::Ref<Columns> columns) const {
  // Eight columns at a time: their filter state stays in the innermost cache while the run goes by.
  for (Eigen::Index first = 0; first < columns.cols(); first += kStrip) {
    if (first + kStrip <= columns.cols()) {
      apply_to_strip<true>(columns.middleCols(first, kStrip));
    } else {
      apply_to_strip<false>(columns.rightCols(columns.cols() - first));
    }
  }
}

Innovations Whitening::innovations(const Eigen::VectorXd& residual_K) const {
  Innovations all{residual_K, residual_K};
  Eigen::VectorXd state = Eigen::VectorXd::Zero(size_);
  Square<Eigen::Dynamic> transition(size_, size_);
  for (Eigen::Index k = 0; k < run_->samples(); ++k) {
    for (Eigen::Index sensor = 0; sensor < run_->sensors(); ++sensor) {
      const Eigen::Index row = k * run_->sensors() + sensor;
      const auto place = static_cast<std::size_t>(row);
      const double noise_K = noise_K_[static_cast<std::size_t>(sensor)];
      const double variance_K2 = expected_K2_[place] + noise_K * noise_K;
      const double innovation_K = residual_K[row] - state[run_->sensor_node[static_cast<std::size_t>(sensor)]];
      all.standardised[row] = innovation_K / std::sqrt(variance_K2);
      all.noise_share[row] = noise_K * noise_K / variance_K2;
      if (inverse_sd_per_K_[place] > 0.0) {
        state += innovation_K * Eigen::Map<const Eigen::VectorXd>(gain_.data() + row * size_, size_);
      }
    }
    if (k + 1 < run_->samples()) {
      set_transition<Eigen::Dynamic>(*run_, k, forget_ratio_[static_cast<std::size_t>(k)], transition);
      state = transition * state.eval();
    }
  }
  return all;
}

Eigen::MatrixXd Whitening::smoothed_flux_W(const Eigen::VectorXd& residual_K) const {
  using Dynamic = Square<Eigen::Dynamic>;
  const Eigen::Index x = run_->states;
  const Eigen::Index q = run_->fluxes;
  const Eigen::Index samples = run_->samples();
  Eigen::MatrixXd flux_W(q, samples);             // predicted, then smoothed
  Eigen::MatrixXd flux_rows(size_, q * samples);  // covariance of the fluxes with the state, before the sample's update
  Eigen::VectorXd innovation(residual_K.size());
  Eigen::VectorXd state = Eigen::VectorXd::Zero(size_);
  Dynamic covariance = Dynamic::Zero(size_, size_);
  Dynamic transition(size_, size_);
  const auto add_flux = [&](double share) {
    for (Eigen::Index f = 0; f < q; ++f) {
      const double rms_W = flux_.rms_W[static_cast<std::size_t>(f)];
      covariance(x + f, x + f) += share * rms_W * rms_W;
    }
  };
  add_flux(1.0);
  for (Eigen::Index k = 0; k < samples; ++k) {
    flux_W.col(k) = state.tail(q);
    flux_rows.middleCols(k * q, q) = covariance.rightCols(q);
    for (Eigen::Index row = k * run_->sensors(); row < (k + 1) * run_->sensors(); ++row) {
      const double inverse_sd_per_K = inverse_sd_per_K_[static_cast<std::size_t>(row)];
      if (inverse_sd_per_K > 0.0) {
        const Eigen::Map<const Eigen::VectorXd> gain(gain_.data() + row * size_, size_);
        innovation[row] = residual_K[row] - state[run_->sensor_node[static_cast<std::size_t>(row - k * run_->sensors())]];
        state += innovation[row] * gain;
        covariance -= gain * gain.transpose() / (inverse_sd_per_K * inverse_sd_per_K);
      }
    }
    if (k + 1 < samples) {
      const double forget_ratio = forget_ratio_[static_cast<std::size_t>(k)];
      set_transition<Eigen::Dynamic>(*run_, k, forget_ratio, transition);
      state = transition * state.eval();
      covariance = transition * covariance.eval() * transition.transpose();
      add_flux(1.0 - forget_ratio * forget_ratio);
    }
  }
  Eigen::VectorXd adjoint = Eigen::VectorXd::Zero(size_);
  for (Eigen::Index k = samples - 1; k >= 0; --k) {
    for (Eigen::Index sensor = run_->sensors() - 1; sensor >= 0; --sensor) {
      const Eigen::Index row = k * run_->sensors() + sensor;
      const double inverse_sd_per_K = inverse_sd_per_K_[static_cast<std::size_t>(row)];
      if (inverse_sd_per_K > 0.0) {
        const Eigen::Map<const Eigen::VectorXd> gain(gain_.data() + row * size_, size_);
        const int node = run_->sensor_node[static_cast<std::size_t>(sensor)];
        adjoint[node] += innovation[row] * inverse_sd_per_K * inverse_sd_per_K - gain.dot(adjoint);
      }
    }
    flux_W.col(k) += flux_rows.middleCols(k * q, q).transpose() * adjoint;
    if (k > 0) {
      set_transition<Eigen::Dynamic>(*run_, k - 1, forget_ratio_[static_cast<std::size_t>(k - 1)], transition);
      adjoint = transition.transpose() * adjoint.eval();
    }
  }
  return flux_W;
}

}  // namespace heatsoak
