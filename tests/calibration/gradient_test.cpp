// Derivatives of the prediction with respect to start temperatures and parameters. References are differences of the same code, and
// complex-step derivatives of equations and an integrator in this file.
#include <gtest/gtest.h>

#include <complex>

#include "estimation/linearised_run.h"
#include "runs_for_tests.h"

namespace heatsoak::calibration {
namespace {

using Complex = std::complex<double>;

/// Parameters: winding capacity, winding-stator, stator capacity, stator-ambient, then the start temperatures of winding and stator.
template <class S>
using Unknowns = std::array<S, 6>;

/// Returns the sensors' values at the end of the run, by fourth-order Runge-Kutta steps of a hundredth of an interval.
template <class S>
std::array<S, 2> at_end(const Unknowns<S>& u, const estimation::TwoNodeTruth& truth, const estimation::MeasuredRun& run) {
  S w = u[4];
  S s = u[5];
  for (std::size_t k = 0; k < run.at.size(); ++k) {
    constexpr int kParts = 100;
    const double h_s = (run.time_s[k + 1] - run.time_s[k]) / kParts;
    const double square_A2 = run.at[k].current_rms_A * run.at[k].current_rms_A;
    const auto slope = [&](S w_C, S s_C) {
      const S joule_W = square_A2 * truth.resistance_25C_ohm * (1.0 + truth.temperature_coefficient_per_K * (w_C - 25.0));
      const S across_W = (w_C - s_C) / u[1];
      return std::array<S, 2>{(joule_W - across_W) / u[0], (across_W - (s_C - run.at[k].ambient_C) / u[3]) / u[2]};
    };
    for (int part = 0; part < kParts; ++part) {
      const auto a = slope(w, s);
      const auto b = slope(w + 0.5 * h_s * a[0], s + 0.5 * h_s * a[1]);
      const auto c = slope(w + 0.5 * h_s * b[0], s + 0.5 * h_s * b[1]);
      const auto d = slope(w + h_s * c[0], s + h_s * c[1]);
      w += h_s / 6.0 * (a[0] + 2.0 * b[0] + 2.0 * c[0] + d[0]);
      s += h_s / 6.0 * (a[1] + 2.0 * b[1] + 2.0 * c[1] + d[1]);
    }
  }
  return {w, s};
}

class Gradient : public testing::Test {
 protected:
  Gradient() : run_(estimation::generated_run(truth_, making(), 3, 0)), model_(estimation::two_node_model(truth_, 1.0)) {
    for (const estimation::FreeParameter& parameter : model_.free) {
      wanted_.push_back(parameter.place);
    }
  }
  static estimation::LogMaking making() {
    estimation::LogMaking making;
    making.duration_s = 240.0;
    return making;
  }
  [[nodiscard]] estimation::LinearisedRun linearised(const std::vector<double>& values, const std::vector<double>& start_C) const {
    return estimation::linearise(model_.network, values, wanted_, model_.flux_nodes, start_C, run_);
  }

  const estimation::TwoNodeTruth truth_;
  const estimation::MeasuredRun run_;
  const estimation::Model model_;
  const std::vector<double> start_C_{31.0, 27.0};
  std::vector<int> wanted_;
};

TEST_F(Gradient, AgreesWithTheComplexStepThroughOtherEquations) {
  const estimation::LinearisedRun found = linearised(model_.values, start_C_);
  const Eigen::Index last = (found.samples() - 1) * 2;
  const Unknowns<double> here{truth_.winding_J_per_K,
                              truth_.winding_stator_K_per_W,
                              truth_.stator_J_per_K,
                              truth_.stator_ambient_K_per_W,
                              start_C_[0],
                              start_C_[1]};
  for (std::size_t i = 0; i < here.size(); ++i) {
    Unknowns<Complex> moved;
    std::ranges::copy(here, moved.begin());
    constexpr double kStep = 1e-30;
    moved[i] += Complex(0.0, kStep);
    const std::array<Complex, 2> end = at_end(moved, truth_, run_);
    for (Eigen::Index sensor = 0; sensor < 2; ++sensor) {
      const double expected = end[static_cast<std::size_t>(sensor)].imag() / kStep;
      const auto column = static_cast<Eigen::Index>(i);
      const double slope = i < 4 ? found.by_parameter(last + sensor, column) : found.by_start(last + sensor, column - 4);
      // The tolerance covers the discretisation error of the tool's step.
      EXPECT_NEAR(slope, expected, 1e-4 * std::abs(expected) + 1e-9) << i << ' ' << sensor;
      EXPECT_NEAR(found.state_C(sensor, found.samples() - 1), end[static_cast<std::size_t>(sensor)].real(), 1e-3);
    }
  }
}

TEST_F(Gradient, AgreesWithDifferencesOfItsOwnPrediction) {
  const estimation::LinearisedRun found = linearised(model_.values, start_C_);
  const auto close = [&](const estimation::Columns& columns, Eigen::Index column, const estimation::LinearisedRun& up,
                         const estimation::LinearisedRun& down, double apart) {
    double worst = 0.0;
    for (Eigen::Index k = 0; k < found.samples(); ++k) {
      for (Eigen::Index sensor = 0; sensor < 2; ++sensor) {
        const double expected = (up.state_C(sensor, k) - down.state_C(sensor, k)) / apart;
        worst = std::max(worst, std::abs(columns(k * 2 + sensor, column) - expected));
      }
    }
    return worst / columns.col(column).cwiseAbs().maxCoeff();
  };
  constexpr double kStep_ratio = 1e-5;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    std::vector<double> up = model_.values;
    std::vector<double> down = model_.values;
    const auto place = static_cast<std::size_t>(wanted_[i]);
    up[place] *= 1.0 + kStep_ratio;
    down[place] *= 1.0 - kStep_ratio;
    EXPECT_LT(close(found.by_parameter, static_cast<Eigen::Index>(i), linearised(up, start_C_), linearised(down, start_C_),
                    up[place] - down[place]),
              1e-6)
        << i;
  }
  for (Eigen::Index node = 0; node < 2; ++node) {
    std::vector<double> up = start_C_;
    std::vector<double> down = start_C_;
    up[static_cast<std::size_t>(node)] += 1e-3;
    down[static_cast<std::size_t>(node)] -= 1e-3;
    EXPECT_LT(close(found.by_start, node, linearised(model_.values, up), linearised(model_.values, down), 2e-3), 1e-6) << node;
  }
}

}  // namespace
}  // namespace heatsoak::calibration
