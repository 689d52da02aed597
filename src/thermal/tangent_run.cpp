#include "thermal/tangent_run.h"

#include <fmt/format.h>

#include <algorithm>
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
  for (Eigen::MatrixXd* matrix : {&step_.by_start, &stage_by_start_, &rate_by_start_, &by_start_sum_}) {
    matrix->setZero(states, states);
  }
  for (Eigen::MatrixXd* matrix : {&step_.by_parameter, &stage_by_parameter_, &rate_by_parameter_, &by_parameter_sum_}) {
    matrix->setZero(states, columns);
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
    stage_by_start_ = step_.by_start;
    stage_by_parameter_ = step_.by_parameter;
    if (ahead_s > 0.0) {
      stage_C_ = step_.state_C + ahead_s * slope_.rate_K_per_s;
      stage_by_start_ += ahead_s * rate_by_start_;
      stage_by_parameter_ += ahead_s * rate_by_parameter_;
      set_slope(at, stage_C_);
    }
    rate_by_start_.noalias() = slope_.by_state * stage_by_start_;
    rate_by_parameter_.noalias() = slope_.by_state * stage_by_parameter_;
    for (std::size_t w = 0; w < wanted_.size(); ++w) {
      rate_by_parameter_.col(static_cast<Eigen::Index>(w)) += slope_.by_parameter.col(wanted_[w]);
    }
    for (std::size_t q = 0; q < heated_.size(); ++q) {
      const double capacity_J_per_K = parameters_[static_cast<std::size_t>(network_.capacity_index(heated_[q]))];
      rate_by_parameter_(heated_[q], static_cast<Eigen::Index>(wanted_.size() + q)) += 1.0 / capacity_J_per_K;
    }
    rate_sum_ += weight * slope_.rate_K_per_s;
    by_start_sum_ += weight * rate_by_start_;
    by_parameter_sum_ += weight * rate_by_parameter_;
  }
  step_.state_C += step_s * rate_sum_;
  step_.by_start += step_s * by_start_sum_;
  step_.by_parameter += step_s * by_parameter_sum_;
}

}  // namespace heatsoak::thermal
