#include "thermal/steady_state.h"

#include <Eigen/Dense>
#include <cmath>

#include "base/copper.h"
#include "base/diagnostic.h"

namespace heatsoak::thermal {
namespace {

class Rates {
 public:
  Rates(const Network& network, const OperatingPoint<double>& at)
      : network_(network), at_(at), values_(network.values()), temperature_C_(static_cast<std::size_t>(network.node_count())) {}

  Eigen::VectorXd operator()(const Eigen::VectorXd& state_C) {
    Eigen::VectorXd rate(state_C.size());
    std::copy(state_C.begin(), state_C.end(), temperature_C_.begin());
    network_.rate_K_per_s<double>(at_, values_, temperature_C_, std::span(rate.data(), static_cast<std::size_t>(rate.size())));
    return rate;
  }

  /// Central differences over 2 K: exact except for rounding if the laws are linear in temperature.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& state_C) {
    Eigen::MatrixXd result(state_C.size(), state_C.size());
    for (Eigen::Index i = 0; i < state_C.size(); ++i) {
      Eigen::VectorXd above = state_C;
      Eigen::VectorXd below = state_C;
      above[i] += 1.0;
      below[i] -= 1.0;
      result.col(i) = 0.5 * ((*this)(above) - (*this)(below));
    }
    return result;
  }

 private:
  const Network& network_;
  OperatingPoint<double> at_;
  std::vector<double> values_;
  std::vector<double> temperature_C_;
};

}  // namespace

std::optional<SteadyState> steady_state(const Network& network, const OperatingPoint<double>& at) {
  constexpr int kMostIterations = 50;
  Rates rates(network, at);
  Eigen::VectorXd state_C = Eigen::VectorXd::Constant(network.state_count(), at.ambient_C);
  for (int i = 0; i < kMostIterations; ++i) {
    const Eigen::MatrixXd jacobian = rates.jacobian(state_C);
    if (jacobian.eigenvalues().real().maxCoeff() >= 0.0) {
      return std::nullopt;
    }
    const Eigen::VectorXd step_K = jacobian.partialPivLu().solve(rates(state_C));
    state_C -= step_K;
    if (step_K.cwiseAbs().maxCoeff() < 1e-11 * (1.0 + state_C.cwiseAbs().maxCoeff())) {
      return SteadyState{{state_C.begin(), state_C.end()}};
    }
  }
  throw base::Failure(base::ExitCode::numerics_failed, "the steady state was not found in 50 Newton steps");
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
