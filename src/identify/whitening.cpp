#include "identify/whitening.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace heatsoak {
namespace {

/// Most nodes that a network has, each with a flux and a sensor.
constexpr int kMostSize = 3 * (Network::kMostNodes - 1);
constexpr Eigen::Index kStrip = 8;

template <int Size>
using Square = Eigen::Matrix<double, Size, Size, Eigen::RowMajor, Size == Eigen::Dynamic ? kMostSize : Size,
                             Size == Eigen::Dynamic ? kMostSize : Size>;

using ConstRowMajorMap = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

}  // namespace

Whitening::Whitening(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise)
    : run_(&run),
      flux_(flux),
      wander_K_(noise.wander_K),
      wanders_(std::ranges::any_of(noise.wander_K, [](double each_K) { return each_K > 0.0; })),
      size_(run.states + run.fluxes + (wanders_ ? run.sensors() : 0)),
      noise_K_(noise.noise_K) {
  const Eigen::Index rows = run.samples() * run.sensors();
  gain_.resize(static_cast<std::size_t>(rows * size_));
  inverse_sd_per_K_.assign(static_cast<std::size_t>(rows), 0.0);
  expected_K2_.assign(static_cast<std::size_t>(rows), 0.0);
  forget_ratio_.resize(run.duration_s.size());
  for (std::size_t k = 0; k < run.duration_s.size(); ++k) {
    forget_ratio_[k] = std::exp(-run.duration_s[k] / flux.time_scale_s);
    if (wanders_) {
      wander_forget_ratio_.push_back(std::exp(-run.duration_s[k] / noise.wander_time_scale_s));
    }
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

/// [[Φ, Γ, 0], [0, ρ, 0], [0, 0, ρ']] of one interval.
template <class Matrix>
void Whitening::set_transition(Eigen::Index interval, Matrix& transition) const {
  const Eigen::Index x = run_->states;
  const Eigen::Index q = run_->fluxes;
  const auto place = static_cast<std::size_t>(interval);
  transition.setZero();
  transition.topLeftCorner(x, x) = ConstRowMajorMap(run_->transition.data() + interval * x * x, x, x);
  transition.block(0, x, x, q) = ConstRowMajorMap(run_->injection.data() + interval * x * q, x, q);
  transition.diagonal().segment(x, q).setConstant(forget_ratio_[place]);
  if (wanders_) {
    transition.diagonal().tail(run_->sensors()).setConstant(wander_forget_ratio_[place]);
  }
}

template <class Matrix>
void Whitening::add_unknown(Eigen::Index interval, Matrix& covariance) const {
  const auto gained_ratio = [interval](const std::vector<double>& forget_ratio) {
    const double left = interval < 0 ? 0.0 : forget_ratio[static_cast<std::size_t>(interval)];
    return 1.0 - left * left;
  };
  const double of_flux = gained_ratio(forget_ratio_);
  for (Eigen::Index f = 0; f < run_->fluxes; ++f) {
    const double rms_W = flux_.rms_W[static_cast<std::size_t>(f)];
    covariance(run_->states + f, run_->states + f) += of_flux * rms_W * rms_W;
  }
  const auto doubt = std::ranges::lower_bound(run_->doubts, interval, {}, &StateDoubt::interval);
  if (doubt != run_->doubts.end() && doubt->interval == interval) {
    covariance.topLeftCorner(run_->states, run_->states) += doubt->covariance_K2;
  }
  if (wanders_) {
    const double of_wander = gained_ratio(wander_forget_ratio_);
    for (Eigen::Index sensor = 0; sensor < run_->sensors(); ++sensor) {
      const double wander_K = wander_K_[static_cast<std::size_t>(sensor)];
      covariance(wander_place(sensor), wander_place(sensor)) += of_wander * wander_K * wander_K;
    }
  }
}

template <int Size>
void Whitening::build(const SensorNoise& noise) {
  Square<Size> covariance = Square<Size>::Zero(size_, size_);
  Square<Size> transition(size_, size_);
  Square<Size> moved(size_, size_);
  add_unknown(-1, covariance);
  for (Eigen::Index k = 0; k < run_->samples(); ++k) {
    for (Eigen::Index sensor = 0; sensor < run_->sensors(); ++sensor) {
      const Eigen::Index row = k * run_->sensors() + sensor;
      Eigen::Map<Eigen::VectorXd> gain(gain_.data() + row * size_, size_);
      const double weight = noise.weight.size() > 0 ? noise.weight[row] : 1.0;
      const int node = node_of(sensor);
      gain = covariance.col(node);
      if (wanders_) {
        gain += covariance.col(wander_place(sensor));
      }
      const double expected_K2 = wanders_ ? gain[node] + gain[wander_place(sensor)] : gain[node];
      expected_K2_[static_cast<std::size_t>(row)] = expected_K2;
      if (std::isnan(run_->residual_K[row]) || weight <= 0.0) {
        gain.setZero();
        continue;
      }
      const double noise_K = noise.noise_K[static_cast<std::size_t>(sensor)];
      const double variance_K2 = expected_K2 + noise_K * noise_K / weight;
      gain /= variance_K2;
      covariance.noalias() -= variance_K2 * gain.head(size_) * gain.head(size_).transpose();
      inverse_sd_per_K_[static_cast<std::size_t>(row)] = 1.0 / std::sqrt(variance_K2);
      log_determinant_ += std::log(variance_K2);
      ++count_;
    }
    if (k + 1 < run_->samples()) {
      set_transition(k, transition);
      moved.noalias() = transition * covariance;
      covariance.noalias() = moved * transition.transpose();
      add_unknown(k, covariance);
    }
  }
}

/// `kStrip` columns.
void Whitening::apply_to_strip(Eigen::Ref<Columns> columns) const {
  using Row = Eigen::Array<double, 1, kStrip>;
  const Eigen::Index x = run_->states;
  const Eigen::Index q = run_->fluxes;
  std::array<Row, kMostSize> state, moved;
  state.fill(Row::Zero());
  for (Eigen::Index k = 0; k < run_->samples(); ++k) {
    for (Eigen::Index sensor = 0; sensor < run_->sensors(); ++sensor) {
      const Eigen::Index row = k * run_->sensors() + sensor;
      const double inverse_sd_per_K = inverse_sd_per_K_[static_cast<std::size_t>(row)];
      Eigen::Map<Row> shown(columns.data() + row * columns.outerStride());
      if (inverse_sd_per_K == 0.0) {
        shown.setZero();
        continue;
      }
      Row innovation = shown;
      innovation -= state[static_cast<std::size_t>(node_of(sensor))];
      if (wanders_) {
        innovation -= state[static_cast<std::size_t>(wander_place(sensor))];
      }
      const double* const gain = gain_.data() + row * size_;
      for (Eigen::Index i = 0; i < size_; ++i) {
        state[static_cast<std::size_t>(i)] += gain[i] * innovation;
      }
      shown = inverse_sd_per_K * innovation;
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
      for (Eigen::Index j = x; j < x + q; ++j) {
        state[static_cast<std::size_t>(j)] *= forget_ratio_[static_cast<std::size_t>(k)];
      }
      for (Eigen::Index j = x + q; j < size_; ++j) {
        state[static_cast<std::size_t>(j)] *= wander_forget_ratio_[static_cast<std::size_t>(k)];
      }
    }
  }
}

void Whitening::apply(Eigen::Ref<Columns> columns) const {
  // Eight columns at a time: their filter state stays in the innermost cache while the run goes by.
  for (Eigen::Index first = 0; first < columns.cols(); first += kStrip) {
    if (first + kStrip <= columns.cols()) {
      apply_to_strip(columns.middleCols(first, kStrip));
    } else {
      const Eigen::Index rest = columns.cols() - first;
      Columns strip = Columns::Zero(columns.rows(), kStrip);
      strip.leftCols(rest) = columns.rightCols(rest);
      apply_to_strip(strip);
      columns.rightCols(rest) = strip.leftCols(rest);
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
      const double innovation_K = residual_K[row] - state[node_of(sensor)] - (wanders_ ? state[wander_place(sensor)] : 0.0);
      all.standardised[row] = innovation_K / std::sqrt(variance_K2);
      all.noise_share[row] = noise_K * noise_K / variance_K2;
      if (inverse_sd_per_K_[place] > 0.0) {
        state += innovation_K * Eigen::Map<const Eigen::VectorXd>(gain_.data() + row * size_, size_);
      }
    }
    if (k + 1 < run_->samples()) {
      set_transition(k, transition);
      state = transition * state.eval();
    }
  }
  return all;
}

FluxEstimate Whitening::smoothed_flux(const Eigen::VectorXd& residual_K) const {
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
  add_unknown(-1, covariance);
  for (Eigen::Index k = 0; k < samples; ++k) {
    flux_W.col(k) = state.segment(x, q);
    flux_rows.middleCols(k * q, q) = covariance.middleCols(x, q);
    for (Eigen::Index row = k * run_->sensors(); row < (k + 1) * run_->sensors(); ++row) {
      const double inverse_sd_per_K = inverse_sd_per_K_[static_cast<std::size_t>(row)];
      if (inverse_sd_per_K > 0.0) {
        const Eigen::Map<const Eigen::VectorXd> gain(gain_.data() + row * size_, size_);
        const Eigen::Index sensor = row - k * run_->sensors();
        innovation[row] = residual_K[row] - state[node_of(sensor)] - (wanders_ ? state[wander_place(sensor)] : 0.0);
        state += innovation[row] * gain;
        covariance -= gain * gain.transpose() / (inverse_sd_per_K * inverse_sd_per_K);
      }
    }
    if (k + 1 < samples) {
      set_transition(k, transition);
      state = transition * state.eval();
      covariance = transition * covariance.eval() * transition.transpose();
      add_unknown(k, covariance);
    }
  }
  Eigen::MatrixXd sd_W(q, samples);
  Eigen::VectorXd adjoint = Eigen::VectorXd::Zero(size_);
  Dynamic information = Dynamic::Zero(size_, size_);  // about the state, from this sample on
  for (Eigen::Index k = samples - 1; k >= 0; --k) {
    for (Eigen::Index sensor = run_->sensors() - 1; sensor >= 0; --sensor) {
      const Eigen::Index row = k * run_->sensors() + sensor;
      const double inverse_sd_per_K = inverse_sd_per_K_[static_cast<std::size_t>(row)];
      if (inverse_sd_per_K > 0.0) {
        const Eigen::Map<const Eigen::VectorXd> gain(gain_.data() + row * size_, size_);
        const double moved = innovation[row] * inverse_sd_per_K * inverse_sd_per_K - gain.dot(adjoint);
        Eigen::VectorXd seen = Eigen::VectorXd::Zero(size_);
        seen[node_of(sensor)] = 1.0;
        if (wanders_) {
          seen[wander_place(sensor)] = 1.0;
        }
        adjoint += moved * seen;
        const Eigen::VectorXd across = information * gain;
        information += (gain.dot(across) + inverse_sd_per_K * inverse_sd_per_K) * seen * seen.transpose() - seen * across.transpose() -
                       across * seen.transpose();
      }
    }
    const auto rows = flux_rows.middleCols(k * q, q);
    flux_W.col(k) += rows.transpose() * adjoint;
    sd_W.col(k) = (rows.middleRows(x, q) - rows.transpose() * information * rows).diagonal().cwiseMax(0.0).cwiseSqrt();
    if (k > 0) {
      set_transition(k - 1, transition);
      adjoint = transition.transpose() * adjoint.eval();
      information = transition.transpose() * information.eval() * transition;
    }
  }
  return {std::move(flux_W), std::move(sd_W)};
}

}  // namespace heatsoak
