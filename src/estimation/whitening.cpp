#include "estimation/whitening.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace heatsoak::estimation {
namespace {

/// Largest filter state: every state node of the largest network has a flux and a drifting sensor.
constexpr int kMostSize = 3 * (thermal::Network::kMostNodes - 1);
constexpr Eigen::Index kStrip = 8;

/// Layout of the filter's state: X temperatures, Q fluxes, W sensor drifts, in this order.
template <int X, int Q, int W>
struct Fixed {
  static constexpr int kMost = X + Q + W;
  static constexpr Eigen::Index states() { return X; }
  static constexpr Eigen::Index fluxes() { return Q; }
  static constexpr Eigen::Index drifts() { return W; }
  static constexpr Eigen::Index size() { return X + Q + W; }
};

struct Counted {
  static constexpr int kMost = kMostSize;
  Eigen::Index x, q, w;
  [[nodiscard]] Eigen::Index states() const { return x; }
  [[nodiscard]] Eigen::Index fluxes() const { return q; }
  [[nodiscard]] Eigen::Index drifts() const { return w; }
  [[nodiscard]] Eigen::Index size() const { return x + q + w; }
};

/// Square matrix of the size of the filter's state; does not allocate memory on the heap.
using SquareOfState = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMostSize, kMostSize>;

using ConstRowMajorMap = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

}  // namespace

Whitening::Whitening(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise)
    : run_(&run),
      flux_(flux),
      drifts_(flux.drift_K > 0.0),
      size_(run.states + run.fluxes + (drifts_ ? run.sensors() : 0)),
      noise_K_(noise.noise_K) {
  const Eigen::Index rows = run.samples() * run.sensors();
  gain_.resize(static_cast<std::size_t>(rows * size_));
  inverse_sd_per_K_.assign(static_cast<std::size_t>(rows), 0.0);
  expected_K2_.assign(static_cast<std::size_t>(rows), 0.0);
  forget_ratio_.resize(run.duration_s.size());
  for (std::size_t k = 0; k < run.duration_s.size(); ++k) {
    forget_ratio_[k] = std::exp(-run.duration_s[k] / flux.time_scale_s);
    if (drifts_) {
      drift_forget_ratio_.push_back(std::exp(-run.duration_s[k] / flux.drift_time_scale_s));
    }
  }
  for_layout([&](const auto& layout) { build(layout, noise); });
}

template <class With>
void Whitening::for_layout(const With& with) const {
  const Counted counted{run_->states, run_->fluxes, size_ - run_->states - run_->fluxes};
  const auto is_taken = [&](const auto& layout) {
    const bool fits = counted.x == layout.states() && counted.q == layout.fluxes() && counted.w == layout.drifts();
    if (fits) {
      with(layout);
    }
    return fits;
  };
  if (!(is_taken(Fixed<2, 2, 0>()) || is_taken(Fixed<2, 2, 1>()) || is_taken(Fixed<2, 2, 2>()) || is_taken(Fixed<3, 2, 0>()) ||
        is_taken(Fixed<3, 2, 2>()) || is_taken(Fixed<3, 3, 0>()))) {
    with(counted);
  }
}

Whitening::Step Whitening::step_of(Eigen::Index interval) const {
  const auto place = static_cast<std::size_t>(interval);
  return {run_->transition.data() + interval * run_->states * run_->states, run_->injection.data() + interval * run_->states * run_->fluxes,
          forget_ratio_[place], drifts_ ? drift_forget_ratio_[place] : 1.0};
}

/// Sets the transition matrix of one interval, F = [[Φ, Γ, 0], [0, ρ, 0], [0, 0, ρ']].
template <class Matrix>
void Whitening::set_transition(Eigen::Index interval, Matrix& transition) const {
  const Eigen::Index x = run_->states;
  const Eigen::Index q = run_->fluxes;
  const Step step = step_of(interval);
  transition.setZero();
  transition.topLeftCorner(x, x) = ConstRowMajorMap(step.transition, x, x);
  transition.block(0, x, x, q) = ConstRowMajorMap(step.injection, x, q);
  transition.diagonal().segment(x, q).setConstant(step.forget_ratio);
  transition.diagonal().tail(size_ - x - q).setConstant(step.drift_forget_ratio);
}

