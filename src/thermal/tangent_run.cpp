#include "thermal/tangent_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/diagnostic.h"
#include "thermal/transient.h"

namespace heatsoak::thermal {
namespace {

/// Step size times the bound of the fastest eigenvalue; the local error is then below 1e-5 of the change.
constexpr double kStepPerTimeConstant = 0.5;
/// If interval times eigenvalue is below this, the third-order method has no larger error with one stage less.
constexpr double kShortStep = 0.12;

struct Stage {
  double share;   ///< time of the stage as a share of the step
  double weight;  ///< weight of the stage's rate in the result
};
constexpr Stage kFourthOrder[] = {{0.0, 1.0 / 6.0}, {0.5, 1.0 / 3.0}, {0.5, 1.0 / 3.0}, {1.0, 1.0 / 6.0}};
constexpr Stage kThirdOrder[] = {{0.0, 0.25}, {1.0 / 3.0, 0.0}, {2.0 / 3.0, 0.75}};

constexpr double kMostParts = 10'000.0;
constexpr double kAbsoluteZero_C = -273.15;

/// Derivatives of the state with respect to some quantities during one step, one column per quantity.
struct Sensitivities {
  const Eigen::MatrixXd& begin;          ///< at the beginning of the step
  const Eigen::MatrixXd* direct_per_s;   ///< derivative of the rates at a constant state; null: none
  Eigen::MatrixXd& rate_per_s;           ///< rates of the last stage
  Eigen::MatrixXd& weighted_rate_per_s;  ///< sum over the stages
};

/// Adds one stage, `ahead_s` after the beginning of the step. `States`: number of state nodes; 0: any number.
template <int States>
void add_stage(const Eigen::MatrixXd& by_state, double ahead_s, double weight, const Sensitivities& of) {
  const Eigen::Index states = States > 0 ? States : by_state.rows();
  std::array<double, (States > 0 ? States : Network::kMostNodes)> now{};
  for (Eigen::Index column = 0; column < of.begin.cols(); ++column) {
    const Eigen::Index first = column * states;
    const double* const begin = of.begin.data() + first;
    double* const rate_per_s = of.rate_per_s.data() + first;
    double* const sum_per_s = of.weighted_rate_per_s.data() + first;
    for (Eigen::Index i = 0; i < states; ++i) {
      now[static_cast<std::size_t>(i)] = ahead_s > 0.0 ? begin[i] + ahead_s * rate_per_s[i] : begin[i];
    }
    for (Eigen::Index i = 0; i < states; ++i) {
      double sum = by_state.data()[i] * now[0];
      for (Eigen::Index j = 1; j < states; ++j) {
        sum += by_state.data()[j * states + i] * now[static_cast<std::size_t>(j)];
      }
      rate_per_s[i] = of.direct_per_s ? sum + of.direct_per_s->data()[first + i] : sum;
      sum_per_s[i] += weight * rate_per_s[i];
    }
  }
}

void add_stage(const Eigen::MatrixXd& by_state, double ahead_s, double weight, const Sensitivities& of) {
  if (by_state.rows() == 2) {
    add_stage<2>(by_state, ahead_s, weight, of);
  } else if (by_state.rows() == 3) {
    add_stage<3>(by_state, ahead_s, weight, of);
  } else {
    add_stage<0>(by_state, ahead_s, weight, of);
  }
}

}  // namespace

TangentRun::TangentRun(const Network& network, std::span<const double> parameters, std::span<const int> wanted, std::span<const int> heated)
    : network_(network),
      parameters_(parameters.begin(), parameters.end()),
      wanted_(wanted.begin(), wanted.end()),
      heated_(heated.begin(), heated.end()) {
  const Eigen::Index states = network.state_count();
  const auto columns = static_cast<Eigen::Index>(wanted.size() + heated.size());
  for (Eigen::VectorXd* vector : {&step_.state_C, &stage_C_, &rate_sum_}) {
    vector->setZero(states);
  }
  for (Eigen::MatrixXd* matrix : {&step_.by_start, &rate_by_start_, &by_start_sum_}) {
    matrix->setZero(states, states);
  }
  for (Eigen::MatrixXd* matrix : {&step_.by_parameter, &direct_, &rate_by_parameter_, &by_parameter_sum_}) {
    matrix->setZero(states, columns);
  }
  for (std::size_t q = 0; q < heated.size(); ++q) {
    const double capacity_J_per_K = parameters_[static_cast<std::size_t>(network.capacity_index(heated[q]))];
    direct_(heated[q], static_cast<Eigen::Index>(wanted.size() + q)) = 1.0 / capacity_J_per_K;
  }
}

void TangentRun::set_slope(const OperatingPoint<double>& at, const Eigen::VectorXd& state_C) {
  network_.linearise(at, parameters_, std::span(state_C.data(), static_cast<std::size_t>(state_C.size())), slope_);
}

const NetworkStep& TangentRun::over(std::span<const double> start_C, double duration_s, const OperatingPoint<double>& at) {
  std::ranges::copy(start_C, step_.state_C.begin());
  step_.by_start.setIdentity();
  step_.by_parameter.setZero();
  set_slope(at, step_.state_C);
  const double fastest_per_s = slope_.by_state.cwiseAbs().rowwise().sum().maxCoeff();
  const double parts = std::max(1.0, std::ceil(duration_s * fastest_per_s / kStepPerTimeConstant));
  if (!(parts <= kMostParts)) {
    throw base::Failure(base::ExitCode::numerics_failed,
                        fmt::format("a thermal network with a time constant of {:.2g} s is too fast for an interval "
                                    "of {:.3g} s; check whether a thermal resistance or a heat capacity is too small",
                                    1.0 / fastest_per_s, duration_s));
  }
  for (int part = 0; part < static_cast<int>(parts); ++part) {
    if (part > 0) {
      set_slope(at, step_.state_C);
    }
    one_step(duration_s / parts, duration_s * fastest_per_s < kShortStep, at);
  }
  if (!(step_.state_C.minCoeff() > kAbsoluteZero_C && step_.state_C.maxCoeff() < kDestroyed_C)) {
    throw base::Failure(
        base::ExitCode::numerics_failed,
        fmt::format("the simulated temperature leaves {:.0f} to {:.0f} °C with the logged heat input", kAbsoluteZero_C, kDestroyed_C));
  }
  return step_;
}

void TangentRun::one_step(double step_s, bool is_short, const OperatingPoint<double>& at) {
  rate_sum_.setZero();
  by_start_sum_.setZero();
  by_parameter_sum_.setZero();
  for (const auto& [share, weight] : is_short ? std::span<const Stage>(kThirdOrder) : std::span<const Stage>(kFourthOrder)) {
    const double ahead_s = share * step_s;
    if (ahead_s > 0.0) {
      stage_C_ = step_.state_C + ahead_s * slope_.rate_K_per_s;
      set_slope(at, stage_C_);
    }
    for (std::size_t w = 0; w < wanted_.size(); ++w) {
      direct_.col(static_cast<Eigen::Index>(w)) = slope_.by_parameter.col(wanted_[w]);
    }
    add_stage(slope_.by_state, ahead_s, weight, {step_.by_start, nullptr, rate_by_start_, by_start_sum_});
    add_stage(slope_.by_state, ahead_s, weight, {step_.by_parameter, &direct_, rate_by_parameter_, by_parameter_sum_});
    rate_sum_ += weight * slope_.rate_K_per_s;
  }
  step_.state_C += step_s * rate_sum_;
  step_.by_start += step_s * by_start_sum_;
  step_.by_parameter += step_s * by_parameter_sum_;
}

}  // namespace heatsoak::thermal
