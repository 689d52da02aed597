#include "thermal/steady_state.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/copper.h"
#include "base/diagnostic.h"

namespace heatsoak::thermal {
namespace {

Eigen::VectorXd rates_at(const RateFunction& rates, const Eigen::VectorXd& state_C) {
  Eigen::VectorXd rate(state_C.size());
  const auto count = static_cast<std::size_t>(state_C.size());
  rates(std::span(state_C.data(), count), std::span(rate.data(), count));
  return rate;
}

/// Central differences over 2 K: exact except for rounding if the laws are linear in temperature.
Eigen::MatrixXd jacobian_at(const RateFunction& rates, const Eigen::VectorXd& state_C) {
  Eigen::MatrixXd result(state_C.size(), state_C.size());
  for (Eigen::Index i = 0; i < state_C.size(); ++i) {
    Eigen::VectorXd above = state_C;
    Eigen::VectorXd below = state_C;
    above[i] += 1.0;
    below[i] -= 1.0;
    result.col(i) = 0.5 * (rates_at(rates, above) - rates_at(rates, below));
  }
  return result;
}

}  // namespace

std::optional<SteadyState> steady_state(const RateFunction& rates, std::span<const double> start_C) {
  constexpr int kMostIterations = 50;
  Eigen::VectorXd state_C = Eigen::Map<const Eigen::VectorXd>(start_C.data(), static_cast<Eigen::Index>(start_C.size()));
  for (int i = 0; i < kMostIterations; ++i) {
    const Eigen::MatrixXd jacobian = jacobian_at(rates, state_C);
    if (jacobian.eigenvalues().real().maxCoeff() >= 0.0) {
      return std::nullopt;
    }
    const Eigen::VectorXd step_K = jacobian.partialPivLu().solve(rates_at(rates, state_C));
    state_C -= step_K;
    if (step_K.cwiseAbs().maxCoeff() < 1e-11 * (1.0 + state_C.cwiseAbs().maxCoeff())) {
      return SteadyState{{state_C.begin(), state_C.end()}};
    }
  }
  throw base::Failure(base::ExitCode::numerics_failed, "the steady state was not found in 50 Newton steps");
}

std::optional<SteadyState> steady_state(const Network& network, const OperatingPoint<double>& at) {
  const std::vector<double> values = network.values();
  std::vector<double> temperature_C(static_cast<std::size_t>(network.node_count()));
  const auto rates = [&](std::span<const double> state_C, std::span<double> rate_K_per_s) {
    std::ranges::copy(state_C, temperature_C.begin());
    network.rate_K_per_s<double>(at, values, temperature_C, rate_K_per_s);
  };
  return steady_state(rates, std::vector<double>(static_cast<std::size_t>(network.state_count()), at.ambient_C));
}

OnOffSteadyState on_off_steady_state(const TwoNodeMotor& motor, const OnOffCurrent& current) {
  OnOffSteadyState result;
  result.current_rms_A = current.current_on_A * std::sqrt(current.time_on_s / (current.time_on_s + current.time_off_s));  // (8)
  const double resistance_ambient_ohm =
      motor.terminal_resistance_25C_ohm * base::resistance_ratio(motor.temperature_coefficient_per_K, current.ambient_C);
  const double coefficient_per_K = motor.temperature_coefficient_per_K * motor.terminal_resistance_25C_ohm / resistance_ambient_ohm;
  const double total_K_per_W = motor.thermal_resistance_winding_stator_K_per_W + motor.thermal_resistance_stator_ambient_K_per_W;
  const double cold_rise_K = total_K_per_W * resistance_ambient_ohm * result.current_rms_A * result.current_rms_A;
  const double denominator = 1.0 - coefficient_per_K * cold_rise_K;
  result.runaway = !(denominator > 0.0);
  const double winding_rise_K = cold_rise_K / denominator;                                                        // (9)
  const double stator_rise_K = motor.thermal_resistance_stator_ambient_K_per_W / total_K_per_W * winding_rise_K;  // (10)
  result.stator_C = current.ambient_C + stator_rise_K;                                                            // (11)
  result.winding_C = current.ambient_C + winding_rise_K;                                                          // (12)
  return result;
}

}  // namespace heatsoak::thermal