/// Replaces the covariance P by F·P·Fᵀ; exploits that most of F is zero. `moved` is workspace for F·P.
template <class Layout, class Matrix>
void Whitening::predict(const Layout& layout, const Step& step, Matrix& covariance, Matrix& moved) {
  const Eigen::Index x = layout.states();
  const Eigen::Index q = layout.fluxes();
  const auto forget_ratio = [&](Eigen::Index i) { return i < x + q ? step.forget_ratio : step.drift_forget_ratio; };
  // Row by row, so that the compiler can vectorise over the columns.
  const auto add_row = [&](Eigen::Index i, double share, Eigen::Index j) {
    for (Eigen::Index c = 0; c < layout.size(); ++c) {
      moved(i, c) += share * covariance(j, c);
    }
  };
  for (Eigen::Index i = 0; i < x; ++i) {
    for (Eigen::Index c = 0; c < layout.size(); ++c) {
      moved(i, c) = step.transition[i * x] * covariance(0, c);
    }
    for (Eigen::Index j = 1; j < x; ++j) {
      add_row(i, step.transition[i * x + j], j);
    }
    for (Eigen::Index f = 0; f < q; ++f) {
      add_row(i, step.injection[i * q + f], x + f);
    }
  }
  for (Eigen::Index i = 0; i < x; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (Eigen::Index c = 0; c < x; ++c) {
        sum += moved(i, c) * step.transition[j * x + c];
      }
      for (Eigen::Index f = 0; f < q; ++f) {
        sum += moved(i, x + f) * step.injection[j * q + f];
      }
      covariance(i, j) = covariance(j, i) = sum;
    }
    for (Eigen::Index c = x; c < layout.size(); ++c) {
      covariance(i, c) = covariance(c, i) = moved(i, c) * forget_ratio(c);
    }
  }
  for (Eigen::Index i = x; i < layout.size(); ++i) {
    for (Eigen::Index c = x; c < layout.size(); ++c) {
      covariance(i, c) *= forget_ratio(i) * forget_ratio(c);
    }
  }
}

template <class Matrix>
void Whitening::add_unknown(std::optional<Eigen::Index> interval, Matrix& covariance) const {
  const auto gained_ratio = [interval](const std::vector<double>& forget_ratio) {
    const double left = interval ? forget_ratio[static_cast<std::size_t>(*interval)] : 0.0;
    return 1.0 - left * left;
  };
  const double of_flux = gained_ratio(forget_ratio_);
  for (Eigen::Index f = 0; f < run_->fluxes; ++f) {
    const double rms_W = flux_.rms_W[static_cast<std::size_t>(f)];
    covariance(run_->states + f, run_->states + f) += of_flux * rms_W * rms_W;
  }
  if (interval) {
    const auto uncertainty = std::ranges::lower_bound(run_->state_uncertainties, *interval, {}, &StateUncertainty::interval);
    if (uncertainty != run_->state_uncertainties.end() && uncertainty->interval == *interval) {
      covariance.topLeftCorner(run_->states, run_->states) += uncertainty->covariance_K2;
    }
  }
  if (drifts_) {
    const double of_drift = gained_ratio(drift_forget_ratio_);
    for (Eigen::Index sensor = 0; sensor < run_->sensors(); ++sensor) {
      covariance(drift_place(sensor), drift_place(sensor)) += of_drift * flux_.drift_K * flux_.drift_K;
    }
  }
}

template <class Layout>
void Whitening::build(const Layout& layout, const SensorNoise& noise) {
  const Eigen::Index size = layout.size();
  using Matrix = Eigen::Matrix<double, Layout::kMost, Layout::kMost, Eigen::RowMajor>;
  Matrix covariance = Matrix::Zero();
  Matrix moved = Matrix::Zero();
  std::array<double, Layout::kMost> learnt_K{};
  add_unknown({}, covariance);
  // Logarithms are slow: take one of the product of many factors, as long as it neither overflows nor underflows.
  constexpr double kSmall = 1e-100;
  double determinant = 1.0;
  for (Eigen::Index k = 0; k < run_->samples(); ++k) {
    for (Eigen::Index sensor = 0; sensor < run_->sensors(); ++sensor) {
      const Eigen::Index row = k * run_->sensors() + sensor;
      double* const gain = gain_.data() + row * size;
      const double weight = noise.weight.size() > 0 ? noise.weight[row] : 1.0;
      const int node = node_of(sensor);
      const Eigen::Index drift = drift_place(sensor);
      for (Eigen::Index i = 0; i < size; ++i) {
        gain[i] = layout.drifts() > 0 ? covariance(node, i) + covariance(drift, i) : covariance(node, i);
      }
      const double expected_K2 = layout.drifts() > 0 ? gain[node] + gain[drift] : gain[node];
      expected_K2_[static_cast<std::size_t>(row)] = expected_K2;
      if (std::isnan(run_->residual_K[row]) || weight <= 0.0) {
        std::fill_n(gain, size, 0.0);
        continue;
      }
      const double noise_K = noise.noise_K[static_cast<std::size_t>(sensor)];
      const double variance_K2 = expected_K2 + noise_K * noise_K / weight;
      const double inverse_sd_per_K = 1.0 / std::sqrt(variance_K2);
      for (Eigen::Index i = 0; i < size; ++i) {
        learnt_K[static_cast<std::size_t>(i)] = gain[i] * inverse_sd_per_K;
        gain[i] *= inverse_sd_per_K * inverse_sd_per_K;
      }
      for (Eigen::Index i = 0; i < size; ++i) {
        for (Eigen::Index j = 0; j < size; ++j) {
          covariance(i, j) -= learnt_K[static_cast<std::size_t>(i)] * learnt_K[static_cast<std::size_t>(j)];
        }
      }
      inverse_sd_per_K_[static_cast<std::size_t>(row)] = inverse_sd_per_K;
      determinant *= variance_K2;
      if (determinant < kSmall || determinant > 1.0 / kSmall) {
        log_determinant_ += std::log(determinant);
        determinant = 1.0;
      }
      ++count_;
    }
    if (k + 1 < run_->samples()) {
      predict(layout, step_of(k), covariance, moved);
      add_unknown(k, covariance);
    }
  }
  log_determinant_ += std::log(determinant);
}

/// Whitens `kStrip` columns in place.
template <class Layout>
void Whitening::apply_to_strip(const Layout& layout, Eigen::Ref<Columns> columns) const {
  using Row = Eigen::Array<double, 1, kStrip>;
  const Eigen::Index x = layout.states();
  const Eigen::Index q = layout.fluxes();
  std::array<Row, Layout::kMost> state, moved;
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
      if (layout.drifts() > 0) {
        innovation -= state[static_cast<std::size_t>(drift_place(sensor))];
      }
      const double* const gain = gain_.data() + row * layout.size();
      for (Eigen::Index i = 0; i < layout.size(); ++i) {
        state[static_cast<std::size_t>(i)] += gain[i] * innovation;
      }
      shown = inverse_sd_per_K * innovation;
    }
    if (k + 1 < run_->samples()) {
      const Step step = step_of(k);
      for (Eigen::Index i = 0; i < x; ++i) {
        Row sum = step.transition[i * x] * state[0];
        for (Eigen::Index j = 1; j < x; ++j) {
          sum += step.transition[i * x + j] * state[static_cast<std::size_t>(j)];
        }
        for (Eigen::Index j = 0; j < q; ++j) {
          sum += step.injection[i * q + j] * state[static_cast<std::size_t>(x + j)];
        }
        moved[static_cast<std::size_t>(i)] = sum;
      }
      std::copy_n(moved.begin(), x, state.begin());
      for (Eigen::Index j = x; j < x + q; ++j) {
        state[static_cast<std::size_t>(j)] *= step.forget_ratio;
      }
      for (Eigen::Index j = x + q; j < layout.size(); ++j) {
        state[static_cast<std::size_t>(j)] *= step.drift_forget_ratio;
      }
    }
  }
}

void Whitening::apply(Eigen::Ref<Columns> columns) const {
  const auto strip_by_strip = [this](Eigen::Ref<Columns> strip) { for_layout([&](const auto& layout) { apply_to_strip(layout, strip); }); };
  // Eight columns at a time, so that their filter states stay in the first-level cache.
  for (Eigen::Index first = 0; first < columns.cols(); first += kStrip) {
    if (first + kStrip <= columns.cols()) {
      strip_by_strip(columns.middleCols(first, kStrip));
    } else {
      const Eigen::Index rest = columns.cols() - first;
      Columns strip = Columns::Zero(columns.rows(), kStrip);
      strip.leftCols(rest) = columns.rightCols(rest);
      strip_by_strip(strip);
      columns.rightCols(rest) = strip.leftCols(rest);
    }
  }
}

Innovations Whitening::innovations(const Eigen::VectorXd& residual_K) const {
  Innovations all{residual_K, residual_K};
  Eigen::VectorXd state = Eigen::VectorXd::Zero(size_);
  SquareOfState transition(size_, size_);
  for (Eigen::Index k = 0; k < run_->samples(); ++k) {
    for (Eigen::Index sensor = 0; sensor < run_->sensors(); ++sensor) {
      const Eigen::Index row = k * run_->sensors() + sensor;
      const auto place = static_cast<std::size_t>(row);
      const double noise_K = noise_K_[static_cast<std::size_t>(sensor)];
      const double variance_K2 = expected_K2_[place] + noise_K * noise_K;
      const double innovation_K = residual_K[row] - state[node_of(sensor)] - (drifts_ ? state[drift_place(sensor)] : 0.0);
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
  using Dynamic = SquareOfState;
  const Eigen::Index x = run_->states;
  const Eigen::Index q = run_->fluxes;
  const Eigen::Index samples = run_->samples();
  Eigen::MatrixXd flux_W(q, samples);             // predicted, then smoothed
  Eigen::MatrixXd flux_rows(size_, q * samples);  // covariance of the fluxes with the state, before the sample's update
  Eigen::VectorXd innovation(residual_K.size());
  Eigen::VectorXd state = Eigen::VectorXd::Zero(size_);
  Dynamic covariance = Dynamic::Zero(size_, size_);
  Dynamic transition(size_, size_);
  add_unknown({}, covariance);
  for (Eigen::Index k = 0; k < samples; ++k) {
    flux_W.col(k) = state.segment(x, q);
    flux_rows.middleCols(k * q, q) = covariance.middleCols(x, q);
    for (Eigen::Index row = k * run_->sensors(); row < (k + 1) * run_->sensors(); ++row) {
      const double inverse_sd_per_K = inverse_sd_per_K_[static_cast<std::size_t>(row)];
      if (inverse_sd_per_K > 0.0) {
        const Eigen::Map<const Eigen::VectorXd> gain(gain_.data() + row * size_, size_);
        const Eigen::Index sensor = row - k * run_->sensors();
        innovation[row] = residual_K[row] - state[node_of(sensor)] - (drifts_ ? state[drift_place(sensor)] : 0.0);
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
  Dynamic information = Dynamic::Zero(size_, size_);  // information about the state from this sample to the last
  for (Eigen::Index k = samples - 1; k >= 0; --k) {
    for (Eigen::Index sensor = run_->sensors() - 1; sensor >= 0; --sensor) {
      const Eigen::Index row = k * run_->sensors() + sensor;
      const double inverse_sd_per_K = inverse_sd_per_K_[static_cast<std::size_t>(row)];
      if (inverse_sd_per_K > 0.0) {
        const Eigen::Map<const Eigen::VectorXd> gain(gain_.data() + row * size_, size_);
        const double moved = innovation[row] * inverse_sd_per_K * inverse_sd_per_K - gain.dot(adjoint);
        Eigen::VectorXd seen = Eigen::VectorXd::Zero(size_);
        seen[node_of(sensor)] = 1.0;
        if (drifts_) {
          seen[drift_place(sensor)] = 1.0;
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

}  // namespace heatsoak::estimation
